// The improved Yasutomi law of a lubricant over the contract: stored, computed with, refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/celsius.h"
#include "core/lubricant/comparison.h"
#include "server/mapping/to_core.h"
#include "server/resources/provenance.h"
#include "server/simulation/contact_inputs.h"
#include "server/simulation/input_errors.h"
#include "server/simulation/input_hash.h"
#include "server/simulation/point_evaluation.h"
#include "server/simulation/point_explanation.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"
#include "tests/service/uncertain_fluids.h"
#include "tests/support/improved_yasutomi.h"

namespace tribodyn::server {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr char kAlphaTemperature[] = "pressure_viscosity_temperature_kelvin";

void set_law(const PrintedYasutomi& law, v1::ImprovedYasutomi& out) {
  out.set_glass_viscosity_pascal_seconds(law.of_pressure[kGlassViscosity]);
  out.set_glass_temperature_rise_kelvin(law.of_pressure[kGlassTemperatureRise]);
  out.set_glass_pressure_factor_per_pascal(law.of_pressure[kGlassPressureFactor]);
  out.set_expansivity_pressure_factor_per_pascal(law.of_pressure[kExpansivityPressureFactor]);
  out.set_expansivity_exponent(law.of_pressure[kExpansivityExponent]);
}

/// The gear oil of tests/support/improved_yasutomi.h with the ambient parameters that the comment
/// of ImprovedYasutomi derives from the printed ones, and all others of fluid 1.
v1::Lubricant gear_oil_with_law() {
  const PrintedYasutomi law = gear_oil_80w90();
  auto out = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  out.clear_name();
  out.clear_provenance();
  out.clear_measurements();
  out.clear_pressure_viscosity_coefficient_per_pascal();
  out.clear_pressure_viscosity_temperature_kelvin();
  out.set_vogel_reference_temperature_kelvin(law.glass_temperature - law.c2);
  out.set_vogel_temperature_coefficient_kelvin(std::numbers::ln10 * law.c1 * law.c2);
  out.set_vogel_viscosity_prefactor_pascal_seconds(law.of_pressure[kGlassViscosity] *
                                                   std::pow(10, -law.c1));
  set_law(law, *out.mutable_improved_yasutomi());
  return out;
}

class PressureLawTest : public testing::Test {
 protected:
  Outcome<v1::Lubricant> create(const v1::Lubricant& lubricant, const std::string& id = "oil") {
    v1::CreateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    request.set_lubricant_id(id);
    return create_lubricant(app_, request);
  }
  v1::Lubricant created(const v1::Lubricant& lubricant, const std::string& id = "oil") {
    const auto made = create(lubricant, id);
    if (!made.ok()) throw std::runtime_error(complaints(made.error()));
    return made.message();
  }
  std::string refused(const v1::Lubricant& lubricant) {
    const auto made = create(lubricant, "refused");
    EXPECT_FALSE(made.ok());
    return made.ok() ? "" : complaints(made.error());
  }
  Outcome<v1::Lubricant> update(const v1::Lubricant& lubricant,
                                const std::vector<std::string>& mask) {
    v1::UpdateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    for (const std::string& path : mask) request.mutable_update_mask()->add_paths(path);
    return update_lubricant(app_, request);
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(PressureLawTest, GivesTheCoreTheLawAndALubricantItsCoefficient) {
  const v1::Lubricant stored = created(gear_oil_with_law());
  const Lubricant oil = to_core(stored);
  EXPECT_EQ(oil.pressure_viscosity_law, PressureViscosityLaw::kImprovedYasutomi);
  EXPECT_EQ(oil.law_parameters, gear_oil_80w90().of_pressure);
  const auto at_forty = lubricant_figures(oil, {}).at.front();
  EXPECT_NEAR(1e3 * at_forty.viscosity, 123.96, 0.005);
  EXPECT_EQ(stored.pressure_viscosity_coefficient_per_pascal(),
            at_forty.pressure_viscosity_coefficient);
  EXPECT_EQ(stored.pressure_viscosity_temperature_kelvin(), kFortyCelsius);
  const v1::ParameterProvenance* entry = find_provenance(stored.provenance(), kAlpha);
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->provenance(), v1::PROVENANCE_DERIVED);
  EXPECT_TRUE(entry->computed());
  for (const auto& warning : stored.characterisation().warnings()) {
    EXPECT_NE(warning.field(), kAlpha) << warning.sentence();
  }
}

TEST_F(PressureLawTest, ALubricantWithoutTheLawIsOneOfRoelands) {
  const Lubricant oil = to_core(seed<v1::Lubricant>("lubricants/paper-fluid-1"));
  EXPECT_EQ(oil.pressure_viscosity_law, PressureViscosityLaw::kRoelands);
  EXPECT_EQ(oil.law_parameters, (std::array<double, kMostLawParameters>{}));
}

TEST_F(PressureLawTest, RefusesAStatedCoefficientAndAnIncompleteLawInOneAnswer) {
  v1::Lubricant oil = gear_oil_with_law();
  oil.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  oil.set_pressure_viscosity_temperature_kelvin(313.15);
  oil.mutable_improved_yasutomi()->clear_expansivity_exponent();
  oil.mutable_improved_yasutomi()->clear_glass_viscosity_pascal_seconds();
  EXPECT_THAT(refused(oil),
              AllOf(HasSubstr("lubricant.pressure_viscosity_coefficient_per_pascal: "
                              "pressure_viscosity_coefficient_per_pascal is stated beside "
                              "improved_yasutomi, which determines it; allowed: unset"),
                    HasSubstr("lubricant.pressure_viscosity_temperature_kelvin: "),
                    HasSubstr("lubricant.improved_yasutomi.expansivity_exponent: "),
                    HasSubstr("lubricant.improved_yasutomi.glass_viscosity_pascal_seconds: ")));
}

TEST_F(PressureLawTest, RefusesNumbersOutsideTheirRangesAndAFluidThatIsNearlyGlass) {
  v1::Lubricant oil = gear_oil_with_law();
  oil.mutable_improved_yasutomi()->set_glass_pressure_factor_per_pascal(0.455);
  oil.mutable_improved_yasutomi()->set_expansivity_exponent(0.4193);
  EXPECT_THAT(refused(oil), AllOf(HasSubstr("0.455 looks like 1/GPa: did you mean 4.55e-10 1/Pa?"),
                                  HasSubstr("lubricant.improved_yasutomi.expansivity_exponent: ")));
  oil = gear_oil_with_law();
  oil.set_vogel_reference_temperature_kelvin(280);
  EXPECT_THAT(refused(oil), HasSubstr("too near its glass transition"));
}

TEST_F(PressureLawTest, ReplacesAnEstimatedCoefficientAndGivesItBack) {
  v1::Lubricant sheet;
  auto& measured = *sheet.mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(140);
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(14.5);
  sheet.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_GROUP_I);
  const v1::Lubricant estimated = created(sheet);
  v1::Lubricant change;
  change.set_name("lubricants/oil");
  set_law(gear_oil_80w90(), *change.mutable_improved_yasutomi());
  const auto with_law = update(change, {"improved_yasutomi"});
  ASSERT_TRUE(with_law.ok()) << complaints(with_law.error());
  EXPECT_EQ(find_provenance(with_law.message().provenance(), kAlpha)->provenance(),
            v1::PROVENANCE_DERIVED);
  EXPECT_NE(with_law.message().pressure_viscosity_coefficient_per_pascal(),
            estimated.pressure_viscosity_coefficient_per_pascal());
  change.mutable_improved_yasutomi()->set_glass_temperature_rise_kelvin(250);
  const auto changed = update(change, {"improved_yasutomi.glass_temperature_rise_kelvin"});
  ASSERT_TRUE(changed.ok()) << complaints(changed.error());
  EXPECT_GT(changed.message().pressure_viscosity_coefficient_per_pascal(),
            with_law.message().pressure_viscosity_coefficient_per_pascal());
  change.clear_improved_yasutomi();
  const auto again = update(change, {"improved_yasutomi"});
  ASSERT_TRUE(again.ok()) << complaints(again.error());
  EXPECT_EQ(again.message().pressure_viscosity_coefficient_per_pascal(),
            estimated.pressure_viscosity_coefficient_per_pascal());
  EXPECT_FALSE(again.message().has_improved_yasutomi());
}

TEST_F(PressureLawTest, AProvenanceOfAMessageOfALubricantIsAViolation) {
  v1::Lubricant sheet;
  sheet.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      140);
  sheet.mutable_measurements()->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      14.5);
  created(sheet);
  for (const char* field : {"measurements", "improved_yasutomi", "create_time", "labels"}) {
    v1::Lubricant change;
    change.set_name("lubricants/oil");
    auto& entry = *change.add_provenance();
    entry.set_field(field);
    entry.set_standard_uncertainty(1);
    const auto answer = update(change, {"provenance"});
    ASSERT_FALSE(answer.ok()) << field;
    EXPECT_EQ(answer.error().code(), 3 /* INVALID_ARGUMENT */) << field;
    EXPECT_THAT(complaints(answer.error()), HasSubstr(field));
  }
}

