#include "server/resources/gear_set_checks.h"

#include <fmt/format.h>
#include <google/protobuf/reflection.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/refusal.h"
#include "server/contract/constraints.h"
#include "server/mapping/to_core.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using Numbers = google::protobuf::RepeatedFieldRef<double>;

constexpr double kShareTolerance = 1e-3;
// relative to 1e-3 + |value|
constexpr double kContinuityTolerance = 1e-6;
constexpr double kPowerTolerance = 1e-6;  // relative to the larger of rolling and sliding speed

/// Adds at most kMaximumTableViolations violations, then the number of the others.
class TableViolations {
 public:
  TableViolations(const std::string& path, Violations& violations)
      : path_(path), violations_(violations) {}
  ~TableViolations() {
    if (count_ <= kMaximumTableViolations) return;
    violations_.add(path_, "{} more violations", count_ - kMaximumTableViolations);
  }
  TableViolations(const TableViolations&) = delete;
  TableViolations& operator=(const TableViolations&) = delete;

  bool any() const { return count_ > 0; }
  /// Calls `place` and `text` only for violations that are kept.
  template <class Place, class Text>
  void add(const Place& place, const Text& text) {
    if (++count_ <= kMaximumTableViolations) violations_.add(place(), text());
  }

 private:
  const std::string& path_;
  Violations& violations_;
  std::size_t count_ = 0;
};

Numbers column(const v1::FlankSlot& slot, const FieldDescriptor& field) {
  return slot.GetReflection()->GetRepeatedFieldRef<double>(slot, &field);
}

/// Returns true if every column of every slot has as many samples as the first one.
bool check_sizes(const v1::GearSet& set, const std::string& path, Violations& violations) {
  const std::size_t before = violations.size();
  const std::string slots = join_path(path, "flank_slots");
  if (set.flank_slots_size() != kFlankPairs) {
    violations.add(slots, "{} slots; allowed: {} (eq 29)", set.flank_slots_size(), kFlankPairs);
    return false;
  }
  const int samples = set.flank_slots(0).load_share_size();
  if (samples < 2 || samples > kMaximumFlankSamples) {
    violations.add(slots + "[0].load_share", "{} samples; allowed: 2 to {}", samples,
                   kMaximumFlankSamples);
    return false;
  }
  const auto& descriptor = *v1::FlankSlot::descriptor();
  for (int k = 0; k < kFlankPairs; ++k) {
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const int size = column(set.flank_slots(k), *descriptor.field(i)).size();
      if (size == samples) continue;
      violations.add(fmt::format("{}[{}].{}", slots, k, descriptor.field(i)->name()),
                     "{} samples; allowed: {}, the number of the first slot's load share", size,
                     samples);
    }
  }
  return violations.size() == before;
}

void check_numbers(const v1::GearSet& set, const LocateSample& locate, TableViolations& limited) {
  const auto& descriptor = *v1::FlankSlot::descriptor();
  for (int k = 0; k < kFlankPairs; ++k) {
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const FieldDescriptor& field = *descriptor.field(i);
      const Constraint* row = find_constraint("FlankSlot", field.name());
      const Numbers values = column(set.flank_slots(k), field);
      for (int j = 0; j < values.size(); ++j) {
        const double value = values.Get(j);
        if (row->allows(value)) continue;
        limited.add([&] { return locate(k, j, field.name()); },
                    [&] { return out_of_range_text(*row, value); });
      }
    }
  }
}

void check_shares(const v1::GearSet& set, const LocateSample& locate, TableViolations& limited) {
  const int samples = set.flank_slots(0).load_share_size();
  for (int j = 0; j < samples; ++j) {
    double sum = 0;
    for (const v1::FlankSlot& slot : set.flank_slots()) sum += slot.load_share(j);
    if (std::abs(sum - 1) <= kShareTolerance) continue;
    limited.add([&] { return locate(0, j, "load_share"); },
                [&] {
                  return fmt::format(
                      "load shares of the three pairs add up to {}; allowed: 1 within {} (eq 29)",
                      sum, kShareTolerance);
                });
  }
}

