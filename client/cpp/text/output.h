#pragma once

#include <google/protobuf/message.h>

#include <functional>
#include <ostream>
#include <string>

namespace tribodyn::client {

enum class OutputFormat { kTable, kCsv, kJson };

/// Returns the message in protobuf's JSON mapping with the field names of the protos (snake_case),
/// indented, with fields that are zero.
std::string json_text(const google::protobuf::Message& message);

/// Returns "\"text\"" as JSON.
std::string json_quoted(const std::string& text);
/// Returns the number as JSON; null if it is not finite.
std::string json_number(double value);
/// Returns the JSON object with one more member; `value` is JSON.
std::string json_with(std::string object, const std::string& name, const std::string& value);

/// Replaces the file in one step: a reader sees either the old text or the new text. Throws Failure
/// if the file cannot be written.
void write_file(const std::string& path, const std::string& text);
/// As above; `write` writes the text.
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

/// Returns why write_file() would fail for a path, as far as a check without writing can find out;
/// empty if the check finds no obstacle.
std::string why_not_writable(const std::string& path);

}  // namespace tribodyn::client
