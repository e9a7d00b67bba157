#include "server/resources/accept_resource.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/contract/labels.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_kinds.h"
#include "server/resources/lubricant_parameters.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

using google::protobuf::util::MessageDifferencer;

template <class Repeated>
bool check_count(const Repeated& list, int maximum, const std::string& path,
                 Violations& violations) {
  if (list.size() <= maximum) return true;
  violations.add(path, "{} entries; allowed: at most {}", list.size(), maximum);
  return false;
}

/// Returns true if the stored resource `name`, from which `ancestor` is derived, itself descends
/// from `ancestor`. Stops at a name whose chain is known, so that a batch follows each step of a
/// chain once.
template <class Resource>
bool descends(std::string name, const std::string& ancestor, const ResourceLookup& lookup) {
  KnownChains& known = *lookup.chains;
  if (known.in_cycle.contains(ancestor)) return true;
  std::vector<std::string> chain;
  std::map<std::string, std::size_t> positions;  // index in the chain by name
  while (!name.empty() && !known.in_no_cycle.contains(name) && !known.in_cycle.contains(name)) {
    if (name == ancestor) {
      known.in_cycle.insert(chain.begin(), chain.end());
      known.in_cycle.insert(ancestor);
      return true;
    }
    const auto [first, is_new] = positions.emplace(name, chain.size());
    if (!is_new) {  // a cycle without the ancestor
      const auto cycle = chain.begin() + static_cast<std::ptrdiff_t>(first->second);
      known.in_cycle.insert(cycle, chain.end());
      chain.erase(cycle, chain.end());
      break;
    }
    chain.push_back(name);
    const auto found = lookup.find({name, 0});
    Resource resource;
    if (!found || !resource.ParseFromString(found->body)) break;
    name = resource.derived_from().substr(0, resource.derived_from().find('@'));
  }
  known.in_no_cycle.insert(chain.begin(), chain.end());
  return false;
}

/// Adds a violation if the resource descends from itself, from one of its descendants, or from a
/// resource that does not exist. A deleted ancestor is allowed.
template <class Resource>
void check_descent(const Resource& stated, const ResourceLookup& lookup, const std::string& path,
                   Violations& violations) {
  const std::string& name = stated.derived_from();
  if (name.empty()) return;
  const std::string collection = Kind<Resource>::kCollection;
  const auto parsed = parse_revision_name(name, collection);
  if (parsed && parsed->name == stated.name()) {
    violations.add(path, "{} is the resource itself", name);
    // an import may renumber revisions, so the revision is not checked
  } else if (!parsed || !lookup.find({parsed->name, 0})) {
    violations.add(path, unknown_name_text(name, collection, lookup.names(collection)));
  } else if (descends<Resource>(parsed->name, stated.name(), lookup)) {
    violations.add(path, "{} itself descends from {}", name, stated.name());
  }
}

/// Copies what the client set and makes the checks that all kinds of resources have in common.
template <class Resource>
Resource normalize(const Resource& stated, const ResourceLookup& lookup, const std::string& path,
                   Missing missing, Violations& violations) {
  Resource out = stated;
  keep_client_part(out);
  if (!check_count(out.labels(), kMaximumLabels, join_path(path, "labels"), violations) ||
      !check_count(out.provenance(), kMaximumProvenances, join_path(path, "provenance"),
                   violations)) {
    return out;
  }
  check_message(out, path, violations, missing);
  check_labels(out.labels(), join_path(path, "labels"), violations);
  check_provenance(*Resource::descriptor(), out.provenance(), join_path(path, "provenance"),
                   violations);
  check_descent(out, lookup, join_path(path, "derived_from"), violations);
  return out;
}

/// Brings an accepted resource into the form in which it is stored.
template <class Resource>
Resource finalize(Resource out) {
  sort_labels(*out.mutable_labels());
  clear_units(*out.mutable_provenance());
  complete_provenance(out, *out.mutable_provenance());
  return out;
}

/// Returns true if an update changes an input of the computed parameters: measurements, base oil
/// class, the pressure-viscosity law or a parameter that the client set.
bool changes_inputs_of_computed(const v1::Lubricant& stated, const v1::Lubricant& present) {
  const auto inputs = [](v1::Lubricant lubricant) {
    clear_computed_parameters(lubricant);
    v1::Lubricant out;
    *out.mutable_measurements() = lubricant.measurements();
    out.set_base_oil_class(lubricant.base_oil_class());
    if (lubricant.has_improved_yasutomi()) {
      *out.mutable_improved_yasutomi() = lubricant.improved_yasutomi();
    }
    const auto& reflection = *lubricant.GetReflection();
    for (const std::string& field : parameter_paths(*v1::Lubricant::descriptor()).numbers) {
      const auto* descriptor = lubricant_parameter(field);
      if (descriptor == nullptr || !reflection.HasField(lubricant, descriptor)) continue;
      reflection.SetDouble(&out, descriptor, reflection.GetDouble(lubricant, descriptor));
    }
    return out;
  };
  return !MessageDifferencer::Equals(inputs(stated), inputs(present));
}

