// Tests of the check of a request's bytes before it is parsed, and of partial parsing.
#include "server/application/wire_check.h"

#include <gmock/gmock.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "server/application/element_limits.h"
#include "server/contract/parse_fields.h"
#include "server/resources/gear_set_checks.h"
#include "tests/service/contract_methods.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Returns the violations of a request as "path: description". The bytes arrive in blocks of a few
/// bytes.
std::vector<std::string> judge_bytes(const std::string& bytes, const Descriptor& type) {
  google::protobuf::io::ArrayInputStream in(bytes.data(), static_cast<int>(bytes.size()), 7);
  Violations violations;
  check_wire(in, static_cast<int>(bytes.size()), type, violations);
  std::vector<std::string> out;
  for (const Violation& each : violations) out.push_back(each.field + ": " + each.description);
  return out;
}
std::vector<std::string> judge_bytes(const Message& message) {
  return judge_bytes(message.SerializeAsString(), *message.GetDescriptor());
}

/// Returns the wire format of a length-delimited field.
std::string wire_field(int number, const std::string& content) {
  std::string out;
  google::protobuf::io::StringOutputStream stream(&out);
  google::protobuf::io::CodedOutputStream coded(&stream);
  coded.WriteTag(static_cast<std::uint32_t>(number) << 3 | 2);
  coded.WriteVarint32(static_cast<std::uint32_t>(content.size()));
  coded.WriteString(content);
  coded.Trim();
  return out;
}

std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

void collect_lists(const Descriptor& type, std::set<const Descriptor*>& seen,
                   std::set<const FieldDescriptor*>& lists) {
  if (!seen.insert(&type).second) return;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated()) lists.insert(&field);
    if (field.message_type() != nullptr) collect_lists(*field.message_type(), seen, lists);
  }
}

TEST(ElementLimits, EveryListThatARequestCanHoldHasOne) {
  std::set<const Descriptor*> seen;
  std::set<const FieldDescriptor*> lists;
  for (const MethodDescriptor* method : all_methods()) {
    collect_lists(*method->input_type(), seen, lists);
  }
  EXPECT_GT(lists.size(), 40U);
  for (const FieldDescriptor* list : lists) {
    EXPECT_TRUE(maximum_elements(*list)) << list->full_name() << ": add max_items";
  }
}

TEST(WireCheck, NamesTheListItsElementsAndItsLimit) {
  v1::CreateGearSetRequest request;
  const std::string slots = wire_field(1, repeated(std::string("\x3a\x00", 2), 5000));
  EXPECT_THAT(judge_bytes(slots, *request.GetDescriptor()),
              ElementsAre("gear_set.flank_slots: 5000 entries; allowed: at most 3"));
  v1::BatchUpdateLubricantsRequest batch;
  for (int i = 0; i < 3; ++i) batch.add_requests();
  for (int i = 0; i < 201; ++i) batch.mutable_requests(1)->mutable_update_mask()->add_paths("");
  for (int i = 0; i < 65; ++i) batch.mutable_requests(2)->mutable_lubricant()->add_labels();
  EXPECT_THAT(judge_bytes(batch),
              ElementsAre("requests[1].update_mask.paths: 201 entries; allowed: at most 200",
                          "requests[2].lubricant.labels: 65 entries; allowed: at most 64"));
}

TEST(WireCheck, CountsNumbersPackedAndSingle) {
  v1::CreateSimulationRequest request;
  auto* curve = request.mutable_simulation()->mutable_inefficiency_curve();
  for (int i = 0; i < 1000; ++i) curve->add_speeds_kilometres_per_hour(i + 1);
  EXPECT_THAT(judge_bytes(request), IsEmpty());
  const std::string single("\x09\x00\x00\x00\x00\x00\x00\x59\x40", 9);
  const std::string more = request.SerializeAsString() + wire_field(1, wire_field(12, single));
  EXPECT_THAT(
      judge_bytes(more, *request.GetDescriptor()),
      ElementsAre(
          "simulation.inefficiency_curve.speeds_kilometres_per_hour: 1001 entries; allowed: "
          "at most 1000"));
}

