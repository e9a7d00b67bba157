#include "core/periodic/orbit_contacts.h"

#include <Eigen/Core>
#include <cmath>

#include "core/gear/flank_motion-inl.h"
#include "core/numerics/dual-inl.h"

namespace tribodyn {
namespace {

using SpeedNumber = HWY_NAMESPACE::Dual<double, 2>;  // by the speeds of pinion and gear

constexpr ContactInput kConditionInputs[kConditionSlopes] = {
    ContactInput::kLoad, ContactInput::kVelocity1X, ContactInput::kVelocity1Y,
    ContactInput::kVelocity2X, ContactInput::kVelocity2Y};

}  // namespace

OrbitContacts::OrbitContacts(const GearPairSystem& system, const MeshGrid& grid,
                             const FlankContactBatch& batch, const ContactSensitivityModel& model,
                             const PeriodicOrbit& orbit, double light_load)
    : system_(system),
      grid_(grid),
      batch_(batch),
      model_(model),
      orbit_(orbit),
      light_load_(light_load),
      off_grid_(batch.model().reduced_modulus(), batch.model().options(), 1) {}

bool OrbitContacts::differentiate() {
  instants_.resize(number_instants(orbit_.pieces, first_));
  const std::size_t room = most_contacts();
  contacts_.reserve(room);
  vectors_.clear(room);
  int next = 0;
  for (std::size_t i = 0; i < orbit_.pieces.size(); ++i) {
    for (int part = next - first_[i]; part < 3; ++part, ++next) {
      if (!add_contacts_at(orbit_.pieces[i], part, instants_[next])) return false;
    }
  }
  batch_.differentiate(vectors_);
  for (int i = 0; i < vectors_.size(); ++i) {
    one_sided_ = one_sided_ || std::abs(vectors_.slopes().edge[0][i] - 1) <= 1e-9;
  }
  for (ContactsAt& each : instants_) add_up(each);
  for (auto& weights : friction_weight_) weights.assign(contacts_.size(), AdjointRow{});
  film_ratio_weight_.assign(contacts_.size(), 0);
  temperature_weight_.assign(contacts_.size(), 0);
  return true;
}

std::size_t OrbitContacts::most_contacts() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < orbit_.pieces.size(); ++i) {
    const OrbitPiece& piece = orbit_.pieces[i];
    const bool goes_on = i > 0 && first_[i] < first_[i - 1] + 3;
    for (int part = goes_on ? 1 : 0; part < 3; ++part) {
      for (int k = 0; k < kFlankPairs; ++k) {
        count += piece.node < 0 || grid_.contact(piece.node + part, k) >= 0 ? 1 : 0;
      }
    }
  }
  return count;
}

