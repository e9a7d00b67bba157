#include "server/transport/http/method_forms.h"

#include "server/transport/http/stream_format.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

std::vector<Form> forms_of(const Method& method) {
  if (method.descriptor->input_type() == v1::GetSimulationRequest::descriptor()) {
    return {Form::kMessage, Form::kPointColumns, Form::kCsv, Form::kNumpy};
  }
  if (method.answer) return {Form::kMessage};
  // Events have positions that a client resumes after; other messages are parts of one whole.
  if (resume_fields(*method.descriptor)) return {Form::kEvents, Form::kLines};
  const auto* type = method.descriptor->output_type();
  if (type == v1::ReadHistoryResponse::descriptor() ||
      type == v1::ReadCampaignResponse::descriptor()) {
    return {Form::kColumns, Form::kCsv, Form::kNumpy, Form::kBinary, Form::kLines};
  }
  return {Form::kLines};
}

}  // namespace tribodyn::server
