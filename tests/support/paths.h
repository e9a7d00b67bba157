#pragma once

#include <string>

namespace tribodyn {

// Only paths.cpp is compiled with paths of this checkout in it: a compiler cache serves all other
// test code to a checkout elsewhere.

/// The path of a file in tests/data.
std::string test_data_file(const std::string& name);

/// The path of the tribodynd that this build made; empty in a build without the service.
std::string server_program();

/// The path of the tribodynd that has the bugs of tests/crash/seeded_bugs, and that folder.
std::string seeded_server_program();
std::string seeded_bugs_folder();

/// The folder of the requests from which request_fuzzer starts: a method's name, then the request
/// in protobuf's text format.
std::string request_corpus_folder();

/// The path of the server that answers with nothing, which benchmarks compare with.
std::string empty_server_program();

}  // namespace tribodyn