void check_measurements(const v1::LubricantMeasurements& measurements, const std::string& path,
                        Violations& violations) {
  check_count(measurements.brookfield_viscosities(), kMaximumMeasurements,
              join_path(path, "brookfield_viscosities"), violations);
  check_count(measurements.densities(), kMaximumMeasurements, join_path(path, "densities"),
              violations);
  const std::string viscosities = join_path(path, "viscosities");
  if (!check_count(measurements.viscosities(), kMaximumMeasurements, viscosities, violations)) {
    return;
  }
  for (int i = 0; i < measurements.viscosities_size(); ++i) {
    if (measurements.viscosities(i).viscosity_case() !=
        v1::ViscosityMeasurement::VISCOSITY_NOT_SET) {
      continue;
    }
    violations.add(fmt::format("{}[{}].viscosity", viscosities, i),
                   "not set; allowed: a kinematic or a dynamic viscosity (eq 34)");
  }
}

void check_boundary_friction(const v1::Lubricant& lubricant, const std::string& path,
                             Violations& violations) {
  const auto& table = lubricant.asperity_friction_by_temperature();
  const std::string at = join_path(path, "asperity_friction_by_temperature");
  if (table.empty()) return;
  if (lubricant.has_asperity_friction_coefficient()) {
    violations.add(at, "set beside asperity_friction_coefficient; allowed: one of the two");
  }
  for (int i = 1; i < table.size(); ++i) {
    if (table[i].temperature_celsius() > table[i - 1].temperature_celsius()) continue;
    violations.add(fmt::format("{}[{}].temperature_celsius", at, i),
                   "{} C after {} C; allowed: rising temperatures", table[i].temperature_celsius(),
                   table[i - 1].temperature_celsius());
  }
}

/// Removes the provenance of computed parameters that the client changed: their values are now the
/// client's.
void unmark_changed_parameters(v1::Lubricant& lubricant, const v1::Lubricant& present) {
  const auto& reflection = *lubricant.GetReflection();
  auto& entries = *lubricant.mutable_provenance();
  for (int i = entries.size() - 1; i >= 0; --i) {
    const auto* field = lubricant_parameter(entries.Get(i).field());
    if (!entries.Get(i).computed() || field == nullptr) continue;
    const bool changed =
        reflection.HasField(lubricant, field) && reflection.HasField(present, field) &&
        reflection.GetDouble(lubricant, field) != reflection.GetDouble(present, field);
    if (changed) entries.DeleteSubrange(i, 1);
  }
}

bool is_equal_provenance(const v1::ParameterProvenance& a, const v1::ParameterProvenance& b) {
  return a.standard_uncertainty() == b.standard_uncertainty() && a.provenance() == b.provenance() &&
         a.source() == b.source();
}

/// Returns true if the entry is equal to the one that the server adds to a number without
/// provenance.
bool is_default_provenance(const v1::ParameterProvenance& entry) {
  return entry.standard_uncertainty() == 0 && entry.source().empty() &&
         (entry.provenance() == v1::PROVENANCE_UNSPECIFIED ||
          entry.provenance() == v1::PROVENANCE_USER);
}

/// Adds a violation for each uncertainty or provenance that the client sets for a computed
/// parameter without setting its value: the server computes all three.
void check_provenance_of_computed(const v1::Lubricant& lubricant, const v1::Lubricant* present,
                                  const std::string& path, Violations& violations) {
  const auto& reflection = *lubricant.GetReflection();
  for (int i = 0; i < lubricant.provenance_size(); ++i) {
    const v1::ParameterProvenance& entry = lubricant.provenance(i);
    const auto* field = lubricant_parameter(entry.field());
    if (field == nullptr) continue;
    const v1::ParameterProvenance* before = nullptr;
    if (present != nullptr) {
      for (const v1::ParameterProvenance& each : present->provenance()) {
        if (each.field() == entry.field()) before = &each;
      }
    }
    if (before != nullptr && is_equal_provenance(entry, *before)) continue;
    const bool is_stated = reflection.HasField(lubricant, field);
    const bool is_changed =
        is_stated && present != nullptr &&
        reflection.GetDouble(lubricant, field) != reflection.GetDouble(*present, field);
    const bool is_computed = entry.computed() && before != nullptr && !is_changed;
    if (is_computed || (!is_stated && !entry.computed() && !is_default_provenance(entry))) {
      violations.add(
          fmt::format("{}[{}].{}", path, i,
                      entry.standard_uncertainty() != 0 ? "standard_uncertainty" : "provenance"),
          "{} is computed, not stated, and its uncertainty and provenance with it; "
          "allowed: both together with the value",
          entry.field());
    }
  }
}

