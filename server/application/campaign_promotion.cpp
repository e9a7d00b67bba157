#include <fmt/format.h>

#include <optional>
#include <utility>

#include "server/application/campaign_decisions.h"
#include "server/application/campaigns.h"
#include "server/application/errors.h"
#include "server/application/resource_writes.h"
#include "server/application/table_columns.h"
#include "server/contract/constraints.h"
#include "server/contract/output_only.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kLongestSource = 4000;  // bytes of ParameterProvenance.source

/// The candidate to be promoted, and everything that the promotion reads of its campaign.
struct Candidate {
  int number;
  std::string campaign;  // relative name
  std::string label;     // its text in the attribute "name"; else empty
  const v1::Campaign& table;

  /// "candidate 3 (oil B) of campaigns/7"
  std::string text() const {
    return fmt::format("candidate {}{} of {}", number, label.empty() ? "" : " (" + label + ")",
                       campaign);
  }
};

bool has_columns_of(const v1::Campaign& table, const std::string& owner) {
  for (const v1::CandidateColumn& each : table.candidate_columns()) {
    if (each.path().starts_with(owner)) return true;
  }
  return false;
}

/// Returns the standard uncertainty of a parameter that the table states; 0: none.
double stated_by_table(const Candidate& candidate, const std::string& field) {
  for (const v1::CandidateAttribute& each : candidate.table.candidate_attributes()) {
    if (each.name() == field + ".uncertainty" && !each.values().empty()) {
      return std::max(0.0, each.values(candidate.number));
    }
  }
  return 0;
}

/// Returns true if the server computes a parameter from the pressure-viscosity law.
bool is_determined(const v1::Lubricant& lubricant, const std::string& field) {
  return lubricant.has_improved_yasutomi() && field.starts_with("pressure_viscosity_");
}
bool is_determined(const v1::Surface&, const std::string&) { return false; }

/// Returns the message that holds the parameter of a path within a resource.
Message& holder_of(const std::string& path, v1::Lubricant& lubricant) {
  if (path.find('.') == std::string::npos) return lubricant;
  return *lubricant.mutable_improved_yasutomi();
}
Message& holder_of(const std::string&, v1::Surface& surface) { return surface; }

/// Gives the parameters of the base, and those of the candidate in their place, to `resource`, a
/// copy of the base. Their provenance names base, campaign and candidate.
template <class Resource>
void set_candidate(const Candidate& candidate, const std::string& owner, const std::string& base,
                   Resource& resource) {
  for (v1::ParameterProvenance& entry : *resource.mutable_provenance()) {
    if (is_determined(resource, entry.field())) continue;
    entry.set_computed(false);
    std::string source = "as in " + base;
    if (!entry.source().empty()) source += ": " + entry.source();
    if (source.size() > kLongestSource) source = "as in " + base;
    entry.set_source(std::move(source));
  }
  // The parameters of a candidate that is a lubricant are those of its base.
  const bool is_lubricant = !candidate.table.candidate_lubricants().empty();
  for (const v1::CandidateColumn& column : candidate.table.candidate_columns()) {
    if (is_lubricant || !column.path().starts_with(owner)) continue;
    const std::string name = column.path().substr(owner.size());
    Message& holder = holder_of(name, resource);
    const FieldDescriptor* field =
        holder.GetDescriptor()->FindFieldByName(name.substr(name.find('.') + 1));
    const auto& reflection = *holder.GetReflection();
    const double before = reflection.GetDouble(holder, field);
    reflection.SetDouble(&holder, field, column.values(candidate.number));
    v1::ParameterProvenance* entry = nullptr;
    for (v1::ParameterProvenance& each : *resource.mutable_provenance()) {
      if (each.field() == name) entry = &each;
    }
    if (entry == nullptr) entry = resource.add_provenance();
    entry->Clear();
    entry->set_field(name);
    entry->set_provenance(v1::PROVENANCE_USER);
    entry->set_source(
        fmt::format("{}, in place of {} in {}", candidate.text(), number_text(before), base));
    entry->set_standard_uncertainty(stated_by_table(candidate, field->name()));
  }
}

/// Returns the base of the candidates.
template <class Resource>
Outcome<Resource> base_of(Application& application, const std::string& revision,
                          const CallContext& call) {
  const auto found = find_stored<Resource>(application, revision, true, call);
  if (!found.ok()) return found.error();
  auto out = to_message<Resource>(found.message());
  if (!out) return unreadable(revision);
  keep_client_part(*out);
  return std::move(*out);
}

/// Leaves out what is known of the sample of the base alone.
template <class Resource>
void clear_sample(Resource& resource) {
  resource.clear_measurements();
  resource.clear_external_sample_id();
  resource.clear_lims_id();
}

