#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace tribodyn::client {

enum class OutputFormat { kTable, kCsv, kJson };

/// The message as protobuf's JSON mapping defines it, indented, zeros written out.
std::string json_text(const google::protobuf::Message& message);

/// Replaces the file in one step: a reader sees the old text or the new one, never half of it.
/// Throws Failure when the file cannot be written.
void write_file(const std::string& path, const std::string& text);

/// Why write_file() would fail for a path, as far as that can be told without writing; empty when
/// nothing stands against it.
std::string why_not_writable(const std::string& path);

}  // namespace tribodyn::client
