#include "core/contact/contact_sensitivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "tests/consistency/contact_case.h"
#include "tests/support/contact_batch.h"
#include "tests/support/improved_yasutomi.h"

namespace tribodyn {
namespace {

struct Output {
  const char* name;
  ContactDerivatives ContactSensitivity::*derivatives;
  double (*value)(const ContactSolution&, const ContactConditions&);
};
using S = ContactSensitivity;
using C = ContactSolution;
using K = ContactConditions;
const std::vector<Output>& outputs() {
  static const std::vector<Output> all{
      {"friction", &S::friction, [](const C& s, const K&) { return s.friction; }},
      {"viscous friction", &S::viscous_friction,
       [](const C& s, const K&) { return s.viscous_friction; }},
      {"boundary friction", &S::boundary_friction,
       [](const C& s, const K&) { return s.boundary_friction; }},
      {"friction coefficient", &S::friction_coefficient,
       [](const C& s, const K&) { return s.friction_coefficient; }},
      {"heat rate", &S::heat_rate, [](const C& s, const K&) { return s.heat_rate; }},
      {"film thickness", &S::film_thickness,
       [](const C& s, const K&) { return s.central_film_thickness; }},
      {"film ratio", &S::film_ratio, [](const C& s, const K&) { return s.film_ratio; }},
      {"film's share of the load", &S::film_load_share,
       [](const C& s, const K& k) { return s.film_load / k.load; }},
      {"maximum pressure", &S::maximum_pressure,
       [](const C& s, const K&) { return s.maximum_pressure; }},
      {"contact temperature", &S::contact_temperature,
       [](const C& s, const K&) { return s.contact_temperature; }},
      {"mean shear stress", &S::mean_shear_stress,
       [](const C& s, const K&) { return s.mean_shear_stress; }},
  };
  return all;
}

struct Contact {
  ContactParametersOf<double> parameters;
  ContactConditions conditions;
  ModelOptions options;

