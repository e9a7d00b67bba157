#include "core/study/contact_summary.h"

#include <array>
#include <utility>
#include <vector>

#include "core/integrate/mesh_cycle_march.h"
#include "core/study/sampled_range.h"

namespace tribodyn {
namespace {

enum SampledFigure {
  kSampledFilmRatio,
  kSampledTemperature,
  kSampledPressure,
  kSampledFlashRise,
  kSampledFigures
};

/// Rates at an instant, and their integrals over time; the last ones of each flank, in the order in
/// which a result adds them up: the figures are the result's to the last bit.
enum FlankRate {
  kFlankLoad,  ///< weight of the next two
  kFilmRatioFlankLoad,
  kTemperatureFlankLoad,
  kFrictionForce0,
  kViscousPower0 = kFrictionForce0 + kFlankPairs,
  kBoundaryPower0 = kViscousPower0 + kFlankPairs,
  kFlankRates = kBoundaryPower0 + kFlankPairs
};
using FlankRates = std::array<double, kFlankRates>;

/// The flanks at the start, middle or end of a piece. Figures of flanks without load mean nothing.
struct FlankSample {
  std::array<double, kFlankPairs> load;
  std::array<std::array<double, kFlankPairs>, kSampledFigures> figure;
  FlankRates per_phase;  ///< rates over mesh phase
};

/// Takes the contacts of an orbit in the order in which they were solved.
class SolvedFlanks {
 public:
  SolvedFlanks(const GearPairSystem& system, const MeshGrid& grid, const FlankContactModel& model,
               const SolvedContacts& contacts)
      : system_(system),
        grid_(grid),
        model_(model),
        friction_(contacts.friction()),
        viscous_(contacts.column(&ContactFigures::viscous_friction)),
        boundary_(contacts.column(&ContactFigures::boundary_friction)),
        temperature_(contacts.column(&ContactFigures::contact_temperature)),
        film_(contacts.column(&ContactFigures::central_film_thickness)),
        film_ratio_(contacts.column(&ContactFigures::film_ratio)),
        pressure_(contacts.column(&ContactFigures::maximum_pressure)),
        stress_(contacts.column(&ContactFigures::mean_shear_stress)) {}

  /// The next instant: part 0, 1 or 2 of a piece.
  void next(const OrbitPiece& piece, int part, FlankSample& out) {
    out.load = {};
    out.per_phase = {};
    if (piece.regime.side == 0 || !piece.regime.loaded) return;
    const MarchState& state = state_of(piece, part);
    Mechanics at;
    system_.kinematics(piece.node >= 0 ? grid_.at(piece.node + part)
                                       : system_.at_phase(piece.phase + 0.5 * part * piece.length),
                       piece.regime, state.data(), at);
    const double load = piece.regime.load(at.mesh_force);
    if (!(load > 0)) return;
    std::array<FlankKinematics, kFlankPairs> off_grid;
    const auto& flanks = flanks_of(system_.mesh(), grid_, piece, part, off_grid);
    for (int k = 0; k < kFlankPairs; ++k) {
      out.load[k] = flanks[k].load_share * load;
      if (out.load[k] > 0) add(flanks[k], state, k, out);
    }
    const double time_per_phase = system_.cycle_angle() / state[kPinionSpeed];
    for (double& rate : out.per_phase) rate *= time_per_phase;
  }

 private:
  void add(const FlankKinematics& flank, const MarchState& state, int k, FlankSample& out) {
    const int n = contact_++;
    const double load = out.load[k];
    FlankMotion motion;
    const ContactConditions conditions =
        system_.contact_conditions(flank, load, state.data(), motion);
    out.figure[kSampledFilmRatio][k] = film_ratio_[n];
    out.figure[kSampledTemperature][k] = temperature_[n];
    out.figure[kSampledPressure][k] = pressure_[n];
    out.figure[kSampledFlashRise][k] =
        model_.flash_temperature_rise(conditions, film_[n], stress_[n], temperature_[n]);
    out.per_phase[kFlankLoad] += load;
    out.per_phase[kFilmRatioFlankLoad] += load * film_ratio_[n];
    out.per_phase[kTemperatureFlankLoad] += load * temperature_[n];
    out.per_phase[kFrictionForce0 + k] = friction_[n];
    out.per_phase[kViscousPower0 + k] = motion.sliding_speed * viscous_[n];
    out.per_phase[kBoundaryPower0 + k] = motion.sliding_speed * boundary_[n];
  }

