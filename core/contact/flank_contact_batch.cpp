#include "core/contact/flank_contact_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/contact/contact_block.h"
#include "core/contact/contact_block_tables.h"
#include "core/contact/hertz.h"
#include "core/lubricant/viscosity.h"

namespace tribodyn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool equal(const AsPublished& a, const AsPublished& b) {
  return a.eq20_semi_major == b.eq20_semi_major && a.eq22_inverted_ratio == b.eq22_inverted_ratio;
}

/// Below it d ln tau/dT <= -(1 - ab) A1/(T - T0)^2 + ab/T < 0 at every pressure, a b = alpha_HN
/// beta_HN; infinite for a Newtonian fluid.
double unique_root_temperature(const Lubricant& oil, bool newtonian) {
  const double product = oil.havriliak_negami_alpha * oil.havriliak_negami_beta;
  if (newtonian || product == 0) return kInfinity;
  if (!(product > 0 && product < 1) || oil.density_temperature_slope > 0) return -kInfinity;
  const double b = oil.vogel_reference_temperature +
                   0.5 * oil.vogel_temperature_coefficient * (1 - product) / product;
  const double t0 = oil.vogel_reference_temperature;
  return (b + std::sqrt(b * b - t0 * t0)) * (1 - 1e-9);
}

/// Returns whether the vector code can certify contacts under the growth of viscosity with pressure
/// of a law other than eq 31: the growth falls with temperature over the whole table, which is
/// proved, and tau is convex in p: d(1/g)/dp <= 1 with g = d ln tau/dp, which is checked at 8 x 48
/// temperatures and depths. Sets limited_rim.
bool can_certify_growth(ContactBlockTables& t, double tau_zero, double gamma) {
  const GrowthLaw<double>& law = t.shear.growth;
  const double c = laws::kRoelandsPressureCoefficient;
  if (!laws::pressure_growth_falls(law, t.inlet_temperature, t.maximum_scaled_pressure / c)) {
    return false;
  }
  if (!t.limited || gamma == 0) return true;
  constexpr int kTemperatures = 8, kDepths = 48;
  using Number = laws::Dual<double, 1>;
  for (int i = 0; i < kTemperatures; ++i) {
    const double temperature = t.inlet_temperature + (t.maximum_temperature - t.inlet_temperature) *
                                                         i / (kTemperatures - 1);
    double before = kInfinity;
    for (int j = 0; j <= kDepths; ++j) {
      const Number pressure =
          Number::variable(std::expm1(t.maximum_log_pressure * j / kDepths) / c, 0);
      const double steepness = laws::pressure_growth(law, Number(temperature), pressure).slope[0];
      if (j == 0) t.limited_rim = t.limited_rim || steepness * tau_zero < gamma;
      const double flatness = 1 / steepness - pressure.value;
      if (!(steepness > 0 && flatness <= before)) return false;
      before = flatness;
    }
  }
  return true;
}

}  // namespace

ContactGeometries::ContactGeometries(double reduced_modulus, const ModelOptions& options,
                                     std::size_t count)
    : reduced_modulus_(reduced_modulus),
      hertz_solution_(options.hertz_solution),
      as_published_(options.as_published) {
  resize(count);
}

void ContactGeometries::resize(std::size_t count) {
  for (auto* column : {&radius_x_, &radius_y_, &curvature_x_, &curvature_y_, &unit_area_,
                       &per_semi_x_, &per_semi_y_, &maximum_pressure_}) {
    column->resize(count);
  }
}