  explicit Contact(const ContactCase& c)
      : parameters{c.lubricant,        c.solid,
                   c.roughness,        c.boundary,
                   c.sump_temperature, c.inlet_temperature_rise},
        conditions(c.conditions),
        options(c.options) {}
  FlankContactModel model() const {
    const auto& p = parameters;
    return {p.lubricant, p.solids,           p.roughness,
            p.boundary,  p.bath_temperature, p.inlet_temperature_rise,
            options};
  }
  ContactSensitivity sensitivity() const { return ContactSensitivityModel(model()).at(conditions); }
};

/// Values of all outputs with one input moved by a share of itself.
std::vector<double> moved(Contact contact, int input, double share) {
  double& x = *contact_inputs(contact.parameters, contact.conditions)[input];
  x *= 1 + share;
  const ContactSolution s = contact.model().solve(contact.conditions);
  EXPECT_EQ(s.status, ContactStatus::kOk);
  std::vector<double> out;
  for (const Output& output : outputs()) out.push_back(output.value(s, contact.conditions));
  return out;
}

/// Central differences of fourth order, d output/d ln input, of steps h and h/2 and their distance.
struct Difference {
  double slope, error;
};
std::vector<Difference> differences(const Contact& contact, int input, double h) {
  const auto at = [&](double share) { return moved(contact, input, share); };
  const auto a = at(-2 * h), b = at(-h), c = at(-h / 2), d = at(h / 2), e = at(h), f = at(2 * h);
  std::vector<Difference> out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double coarse = (8 * (e[i] - b[i]) - (f[i] - a[i])) / (12 * h);
    const double fine = (8 * (d[i] - c[i]) - (e[i] - b[i])) / (6 * h);
    out.push_back({fine, std::abs(fine - coarse)});
  }
  return out;
}

struct Comparison {
  int compared = 0, inconclusive = 0;
  double worst = 0;
};

/// Elasticities d ln output/d ln input to 1e-7 of 1 or, where they are greater, of themselves.
void expect_like_differences(const Contact& contact, const std::string& where,
                             Comparison& comparison) {
  const ContactSensitivity s = contact.sensitivity();
  ASSERT_EQ(s.status, SensitivityStatus::kOk) << where;
  Contact copy = contact;
  const auto inputs = contact_inputs(copy.parameters, copy.conditions);
  for (int i = 0; i < kContactInputs; ++i) {
    const auto by_difference = differences(contact, i, 1e-3);
    for (std::size_t j = 0; j < outputs().size(); ++j) {
      const ContactDerivatives& derivatives = s.*outputs()[j].derivatives;
      const double scale = std::abs(derivatives.value);
      if (scale == 0) continue;
      const double exact = derivatives.by[i] * *inputs[i] / scale;
      const double difference = by_difference[j].slope / scale;
      const double unit = std::max(1.0, std::abs(exact));
      if (!(by_difference[j].error / scale < 2e-8 * unit)) {
        ++comparison.inconclusive;
        continue;
      }
      ++comparison.compared;
      const double error = std::abs(exact - difference) / unit;
      comparison.worst = std::max(comparison.worst, error);
      EXPECT_LT(error, 1e-7) << where << ": " << outputs()[j].name << " by "
                             << "input " << i << " of ContactInput"
                             << ": " << exact << " and " << difference;
    }
  }
}

TEST(ContactSensitivity, AgreesWithCentralDifferencesOnRandomStates) {
  Draw draw(901);
  Comparison comparison;
  for (int n = 0; n < (kShortRun ? 10 : 60); ++n) {
    ContactCase c = random_contact_case(draw);
    c.options.hertz_solution = n % 2 == 0 ? HertzSolution::kSimplified : HertzSolution::kExact;
    c.options.isothermal = n % 10 == 3;
    c.options.newtonian = n % 10 == 5;
    c.options.no_limiting_shear_stress = n % 10 == 7;
    c.options.inlet_shear_heating = n % 4 >= 2;
    c.options.closed_load_sharing = n % 7 < 4;
    if (n % 10 == 9) c.options.pressure_viscosity_index = PressureViscosityIndex::kHoupert;
    if (c.model().solve(c.conditions).status != ContactStatus::kOk) continue;
    expect_like_differences(Contact(c), "state " + std::to_string(n) + ", " + draw.seed(),
                            comparison);
  }
  // Differences across a kink of the second derivative, or of less than their rounding, say
  // nothing.
  EXPECT_LT(comparison.inconclusive, 0.1 * comparison.compared);
  RecordProperty("compared", comparison.compared);
  RecordProperty("inconclusive", comparison.inconclusive);
  RecordProperty("worst", std::to_string(comparison.worst));
}

TEST(ContactSensitivity, AgreesWithCentralDifferencesInTheGear) {
  Comparison comparison;
  for (const double load : {50.0, 500.0, 3000.0}) {
    for (const double sump : {283.15, 313.15, 363.15}) {
      ContactCase c;
      c.conditions.load = load;
      c.sump_temperature = sump;
      expect_like_differences(Contact(c), std::to_string(load) + " N", comparison);
    }
  }
  EXPECT_LT(comparison.inconclusive, 0.1 * comparison.compared);
}

TEST(ContactSensitivity, AgreesWithCentralDifferencesWhereAFilmSupportsAPartOfItsLoad) {
  Comparison comparison;
  for (const double slower : {0.3, 0.03, 0.001}) {
    ContactCase c;
    c.options = recommended_model();
    c.sump_temperature = 363.15;
    for (double* each : {&c.conditions.velocity_1_x, &c.conditions.velocity_1_y,
                         &c.conditions.velocity_2_x, &c.conditions.velocity_2_y}) {
      *each *= slower;
    }
    const ContactSolution s = c.model().solve(c.conditions);
    EXPECT_LT(s.film_load, s.ellipse_load);
    expect_like_differences(Contact(c), std::to_string(s.film_ratio), comparison);
  }
  EXPECT_LT(comparison.inconclusive, 0.1 * comparison.compared);
}

TEST(ContactSensitivity, AgreesWithCentralDifferencesUnderTheImprovedYasutomiLaw) {
  Comparison comparison;
  for (const double load : {50.0, 500.0, 3000.0}) {
    for (const double sump : {293.15, 313.15, 363.15}) {
      ContactCase c;
      set_yasutomi(gear_oil_80w90(), c.lubricant);
      c.conditions.load = load;
      c.sump_temperature = sump;
      expect_like_differences(
          Contact(c), std::to_string(load) + " N, " + std::to_string(sump) + " K", comparison);
      const ContactSensitivity s = Contact(c).sensitivity();
      for (int k = 0; k < kMostLawParameters; ++k) {
        EXPECT_NE(s.friction.by[static_cast<int>(ContactInput::kLawParameters) + k], 0) << k;
      }
      EXPECT_EQ(s.friction.by_input(ContactInput::kPressureViscosityCoefficient), 0);
    }
  }
  EXPECT_LT(comparison.inconclusive, 0.1 * comparison.compared);
}

TEST(ContactSensitivity, AgreesWithCentralDifferencesForSteelOnGlass) {
  Contact contact{ContactCase{}};
  contact.parameters.solids.body_2 = {75e9, 0.22, 1.1, 2500, 840};
  Comparison comparison;
  expect_like_differences(contact, "steel on glass", comparison);
  EXPECT_LT(comparison.inconclusive, 0.1 * comparison.compared);
}

TEST(ContactSensitivity, HasContinuousDerivativesWhereTheStressBeginsToBeLimited) {
  // The limit at which it is met at the centre alone.
  Contact contact{ContactCase{}};
  contact.conditions.load = 300;
  double& limit = contact.parameters.lubricant.limiting_shear_stress_coefficient;
  double low = 0.001, high = 10;
  for (int i = 0; i < 200; ++i) {
    limit = std::sqrt(low * high);
    (contact.model().solve(contact.conditions).limiting_stress_at_centre ? low : high) = limit;
  }
  const double onset = limit;
  limit = onset * (1 + 1e-7);
  const ContactSensitivity free = contact.sensitivity();
  limit = onset * (1 - 1e-7);
  const ContactSensitivity limited = contact.sensitivity();
  for (const Output& output : outputs()) {
    for (int i = 0; i < kContactInputs; ++i) {
      const double a = (free.*output.derivatives).by[i], b = (limited.*output.derivatives).by[i];
      const double x = *contact_inputs(contact.parameters, contact.conditions)[i];
      EXPECT_NEAR(a * x, b * x, 1e-5 * std::abs((free.*output.derivatives).value))
          << output.name << " by "
          << "input " << i << " of ContactInput";
    }
  }
}

TEST(ContactSensitivity, OfABatchsSolutionIsThatOfTheScalarKernel) {
  const ContactCase c;
  const FlankContactModel model = c.model();
  const FlankContactBatch batch(model);
  ContactArrays arrays({c.conditions}, c.solid, c.options);
  ASSERT_EQ(batch.solve(arrays.geometries(), 0, 1, arrays.conditions(), arrays.results()), 0U);
  const ContactSensitivityModel sensitivity(model);
  const ContactSensitivity own = sensitivity.at(c.conditions);
  const ContactSensitivity given = sensitivity.at(c.conditions, *arrays.results().ellipse_load,
                                                  *arrays.results().contact_temperature);
  for (const Output& output : outputs()) {
    for (int i = 0; i < kContactInputs; ++i) {
      const double a = (own.*output.derivatives).by[i];
      EXPECT_NEAR((given.*output.derivatives).by[i], a, 1e-8 * std::abs(a));
    }
  }
}

/// Elasticities of friction, contact temperature and film ratio by the vector code, through the
/// levels, against those of dual numbers one by one. Returns the largest difference; -1 where the
/// scalar kernel solves the contact.
double difference_side_by_side(const ContactCase& c, InstructionSet set) {
  const FlankContactModel model = c.model();
  const FlankContactBatch batch(model, set);
  ContactArrays arrays({c.conditions}, c.solid, c.options);
  bool by_scalar_kernel = false;
  FlankContactBatchResults results = arrays.results();
  results.by_scalar_kernel = &by_scalar_kernel;
  batch.solve(arrays.geometries(), 0, 1, arrays.conditions(), results);
  if (arrays.solution(0).status != ContactStatus::kOk || by_scalar_kernel) return -1;
  DifferentiatedContacts contacts;
  contacts.clear(1);
  contacts.add(arrays.geometries(), 0, c.conditions,
               {*results.ellipse_load, *results.contact_temperature, *results.mean_shear_stress,
                *results.limiting_stress_area_share});
  batch.differentiate(contacts);
  const ContactSensitivityModel sensitivity(model);
  const ContactSensitivity expected =
      sensitivity.at(c.conditions, *results.ellipse_load, *results.contact_temperature);
  EXPECT_EQ(expected.status, SensitivityStatus::kOk);
  Contact copy(c);
  const auto inputs = contact_inputs(copy.parameters, copy.conditions);
  const auto& levels = sensitivity.levels_by_parameter();
  double largest = 0;
  const auto compare = [&](const Columns& rows, int row_count,
                           const ContactDerivatives& one_by_one) {
    const auto compare_one = [&](int input, double found) {
      const bool is_limit =
          input == static_cast<int>(ContactInput::kLimitingShearStressAtZeroPressure);
      const double unit = is_limit ? std::max(1e6, *inputs[input]) : *inputs[input];
      const double scale = unit / one_by_one.value;
      const double exact = one_by_one.by[input] * scale;
      largest = std::max(largest, std::abs(found * scale - exact) / std::max(1.0, std::abs(exact)));
    };
    for (int p = 0; p < kContactParameters; ++p) {
      double sum = 0;
      for (int r = kConditionSlopes; r < row_count; ++r) {
        sum += rows[r][0] * levels[r - kConditionSlopes][p];
      }
      compare_one(p, sum);
    }
    int row = 0;
    for (const ContactInput input :
         {ContactInput::kLoad, ContactInput::kVelocity1X, ContactInput::kVelocity1Y,
          ContactInput::kVelocity2X, ContactInput::kVelocity2Y}) {
      compare_one(static_cast<int>(input), rows[row++][0]);
    }
  };
  compare(contacts.slopes().friction, kContactSlopes, expected.friction);
  compare(contacts.slopes().temperature, kContactSlopes, expected.contact_temperature);
  compare(contacts.slopes().film_ratio, kFilmSlopes, expected.film_ratio);
  return largest;
}

// The solution of the vector code is within 1e-10 of the scalar kernel's, and derivatives magnify
// that.
constexpr double kSideBySide = 1e-7;

TEST(ContactSensitivity, IsTheSameSideBySideOnRandomStates) {
  Draw draw(902);
  int compared = 0;
  double worst = 0;
  for (int n = 0; n < kRandomStates; ++n) {
    ContactCase c = random_contact_case(draw);
    if (n % 3 == 1) set_yasutomi(gear_oil_80w90(), c.lubricant);
    c.options.hertz_solution = n % 2 == 0 ? HertzSolution::kSimplified : HertzSolution::kExact;
    c.options.isothermal = n % 10 == 3;
    c.options.newtonian = n % 10 == 5;
    c.options.no_limiting_shear_stress = n % 10 == 7;
    c.options.no_boundary_friction = n % 20 == 9;
    c.options.inlet_shear_heating = n % 4 >= 2;
    c.options.closed_load_sharing = n % 7 < 4;
    if (n % 5 < 2) {  // a rim on the limit
      c.lubricant.limiting_shear_stress_at_zero_pressure =
          n % 5 == 0 ? 0 : draw.log_between(1, 1e6);
    }
    for (const InstructionSet set : supported_instruction_sets()) {
      const double difference = difference_side_by_side(c, set);
      EXPECT_LT(difference, kSideBySide)
          << "state " << n << ", " << FlankContactBatch::name(set) << ", " << draw.seed();
      compared += difference >= 0;
      worst = std::max(worst, difference);
    }
  }
  EXPECT_GT(compared, kRandomStates / 2);
  RecordProperty("worst", std::to_string(worst));
}

TEST(ContactSensitivity, IsTheSameSideBySideInTheGearUnderBothLaws) {
  for (const bool yasutomi : {false, true}) {
    int compared = 0;
    for (const double load : {5.0, 50.0, 500.0, 3000.0}) {
      for (const double sump : {283.15, 313.15, 363.15}) {
        ContactCase c;
        if (yasutomi) set_yasutomi(gear_oil_80w90(), c.lubricant);
        c.conditions.load = load;
        c.sump_temperature = sump;
        for (const InstructionSet set : supported_instruction_sets()) {
          const double difference = difference_side_by_side(c, set);
          compared += difference >= 0;
          EXPECT_LT(difference, kSideBySide) << yasutomi << ", " << load << " N, " << sump << " K";
        }
      }
    }
    EXPECT_GE(compared, 6) << yasutomi;
  }
}

TEST(ContactSensitivity, SaysWhereDerivativesDoNotExist) {
  const auto status = [](auto&& change) {
    Contact contact{ContactCase{}};
    change(contact);
    return contact.sensitivity().status;
  };
  EXPECT_EQ(status([](Contact&) {}), SensitivityStatus::kOk);
  EXPECT_EQ(status([](Contact& c) { c.conditions.load = 0; }), SensitivityStatus::kNoLoad);
  EXPECT_EQ(status([](Contact& c) { c.conditions.radius_x = -1; }), SensitivityStatus::kNotSolved);
  EXPECT_EQ(status([](Contact& c) { c.conditions = {100, 0.1, 0.1, 1, 1, -1, -1}; }),
            SensitivityStatus::kNoEntrainment);
  EXPECT_EQ(status([](Contact& c) { c.conditions = {100, 0.1, 0.1, 1, 1, 1, 1}; }),
            SensitivityStatus::kNoSliding);
  EXPECT_EQ(status([](Contact& c) { c.conditions = {100, 0.1, 0.1, 1, 1, 0, 0}; }),
            SensitivityStatus::kSurfaceAtRest);
}

TEST(ContactSensitivity, IsOneSidedWhereTheSimplifiedFitsJump) {
  Contact contact{ContactCase{}};
  contact.conditions.radius_y = contact.conditions.radius_x;
  EXPECT_TRUE(contact.sensitivity().one_sided);
  contact.options.hertz_solution = HertzSolution::kExact;
  EXPECT_FALSE(contact.sensitivity().one_sided);
}

TEST(ContactSensitivity, TakesARelaxationTimeOfZeroAsNewtonian) {
  Contact contact{ContactCase{}};
  contact.parameters.lubricant.relaxation_time = 0;
  const ContactSensitivity s = contact.sensitivity();
  EXPECT_EQ(s.friction.by_input(ContactInput::kRelaxationTime), 0);
  contact.parameters.lubricant.relaxation_time = 1;
  contact.options.newtonian = true;
  EXPECT_EQ(s.friction.by, contact.sensitivity().friction.by);
}

}  // namespace
}  // namespace tribodyn
