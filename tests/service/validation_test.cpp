// Tests of rules between fields, limits on work, and names, which the table of constraints cannot
// express.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/contract/check_message.h"
#include "server/contract/resource_names.h"
#include "tests/service/checked_requests.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::IsEmpty;

TEST(RevisionName, EndsInANumberAsItIsPrinted) {
  EXPECT_EQ(parse_revision_name("lubricants/my-oil@12", "lubricants")->revision, 12);
  for (const char* number :
       {"", "0", "01", "-1", "+1", "1x", " 1", "2147483648", "99999999999999999999"}) {
    EXPECT_FALSE(parse_revision_name("lubricants/my-oil@" + std::string(number), "lubricants"))
        << number;
  }
}

TEST(Contact, ReasonableRequestsPass) {
  EXPECT_THAT(check(contact_request()), IsEmpty());
  v1::EvaluateContactRequest request = contact_request();
  *request.mutable_lubricant_parameters() = seed<v1::Lubricant>("lubricants/paper-fluid-2");
  EXPECT_THAT(check(request), IsEmpty());
}

TEST(Contact, AllViolationsAreReportedTogether) {
  const Violations found = check(v1::EvaluateContactRequest());
  for (const char* field : {"radius_x_metres", "radius_y_metres", "youngs_modulus_pascals",
                            "solid_thermal_conductivity_watts_per_metre_kelvin",
                            "solid_density_kilograms_per_cubic_metre",
                            "solid_specific_heat_capacity_joules_per_kilogram_kelvin",
                            "asperity_density_per_square_metre", "asperity_radius_metres",
                            "composite_rms_height_metres"}) {
    EXPECT_THAT(found, violation(field, "0 also means not set"));
  }
  EXPECT_THAT(found, violation("fluid", "lubricant or lubricant_parameters"));
}

TEST(Contact, AnUnknownFluidSuggestsTheNearest) {
  v1::EvaluateContactRequest request = contact_request();
  request.set_lubricant("lubricants/paper-fluid-22");
  EXPECT_THAT(check(request), violation("lubricant", "did you mean \"lubricants/paper-fluid-2\"?"));
  request.set_lubricant("lubricant 3\xc3\xa4\n");
  EXPECT_THAT(check(request), violation("lubricant", "of the form \"lubricants/{id}\""));
  request.set_lubricant(std::string(100'000, 'x'));
  EXPECT_THAT(check(request), violation("lubricant", "xxx..."));
}

TEST(Contact, TheFluidMustHaveAViscosityAndADensityAtTheInlet) {
  v1::EvaluateContactRequest request = contact_request();
  v1::Lubricant* fluid = request.mutable_lubricant_parameters();
  *fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  fluid->set_vogel_reference_temperature_kelvin(340);
  EXPECT_THAT(check(request),
              violation("lubricant_parameters", "below the inlet temperature, 333.15 K (eq 34)"));
  EXPECT_THAT(check(request), violation("lubricant_parameters", "temperature of alpha*"));
  fluid->set_vogel_reference_temperature_kelvin(159);
  fluid->set_density_slope_kilograms_per_cubic_metre_kelvin(-50);
  EXPECT_THAT(check(request), violation("lubricant_parameters", "positive (eq 26)"));
}

TEST(Simulation, ReasonableRequestsPass) {
  EXPECT_THAT(check(point_simulation()), IsEmpty());
  EXPECT_THAT(check(curve_simulation()), IsEmpty());
}

TEST(Simulation, AnUnknownModelIsRefusedWithTheModelsThatExist) {
  v1::Simulation simulation = point_simulation();
  simulation.mutable_operating_point()->set_model(static_cast<v1::PointModel>(4));
  EXPECT_THAT(check(simulation),
              violation("simulation.operating_point.model",
                        "model = 4; allowed: POINT_MODEL_UNSPECIFIED, POINT_MODEL_FULL, "));
}

TEST(Simulation, MarchTolerancesAreRefusedWhereNothingMarches) {
  const std::string path = "simulation.solver_options.";
  v1::Simulation simulation = point_simulation();
  simulation.mutable_solver_options()->set_march_step_tolerance(1e-9);
  simulation.mutable_solver_options()->set_march_settling_tolerance(1e-9);
  EXPECT_THAT(check(simulation), IsEmpty());  // AUTOMATIC may march
  simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  EXPECT_THAT(check(simulation), IsEmpty());
  simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_SHOOTING);
  const Violations found = check(simulation);
  EXPECT_THAT(found,
              violation(path + "march_step_tolerance",
                        "march_step_tolerance = 1e-09 has no effect: method = SHOOTING never "
                        "marches; leave it unset and set tolerance"));
  EXPECT_THAT(found, violation(path + "march_settling_tolerance", "or set method = MARCH"));
  simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_AUTOMATIC);
  simulation.mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
  EXPECT_THAT(check(simulation), violation(path + "march_step_tolerance", "model = QUASI_STATIC"));
  // Stored requests state the defaults.
  simulation.mutable_solver_options()->set_march_step_tolerance(1e-7);
  simulation.mutable_solver_options()->set_march_settling_tolerance(1e-6);
  EXPECT_THAT(check(simulation), IsEmpty());
}

