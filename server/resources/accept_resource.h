#pragma once

#include <optional>
#include <string>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/resources/gear_set_checks.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

// What is stored of a resource that a client states: what only the server sets left out, labels in
// the order of keys, units of provenance left out (they follow from the fields), provenance for
// every parameter. `stated` has its name. Nothing, and all violations at once, when it is not
// acceptable; paths start with `path`.

/// `present` is the revision that an update starts from, null for a new lubricant. Parameters that
/// are not stated are fitted or estimated (lubricant_parameters.h); those marked as computed are so
/// again for a new lubricant, and for one whose measurements, class or other parameters changed.
std::optional<v1::Lubricant> accept(const v1::Lubricant& stated, const v1::Lubricant* present,
                                    const ResourceLookup& lookup, const std::string& path,
                                    Violations& violations);
std::optional<v1::GearSet> accept(const v1::GearSet& stated, const v1::GearSet* present,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations);
std::optional<v1::Surface> accept(const v1::Surface& stated, const v1::Surface* present,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations);
std::optional<v1::Vehicle> accept(const v1::Vehicle& stated, const v1::Vehicle* present,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations);

/// Only the checks of what a client states beside a table that cannot be taken: so that all
/// violations come at once.
void check_stated(const v1::Lubricant& stated, const ResourceLookup& lookup,
                  const std::string& path, Violations& violations);
void check_stated(const v1::GearSet& stated, const ResourceLookup& lookup, const std::string& path,
                  Violations& violations);

/// A gear set whose tables a client sent as text; `locate` says where in it.
std::optional<v1::GearSet> accept(const v1::GearSet& stated, const LocateSample& locate,
                                  const ResourceLookup& lookup, const std::string& path,
                                  Violations& violations);

inline constexpr int kMaximumLabels = 64;
inline constexpr int kMaximumProvenances = 200;
inline constexpr int kMaximumMeasurements = 1000;  ///< rows of one table

}  // namespace tribodyn::server