void check_continuity(const v1::GearSet& set, const LocateSample& locate,
                      TableViolations& limited) {
  const auto& descriptor = *v1::FlankSlot::descriptor();
  for (int k = 0; k + 1 < kFlankPairs; ++k) {
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const FieldDescriptor& field = *descriptor.field(i);
      const Numbers here = column(set.flank_slots(k), field);
      const double last = here.Get(here.size() - 1);
      const double first = column(set.flank_slots(k + 1), field).Get(0);
      if (std::abs(last - first) <= kContinuityTolerance * (1e-3 + std::abs(last))) continue;
      limited.add([&] { return locate(k, here.size() - 1, field.name()); },
                  [&] {
                    return fmt::format(
                        "{} = {}, but {} at the first sample of the next slot ({}); allowed: equal",
                        field.name(), last, first, locate(k + 1, 0, field.name()));
                  });
    }
  }
}

/// Terms of the power balance of a sample, which add up to 0 (power in = power lost).
struct PowerBalance {
  double arms = 0;     ///< r_fr,p + r_fr,g N_p/N_g [m]
  double sliding = 0;  ///< A [m/s per rad/s]
  bool holds = false;
};

/// `ratio` is N_p/N_g.
PowerBalance power_balance(const v1::FlankSlot& slot, int sample, double ratio) {
  const double pinion =
      std::hypot(slot.pinion_velocity_x_metres(sample), slot.pinion_velocity_y_metres(sample));
  PowerBalance out;
  out.sliding = std::hypot(
      slot.pinion_velocity_x_metres(sample) - ratio * slot.gear_velocity_x_metres(sample),
      slot.pinion_velocity_y_metres(sample) - ratio * slot.gear_velocity_y_metres(sample));
  out.arms =
      slot.pinion_friction_arm_metres(sample) + ratio * slot.gear_friction_arm_metres(sample);
  out.holds = std::abs(out.arms + out.sliding) <= kPowerTolerance * std::max(pinion, out.sliding);
  return out;
}

void check_power(const v1::GearSet& set, const LocateSample& locate, TableViolations& limited) {
  const double ratio = static_cast<double>(set.pinion_teeth()) / set.gear_teeth();
  for (int k = 0; k < kFlankPairs; ++k) {
    const v1::FlankSlot& slot = set.flank_slots(k);
    for (int j = 0; j < slot.load_share_size(); ++j) {
      const PowerBalance balance = power_balance(slot, j, ratio);
      if (balance.holds) continue;
      limited.add([&] { return locate(k, j, "pinion_friction_arm_metres"); },
                  [&] {
                    return fmt::format(
                        "r_fr,p + r_fr,g N_p/N_g = {} m, sliding speed A = {} m per rad/s; "
                        "allowed: a sum equal to -A (power in = power lost)",
                        balance.arms, balance.sliding);
                  });
    }
  }
}

/// Returns N_g/N_p of the tooth contact data if series and flank slots agree on a ratio with which
/// the teeth disagree: somebody changed the teeth of a set and kept its data. Else nullopt.
std::optional<double> other_ratio_of_data(const v1::GearSet& set) {
  if (!set.has_series() || set.pinion_teeth() <= 0 || set.gear_teeth() <= 0) return std::nullopt;
  const double pinion = set.series().pinion_contact_radius_metres().mean();
  const double gear = set.series().gear_contact_radius_metres().mean();
  const double of_teeth = static_cast<double>(set.gear_teeth()) / set.pinion_teeth();
  if (!(pinion > 0) || !(gear > 0) || !std::isfinite(gear / pinion)) return std::nullopt;
  const double of_data = gear / pinion;
  if (std::abs(of_data - of_teeth) <= kRatioTolerance * of_teeth) return std::nullopt;
  Violations ignored;
  if (!check_sizes(set, "", ignored)) return std::nullopt;
  bool slots_fit_the_teeth = true;
  for (const v1::FlankSlot& slot : set.flank_slots()) {
    for (int j = 0; j < slot.load_share_size(); ++j) {
      if (!power_balance(slot, j, 1 / of_data).holds) return std::nullopt;
      slots_fit_the_teeth = slots_fit_the_teeth && power_balance(slot, j, 1 / of_teeth).holds;
    }
  }
  if (slots_fit_the_teeth) return std::nullopt;  // then a radius is wrong
  return of_data;
}

