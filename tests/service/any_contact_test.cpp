// EvaluateContact answers every contact within the allowed ranges soon, with finite numbers or with
// a reason.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include "google/rpc/error_details.pb.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/simulation/contact_inputs.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Draws numbers from the allowed range: evenly in magnitude, at its ends, or near a typical
/// request.
class AnyNumber {
 public:
  double operator()(const Constraint& row, double typical) {
    switch (random_() % 8) {
      case 0:
        return row.minimum;
      case 1:
        return row.maximum;
      case 2:
      case 3:
        return typical;
      default:
        break;
    }
    const double sign = row.minimum < 0 && flag() ? -1 : 1;
    const double largest = sign < 0 ? -row.minimum : row.maximum;
    const double smallest = row.minimum > 0 ? row.minimum : largest * 1e-12;
    return sign * std::min(largest, smallest * std::pow(largest / smallest, share_(random_)));
  }
  bool flag() { return random_() % 2 == 0; }
  bool seldom() { return random_() % 6 == 0; }

 private:
  std::mt19937_64 random_{20261121};
  std::uniform_real_distribution<double> share_{0, 1};
};

void randomise(Message* message, AnyNumber& any) {
  const auto& descriptor = *message->GetDescriptor();
  const auto& reflection = *message->GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor* field = descriptor.field(i);
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      const Constraint* row = find_constraint(descriptor.name(), field->name());
      reflection.SetDouble(message, field, any(*row, reflection.GetDouble(*message, field)));
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
      reflection.SetBool(message, field, any.seldom());
    }
  }
}

TEST(AnyContact, AnswersInFiniteNumbersOrRefuses) {
  constexpr int kRequests = 20'000;
  Bench bench;
  Application app = bench.application();
  AnyNumber any;
  std::map<std::string, int> tally;
  std::chrono::duration<double> slowest{0};
  for (int i = 0; i < kRequests; ++i) {
    v1::EvaluateContactRequest request = contact_request();
    *request.mutable_lubricant_parameters() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    randomise(&request, any);
    if (any.flag()) randomise(request.mutable_lubricant_parameters(), any);
    randomise(request.mutable_model_options(), any);
    if (any.seldom()) {
      randomise(request.mutable_model_options()->mutable_as_published(), any);
      // EvaluateContact always refuses this switch.
      request.mutable_model_options()->mutable_as_published()->clear_eq46_square_root_of_sum();
    }
    if (any.seldom()) {
      request.mutable_model_options()->set_pressure_viscosity_index(
          v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto outcome = answer_contact(app, request);
    slowest =
        std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin));
    if (outcome.ok()) {
      ++tally[v1::ContactStatus_Name(outcome.message().status())];
      ASSERT_EQ(first_not_finite(outcome.message()), "") << request.ShortDebugString();
      ASSERT_LE(outcome.message().contact_temperature_kelvin(), kHottestContact)
          << request.ShortDebugString();
      continue;
    }
    google::rpc::ErrorInfo info;
    ASSERT_TRUE(outcome.error().details(0).UnpackTo(&info));
    ++tally[info.reason()];
    ASSERT_NE(info.reason(), "INTERNAL") << request.ShortDebugString();
    ASSERT_NE(info.reason(), "RESULT_NOT_FINITE")
        << outcome.error().message() << ": " << request.ShortDebugString();
  }
  for (const auto& [reason, count] : tally) RecordProperty(reason, count);
  EXPECT_GT(tally["CONTACT_STATUS_OK"], kRequests / 10);
  EXPECT_LT(slowest.count(), 1) << "one call must not hold up the others";
}

}  // namespace
}  // namespace tribodyn::server
