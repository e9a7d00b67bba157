#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"

namespace tribodyn::server {

/// Returns the position of a sample of a tooth contact table in the client's request:
/// "gear_set.flank_slots[0].load_share[17]", "tooth_contact_csv row 19 column load_share".
using LocateSample = std::function<std::string(int slot, int sample, std::string_view column)>;

/// Checks the tooth contact tables. They must have three slots; all columns must have the same
/// number of finite samples; radii must be positive; load shares must not be negative and must add
/// up to 1 within 1e-3 at every sample; every column must be continuous from one slot to the next;
/// friction arms must satisfy the power identity r_fr,p + r_fr,g N_p/N_g = -|A_p - A_g N_p/N_g|.
/// The path of a violation is its sample. Adds at most kMaximumTableViolations violations and the
/// number of the others.
void check_flank_slots(const v1::GearSet& gear_set, const LocateSample& locate,
                       const std::string& path, Violations& violations);

/// Checks a mesh series: equal numbers of sines and cosines, all finite, and R_g0/R_p0 = N_g/N_p
/// within kRatioTolerance.
void check_series(const v1::MeshSeries& series, const v1::GearSet& gear_set,
                  const std::string& path, Violations& violations);

/// Checks what the table of constraints cannot express: series, tables, the data by torque, and the
/// core's check of a gear set.
void check_gear_set(const v1::GearSet& gear_set, const std::string& path, Violations& violations);

/// Like the function above; `locate` returns the positions of samples of `flank_slots`.
void check_gear_set(const v1::GearSet& gear_set, const LocateSample& locate,
                    const std::string& path, Violations& violations);

inline constexpr double kRatioTolerance = 1e-9;  ///< relative, of R_g0 = R_p0 N_g/N_p
inline constexpr int kMaximumFlankSamples = 10'000;
inline constexpr int kMaximumHarmonics = 1000;
inline constexpr int kMaximumTorques = 100;
inline constexpr std::size_t kMaximumTableViolations = 100;

}  // namespace tribodyn::server