void check_range(std::string_view message, std::string_view field, double value,
                 const std::string& path, Violations& violations) {
  const Constraint* row = find_constraint(message, field);
  if (row->allows(value)) return;
  violations.add(path, out_of_range_text(*row, value));
}

void check_fourier(const v1::FourierSeries& series, const std::string& path,
                   Violations& violations) {
  if (series.sine_size() != series.cosine_size() || series.sine_size() > kMaximumHarmonics) {
    violations.add(path, "{} sine and {} cosine terms; allowed: as many of each, at most {}",
                   series.sine_size(), series.cosine_size(), kMaximumHarmonics);
  }
  check_range("FourierSeries", "mean", series.mean(), join_path(path, "mean"), violations);
  const int harmonics = std::min({series.sine_size(), series.cosine_size(), kMaximumHarmonics});
  for (int i = 0; i < harmonics; ++i) {
    check_range("FourierSeries", "sine", series.sine(i), fmt::format("{}.sine[{}]", path, i),
                violations);
    check_range("FourierSeries", "cosine", series.cosine(i), fmt::format("{}.cosine[{}]", path, i),
                violations);
  }
}

/// Adds a violation if the torques do not ascend or are out of range.
template <class Entries>
void check_torques(const Entries& entries, const std::string& path, Violations& violations) {
  if (entries.size() > kMaximumTorques) {
    violations.add(path, "{} torques; allowed: at most {}", entries.size(), kMaximumTorques);
  }
  for (int i = 0; i < std::min(entries.size(), kMaximumTorques); ++i) {
    check_range("LoadShareAtTorque", "pinion_torque_newton_metres",
                entries.Get(i).pinion_torque_newton_metres(),
                fmt::format("{}[{}].pinion_torque_newton_metres", path, i), violations);
  }
  for (int i = 1; i < std::min(entries.size(), kMaximumTorques); ++i) {
    const double before = entries.Get(i - 1).pinion_torque_newton_metres();
    const double torque = entries.Get(i).pinion_torque_newton_metres();
    if (torque > before) continue;
    violations.add(fmt::format("{}[{}].pinion_torque_newton_metres", path, i),
                   "{} N m after {} N m; allowed: ascending", torque, before);
  }
}

void check_shares_by_torque(const v1::GearSet& set, const std::string& path,
                            Violations& violations) {
  const int samples = set.flank_slots(0).load_share_size();
  const Constraint* row = find_constraint("LoadShareAtTorque.Slot", "load_share");
  for (int i = 0; i < set.load_share_by_torque_size(); ++i) {
    const v1::LoadShareAtTorque& entry = set.load_share_by_torque(i);
    const std::string here = fmt::format("{}[{}]", path, i);
    const auto locate = [&](int slot, int sample, std::string_view name) {
      return fmt::format("{}.slots[{}].{}[{}]", here, slot, name, sample);
    };
    bool whole = entry.slots_size() == kFlankPairs;
    for (const auto& slot : entry.slots()) whole = whole && slot.load_share_size() == samples;
    if (!whole) {
      violations.add(here + ".slots", "allowed: {} slots of {} samples, as in flank_slots",
                     kFlankPairs, samples);
      continue;
    }
    v1::GearSet shares;  // holds the slots as the checks below expect them
    TableViolations limited(here, violations);
    for (const auto& slot : entry.slots()) {
      *shares.add_flank_slots()->mutable_load_share() = slot.load_share();
    }
    for (int k = 0; k < kFlankPairs; ++k) {
      for (int j = 0; j < samples; ++j) {
        const double share = shares.flank_slots(k).load_share(j);
        if (row->allows(share)) continue;
        limited.add([&] { return locate(k, j, "load_share"); },
                    [&] { return out_of_range_text(*row, share); });
      }
    }
    if (!limited.any()) check_shares(shares, locate, limited);
  }
}

}  // namespace

void check_flank_slots(const v1::GearSet& gear_set, const LocateSample& locate,
                       const std::string& path, Violations& violations) {
  if (!check_sizes(gear_set, path, violations)) return;
  TableViolations limited(path, violations);
  check_numbers(gear_set, locate, limited);
  if (limited.any()) return;
  check_shares(gear_set, locate, limited);
  check_continuity(gear_set, locate, limited);
  if (gear_set.gear_teeth() > 0) check_power(gear_set, locate, limited);
}

