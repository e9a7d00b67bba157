#include "server/contract/output_only.h"

#include <vector>

namespace tribodyn::server {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void keep_client_part(Message& message) {
  message.DiscardUnknownFields();
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (is_output_only(*field)) {
      reflection.ClearField(&message, field);
    } else if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      continue;
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        keep_client_part(*reflection.MutableRepeatedMessage(&message, field, i));
      }
    } else {
      keep_client_part(*reflection.MutableMessage(&message, field));
    }
  }
}

}  // namespace tribodyn::server