/// Accepts a resource that also passes `check`, which adds violations of rules of its kind.
template <class Resource, class Check>
std::optional<Resource> accept_checked(const Resource& stated, const ResourceLookup& lookup,
                                       const std::string& path, Violations& violations,
                                       const Check& check) {
  const std::size_t before = violations.size();
  Resource out = normalize(stated, lookup, path, Missing::kViolation, violations);
  check(out);
  if (violations.size() > before) return std::nullopt;
  return finalize(std::move(out));
}

// Rules of single kinds.
template <class Resource>
void check_kind(const Resource&, const std::string&, Violations&) {}
void check_kind(const v1::GearSet& gear_set, const std::string& path, Violations& violations) {
  check_gear_set(gear_set, path, violations);
}
void check_kind(const v1::Surface& surface, const std::string& path, Violations& violations) {
  check_count(surface.measurements(), kMaximumMeasurements, join_path(path, "measurements"),
              violations);
}

template <class Resource>
std::optional<Resource> accept_kind(const Resource& stated, const std::type_identity_t<Resource>*,
                                    const ResourceLookup& lookup, const std::string& path,
                                    Violations& violations) {
  return accept_checked(stated, lookup, path, violations,
                        [&](const Resource& resource) { check_kind(resource, path, violations); });
}

std::optional<v1::Lubricant> accept_kind(const v1::Lubricant& stated, const v1::Lubricant* present,
                                         const ResourceLookup& lookup, const std::string& path,
                                         Violations& violations) {
  const std::size_t before = violations.size();
  v1::Lubricant out = normalize(stated, lookup, path, Missing::kAllowed, violations);
  check_measurements(out.measurements(), join_path(path, "measurements"), violations);
  check_provenance_of_computed(out, present, join_path(path, "provenance"), violations);
  if (violations.size() > before) return std::nullopt;
  if (present != nullptr) unmark_changed_parameters(out, *present);
  // A new lubricant may be a copy of another one with different measurements.
  if (present == nullptr || changes_inputs_of_computed(out, *present)) {
    clear_computed_parameters(out);
  }
  check_law_of_pressure(out, path, violations);
  check_boundary_friction(out, path, violations);
  if (out.has_improved_yasutomi()) {  // without all of its parameters the law determines nothing
    check_message(out.improved_yasutomi(), join_path(path, "improved_yasutomi"), violations);
  }
  if (violations.size() > before) return std::nullopt;
  complete_parameters(out, path, violations);
  if (violations.size() > before) return std::nullopt;
  check_message(out, path, violations);
  if (violations.size() > before) return std::nullopt;
  return finalize(std::move(out));
}

}  // namespace

std::optional<v1::GearSet> accept(const v1::GearSet& stated, const LocateSample& locate,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations) {
  return accept_checked(stated, lookup, path, violations, [&](const v1::GearSet& gear_set) {
    check_gear_set(gear_set, locate, path, violations);
  });
}

template <class Resource>
std::optional<Resource> accept(const Resource& stated,
                               const std::type_identity_t<Resource>* present,
                               const ResourceLookup& lookup, const std::string& path,
                               Violations& violations) {
  return accept_kind(stated, present, lookup, path, violations);
}

#define TRIBODYN_ACCEPT(Resource, field, collection, seed)                               \
  template std::optional<v1::Resource> accept(const v1::Resource&, const v1::Resource*,  \
                                              const ResourceLookup&, const std::string&, \
                                              Violations&);
TRIBODYN_RESOURCE_KINDS(TRIBODYN_ACCEPT)
#undef TRIBODYN_ACCEPT

void check_client_fields(const v1::Lubricant& stated, const ResourceLookup& lookup,
                         const std::string& path, Violations& violations) {
  normalize(stated, lookup, path, Missing::kAllowed, violations);
}

void check_client_fields(const v1::GearSet& stated, const ResourceLookup& lookup,
                         const std::string& path, Violations& violations) {
  normalize(stated, lookup, path, Missing::kViolation, violations);
}

}  // namespace tribodyn::server
