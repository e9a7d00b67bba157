#include "tests/support/paths.h"

namespace tribodyn {

std::string test_data_file(const std::string& name) { return TRIBODYN_TEST_DATA "/" + name; }

std::string server_program() { return TRIBODYND_PATH; }

std::string seeded_server_program() { return SEEDED_SERVER_PATH; }

std::string seeded_bugs_folder() { return SEEDED_BUGS_FOLDER; }

std::string request_corpus_folder() { return REQUEST_CORPUS_FOLDER; }

std::string make_certificates_program() { return MAKE_CERTIFICATES_PATH; }

std::string empty_server_program() { return EMPTY_SERVER_PATH; }

}  // namespace tribodyn