v1::EvaluateContactRequest contact_of(const v1::Lubricant& lubricant) {
  v1::EvaluateContactRequest out;
  *out.mutable_lubricant_parameters() = lubricant;
  out.set_load_newtons(1000);
  out.set_radius_x_metres(0.03);
  out.set_radius_y_metres(0.04);
  out.set_pinion_velocity_x_metres_per_second(5);
  out.set_gear_velocity_x_metres_per_second(4);
  out.set_sump_temperature_celsius(60);
  out.set_inlet_temperature_rise_kelvin(10);
  out.set_youngs_modulus_pascals(210e9);
  out.set_poissons_ratio(0.3);
  out.set_solid_thermal_conductivity_watts_per_metre_kelvin(46);
  out.set_solid_density_kilograms_per_cubic_metre(7850);
  out.set_solid_specific_heat_capacity_joules_per_kilogram_kelvin(470);
  out.set_asperity_density_per_square_metre(2e9);
  out.set_asperity_radius_metres(40e-6);
  out.set_composite_rms_height_metres(0.4e-6);
  out.set_tribofilm_shear_strength_pascals(2e6);
  out.set_asperity_friction_coefficient(0.1);
  return out;
}

Violations violations_of(const v1::EvaluateContactRequest& request) {
  Violations out;
  read_contact(request, seed_lookup(), out);
  return out;
}

