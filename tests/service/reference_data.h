#pragma once

#include <google/protobuf/struct.pb.h>

#include <string>
#include <vector>

namespace tribodyn::server {

using JsonValue = google::protobuf::Value;

/// Reads a file of tests/data. Infinity without quotes, as Python writes it, becomes null.
JsonValue load_reference(const std::string& name);

/// Returns the value at a path such as "tables.Rx.0": members by name, elements by number.
const JsonValue& at(const JsonValue& value, const std::string& path);
double number(const JsonValue& value, const std::string& path);
std::vector<double> numbers(const JsonValue& list);

}  // namespace tribodyn::server
