#include "proto/field_behavior.h"

#include <algorithm>

#include "google/api/field_behavior.pb.h"

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

bool is_documentary(const google::protobuf::FieldDescriptor& field) {
  return has(field, google::api::OPTIONAL);
}

}  // namespace tribodyn