TEST(PressureLaw, AContactOfStatedParametersIsThatOfTheCore) {
  const v1::EvaluateContactRequest request = contact_of(gear_oil_with_law());
  Violations violations;
  const auto oil = read_contact(request, seed_lookup(), violations);
  ASSERT_TRUE(oil) << violations.front().field << ": " << violations.front().description;
  Lubricant expected = to_core(seed<v1::Lubricant>("lubricants/paper-fluid-1"));
  expected.pressure_viscosity_coefficient = expected.pressure_viscosity_temperature = 0;
  set_yasutomi(gear_oil_80w90(), expected);
  const ContactSolution solution =
      FlankContactModel(expected, solid(request), roughness(request), boundary_friction(request),
                        60 + kZeroCelsius, 10, recommended_model())
          .solve(contact_conditions(request));
  const v1::EvaluateContactResponse answer = evaluate_contact(request, *oil);
  EXPECT_EQ(answer.friction_newtons(), solution.friction);
  EXPECT_EQ(answer.central_film_thickness_metres(), solution.central_film_thickness);
}

TEST(PressureLaw, RefusesOptionsThatConcernRoelandssLaw) {
  v1::EvaluateContactRequest request = contact_of(gear_oil_with_law());
  request.mutable_model_options()->mutable_as_published()->set_eq31_32_logarithm(true);
  Violations violations = violations_of(request);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations.front().field, "model_options.as_published.eq31_32_logarithm");
  request.mutable_model_options()->clear_as_published();
  request.mutable_model_options()->set_pressure_viscosity_index(
      v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
  violations = violations_of(request);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations.front().field, "model_options.pressure_viscosity_index");
  request = contact_of(gear_oil_with_law());
  request.mutable_lubricant_parameters()->set_pressure_viscosity_coefficient_per_pascal(2e-8);
  violations = violations_of(request);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations.front().field,
            "lubricant_parameters.pressure_viscosity_coefficient_per_pascal");
}

