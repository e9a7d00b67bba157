#include "server/application/contacts.h"

#include "server/application/errors.h"
#include "server/simulation/contact_inputs.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

Outcome<v1::EvaluateContactResponse> evaluate_contact(Application& application,
                                                      const v1::EvaluateContactRequest& request,
                                                      const CallContext& call) {
  Violations violations;
  const auto lubricant = read_contact(
      request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!lubricant) return invalid(violations);
  return evaluate_contact(request, *lubricant);
}

}  // namespace tribodyn::server
