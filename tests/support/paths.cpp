#include "tests/support/paths.h"

namespace tribodyn {

std::string test_data_file(const std::string& name) { return TRIBODYN_TEST_DATA "/" + name; }

std::string server_program() { return TRIBODYND_PATH; }

std::string empty_server_program() { return EMPTY_SERVER_PATH; }

}  // namespace tribodyn