v1::Simulation point_of(const std::string& lubricant) {
  v1::Simulation out;
  out.set_lubricant(lubricant);
  out.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(60);
  return out;
}

TEST_F(PressureLawTest, EveryParameterOfTheLawIsAnInputOfAResult) {
  const v1::Lubricant oil = created(gear_oil_with_law());
  const auto hash_of = [](const v1::Lubricant& lubricant) {
    Fluids fluids;
    fluids.add("lubricants/oil", lubricant);
    Violations violations;
    return input_hash(
        *read_simulation(point_of("lubricants/oil"), fluids.lookup(), "", violations));
  };
  const auto* type = v1::ImprovedYasutomi::descriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    v1::Lubricant other = oil;
    auto& law = *other.mutable_improved_yasutomi();
    const double value = law.GetReflection()->GetDouble(law, type->field(i));
    law.GetReflection()->SetDouble(&law, type->field(i), 1.001 * value);
    EXPECT_NE(hash_of(oil), hash_of(other)) << type->field(i)->name();
  }
}

TEST_F(PressureLawTest, AnUncertainParameterOfTheLawIsAnErrorOfItsOwn) {
  v1::Lubricant oil = gear_oil_with_law();
  auto& entry = *oil.add_provenance();
  entry.set_field("improved_yasutomi.glass_temperature_rise_kelvin");
  entry.set_standard_uncertainty(5);
  const InputErrors errors = lubricant_errors(created(oil));
  const std::string name = "lubricant.improved_yasutomi.glass_temperature_rise_kelvin";
  ASSERT_TRUE(std::any_of(errors.errors.begin(), errors.errors.end(),
                          [&](const InputError& each) { return each.input == name; }));
  for (const InputError& each : errors.errors) {
    if (each.input != name) continue;
    UncertainInputs inputs;
    inputs.lubricant = oil;
    const double deviation = 1;
    each.apply({&deviation, 1}, inputs);
    EXPECT_NEAR(inputs.lubricant.improved_yasutomi().glass_temperature_rise_kelvin(), 215.6, 0.2);
  }
  EXPECT_THAT(errors.without_uncertainty,
              AllOf(testing::Contains("lubricant.improved_yasutomi.expansivity_exponent"),
                    Not(testing::Contains(std::string("lubricant.") + kAlpha)),
                    Not(testing::Contains(std::string("lubricant.") + kAlphaTemperature))));
}

v1::EvaluatePointsRequest points_of_law(
    const std::vector<std::pair<std::string, double>>& columns) {
  v1::EvaluatePointsRequest out;
  out.set_lubricant("lubricants/oil");
  out.set_tolerance(1e-6);
  out.add_conditions()->set_speed_kilometres_per_hour(60);
  for (const auto& [path, value] : columns) {
    auto& column = *out.add_candidate_columns();
    column.set_path(path);
    column.add_values(value);
  }
  return out;
}