void ContactGeometries::set(std::size_t i, double radius_x, double radius_y) {
  radius_x_[i] = radius_x;
  radius_y_[i] = radius_y;
  if (!(radius_x > 0 && radius_y > 0)) {
    curvature_x_[i] = curvature_y_[i] = unit_area_[i] = per_semi_x_[i] = 0;
    per_semi_y_[i] = maximum_pressure_[i] = 0;
    return;
  }
  const HertzFit fit = hertz_solution_ == HertzSolution::kExact
                           ? exact_ellipticity(radius_x, radius_y)
                           : simplified_ellipticity(radius_x, radius_y, as_published_);
  const UnitLoadEllipse unit =
      unit_load_ellipse(fit, radius_x, radius_y, reduced_modulus_, as_published_);
  const bool major_along_y = radius_y >= radius_x;
  curvature_x_[i] = 1 / radius_x;
  curvature_y_[i] = 1 / radius_y;
  unit_area_[i] = std::numbers::pi * unit.semi_minor * unit.semi_major;
  per_semi_x_[i] = 1 / (major_along_y ? unit.semi_minor : unit.semi_major);
  per_semi_y_[i] = 1 / (major_along_y ? unit.semi_major : unit.semi_minor);
  maximum_pressure_[i] = unit.maximum_pressure;
}

void ContactGeometries::copy(std::size_t i, const ContactGeometries& from, std::size_t j) {
  radius_x_[i] = from.radius_x_[j];
  radius_y_[i] = from.radius_y_[j];
  curvature_x_[i] = from.curvature_x_[j];
  curvature_y_[i] = from.curvature_y_[j];
  unit_area_[i] = from.unit_area_[j];
  per_semi_x_[i] = from.per_semi_x_[j];
  per_semi_y_[i] = from.per_semi_y_[j];
  maximum_pressure_[i] = from.maximum_pressure_[j];
}

struct FlankContactBatch::Tables : ContactBlockTables {};

FlankContactBatch::FlankContactBatch(const FlankContactModel& model)
    : FlankContactBatch(model, widest()) {}

FlankContactBatch::FlankContactBatch(const FlankContactModel& model, InstructionSet instruction_set)
    : model_(model), instruction_set_(instruction_set) {
  auto tables = std::make_unique<Tables>();
  Tables& t = *tables;
  const ContactParametersOf<double>& in = model.parameters();
  const Lubricant& oil = in.lubricant;
  const ModelOptions& options = model.options();
  static_cast<ContactConstants<double>&>(t) = model.constants();
  t.inlet_shear_heating = options.inlet_shear_heating;
  t.closed_load_sharing = options.closed_load_sharing && t.asperity_load_factor > 0;
  t.inverse_roughness = 1 / in.roughness.composite_rms_height;
  t.no_boundary_friction = options.no_boundary_friction;
  if (!options.no_boundary_friction) t.boundary = in.boundary;
  t.isothermal = options.isothermal;
  t.limited = !options.no_limiting_shear_stress;
  const bool roelands = oil.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
  const double tau_zero = oil.limiting_shear_stress_at_zero_pressure;
  const double gamma = oil.limiting_shear_stress_coefficient;
  if (t.limited) {
    t.log_limit_at_edge = std::log(tau_zero);
    t.limit_slope = gamma / laws::kRoelandsPressureCoefficient;
  }

  double end_of_density = kInfinity;
  if (!t.shear.newtonian && oil.density_temperature_slope < 0) {
    end_of_density = -oil.density_at_zero_kelvin / oil.density_temperature_slope;
  }
  t.shear.newtonian = t.shear.newtonian || oil.relaxation_time == 0;
  t.unique_root_temperature = unique_root_temperature(oil, t.shear.newtonian);
  const bool one_equilibrium = t.isothermal || t.unique_root_temperature >= end_of_density;
  if (one_equilibrium) t.unique_root_temperature = kInfinity;

  const auto factor_at = [&](double temperature) {
    return laws::roelands_factor(log_ambient_viscosity(oil, temperature));
  };
  t.maximum_temperature = std::min(t.inlet_temperature + 200, 0.9 * end_of_density);
  if (t.limited && roelands && gamma > 0) {
    // d2 tau/dp2 = tau c^2 L Z u^(Z-2) (L Z u^Z + Z - 1), u = 1 + c p >= 1; d tau/dp is least,
    // where tau exceeds tau_L0 at the edge, at tau_L0 and the least L.
    t.convex_factor = (1 - t.shear.index) / t.shear.index;
    t.limited_rim = tau_zero * t.shear.index * factor_at(t.maximum_temperature) < t.limit_slope;
  }
  const AsPublished& p = options.as_published;
  const bool limit_rises = !t.limited || (tau_zero >= 0 && gamma >= 0 && tau_zero + gamma > 0);
  const bool proved = one_equilibrium || t.limited;
  t.can_certify = !p.eq17_atan && !p.eq31_32_logarithm && !p.eq43_44_polynomials &&
                  options.hertz_load == HertzLoad::kFilmLoad && limit_rises && proved &&
                  t.maximum_temperature > t.inlet_temperature + 1 && std::isfinite(t.log_film) &&
                  std::isnormal(std::exp(log_ambient_viscosity(oil, t.inlet_temperature))) &&
                  tabulate_ratio(instruction_set, factor_at(t.maximum_temperature),
                                 factor_at(t.inlet_temperature), t) &&
                  (roelands || can_certify_growth(t, tau_zero, gamma));
  tabulate_asperities(t);
  if (t.can_certify && t.limited && !t.isothermal) fit_start(instruction_set, t);
  tables_ = std::move(tables);
}

