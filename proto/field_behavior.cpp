#include "proto/field_behavior.h"

#include <algorithm>

#include "google/api/field_behavior.pb.h"
#include "tribodyn/v1/limits.pb.h"

namespace tribodyn {

namespace {

bool has(const google::protobuf::FieldDescriptor& field, google::api::FieldBehavior behavior) {
  const auto& all = field.options().GetRepeatedExtension(google::api::field_behavior);
  return std::find(all.begin(), all.end(), behavior) != all.end();
}

}  // namespace

bool is_output_only(const google::protobuf::FieldDescriptor& field) {
  return has(field, google::api::OUTPUT_ONLY);
}

bool may_be_unset(const google::protobuf::FieldDescriptor& field) {
  return has(field, google::api::OPTIONAL);
}

bool is_documentary(const google::protobuf::FieldDescriptor& field) {
  return field.options().GetExtension(v1::documentary);
}

}  // namespace tribodyn