TEST(WireCheck, AddsUpTheListsOfAMessageSentInParts) {
  v1::CreateSimulationRequest request;
  for (int i = 0; i < 40; ++i) request.mutable_simulation()->add_labels()->set_key("k");
  EXPECT_THAT(judge_bytes(request), IsEmpty());
  EXPECT_THAT(judge_bytes(repeated(request.SerializeAsString(), 2), *request.GetDescriptor()),
              ElementsAre("simulation.labels: 80 entries; allowed: at most 64"));
}

TEST(WireCheck, LimitsUnknownFields) {
  v1::CreateLubricantRequest request;
  const std::string unknown("\xf8\x3f\x01", 3);  // field 1023 = 1
  EXPECT_THAT(judge_bytes(wire_field(1, repeated(unknown, 100)), *request.GetDescriptor()),
              IsEmpty());
  EXPECT_THAT(
      judge_bytes(wire_field(1, repeated(unknown, 101)), *request.GetDescriptor()),
      ElementsAre("lubricant: 101 fields that Lubricant does not have; allowed: at most 100"));
  // Parser and check treat a known field of another wire type as unknown.
  EXPECT_THAT(judge_bytes(wire_field(1, repeated(std::string("\x20\x01", 2), 101)),
                          *request.GetDescriptor()),
              ElementsAre(HasSubstr("101 fields")));
}

TEST(WireCheck, LimitsElementsInAll) {
  v1::BatchCreateLubricantsRequest batch;
  auto* lubricant = batch.add_requests()->mutable_lubricant();
  for (int i = 0; i < 64; ++i) lubricant->add_labels();
  for (int i = 0; i < 200; ++i) lubricant->add_provenance();
  const std::string one = batch.SerializeAsString();
  EXPECT_THAT(judge_bytes(repeated(one, 3000), *batch.GetDescriptor()), IsEmpty());
  EXPECT_THAT(
      judge_bytes(repeated(one, 4000), *batch.GetDescriptor()),
      ElementsAre(HasSubstr("1064000 messages and texts in all; allowed: at most 1000000")));
}

TEST(WireCheck, RefusesBytesThatAreNoMessage) {
  const Descriptor& type = *v1::CreateLubricantRequest::descriptor();
  for (const std::string& bytes :
       {std::string("\x0a"), std::string("\x0a\x05\x01"), std::string("\x00", 1),
        std::string("\x0a\xff\xff\xff\xff\x0f"), std::string("\x0b\x0c"), std::string("\x0c"),
        std::string("\x0f"), wire_field(1, std::string("\x0a\x05\x01")),
        std::string(100'000, '\x0b')}) {
    EXPECT_THAT(judge_bytes(bytes, type), ElementsAre(HasSubstr("not a CreateLubricantRequest")));
  }
}

/// Fills a message with random fields, including lists near their limits.
void fill_lists(Message& message, std::mt19937& random, int depth) {
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (random() % 3 != 0) continue;
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (!field.is_repeated()) {
      if (is_message && depth > 0) {
        fill_lists(*reflection.MutableMessage(&message, &field), random, depth - 1);
      }
      continue;
    }
    const int maximum = maximum_elements(field).value_or(0);
    const int count =
        maximum < 1000 && random() % 8 == 0 ? maximum + static_cast<int>(random() % 2) : 2;
    for (int k = 0; k < count; ++k) {
      if (is_message) {
        Message* added = reflection.AddMessage(&message, &field);
        if (depth > 0 && count == 2) fill_lists(*added, random, depth - 1);
      } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
        reflection.AddString(&message, &field, "x");
      } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
        reflection.AddInt32(&message, &field, 100 * k);  // one byte or two
      } else {
        reflection.AddDouble(&message, &field, k);
      }
    }
  }
}