FlankContactBatch::~FlankContactBatch() = default;
FlankContactBatch::FlankContactBatch(FlankContactBatch&&) noexcept = default;
FlankContactBatch& FlankContactBatch::operator=(FlankContactBatch&&) noexcept = default;

InstructionSet FlankContactBatch::widest() {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2}) {
    if (has_instructions(set)) return set;
  }
  return InstructionSet::kPortable;
}

bool FlankContactBatch::supported(InstructionSet instruction_set) {
  return has_instructions(instruction_set);
}

const char* FlankContactBatch::name(InstructionSet instruction_set) {
  static constexpr const char* kNames[] = {"portable", "avx2", "avx512"};
  return kNames[static_cast<int>(instruction_set)];
}

namespace {

/// A figure in the caller's arrays, in the scalar kernel's solution and in a block.
struct Figure {
  double* FlankContactBatchResults::*to;
  double ContactSolution::*of_scalar_kernel;
  ContactLanes ContactBlockResults::*of_block;
};
using To = FlankContactBatchResults;
using Solution = ContactSolution;
using Block = ContactBlockResults;
constexpr Figure kFigures[] = {
    {&To::friction, &Solution::friction, &Block::friction},
    {&To::viscous_friction, &Solution::viscous_friction, &Block::viscous_friction},
    {&To::boundary_friction, &Solution::boundary_friction, &Block::boundary_friction},
    {&To::contact_temperature, &Solution::contact_temperature, &Block::contact_temperature},
    {&To::central_film_thickness, &Solution::central_film_thickness, &Block::film_thickness},
    {&To::film_ratio, &Solution::film_ratio, &Block::film_ratio},
    {&To::maximum_pressure, &Solution::maximum_pressure, &Block::maximum_pressure},
    {&To::ellipse_load, &Solution::ellipse_load, &Block::ellipse_load},
    {&To::asperity_load, &Solution::asperity_load, &Block::asperity_load},
    {&To::sliding_speed, &Solution::sliding_speed, &Block::sliding_speed},
    {&To::shear_rate, &Solution::shear_rate, &Block::shear_rate},
    {&To::mean_shear_stress, &Solution::mean_shear_stress, &Block::mean_shear_stress},
    {&To::limiting_stress_area_share, &Solution::limiting_stress_area_share,
     &Block::limited_area_share},
};

/// Contact i of the caller's arrays from the scalar kernel's solution.
void put(const ContactSolution& s, std::size_t i, const FlankContactBatchResults& to) {
  const auto set = [i](auto* array, auto value) {
    if (array != nullptr) array[i] = value;
  };
  for (const Figure& each : kFigures) set(to.*each.to, s.*each.of_scalar_kernel);
  set(to.limiting_stress_at_centre, s.limiting_stress_at_centre);
  set(to.by_scalar_kernel, true);
  set(to.status, s.status);
}

/// The first `count` contacts of a block; n of them is contact place(n) of the caller's arrays.
template <class Place>
void put(const ContactBlockResults& from, int count, Place&& place,
         const FlankContactBatchResults& to) {
  const auto set = [&](auto* array, auto&& value) {
    if (array == nullptr) return;
    for (int n = 0; n < count; ++n) array[place(n)] = value(n);
  };
  for (const Figure& each : kFigures) {
    set(to.*each.to, [&lanes = from.*each.of_block](int n) { return lanes[n]; });
  }
  set(to.limiting_stress_at_centre, [&](int n) { return from.limited_at_centre[n] != 0; });
  set(to.by_scalar_kernel, [](int) { return false; });
  set(to.status, [](int) { return ContactStatus::kOk; });
}

bool all_loaded(const double* load) {
  bool all = true;
  for (int n = 0; n < kBlockContacts; ++n) all = all && !(load[n] <= 0);
  return all;
}

/// Contacts gathered from here and there.
class Collected {
 public:
  /// Copies the first contact of `from` to place n.
  void take(const ContactBlockInputs& from, int n) {
    for (std::size_t c = 0; c < kColumns.size(); ++c) column_[c][n] = *(from.*kColumns[c]);
  }
  /// Fills the rest with copies of the last of `count`.
  void pad(int count) {
    for (ContactLanes& column : column_) {
      std::fill(column + count, column + kBlockContacts, column[count - 1]);
    }
  }
  ContactBlockInputs inputs() const {
    ContactBlockInputs in;
    for (std::size_t c = 0; c < kColumns.size(); ++c) in.*kColumns[c] = column_[c];
    return in;
  }

