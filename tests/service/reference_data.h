#pragma once

#include <google/protobuf/struct.pb.h>

#include <string>
#include <vector>

namespace tribodyn::server {

using JsonValue = google::protobuf::Value;

/// A file of tests/data. A bare Infinity, as Python writes it, reads as null.
JsonValue load_reference(const std::string& name);

/// "tables.Rx.0": members by name, elements by number.
const JsonValue& at(const JsonValue& value, const std::string& path);
double number(const JsonValue& value, const std::string& path);
std::vector<double> numbers(const JsonValue& list);

}  // namespace tribodyn::server