TEST(WireCheck, JudgesByBytesAsCountingJudgesTheParsedRequest) {
  std::mt19937 random(20261122);
  int refused = 0;
  for (int round = 0; round < 100; ++round) {
    for (const MethodDescriptor* method : all_methods()) {
      const std::unique_ptr<Message> request(google::protobuf::MessageFactory::generated_factory()
                                                 ->GetPrototype(method->input_type())
                                                 ->New());
      fill_lists(*request, random, 5);
      Violations counted;
      check_counts(*request, "", counted);
      std::multiset<std::string> expected;
      for (const Violation& each : counted) {
        expected.insert(each.field + ": " + each.description);
      }
      const std::vector<std::string> found = judge_bytes(*request);
      EXPECT_EQ(std::multiset<std::string>(found.begin(), found.end()), expected);
      refused += expected.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 20) << "too few of the messages exceed a limit";
}

TEST(WireCheck, LetsTheLargestAcceptableSimulationPass) {
  v1::CreateSimulationRequest request;
  auto* simulation = request.mutable_simulation();
  simulation->set_display_name(std::string(200, 'x'));
  for (int i = 0; i < 64; ++i) {
    v1::Label* label = simulation->add_labels();
    label->set_key(std::string(190, 'k') + std::to_string(i));
    label->set_value(std::string(200, 'v'));
  }
  auto* history = simulation->mutable_operating_point()->mutable_history();
  for (int i = 0; i < 100; ++i) history->add_columns(std::string(200, 'c'));
  EXPECT_THAT(judge_bytes(request), IsEmpty());
  EXPECT_LT(request.ByteSizeLong(), kUsualRequestBytes / 8);
}

TEST(RequestLimits, AGearSetOfTheFinestTablesFits) {
  v1::CreateGearSetRequest request;
  *request.mutable_gear_set() = seed<v1::GearSet>("gearSets/reference-axle");
  auto* gear_set = request.mutable_gear_set();
  const auto stretch = [](auto* numbers) { numbers->Resize(kMaximumFlankSamples, 0.5); };
  for (v1::FlankSlot& slot : *gear_set->mutable_flank_slots()) {
    const auto& reflection = *slot.GetReflection();
    for (int i = 0; i < slot.GetDescriptor()->field_count(); ++i) {
      auto numbers =
          reflection.GetMutableRepeatedFieldRef<double>(&slot, slot.GetDescriptor()->field(i));
      while (numbers.size() < kMaximumFlankSamples) numbers.Add(0.5);
    }
  }
  for (int i = 0; i < 20; ++i) {
    auto* shares = gear_set->add_load_share_by_torque();
    for (int k = 0; k < 3; ++k) stretch(shares->add_slots()->mutable_load_share());
    *gear_set->add_series_by_torque() = gear_set->series();
  }
  EXPECT_THAT(judge_bytes(request), IsEmpty());
  const std::size_t maximum = maximum_request_bytes(*row_of(request).descriptor);
  EXPECT_LT(request.ByteSizeLong(), maximum);
  EXPECT_LT(maximum, kMaximumResponseBytes) << "its answer holds it";
}

TEST(Violations, KeepTheFirstAndCountAll) {
  Violations violations;
  for (int i = 0; i < 100'000; ++i) violations.push_back({std::to_string(i), "x"});
  EXPECT_EQ(violations.size(), 100'000U);
  const auto kept = std::distance(violations.begin(), violations.end());
  EXPECT_EQ(static_cast<std::size_t>(kept), std::size_t{Violations::kMostKept});
  EXPECT_EQ(violations.front().field, "0");
  Violations more;
  more.push_back({"first", "x"});
  more.append(violations);
  EXPECT_EQ(more.size(), 100'001U);
}

TEST(ParseFields, ReadsTheFieldsThatAreNamedAndSkipsTheOthers) {
  v1::SimulationResult whole;
  whole.set_model_version("model");
  whole.set_platform("platform");
  whole.add_input_warnings()->set_code("FIRST");
  whole.add_assumptions()->set_value("skipped");
  v1::SimulationResult more;
  more.add_input_warnings()->set_code("SECOND");
  // The bytes of two messages in a row are those of both merged.
  const std::string bytes = whole.SerializeAsString() + more.SerializeAsString();
  v1::SimulationResult out;
  ASSERT_TRUE(parse_fields(bytes,
                           {v1::SimulationResult::kModelVersionFieldNumber,
                            v1::SimulationResult::kInputWarningsFieldNumber},
                           out));
  EXPECT_EQ(out.model_version(), "model");
  EXPECT_EQ(out.platform(), "");
  EXPECT_EQ(out.assumptions_size(), 0);
  ASSERT_EQ(out.input_warnings_size(), 2);
  EXPECT_EQ(out.input_warnings(1).code(), "SECOND");
  EXPECT_FALSE(parse_fields(bytes.substr(0, bytes.size() - 1), {1}, out)) << "broken off";
}

}  // namespace
}  // namespace tribodyn::server
