#pragma once

#include <google/protobuf/compiler/parser.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <string>

namespace tribodyn {

/// Returns the descriptors of a proto file of package p with `body`. Types stay as `body` names
/// them, and options stay uninterpreted.
inline google::protobuf::FileDescriptorSet parsed_contract(const std::string& body) {
  const std::string text = "syntax = \"proto3\"; package p;\n" + body;
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  google::protobuf::io::Tokenizer tokenizer(&stream, nullptr);
  google::protobuf::compiler::Parser parser;
  google::protobuf::FileDescriptorSet set;
  EXPECT_TRUE(parser.Parse(&tokenizer, set.add_file())) << text;
  return set;
}

}  // namespace tribodyn