TEST(Simulation, AllViolationsAreReportedTogether) {
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/paper-fluid-x");
  simulation.set_gear_set("gearSets/reference-axl");
  simulation.set_surface("runin");
  simulation.set_vehicle("vehicles/passenger_car");
  simulation.set_sump_temperature_celsius(-300);
  simulation.mutable_solver_options()->set_march_step_tolerance(1);
  v1::OperatingPointStudy* point = simulation.mutable_operating_point();
  point->set_model(static_cast<v1::PointModel>(17));
  point->mutable_history()->add_columns("mesh_force");
  const Violations found = check(simulation);
  EXPECT_THAT(found, violation("simulation.lubricant", "lubricants/paper-fluid-1"));
  EXPECT_THAT(found, violation("simulation.gear_set", "did you mean"));
  EXPECT_THAT(found, violation("simulation.surface", "surfaces/run-in"));
  EXPECT_THAT(found, violation("simulation.vehicle", "vehicles/passenger-car"));
  EXPECT_THAT(found, violation("simulation.sump_temperature_celsius", "-300 C"));
  EXPECT_THAT(found, violation("simulation.solver_options.march_step_tolerance", "= 1"));
  EXPECT_THAT(found,
              violation("simulation.operating_point.model",
                        "POINT_MODEL_FULL, POINT_MODEL_QUASI_STATIC, POINT_MODEL_AUTOMATIC"));
  EXPECT_THAT(found, violation("simulation.operating_point.condition", "cruise"));
  EXPECT_THAT(found, violation("simulation.operating_point.history.columns[0]",
                               "did you mean \"mesh_force_newtons\"?"));
  EXPECT_EQ(found.size(), 9U);
}

TEST(Simulation, AStudyIsNeeded) {
  v1::Simulation simulation = point_simulation();
  simulation.clear_study();
  EXPECT_THAT(check(simulation), violation("simulation.study", "operating_point"));
}

TEST(Simulation, TheLubricantMustBeLiquidAtTheSumpTemperature) {
  v1::Simulation simulation = point_simulation();
  simulation.set_sump_temperature_celsius(-70);
  simulation.set_inlet_temperature_rise_kelvin(0);
  EXPECT_THAT(check(simulation), IsEmpty()) << "203 K is above the 159 K of fluid 1";
}

TEST(Simulation, MeshDataByTorqueMustExistIfRequested) {
  v1::Simulation simulation = point_simulation();
  simulation.mutable_model_options()->set_load_dependent_mesh_data(true);
  EXPECT_THAT(check(simulation), IsEmpty());
  simulation.set_gear_set("gearSets/reference-axle-loaded-error");
  EXPECT_THAT(check(simulation),
              violation("simulation.model_options.load_dependent_mesh_data",
                        "gearSets/reference-axle-loaded-error holds no data by torque"));
}

TEST(AsPublished, Eq46IsRefusedWhereNoProfileBecomesASurface) {
  const std::string why = "acts where measured profiles become a surface";
  const std::string field = "model_options.as_published.eq46_square_root_of_sum";
  v1::EvaluateContactRequest contact = contact_request();
  contact.mutable_model_options()->mutable_as_published()->set_eq46_square_root_of_sum(true);
  EXPECT_THAT(check(contact), violation(field, why));
  v1::Simulation history = point_simulation();
  history.mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
  for (v1::Simulation each : {point_simulation(), curve_simulation(), history}) {
    each.mutable_model_options()->mutable_as_published()->set_eq46_square_root_of_sum(true);
    EXPECT_THAT(check(each), violation("simulation." + field, why));
  }
}

TEST(Curve, SpeedsMustBeSetInExactlyOneWay) {
  const std::string speeds = "simulation.inefficiency_curve.speeds_kilometres_per_hour";
  v1::Simulation simulation = curve_simulation();
  simulation.mutable_inefficiency_curve()->add_speeds_kilometres_per_hour(30);
  EXPECT_THAT(check(simulation), violation(speeds, "one of the two"));
  simulation.mutable_inefficiency_curve()->Clear();
  EXPECT_THAT(check(simulation), violation(speeds, "not set"));
  simulation.mutable_inefficiency_curve()->set_first_speed_kilometres_per_hour(10);
  EXPECT_THAT(
      check(simulation),
      violation("simulation.inefficiency_curve.last_speed_kilometres_per_hour", "need each other"));
  EXPECT_THAT(
      check(simulation),
      violation("simulation.inefficiency_curve.speed_step_kilometres_per_hour", "need each other"));
}

TEST(Curve, LastIsNotBelowFirst) {
  v1::Simulation simulation = curve_simulation();
  simulation.mutable_inefficiency_curve()->set_last_speed_kilometres_per_hour(10);
  EXPECT_THAT(check(simulation),
              violation("simulation.inefficiency_curve.last_speed_kilometres_per_hour",
                        "at least the first speed, 20 km/h"));
}

