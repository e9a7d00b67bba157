#pragma once

#include <string>

namespace tribodyn {

// Only paths.cpp contains paths of this checkout, so that the compiler cache works for all other
// test code in every checkout.

/// Returns the path of a file in tests/data.
std::string test_data_file(const std::string& name);

/// Returns the path of this build's tribodynd; empty in a build without the service.
std::string server_program();

/// Returns the path of the tribodynd with the bugs of tests/crash/seeded_bugs.
std::string seeded_server_program();
std::string seeded_bugs_folder();

/// Returns the folder of the corpus of request_fuzzer. A file has a method's name, then the request
/// in protobuf's text format.
std::string request_corpus_folder();

std::string make_certificates_program();

/// Returns the path of a server whose answers are empty, the baseline of benchmarks.
std::string empty_server_program();

}  // namespace tribodyn