/// Returns the resource that the candidate becomes, accepted. Adds all violations.
template <class Resource>
Outcome<Resource> promoted(Application& application, const v1::PromoteCandidateRequest& request,
                           const Candidate& candidate, const std::string& id,
                           const std::string& revision, const CallContext& call,
                           Violations& violations) {
  const std::string name = new_name<Resource>(id, "", violations);
  Outcome<Resource> found = base_of<Resource>(application, revision, call);
  if (!found.ok() || name.empty()) return found;
  Resource& out = found.message();
  const std::string field = Kind<Resource>::kField;
  clear_sample(out);
  set_candidate(candidate, field + ".", revision, out);
  out.set_derived_from(revision);
  out.set_name(name);
  out.set_display_name(request.display_name().empty() ? candidate.label : request.display_name());
  out.set_description(fmt::format("Variant of {}: {}.", revision, candidate.text()));
  auto accepted =
      accept(out, nullptr, resource_lookup(application.store, call.project, call.limits), field,
             violations);
  if (accepted) out = std::move(*accepted);
  return found;
}

template <class Resource>
std::optional<google::rpc::Status> taken(Application& application, const Resource& resource,
                                         const CallContext& call) {
  const std::string name = full_name(call.project, resource.name());
  const auto stored = application.store.resource(name, call.limits);
  if (!stored) return std::nullopt;
  return name_taken<Resource>(name, stored->delete_time.has_value());
}

/// Checks the numbers and ids of the request.
void check_promotion(const v1::PromoteCandidateRequest& request, const StoredCampaign& stored,
                     const v1::Campaign& table, Violations& violations) {
  if (request.candidate() < 0 || request.candidate() >= stored.candidates) {
    violations.add("candidate", "candidate = {}; allowed: 0 to {}", request.candidate(),
                   stored.candidates - 1);
  }
  const bool has_surface = has_columns_of(table, "surface.");
  if (request.lubricant_id().empty() && request.surface_id().empty()) {
    violations.add("lubricant_id", "not set; allowed: an id");
  }
  if (has_surface && request.surface_id().empty()) {
    violations.add(
        "surface_id",
        "not set; allowed: an id, because candidates have surface parameters of their own");
  }
  if (!has_surface && !request.surface_id().empty()) {
    violations.add("surface_id",
                   "set; allowed: none, because all candidates have the surface of the campaign");
  }
}

}  // namespace

Outcome<v1::PromoteCandidateResponse> promote_candidate(Application& application,
                                                        const v1::PromoteCandidateRequest& request,
                                                        const CallContext& call) {
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  const StoredCampaign& stored = found.message();
  TableColumns columns(application, stored, call);
  const v1::Campaign& table = columns.table();
  Violations violations;
  check_promotion(request, stored, table, violations);
  if (!violations.empty()) return invalid(violations);
  Candidate candidate{request.candidate(), relative_name(name_of(stored)), "", table};
  for (const v1::CandidateAttribute& each : table.candidate_attributes()) {
    if (each.name() == "name" && !each.texts().empty()) {
      candidate.label = each.texts(request.candidate());
    }
  }
  std::optional<v1::Lubricant> lubricant;
  std::optional<v1::Surface> surface;
  if (!request.lubricant_id().empty()) {
    auto out = promoted<v1::Lubricant>(application, request, candidate, request.lubricant_id(),
                                       table.candidate_lubricants().empty()
                                           ? stored.revisions.lubricant
                                           : table.candidate_lubricants(request.candidate()),
                                       call, violations);
    if (!out.ok()) return out.error();
    lubricant = std::move(out.message());
  }
  if (!request.surface_id().empty()) {
    auto out = promoted<v1::Surface>(application, request, candidate, request.surface_id(),
                                     stored.revisions.surface, call, violations);
    if (!out.ok()) return out.error();
    surface = std::move(out.message());
  }
  if (!violations.empty()) return invalid(violations);
  std::vector<ResourceWrite> writes;
  for (int attempt = 0;; ++attempt) {
    if (lubricant) {
      if (auto refused = taken(application, *lubricant, call)) return *std::move(refused);
    }
    if (surface) {
      if (auto refused = taken(application, *surface, call)) return *std::move(refused);
    }
    v1::PromoteCandidateResponse out;
    writes.clear();
    const auto add = [&](const auto& resource) {
      writes.push_back(
          {{full_name(call.project, resource.name()), resource.SerializeAsString()}, std::nullopt});
    };
    if (lubricant) add(*lubricant);
    if (surface) add(*surface);
    if (request.validate_only()) {
      if (lubricant) {
        *out.mutable_lubricant() = preview<v1::Lubricant>(lubricant->SerializeAsString(), call);
      }
      if (surface) {
        *out.mutable_surface() = preview<v1::Surface>(surface->SerializeAsString(), call);
      }
      return out;
    }
    const auto written = application.store.write_resources(writes, system_time(), call.limits);
    if (written) {
      for (const StoredResource& each : *written) {
        const bool is_lubricant = lubricant && &each == &written->front();
        if (is_lubricant) {
          auto answered = answer<v1::Lubricant>(each);
          if (!answered.ok()) return answered.error();
          *out.mutable_lubricant() = std::move(answered.message());
        } else {
          auto answered = answer<v1::Surface>(each);
          if (!answered.ok()) return answered.error();
          *out.mutable_surface() = std::move(answered.message());
        }
      }
      return out;
    }
    if (attempt == kUpdateAttempts) return contention<v1::Lubricant>("a promoted resource");
  }
}

}  // namespace tribodyn::server
