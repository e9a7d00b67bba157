#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "server/contract/labels.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/resources/gear_set_checks.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

// accept() checks a resource that a client sent and returns it in the form in which it is stored:
// without output-only fields and units of provenance (they follow from the fields), with labels
// sorted by key and with provenance for every parameter. `stated` has its name. Returns nullopt and
// adds all violations if a check fails; their paths start with `path`.

/// `present` is the revision before an update, or null for a new resource. For a kind without rules
/// of its own, constraints.cpp and the descriptor say everything. Unset parameters of a lubricant
/// are fitted or estimated (lubricant_parameters.h); those marked as computed are computed again
/// for a new lubricant, and if an update changes measurements, base oil class or another parameter.
template <class Resource>
std::optional<Resource> accept(const Resource& stated,
                               const std::type_identity_t<Resource>* present,
                               const ResourceLookup& lookup, const std::string& path,
                               Violations& violations);

/// Checks the fields beside a table that cannot be read, so that the client receives all violations
/// at once.
void check_client_fields(const v1::Lubricant& stated, const ResourceLookup& lookup,
                         const std::string& path, Violations& violations);
void check_client_fields(const v1::GearSet& stated, const ResourceLookup& lookup,
                         const std::string& path, Violations& violations);

/// Accepts a gear set whose tables were sent as text. `locate` returns the position of a sample in
/// the text.
std::optional<v1::GearSet> accept(const v1::GearSet& stated, const LocateSample& locate,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations);

inline constexpr int kMaximumProvenances = 200;
inline constexpr int kMaximumMeasurements = 1000;  ///< rows of one table of measurements

}  // namespace tribodyn::server