  const GearPairSystem& system_;
  const MeshGrid& grid_;
  const FlankContactModel& model_;
  const double *friction_, *viscous_, *boundary_, *temperature_, *film_, *film_ratio_, *pressure_,
      *stress_;
  int contact_ = 0;
};

}  // namespace

std::optional<ContactSummary> contact_summary(const PointResult& r) {
  if (r.film_ratio.maximum == 0) return std::nullopt;
  return ContactSummary{
      r.film_ratio.minimum,        r.film_ratio.mean,          r.contact_temperature.maximum,
      r.contact_temperature.mean,  r.viscous_loss_power,       r.boundary_loss_power,
      r.friction_coefficient.mean, r.maximum_pressure.maximum, r.flash_temperature_rise.maximum};
}

std::optional<ContactSummary> contact_summary(const PointProblem& problem,
                                              const PeriodicOrbit& orbit) {
  const GearPairSystem& system = problem.system();
  SolvedFlanks flanks(system, problem.gear_set.grids().with_steps(orbit.steps_per_mesh_cycle),
                      problem.contacts.model(), *orbit.contacts);
  const double load_floor =
      kLeastCountedLoad *
      march_scales(system, orbit.torques, problem.target.mean_pinion_speed).torque /
      system.mesh().mean_pinion_contact_radius();
  std::vector<int> first;
  number_instants(orbit.pieces, first);
  FlankRates integral{};
  std::array<SampledRange, kSampledFigures> range;
  std::array<FlankSample, 3> samples;
  std::array<FlankSample*, 3> at = {&samples[0], &samples[1], &samples[2]};
  for (std::size_t i = 0; i < orbit.pieces.size(); ++i) {
    const OrbitPiece& piece = orbit.pieces[i];
    std::swap(at[0], at[2]);
    const bool goes_on = i > 0 && first[i] < first[i - 1] + 3;
    for (int part = goes_on ? 1 : 0; part < 3; ++part) flanks.next(piece, part, *at[part]);
    for (int part = 0; part < 3; ++part) {
      const double weight = piece.length * (part == 1 ? 4 : 1) / 6;  // Simpson's rule
      for (int n = 0; n < kFlankRates; ++n) integral[n] += weight * at[part]->per_phase[n];
    }
    for (int k = 0; k < kFlankPairs; ++k) {
      const auto value = [&](std::size_t figure, std::size_t part) {
        return at[part]->figure[figure][k];
      };
      const std::array<double, 3> load = {at[0]->load[k], at[1]->load[k], at[2]->load[k]};
      add_counted(load, load_floor, value, range);
    }
  }
  if (!(range[kSampledFilmRatio].high > 0)) return std::nullopt;
  const double time = orbit.pieces.back().end[kTime], load_time = integral[kFlankLoad];
  double friction = 0, viscous_power = 0, boundary_power = 0;
  for (int k = 0; k < kFlankPairs; ++k) {
    friction += integral[kFrictionForce0 + k];
    viscous_power += integral[kViscousPower0 + k] / time;
    boundary_power += integral[kBoundaryPower0 + k] / time;
  }
  return ContactSummary{range[kSampledFilmRatio].low,
                        integral[kFilmRatioFlankLoad] / load_time,
                        range[kSampledTemperature].high,
                        integral[kTemperatureFlankLoad] / load_time,
                        viscous_power,
                        boundary_power,
                        friction / load_time,
                        range[kSampledPressure].high,
                        range[kSampledFlashRise].high};
}

}  // namespace tribodyn
