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
#include "server/resources/lubricant_parameters.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

using google::protobuf::util::MessageDifferencer;

template <class Repeated>
bool check_count(const Repeated& list, int maximum, const std::string& path,
                 Violations& violations) {
  if (list.size() <= maximum) return true;
  violations.push_back(
      {path, fmt::format("{} entries; allowed: at most {}", list.size(), maximum)});
  return false;
}

const char* collection_of(const v1::Lubricant&) { return kLubricants; }
const char* collection_of(const v1::GearSet&) { return kGearSets; }
const char* collection_of(const v1::Surface&) { return kSurfaces; }
const char* collection_of(const v1::Vehicle&) { return kVehicles; }

/// Whether what is stored under `name` descends from `ancestor`, which is derived from it. Stops at
/// a name whose chain is known, so that a batch takes each step of a chain once.
template <class Resource>
bool descends(std::string name, const std::string& ancestor, const ResourceLookup& lookup) {
  KnownChains& known = *lookup.chains;
  if (known.in_ring.contains(ancestor)) return true;
  std::vector<std::string> chain;
  std::map<std::string, std::size_t> places;  // in the chain
  while (!name.empty() && !known.in_no_ring.contains(name) && !known.in_ring.contains(name)) {
    if (name == ancestor) {
      known.in_ring.insert(chain.begin(), chain.end());
      known.in_ring.insert(ancestor);
      return true;
    }
    const auto [first, is_new] = places.emplace(name, chain.size());
    if (!is_new) {  // a ring without the ancestor
      const auto ring = chain.begin() + static_cast<std::ptrdiff_t>(first->second);
      known.in_ring.insert(ring, chain.end());
      chain.erase(ring, chain.end());
      break;
    }
    chain.push_back(name);
    const auto found = lookup.find({name, 0});
    Resource resource;
    if (!found || !resource.ParseFromString(found->body)) break;
    name = resource.derived_from().substr(0, resource.derived_from().find('@'));
  }
  known.in_no_ring.insert(chain.begin(), chain.end());
  return false;
}

/// A resource may descend from a deleted one, never from itself or its own descendants.
template <class Resource>
void check_descent(const Resource& stated, const ResourceLookup& lookup, const std::string& path,
                   Violations& violations) {
  const std::string& name = stated.derived_from();
  if (name.empty()) return;
  const std::string collection = collection_of(stated);
  const auto parsed = parse_revision_name(name, collection);
  if (parsed && parsed->name == stated.name()) {
    violations.push_back({path, fmt::format("{} is the resource itself", name)});
  } else if (!parsed || !lookup.find({parsed->name, 0})) {  // revisions number anew on import
    violations.push_back({path, unknown_name_text(name, collection, lookup.names(collection))});
  } else if (descends<Resource>(parsed->name, stated.name(), lookup)) {
    violations.push_back({path, fmt::format("{} itself descends from {}", name, stated.name())});
  }
}

/// What all kinds have in common, before what is particular to one.
template <class Resource>
Resource begin(const Resource& stated, const ResourceLookup& lookup, const std::string& path,
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

template <class Resource>
Resource end(Resource out) {
  sort_labels(*out.mutable_labels());
  clear_units(*out.mutable_provenance());
  complete_provenance(out, *out.mutable_provenance());
  return out;
}

/// What a lubricant's computed parameters were computed from.
bool has_other_grounds(const v1::Lubricant& stated, const v1::Lubricant& present) {
  const auto grounds = [](v1::Lubricant lubricant) {
    forget_computed(lubricant);
    v1::Lubricant out;
    *out.mutable_measurements() = lubricant.measurements();
    out.set_base_oil_class(lubricant.base_oil_class());
    const auto& reflection = *lubricant.GetReflection();
    for (const std::string& field : parameter_paths(*v1::Lubricant::descriptor()).numbers) {
      const auto* descriptor = v1::Lubricant::descriptor()->FindFieldByName(field);
      if (!reflection.HasField(lubricant, descriptor)) continue;
      reflection.SetDouble(&out, descriptor, reflection.GetDouble(lubricant, descriptor));
    }
    return out;
  };
  return !MessageDifferencer::Equals(grounds(stated), grounds(present));
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
    violations.push_back({fmt::format("{}[{}].viscosity", viscosities, i),
                          "not set; allowed: a kinematic or a dynamic viscosity (eq 34)"});
  }
}

/// A computed parameter that the client changed is the client's from then on.
void take_over_changed(v1::Lubricant& lubricant, const v1::Lubricant& present) {
  const auto& reflection = *lubricant.GetReflection();
  auto& entries = *lubricant.mutable_provenance();
  for (int i = entries.size() - 1; i >= 0; --i) {
    const auto* field = v1::Lubricant::descriptor()->FindFieldByName(entries.Get(i).field());
    if (!entries.Get(i).computed() || field == nullptr || !field->has_presence()) continue;
    const bool changed =
        reflection.HasField(lubricant, field) && reflection.HasField(present, field) &&
        reflection.GetDouble(lubricant, field) != reflection.GetDouble(present, field);
    if (changed) entries.DeleteSubrange(i, 1);
  }
}