 private:
  using In = ContactBlockInputs;
  static constexpr std::array kColumns{&In::load,        &In::x_1,         &In::y_1,
                                       &In::x_2,         &In::y_2,         &In::start_temperature,
                                       &In::curvature_x, &In::curvature_y, &In::unit_area,
                                       &In::per_semi_x,  &In::per_semi_y,  &In::unit_pressure};
  alignas(64) ContactLanes column_[kColumns.size()];
};

constexpr ContactLanes kNoStart{};

}  // namespace

std::size_t FlankContactBatch::solve(const ContactGeometries& geometries, std::size_t first,
                                     std::size_t count,
                                     const FlankContactBatchConditions& conditions,
                                     const FlankContactBatchResults& results, Digits digits) const {
  const ContactGeometries& g = geometries;
  const FlankContactBatchConditions& k = conditions;
  std::size_t by_scalar_kernel = 0;
  const auto solve_alone = [&](std::size_t i) {
    put(model_.solve({k.load[i], g.radius_x_[first + i], g.radius_y_[first + i], k.velocity_1_x[i],
                      k.velocity_1_y[i], k.velocity_2_x[i], k.velocity_2_y[i]}),
        i, results);
    ++by_scalar_kernel;
  };
  const bool can_certify = tables_->can_certify && g.reduced_modulus_ == model_.reduced_modulus() &&
                           g.hertz_solution_ == model_.options().hertz_solution &&
                           equal(g.as_published_, model_.options().as_published);
  if (!can_certify) {
    for (std::size_t i = 0; i < count; ++i) solve_alone(i);
    return by_scalar_kernel;
  }

  // Blocks that are under load all over are read where they are, others are collected first.
  const auto inputs = [&](std::size_t i) {
    const std::size_t at = first + i;
    return ContactBlockInputs{k.load + i,
                              k.velocity_1_x + i,
                              k.velocity_1_y + i,
                              k.velocity_2_x + i,
                              k.velocity_2_y + i,
                              k.start_temperature != nullptr ? k.start_temperature + i : kNoStart,
                              g.curvature_x_.data() + at,
                              g.curvature_y_.data() + at,
                              g.unit_area_.data() + at,
                              g.per_semi_x_.data() + at,
                              g.per_semi_y_.data() + at,
                              g.maximum_pressure_.data() + at};
  };
  ContactBlockResults solved;
  Collected collected;
  std::array<std::size_t, kBlockContacts> place;
  int filled = 0;
  const auto flush = [&] {
    collected.pad(filled);
    solve_contact_block(instruction_set_, *tables_, digits, filled, collected.inputs(), solved);
    put(
        solved, filled, [&](int n) { return place[n]; }, results);
    for (int n = 0; n < filled; ++n) {
      if (solved.certified[n] == 0) solve_alone(place[n]);
    }
    filled = 0;
  };
  for (std::size_t i = 0; i < count;) {
    if (filled == 0 && count - i >= kBlockContacts && all_loaded(k.load + i)) {
      solve_contact_block(instruction_set_, *tables_, digits, kBlockContacts, inputs(i), solved);
      put(
          solved, kBlockContacts, [i](int n) { return i + n; }, results);
      for (int n = 0; n < kBlockContacts; ++n) {
        if (solved.certified[n] == 0) solve_alone(i + n);
      }
      i += kBlockContacts;
      continue;
    }
    if (k.load[i] <= 0) {
      solve_alone(i);
      --by_scalar_kernel;
    } else {
      collected.take(inputs(i), filled);
      place[filled] = i;
      if (++filled == kBlockContacts) flush();
    }
    ++i;
  }
  if (filled > 0) flush();
  return by_scalar_kernel;
}