/// The contacts of one instant. False where one has no derivatives.
bool OrbitContacts::add_contacts_at(const OrbitPiece& piece, int part, ContactsAt& out) {
  const MarchState& y = state_of(piece, part);
  Mechanics at;
  if (piece.node >= 0) {
    system_.kinematics(grid_.at(piece.node + part), piece.regime, y.data(), at);
  } else {
    system_.kinematics(piece.phase + 0.5 * part * piece.length, piece.regime, y.data(), at);
  }
  out.mesh_force = at.mesh_force;
  out.transmission_error = at.transmission_error;
  out.transmission_velocity = at.transmission_velocity;
  out.load = piece.regime.load(at.mesh_force);
  out.arms_follow = out.load > light_load_;
  out.first = static_cast<int>(contacts_.size());
  if (!(out.load > 0)) return true;
  const ModelOptions& options = system_.options();
  std::array<FlankKinematics, kFlankPairs> off_grid;
  const auto& flanks = flanks_of(system_.mesh(), grid_, piece, part, off_grid);
  for (int k = 0; k < kFlankPairs; ++k) {
    const FlankKinematics& flank = flanks[k];
    const double load = flank.load_share * out.load;
    if (!(load > 0)) continue;
    const SpeedNumber pinion_speed = SpeedNumber::variable(y[kPinionSpeed], 0);
    FlankMotionOf<SpeedNumber> motion;
    HWY_NAMESPACE::set_flank_motion(flank, pinion_speed, SpeedNumber::variable(y[kGearSpeed], 1),
                                    options.tabulated_friction_arms, motion);
    if (!(motion.sliding_speed > 0)) return false;
    if (options.subtract_contact_point_motion) {
      HWY_NAMESPACE::subtract_drift(flank, pinion_speed, motion);
    }
    const SpeedNumber velocity[4] = {motion.pinion_x, motion.pinion_y, motion.gear_x,
                                     motion.gear_y};
    Contact contact;
    contact.load = load;
    contact.load_by_force = flank.load_share * piece.regime.side;
    for (int v = 0; v < 4; ++v) {
      for (int s = 0; s < 2; ++s) contact.velocity_by_speed[v][s] = velocity[v].slope[s];
    }
    const SpeedNumber* const arms[2] = {&motion.pinion_friction_arm, &motion.gear_friction_arm};
    contact.sliding_speed = motion.sliding_speed.value;
    for (int s = 0; s < 2; ++s) {
      contact.arm[s] = arms[s]->value;
      contact.sliding_speed_slopes[s] = motion.sliding_speed.slope[s];
      for (int n = 0; n < 2; ++n) contact.arm_slopes[n][s] = arms[n]->slope[s];
    }
    const ContactConditions conditions{load,
                                       flank.radius_x,
                                       flank.radius_y,
                                       velocity[0].value,
                                       velocity[1].value,
                                       velocity[2].value,
                                       velocity[3].value};
    const std::size_t index = contacts_.size();
    const SolvedContacts& solved = *orbit_.contacts;
    ContactFigures figures;
    solved.copy(index, figures);
    contact.friction = figures.friction;
    contact.film_ratio = figures.film_ratio;
    contact.temperature = figures.contact_temperature;
    const bool both_move = (velocity[0].value != 0 || velocity[1].value != 0) &&
                           (velocity[2].value != 0 || velocity[3].value != 0);
    if (solved.by_scalar_kernel(index) || !both_move) {
      contact.lane = -1 - static_cast<int>(of_scalar_kernel_.size());
      of_scalar_kernel_.push_back(
          model_.at(conditions, solved.ellipse_load(index), figures.contact_temperature));
      if (of_scalar_kernel_.back().status != SensitivityStatus::kOk) return false;
      one_sided_ = one_sided_ || of_scalar_kernel_.back().one_sided;
    } else {
      const ContactGeometries* geometries = &off_grid_;
      std::size_t place = 0;
      if (piece.node >= 0) {
        geometries = &grid_.contacts().geometries;
        place = static_cast<std::size_t>(grid_.contact(piece.node + part, k));
      } else {
        off_grid_.set(0, flank.radius_x, flank.radius_y);
      }
      one_sided_ = one_sided_ ||
                   (options.hertz_solution == HertzSolution::kSimplified &&
                    std::abs(flank.radius_x - flank.radius_y) <= 1e-9 * std::abs(flank.radius_y));
      contact.lane = vectors_.add(*geometries, place, conditions,
                                  {solved.ellipse_load(index), figures.contact_temperature,
                                   figures.mean_shear_stress, figures.limiting_stress_area_share});
    }
    contacts_.push_back(contact);
  }
  out.count = static_cast<int>(contacts_.size()) - out.first;
  return true;
}

template <class ByCondition>
ArmSlopes OrbitContacts::by_motion(const Contact& contact, ByCondition&& by) {
  ArmSlopes out{by(0) * contact.load_by_force, 0, 0};
  for (int v = 0; v < 4; ++v) {
    const double by_velocity = by(1 + v);
    for (int s = 0; s < 2; ++s) out[1 + s] += by_velocity * contact.velocity_by_speed[v][s];
  }
  return out;
}

void OrbitContacts::add_up(ContactsAt& at) const {
  double torque[2] = {};
  ArmSlopes torque_slopes[2] = {};
  const ContactSlopes& slopes = vectors_.slopes();
  for (int i = at.first; i < at.first + at.count; ++i) {
    const Contact& c = contacts_[i];
    const auto slopes_of = [&](const Columns& rows,
                               const ContactDerivatives ContactSensitivity::*of) {
      if (c.lane >= 0) return by_motion(c, [&](int n) { return rows[n][c.lane]; });
      const ContactDerivatives& derivatives = of_scalar_kernel_[-1 - c.lane].*of;
      return by_motion(c, [&](int n) { return derivatives.by_input(kConditionInputs[n]); });
    };
    const ArmSlopes friction = slopes_of(slopes.friction, &ContactSensitivity::friction);
    const ArmSlopes film_ratio = slopes_of(slopes.film_ratio, &ContactSensitivity::film_ratio);
    const ArmSlopes temperature =
        slopes_of(slopes.temperature, &ContactSensitivity::contact_temperature);
    at.sum[kLossSum] += c.sliding_speed * c.friction;
    at.sum[kLoadSum] += c.load;
    at.sum[kFilmRatioLoadSum] += c.film_ratio * c.load;
    at.sum[kTemperatureLoadSum] += c.temperature * c.load;
    for (int m = 0; m < 3; ++m) {
      const double load_slope = m == 0 ? c.load_by_force : 0;
      at.sum_slopes[kLossSum][m] +=
          c.sliding_speed * friction[m] + (m > 0 ? c.sliding_speed_slopes[m - 1] * c.friction : 0);
      at.sum_slopes[kLoadSum][m] += load_slope;
      at.sum_slopes[kFilmRatioLoadSum][m] += film_ratio[m] * c.load + c.film_ratio * load_slope;
      at.sum_slopes[kTemperatureLoadSum][m] += temperature[m] * c.load + c.temperature * load_slope;
    }
    for (int n = 0; n < 2; ++n) {
      torque[n] += c.arm[n] * c.friction;
      for (int m = 0; m < 3; ++m) {
        torque_slopes[n][m] +=
            c.arm[n] * friction[m] + (m > 0 ? c.arm_slopes[n][m - 1] * c.friction : 0);
      }
    }
  }
  at.sum[kFrictionTorqueSum] = torque[0];
  at.sum_slopes[kFrictionTorqueSum] = torque_slopes[0];
  if (!at.arms_follow) return;
  const int side = at.mesh_force > 0 ? 1 : -1;
  for (int n = 0; n < 2; ++n) {
    for (int m = 0; m < 3; ++m) {
      at.arm[n][m] = (torque_slopes[n][m] - (m == 0 ? side * torque[n] / at.load : 0)) / at.load;
    }
  }
}