TEST_F(PressureLawTest, CandidatesDifferInParametersOfTheLawAsTheElasticitiesSay) {
  Fluids fluids;
  const v1::Lubricant oil = created(gear_oil_with_law());
  fluids.add("lubricants/oil", oil);
  const auto evaluate = [&](const v1::EvaluatePointsRequest& request) {
    Violations violations;
    const auto points = read_points(request, fluids.lookup(), violations);
    if (!points) throw std::runtime_error(violations.front().description);
    PreparedGearSets gear_sets;
    return evaluate_points(*points, gear_sets, [] { return false; });
  };
  const auto* type = v1::ImprovedYasutomi::descriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    const std::string path = "lubricant.improved_yasutomi." + type->field(i)->name();
    const auto& law = oil.improved_yasutomi();
    const double value = law.GetReflection()->GetDouble(law, type->field(i));
    const double step = i == 0 ? 0.1 : 0.01;  // the glass viscosity has hardly any effect
    const double above =
        evaluate(points_of_law({{path, (1 + step) * value}})).inefficiency_energy_mean_percent(0);
    const double below =
        evaluate(points_of_law({{path, (1 - step) * value}})).inefficiency_energy_mean_percent(0);
    v1::EvaluatePointsRequest request = points_of_law({});
    request.add_elasticity_parameters(path);
    const double elasticity = evaluate(request).elasticities(0).values(0);
    EXPECT_NE(elasticity, 0) << path;
    EXPECT_NEAR(elasticity, std::log(above / below) / std::log((1 + step) / (1 - step)), 2e-3)
        << path;
  }
}

TEST_F(PressureLawTest, RefusesColumnsWithoutEffectUnderTheLawOfTheBase) {
  Fluids fluids;
  fluids.add("lubricants/oil", created(gear_oil_with_law()));
  const auto refused_column = [&](const std::string& base, const std::string& path, double value) {
    v1::EvaluatePointsRequest request = points_of_law({{path, value}});
    request.set_lubricant(base);
    Violations violations;
    EXPECT_FALSE(read_points(request, fluids.lookup(), violations));
    return violations.empty() ? "" : violations.front().field + violations.front().description;
  };
  EXPECT_THAT(
      refused_column("lubricants/oil", "lubricant.pressure_viscosity_coefficient_per_pascal", 2e-8),
      AllOf(HasSubstr("candidate_columns[0].path"),
            HasSubstr("has no effect: lubricants/oil follows improved_yasutomi")));
  EXPECT_THAT(refused_column("lubricants/paper-fluid-1",
                             "lubricant.improved_yasutomi.expansivity_exponent", -0.4),
              HasSubstr("lubricants/paper-fluid-1 does not follow improved_yasutomi"));
}

TEST_F(PressureLawTest, ADifferenceOfTheLawAloneIsOneOfThePressureResponse) {
  const v1::Lubricant with_law = created(gear_oil_with_law(), "law");
  v1::Lubricant roelands = with_law;
  roelands.clear_improved_yasutomi();
  Fluids fluids;
  fluids.add("lubricants/law", with_law);
  fluids.add("lubricants/roelands", roelands);
  v1::ExplainPointsRequest request;
  request.set_lubricant("lubricants/law");
  request.set_other_lubricant("lubricants/roelands");
  request.add_conditions()->set_speed_kilometres_per_hour(60);
  Violations violations;
  const auto explanation = read_explanation(request, fluids.lookup(), violations);
  ASSERT_TRUE(explanation);
  PreparedGearSets gear_sets;
  const auto answer = explain_points(*explanation, gear_sets, [] { return false; });
  ASSERT_EQ(answer.points_size(), 1);
  const v1::DifferenceExplanation& point = answer.points(0);
  const double difference = point.inefficiency_difference_percent().value();
  EXPECT_GT(std::abs(difference), 1e-4);
  for (const v1::DifferenceCause& cause : point.causes()) {
    const double share = cause.inefficiency_percent().shapley_value().value();
    if (cause.group() == v1::PARAMETER_GROUP_PRESSURE_RESPONSE) {
      EXPECT_NEAR(share, difference, 1e-12);
    } else {
      EXPECT_EQ(share, 0);
    }
  }
}

}  // namespace
}  // namespace tribodyn::server