TEST(Curve, SpeedsDiffer) {
  v1::Simulation simulation = curve_simulation();
  auto* curve = simulation.mutable_inefficiency_curve();
  curve->Clear();
  for (const double speed : {50.0, 20.0, 50.0}) curve->add_speeds_kilometres_per_hour(speed);
  EXPECT_THAT(check(simulation),
              violation("simulation.inefficiency_curve.speeds_kilometres_per_hour",
                        "50 km/h is named twice"));
}

TEST(Curve, PointsAndWorkAreLimited) {
  v1::Simulation simulation = curve_simulation();
  auto* curve = simulation.mutable_inefficiency_curve();
  curve->set_speed_step_kilometres_per_hour(0.1);
  EXPECT_THAT(check(simulation),
              violation("simulation.inefficiency_curve.speed_step_kilometres_per_hour",
                        "1201 points; allowed: at most 1000"));
  curve->set_speed_step_kilometres_per_hour(0.125);
  EXPECT_THAT(check(simulation), IsEmpty());
  simulation.mutable_solver_options()->set_maximum_mesh_cycles(100000);
  EXPECT_THAT(check(simulation), violation("simulation.inefficiency_curve", "work limit"));
  simulation.clear_solver_options();
  curve->set_sensitivities(true);
  EXPECT_THAT(check(simulation),
              violation("simulation.inefficiency_curve.speed_step_kilometres_per_hour",
                        "961 points with sensitivities; allowed: at most 300"));
  curve->set_speed_step_kilometres_per_hour(0.5);
  EXPECT_THAT(check(simulation), IsEmpty());
}

TEST(Curve, ManyBadSpeedsAreCountedNotListed) {
  v1::Simulation simulation = curve_simulation();
  auto* curve = simulation.mutable_inefficiency_curve();
  curve->Clear();
  for (int i = 0; i < 200'000; ++i) curve->add_speeds_kilometres_per_hour(-1 - i);
  const Violations found = check(simulation);
  EXPECT_LT(found.size(), 20U);
  EXPECT_THAT(found,
              violation("simulation.inefficiency_curve.speeds_kilometres_per_hour", "990 more"));
  EXPECT_THAT(found, violation("simulation.inefficiency_curve.speeds_kilometres_per_hour",
                               "200000 points; allowed: at most 1000"));
}

TEST(History, ColumnsAreKnownDistinctAndNotTooMany) {
  v1::Simulation simulation = point_simulation();
  auto* history = simulation.mutable_operating_point()->mutable_history();
  EXPECT_THAT(check(simulation),
              violation("simulation.operating_point.history.columns", "name at least one"));
  history->add_columns("flank_load_newtons");
  history->add_columns("flank_load_newtons");
  EXPECT_THAT(check(simulation),
              violation("simulation.operating_point.history.columns[1]", "named twice"));
  history->mutable_columns()->DeleteSubrange(1, 1);
  EXPECT_THAT(check(simulation), IsEmpty());
  history->set_mesh_cycles(1000);
  history->set_samples_per_mesh_cycle(6667);
  EXPECT_THAT(check(simulation), violation("simulation.operating_point.history",
                                           "20001000 values; allowed: at most 20000000"))
      << "a flank column counts three times";
  for (int i = 0; i < 10'000; ++i) history->add_columns("x");
  EXPECT_LT(check(simulation).size(), 120U);
}

TEST(Simulation, OutputOnlyFieldsAreIgnored) {
  v1::Simulation simulation = point_simulation();
  simulation.set_name("simulations/1");
  simulation.set_state(v1::Simulation::SUCCEEDED);
  simulation.set_progress_fraction(kNaN);
  simulation.mutable_result()->add_points()->set_speed_kilometres_per_hour(kNaN);
  Violations violations;
  const auto inputs = read_simulation(simulation, seed_lookup(), "simulation", violations);
  ASSERT_TRUE(inputs);
  EXPECT_EQ(inputs->requested.SerializeAsString(), point_simulation().SerializeAsString());
}

TEST(Simulation, LongTextsAreRefused) {
  v1::Simulation simulation = point_simulation();
  simulation.set_display_name(std::string(201, 'x'));
  EXPECT_THAT(check(simulation), violation("simulation.display_name", "201 bytes"));
}

TEST(NotFinite, IsFoundAtEveryDepth) {
  v1::SimulationResult result;
  auto* point = result.add_points()->mutable_result();
  EXPECT_EQ(first_not_finite(result), "");
  point->mutable_shear_rate_per_second()->set_maximum(kInfinity);
  EXPECT_EQ(first_not_finite(result), "") << "no film under sliding: documented";
  point->mutable_shear_rate_per_second()->set_maximum(kNaN);
  EXPECT_EQ(first_not_finite(result), "points.result.shear_rate_per_second.maximum");
  point->clear_shear_rate_per_second();
  point->mutable_film_ratio()->set_mean(kInfinity);
  EXPECT_EQ(first_not_finite(result), "points.result.film_ratio.mean");
}

}  // namespace
}  // namespace tribodyn::server