bool says_the_same(const v1::ParameterProvenance& a, const v1::ParameterProvenance& b) {
  return a.standard_uncertainty() == b.standard_uncertainty() && a.provenance() == b.provenance() &&
         a.source() == b.source();
}

/// Says nothing that the server would not say of a number without provenance.
bool says_nothing(const v1::ParameterProvenance& entry) {
  return entry.standard_uncertainty() == 0 && entry.source().empty() &&
         (entry.provenance() == v1::PROVENANCE_UNSPECIFIED ||
          entry.provenance() == v1::PROVENANCE_USER);
}

/// How a parameter is known cannot be stated without its value: the server computes the value, and
/// with it how it is known.
void check_provenance_of_computed(const v1::Lubricant& lubricant, const v1::Lubricant* present,
                                  const std::string& path, Violations& violations) {
  const auto& reflection = *lubricant.GetReflection();
  for (int i = 0; i < lubricant.provenance_size(); ++i) {
    const v1::ParameterProvenance& entry = lubricant.provenance(i);
    const auto* field = v1::Lubricant::descriptor()->FindFieldByName(entry.field());
    if (field == nullptr || !field->has_presence()) continue;
    const v1::ParameterProvenance* before = nullptr;
    if (present != nullptr) {
      for (const v1::ParameterProvenance& each : present->provenance()) {
        if (each.field() == entry.field()) before = &each;
      }
    }
    if (before != nullptr && says_the_same(entry, *before)) continue;
    const bool is_stated = reflection.HasField(lubricant, field);
    const bool is_changed =
        is_stated && present != nullptr &&
        reflection.GetDouble(lubricant, field) != reflection.GetDouble(*present, field);
    const bool is_computed = entry.computed() && before != nullptr && !is_changed;
    if (is_computed || (!is_stated && !entry.computed() && !says_nothing(entry))) {
      violations.push_back(
          {fmt::format("{}[{}].{}", path, i,
                       entry.standard_uncertainty() != 0 ? "standard_uncertainty" : "provenance"),
           fmt::format("{} is computed, not stated, and its uncertainty and provenance with it; "
                       "allowed: both together with the value",
                       entry.field())});
    }
  }
}

}  // namespace

std::optional<v1::Lubricant> accept(const v1::Lubricant& stated, const v1::Lubricant* present,
                                    const ResourceLookup& lookup, const std::string& path,
                                    Violations& violations) {
  const std::size_t before = violations.size();
  v1::Lubricant out = begin(stated, lookup, path, Missing::kAllowed, violations);
  check_measurements(out.measurements(), join_path(path, "measurements"), violations);
  check_provenance_of_computed(out, present, join_path(path, "provenance"), violations);
  if (violations.size() > before) return std::nullopt;
  if (present != nullptr) take_over_changed(out, *present);
  // A copy of another lubricant may have other measurements than those it was computed from.
  if (present == nullptr || has_other_grounds(out, *present)) forget_computed(out);
  complete_parameters(out, path, violations);
  if (violations.size() > before) return std::nullopt;
  check_message(out, path, violations);
  if (violations.size() > before) return std::nullopt;
  return end(std::move(out));
}

std::optional<v1::GearSet> accept(const v1::GearSet& stated, const LocateSample& locate,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations) {
  const std::size_t before = violations.size();
  v1::GearSet out = begin(stated, lookup, path, Missing::kViolation, violations);
  if (locate) {
    check_gear_set(out, locate, path, violations);
  } else {
    check_gear_set(out, path, violations);
  }
  if (violations.size() > before) return std::nullopt;
  return end(std::move(out));
}

std::optional<v1::GearSet> accept(const v1::GearSet& stated, const v1::GearSet*,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations) {
  return accept(stated, LocateSample(), lookup, path, violations);
}

std::optional<v1::Surface> accept(const v1::Surface& stated, const v1::Surface*,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations) {
  const std::size_t before = violations.size();
  v1::Surface out = begin(stated, lookup, path, Missing::kViolation, violations);
  check_count(out.measurements(), kMaximumMeasurements, join_path(path, "measurements"),
              violations);
  if (violations.size() > before) return std::nullopt;
  return end(std::move(out));
}

std::optional<v1::Vehicle> accept(const v1::Vehicle& stated, const v1::Vehicle*,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations) {
  const std::size_t before = violations.size();
  v1::Vehicle out = begin(stated, lookup, path, Missing::kViolation, violations);
  if (violations.size() > before) return std::nullopt;
  return end(std::move(out));
}

void check_stated(const v1::Lubricant& stated, const ResourceLookup& lookup,
                  const std::string& path, Violations& violations) {
  begin(stated, lookup, path, Missing::kAllowed, violations);
}

void check_stated(const v1::GearSet& stated, const ResourceLookup& lookup, const std::string& path,
                  Violations& violations) {
  begin(stated, lookup, path, Missing::kViolation, violations);
}

}  // namespace tribodyn::server