void OrbitContacts::weigh_arms(const ContactsAt& at, int group,
                               const std::array<AdjointRow, 2>& arm) {
  if (!at.arms_follow) return;
  const double per_load = 1 / at.load;
  for (int i = at.first; i < at.first + at.count; ++i) {
    const Contact& c = contacts_[i];
    AdjointRow& weight = friction_weight_[group][i];
    const double pinion = c.arm[0] * per_load, gear = c.arm[1] * per_load;
    for (int f = 0; f < kAdjointLanes; ++f) weight[f] += pinion * arm[0][f] + gear * arm[1][f];
  }
}

void OrbitContacts::weigh_sums(const ContactsAt& at, double weight, int other, double loss_weight) {
  for (int i = at.first; i < at.first + at.count; ++i) {
    const Contact& c = contacts_[i];
    AdjointRow& friction = friction_weight_[kGroups - 1][i];
    friction[kLossSum] += weight * c.sliding_speed;
    friction[kFrictionTorqueSum] += weight * c.arm[0];
    friction[other] += loss_weight * c.sliding_speed;
    film_ratio_weight_[i] += weight * c.load;
    temperature_weight_[i] += weight * c.load;
  }
}

OrbitContacts::ByParameters OrbitContacts::by_parameters() const {
  using Parameters = Eigen::Map<const Eigen::Matrix<double, 1, kContactParameters>>;
  constexpr int kLast = (kGroups - 1) * kAdjointLanes;
  ByParameters out = ByParameters::Zero();
  // Those of the vector code, in the order of their lanes.
  const auto count = static_cast<std::size_t>(vectors_.size());
  std::vector<AdjointRow> weights(count);
  const auto in_lanes = [&](const auto& from, auto& to) {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (contacts_[i].lane >= 0) to[contacts_[i].lane] = from[i];
    }
  };
  Eigen::Matrix<double, kGroups * kAdjointLanes, kContactLevels> by_level;
  const ContactSlopes& slopes = vectors_.slopes();
  for (int group = 0; group < kGroups; ++group) {
    in_lanes(friction_weight_[group], weights);
    std::array<AdjointRow, kContactLevels> sum{};
    add_weighted_slopes(batch_.instruction_set(), vectors_.size(), weights.data(),
                        slopes.friction[kConditionSlopes], slopes.friction.stride(), kContactLevels,
                        sum.data());
    for (int l = 0; l < kContactLevels; ++l) {
      for (int f = 0; f < kAdjointLanes; ++f) by_level(group * kAdjointLanes + f, l) = sum[l][f];
    }
  }
  Eigen::VectorXd weight(count);
  const auto add_row = [&](const std::vector<double>& from, const Columns& rows, int levels,
                           int figure) {
    in_lanes(from, weight);
    using Rows =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                   Eigen::OuterStride<>>;
    const Rows matrix(rows[kConditionSlopes], levels, static_cast<Eigen::Index>(count),
                      Eigen::OuterStride<>(static_cast<Eigen::Index>(rows.stride())));
    by_level.row(kLast + figure).head(levels) += (matrix * weight).transpose();
  };
  add_row(film_ratio_weight_, slopes.film_ratio, kDirectLevels, kFilmRatioLoadSum);
  add_row(temperature_weight_, slopes.temperature, kContactLevels, kTemperatureLoadSum);
  using Levels =
      Eigen::Map<const Eigen::Matrix<double, kContactLevels, kContactParameters, Eigen::RowMajor>>;
  out.noalias() = by_level * Levels(model_.levels_by_parameter()[0].data());

  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (contacts_[i].lane >= 0) continue;
    const ContactSensitivity& each = of_scalar_kernel_[-1 - contacts_[i].lane];
    const Parameters friction(each.friction.by.data());
    for (int group = 0; group < kGroups; ++group) {
      for (int f = 0; f < kAdjointLanes; ++f) {
        out.row(group * kAdjointLanes + f) += friction_weight_[group][i][f] * friction;
      }
    }
    out.row(kLast + kFilmRatioLoadSum) +=
        film_ratio_weight_[i] * Parameters(each.film_ratio.by.data());
    out.row(kLast + kTemperatureLoadSum) +=
        temperature_weight_[i] * Parameters(each.contact_temperature.by.data());
  }
  return out;
}

}  // namespace tribodyn
