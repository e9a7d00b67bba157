#include "tests/contract/breaking_changes.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

namespace tribodyn {
namespace {

using google::protobuf::FileDescriptorSet;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr char kContract[] = R"(
  file {
    package: "p"
    message_type {
      name: "M"
      field { name: "a" number: 1 type: TYPE_DOUBLE label: LABEL_OPTIONAL }
      field { name: "b" number: 2 type: TYPE_STRING label: LABEL_OPTIONAL oneof_index: 0 }
      oneof_decl { name: "choice" }
      nested_type { name: "Inner" field { name: "c" number: 1 type: TYPE_MESSAGE type_name: ".p.M" label: LABEL_REPEATED } }
    }
    enum_type { name: "E" value { name: "E_UNSPECIFIED" number: 0 } value { name: "E_ON" number: 1 } }
    service { name: "S" method { name: "Get" input_type: ".p.M" output_type: ".p.M" server_streaming: true } }
  })";

FileDescriptorSet contract() {
  FileDescriptorSet out;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(kContract, &out));
  return out;
}

std::vector<std::string> changed(void (*change)(google::protobuf::FileDescriptorProto&)) {
  FileDescriptorSet now = contract();
  change(*now.mutable_file(0));
  return breaking_changes(contract(), now);
}

TEST(BreakingChanges, AreNoneInTheSameContract) {
  EXPECT_THAT(changed([](auto&) {}), IsEmpty());
}

TEST(BreakingChanges, AreNotAdditions) {
  EXPECT_THAT(changed([](auto& file) {
                auto* field = file.mutable_message_type(0)->add_field();
                field->set_name("new");
                field->set_number(3);
                file.add_message_type()->set_name("New");
                auto* value = file.mutable_enum_type(0)->add_value();
                value->set_name("E_NEW");
                value->set_number(2);
                file.mutable_service(0)->add_method()->set_name("List");
                file.mutable_service(0)->mutable_method(1)->set_input_type(".p.M");
                file.mutable_service(0)->mutable_method(1)->set_output_type(".p.M");
              }),
              IsEmpty());
}

TEST(BreakingChanges, AreAChangedNumber) {
  EXPECT_THAT(
      changed([](auto& file) { file.mutable_message_type(0)->mutable_field(0)->set_number(7); }),
      ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished"));
}

TEST(BreakingChanges, AreAChangedNameTypeCardinalityOrOneof) {
  EXPECT_THAT(
      changed([](auto& file) { file.mutable_message_type(0)->mutable_field(0)->set_name("z"); }),
      ElementsAre("p.M #1 was \"a, TYPE_DOUBLE\" and is \"z, TYPE_DOUBLE\""));
  EXPECT_THAT(changed([](auto& file) {
                file.mutable_message_type(0)->mutable_field(0)->set_type(
                    google::protobuf::FieldDescriptorProto::TYPE_FLOAT);
              }),
              ElementsAre("p.M #1 was \"a, TYPE_DOUBLE\" and is \"a, TYPE_FLOAT\""));
  EXPECT_THAT(changed([](auto& file) {
                file.mutable_message_type(0)->mutable_field(0)->set_label(
                    google::protobuf::FieldDescriptorProto::LABEL_REPEATED);
              }),
              ElementsAre("p.M #1 was \"a, TYPE_DOUBLE\" and is \"a, repeated TYPE_DOUBLE\""));
  EXPECT_THAT(changed([](auto& file) {
                file.mutable_message_type(0)->mutable_field(0)->set_proto3_optional(true);
              }),
              ElementsAre("p.M #1 was \"a, TYPE_DOUBLE\" and is \"a, optional TYPE_DOUBLE\""));
  EXPECT_THAT(
      changed(
          [](auto& file) { file.mutable_message_type(0)->mutable_field(1)->clear_oneof_index(); }),
      ElementsAre("p.M #2 was \"b, TYPE_STRING in oneof choice\" and is \"b, TYPE_STRING\""));
  EXPECT_THAT(
      changed([](auto& file) {
        file.mutable_message_type(0)->mutable_nested_type(0)->mutable_field(0)->set_type_name(
            ".p.N");
      }),
      ElementsAre("p.M.Inner #1 was \"c, repeated p.M\" and is \"c, repeated p.N\""));
}

TEST(BreakingChanges, AreARemovedFieldUnlessItsNumberAndNameAreReserved) {
  const auto remove = [](auto& file) {
    file.mutable_message_type(0)->mutable_field()->DeleteSubrange(0, 1);
    return file.mutable_message_type(0);
  };
  FileDescriptorSet now = contract();
  auto* message = remove(*now.mutable_file(0));
  EXPECT_THAT(breaking_changes(contract(), now), ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished"));
  auto* range = message->add_reserved_range();
  range->set_start(1);
  range->set_end(2);
  EXPECT_THAT(breaking_changes(contract(), now),
              ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished and its name is not reserved"));
  message->add_reserved_name("a");
  EXPECT_THAT(breaking_changes(contract(), now), IsEmpty());
  EXPECT_THAT(
      breaking_changes(now, contract()),
      ElementsAre("p.M #1 was \"reserved\" and is \"a, TYPE_DOUBLE\"", "p.M a (reserved) vanished"))
      << "a reserved number comes back";
}

TEST(BreakingChanges, AreAValueThatIsRenamedOrRemoved) {
  EXPECT_THAT(
      changed([](auto& file) { file.mutable_enum_type(0)->mutable_value(1)->set_name("E_OFF"); }),
      ElementsAre("p.E #1 was \"E_ON\" and is \"E_OFF\""));
  EXPECT_THAT(changed([](auto& file) { file.mutable_enum_type(0)->mutable_value()->RemoveLast(); }),
              ElementsAre("p.E #1 (E_ON) vanished"));
  EXPECT_THAT(changed([](auto& file) {
                auto* type = file.mutable_enum_type(0);
                type->mutable_value()->RemoveLast();
                type->add_reserved_range()->set_start(1);
                type->mutable_reserved_range(0)->set_end(1);
                type->add_reserved_name("E_ON");
              }),
              IsEmpty());
}

TEST(BreakingChanges, AreARemovedMessageServiceOrMethodAndAChangedSignature) {
  EXPECT_THAT(
      changed([](auto& file) { file.mutable_message_type(0)->clear_nested_type(); }),
      ElementsAre("p.M.Inner (message) vanished", "p.M.Inner #1 (c, repeated p.M) vanished"));
  EXPECT_THAT(changed([](auto& file) { file.clear_service(); }),
              ElementsAre("p.S (service) vanished", "p.S/Get (p.M -> stream p.M) vanished"));
  EXPECT_THAT(changed([](auto& file) {
                file.mutable_service(0)->mutable_method(0)->set_server_streaming(false);
              }),
              ElementsAre("p.S/Get was \"p.M -> stream p.M\" and is \"p.M -> p.M\""));
}

}  // namespace
}  // namespace tribodyn