void check_series(const v1::MeshSeries& series, const v1::GearSet& gear_set,
                  const std::string& path, Violations& violations) {
  const std::size_t before = violations.size();
  check_range("MeshSeries", "pinion_torque_newton_metres", series.pinion_torque_newton_metres(),
              join_path(path, "pinion_torque_newton_metres"), violations);
  const auto check = [&](const v1::FourierSeries& each, const char* field) {
    check_fourier(each, join_path(path, field), violations);
  };
  check(series.pinion_contact_radius_metres(), "pinion_contact_radius_metres");
  check(series.gear_contact_radius_metres(), "gear_contact_radius_metres");
  check(series.mesh_stiffness_newtons_per_metre(), "mesh_stiffness_newtons_per_metre");
  check(series.static_transmission_error_metres(), "static_transmission_error_metres");
  if (violations.size() > before || gear_set.pinion_teeth() <= 0) return;
  const double pinion = series.pinion_contact_radius_metres().mean();
  const double gear = series.gear_contact_radius_metres().mean();
  const double expected = pinion * gear_set.gear_teeth() / gear_set.pinion_teeth();
  if (std::abs(gear - expected) <= kRatioTolerance * std::abs(expected)) return;
  violations.add(join_path(path, "gear_contact_radius_metres.mean"),
                 "R_g0 = {} m; allowed: R_p0 N_g/N_p = {} m within {}, or the "
                 "transmission error grows without bound (eqs 8, 9)",
                 gear, expected, kRatioTolerance);
}

namespace {

/// Checks series, dynamics and tables. Checks against the ratio need the numbers of teeth.
void check_tables(const v1::GearSet& gear_set, const LocateSample& locate, const std::string& path,
                  Violations& violations) {
  const std::size_t before = violations.size();
  if (!gear_set.has_series()) {
    violations.add(join_path(path, "series"), "not set (eqs 8-11)");
  } else {
    check_series(gear_set.series(), gear_set, join_path(path, "series"), violations);
  }
  if (!gear_set.has_dynamics()) {
    violations.add(join_path(path, "dynamics"), "not set (eqs 1-5)");
  }
  check_flank_slots(gear_set, locate, path, violations);
  const std::string by_torque = join_path(path, "series_by_torque");
  check_torques(gear_set.series_by_torque(), by_torque, violations);
  for (int i = 0; i < std::min(gear_set.series_by_torque_size(), kMaximumTorques); ++i) {
    check_series(gear_set.series_by_torque(i), gear_set, fmt::format("{}[{}]", by_torque, i),
                 violations);
  }
  const std::string shares = join_path(path, "load_share_by_torque");
  check_torques(gear_set.load_share_by_torque(), shares, violations);
  if (violations.size() > before) return;
  check_shares_by_torque(gear_set, shares, violations);
}

}  // namespace

void check_gear_set(const v1::GearSet& gear_set, const LocateSample& locate,
                    const std::string& path, Violations& violations) {
  const std::size_t before = violations.size();
  if (const auto ratio = other_ratio_of_data(gear_set)) {
    violations.add(join_path(path, "gear_teeth"),
                   "{}/{} teeth; the series (R_g0/R_p0) and the flank slots belong to a ratio of "
                   "{:.6g}; a gear set of another ratio needs tooth contact data of its own",
                   gear_set.gear_teeth(), gear_set.pinion_teeth(), *ratio);
    v1::GearSet without_teeth = gear_set;  // the checks against the ratio need them
    without_teeth.clear_pinion_teeth();
    without_teeth.clear_gear_teeth();
    return check_tables(without_teeth, locate, path, violations);
  }
  check_tables(gear_set, locate, path, violations);
  if (violations.size() > before) return;
  try {
    check(to_core(gear_set));
  } catch (const Refusal& refusal) {
    violations.add(path.empty() ? "gear_set" : path, refusal.what());
  }
}

void check_gear_set(const v1::GearSet& gear_set, const std::string& path, Violations& violations) {
  const auto locate = [&](int slot, int sample, std::string_view name) {
    return fmt::format("{}[{}].{}[{}]", join_path(path, "flank_slots"), slot, name, sample);
  };
  check_gear_set(gear_set, locate, path, violations);
}

}  // namespace tribodyn::server
