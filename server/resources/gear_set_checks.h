#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"

namespace tribodyn::server {

/// Says where a number of the tooth contact tables stands in what the client sent:
/// "gear_set.flank_slots[0].load_share[17]", "tooth_contact_csv row 19 column load_share".
using LocateSample = std::function<std::string(int slot, int sample, std::string_view column)>;

/// Tooth contact tables of three slots: as many samples in every column, all finite, radii
/// positive, load shares not negative and adding up to 1 within 1e-3 at every sample, every column
/// continuous from a pair to the next, and friction arms that keep the power identity r_fr,p +
/// r_fr,g N_p/N_g = -|A_p - A_g N_p/N_g|. Each violation stands at its sample. At most
/// kMaximumTableViolations of them; the rest are counted.
void check_flank_slots(const v1::GearSet& gear_set, const LocateSample& locate,
                       const std::string& path, Violations& violations);

/// Series: as many sines as cosines, all finite, R_g0/R_p0 = N_g/N_p within 1e-9.
void check_series(const v1::MeshSeries& series, const v1::GearSet& gear_set,
                  const std::string& path, Violations& violations);

/// Everything that the table of constraints cannot say of a gear set: series, tables, the data by
/// torque, and the core's own check.
void check_gear_set(const v1::GearSet& gear_set, const std::string& path, Violations& violations);

/// The same with the tables of `flank_slots` located elsewhere.
void check_gear_set(const v1::GearSet& gear_set, const LocateSample& locate,
                    const std::string& path, Violations& violations);

inline constexpr double kRatioTolerance = 1e-9;  ///< of R_g0 against R_p0 N_g/N_p
inline constexpr int kMaximumFlankSamples = 10'000;
inline constexpr int kMaximumHarmonics = 1000;
inline constexpr int kMaximumTorques = 100;
inline constexpr std::size_t kMaximumTableViolations = 100;

}  // namespace tribodyn::server