void DifferentiatedContacts::clear(std::size_t room) {
  count_ = 0;
  solved_.resize_for_overwrite(kSolvedContactRows, room);
  slopes_.resize_for_overwrite(room);
}

int DifferentiatedContacts::add(const ContactGeometries& geometries, std::size_t i,
                                const ContactConditions& conditions, const Solved& solved) {
  const auto put = [&](SolvedContactRow row, double value) { solved_[row][count_] = value; };
  put(kSolvedLoad, conditions.load);
  put(kSolvedVelocity1X, conditions.velocity_1_x);
  put(kSolvedVelocity1Y, conditions.velocity_1_y);
  put(kSolvedVelocity2X, conditions.velocity_2_x);
  put(kSolvedVelocity2Y, conditions.velocity_2_y);
  put(kSolvedCurvatureX, geometries.curvature_x_[i]);
  put(kSolvedCurvatureY, geometries.curvature_y_[i]);
  put(kSolvedUnitArea, geometries.unit_area_[i]);
  put(kSolvedPerSemiX, geometries.per_semi_x_[i]);
  put(kSolvedPerSemiY, geometries.per_semi_y_[i]);
  put(kSolvedUnitPressure, geometries.maximum_pressure_[i]);
  put(kSolvedEllipseLoad, solved.ellipse_load);
  put(kSolvedContactTemperature, solved.contact_temperature);
  put(kSolvedMeanShearStress, solved.mean_shear_stress);
  put(kSolvedLimitedAreaShare, solved.limiting_stress_area_share);
  return count_++;
}

void FlankContactBatch::differentiate(DifferentiatedContacts& contacts) const {
  if (contacts.count_ == 0) return;
  const auto count = static_cast<std::size_t>(contacts.count_);
  const std::size_t padded = (count + kColumnLanes - 1) / kColumnLanes * kColumnLanes;
  for (int row = 0; row < kSolvedContactRows; ++row) {
    double* const at = contacts.solved_[row];
    std::fill(at + count, at + padded, at[count - 1]);
  }
  differentiate_contacts(instruction_set_, *tables_, count, contacts.solved_, contacts.slopes_);
}

}  // namespace tribodyn
