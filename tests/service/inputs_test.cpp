// Tests of a simulation's inputs: defaults, studies, hash and assumptions.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/version.h"
#include "google/api/resource.pb.h"
#include "proto/field_behavior.h"
#include "server/contract/canonical_text.h"
#include "server/resources/accept_resource.h"
#include "server/simulation/assumptions.h"
#include "server/simulation/cost_estimate.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/input_fields.h"
#include "server/simulation/input_hash.h"
#include "server/simulation/simulation_inputs.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"
#include "tests/service/contract_methods.h"
#include "tests/service/support.h"
#include "tribodyn/v1/labels.pb.h"

namespace tribodyn::server {
namespace {

SimulationInputs inputs_of(const v1::Simulation& simulation) {
  Violations violations;
  auto inputs = read_simulation(simulation, seed_lookup(), "simulation", violations);
  if (!inputs) throw std::runtime_error(violations.front().description);
  return *inputs;
}

/// Returns a changed copy of a shared resource.
template <class Resource, class Change>
std::shared_ptr<const Resource> changed(const std::shared_ptr<const Resource>& resource,
                                        const Change& change) {
  auto copy = std::make_shared<Resource>(*resource);
  change(*copy);
  return copy;
}

TEST(AcceptedNames, StandForWhatTheRequestLeavesOut) {
  v1::Simulation request;
  request.set_surface("surfaces/stated");
  set_accepted_names({.gear_set = "gearSets/default-then@2",
                      .surface = "surfaces/stated@1",
                      .vehicle = "vehicles/default-then@1"},
                     request);
  EXPECT_EQ(request.gear_set(), "gearSets/default-then");
  EXPECT_EQ(request.surface(), "surfaces/stated");
  EXPECT_EQ(request.vehicle(), "vehicles/default-then");
}

TEST(Inputs, DefaultsAreThoseOfTheContract) {
  const SimulationInputs inputs = inputs_of(point_simulation());
  EXPECT_EQ(inputs.gear_set->name(), "gearSets/reference-axle");
  EXPECT_EQ(inputs.surface->name(), "surfaces/run-in");
  EXPECT_EQ(inputs.vehicle->name(), "vehicles/passenger-car");
  const Scene physical = scene(inputs);
  EXPECT_EQ(physical.sump_temperature, 313.15);
  EXPECT_EQ(physical.inlet_temperature_rise, 20);
  const auto point = std::get<PointStudy>(study(inputs));
  EXPECT_EQ(point.condition.kind, OperatingCondition::Kind::kCruise);
  EXPECT_EQ(point.condition.vehicle_speed, 65 / 3.6);
  EXPECT_EQ(point.options.model, PointModel::kAutomatic);
  EXPECT_EQ(point.options.start, PointStart::kQuasiStatic);
  EXPECT_EQ(point.options.march_step_tolerance, 1e-7);
  EXPECT_EQ(point.options.march_settling_tolerance, 1e-6);
  EXPECT_EQ(point.options.maximum_mesh_cycles, 4000);
  EXPECT_EQ(point.options.recorded_mesh_cycles, 50);
  EXPECT_TRUE(point.options.history.columns.empty());
}

TEST(Inputs, EveryModelIsConverted) {
  v1::Simulation simulation = point_simulation();
  const auto arrived = [&](v1::PointModel model) {
    simulation.mutable_operating_point()->set_model(model);
    return std::get<PointStudy>(study(inputs_of(simulation))).options.model;
  };
  EXPECT_EQ(arrived(v1::POINT_MODEL_AUTOMATIC), PointModel::kAutomatic);
  EXPECT_EQ(arrived(v1::POINT_MODEL_FULL), PointModel::kFull);
  EXPECT_EQ(arrived(v1::POINT_MODEL_QUASI_STATIC), PointModel::kQuasiStatic);
}

TEST(Inputs, EveryOperatingConditionIsConverted) {
  v1::Simulation simulation = point_simulation();
  v1::OperatingPointStudy* asked = simulation.mutable_operating_point();
  asked->mutable_cruise()->set_ascent_angle_degrees(90 / std::numbers::pi);
  asked->set_model(v1::POINT_MODEL_QUASI_STATIC);
  asked->set_start(v1::POINT_START_LARGE_VIBRATION);
  asked->set_probe_coexisting_response(true);
  asked->mutable_history()->add_columns("mesh_force_newtons");
  asked->mutable_history()->set_mesh_cycles(3);
  auto point = std::get<PointStudy>(study(inputs_of(simulation)));
  EXPECT_DOUBLE_EQ(point.condition.ascent_angle, 0.5);
  EXPECT_EQ(point.options.model, PointModel::kQuasiStatic);
  EXPECT_EQ(point.options.start, PointStart::kLargeVibration);
  EXPECT_TRUE(point.options.probe_coexisting_response);
  EXPECT_EQ(point.options.history.columns, std::vector<HistoryColumn>{HistoryColumn::kMeshForce});
  EXPECT_EQ(point.options.history.mesh_cycles, 3);
  EXPECT_EQ(point.options.history.samples_per_mesh_cycle, 192);

  asked->mutable_drive_cycle_snapshot()->set_speed_kilometres_per_hour(36);
  asked->mutable_drive_cycle_snapshot()->set_acceleration_metres_per_second_squared(-2);
  point = std::get<PointStudy>(study(inputs_of(simulation)));
  EXPECT_EQ(point.condition.kind, OperatingCondition::Kind::kDriveCycleSnapshot);
  EXPECT_EQ(point.condition.vehicle_speed, 10);
  EXPECT_EQ(point.condition.acceleration, -2);

  asked->mutable_prescribed_torque()->set_pinion_torque_newton_metres(-30);
  asked->mutable_prescribed_torque()->set_pinion_speed_radians_per_second(250);
  point = std::get<PointStudy>(study(inputs_of(simulation)));
  EXPECT_EQ(point.condition.kind, OperatingCondition::Kind::kPrescribedTorque);
  EXPECT_EQ(point.condition.pinion_torque, -30);
  EXPECT_EQ(point.condition.pinion_speed, 250);
}

TEST(Inputs, ARangeOfSpeedsIncludesItsLast) {
  v1::Simulation simulation = curve_simulation();
  v1::InefficiencyCurveStudy* asked = simulation.mutable_inefficiency_curve();
  asked->set_first_speed_kilometres_per_hour(0.1);
  asked->set_last_speed_kilometres_per_hour(0.7);
  asked->set_speed_step_kilometres_per_hour(0.1);
  asked->set_direction(v1::SWEEP_DIRECTION_DOWN);
  asked->set_ascent_angle_degrees(180 / std::numbers::pi / 10);
  const auto curve = std::get<CurveStudy>(study(inputs_of(simulation)));
  ASSERT_EQ(curve.vehicle_speeds.size(), 7U);
  EXPECT_DOUBLE_EQ(curve.vehicle_speeds.front(), 0.1 / 3.6);
  EXPECT_DOUBLE_EQ(curve.vehicle_speeds.back(), 0.7 / 3.6);
  EXPECT_EQ(curve.options.direction, SweepDirection::kDown);
  EXPECT_DOUBLE_EQ(curve.ascent_angle, 0.1);
}

TEST(Hash, DependsOnValuesAndNotOnNames) {
  const SimulationInputs inputs = inputs_of(point_simulation());
  const std::string hash = input_hash(inputs);
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(hash, input_hash(inputs_of(point_simulation())));
  SimulationInputs same = inputs;
  same.lubricant = changed(inputs.lubricant, [](v1::Lubricant& fluid) {
    fluid.set_name("lubricants/other");
    fluid.set_display_name("other");
    fluid.set_description("other");
    for (auto& entry : *fluid.mutable_provenance()) entry.set_source("other");
  });
  same.effective.set_display_name("other");
  same.effective.set_lubricant("lubricants/other");
  EXPECT_EQ(hash, input_hash(same));
  SimulationInputs other = inputs;
  other.lubricant = changed(inputs.lubricant, [](v1::Lubricant& fluid) {
    fluid.set_thermal_conductivity_watts_per_metre_kelvin(std::nextafter(0.154, 1));
  });
  EXPECT_NE(hash, input_hash(other));
  other = inputs;
  other.gear_set = changed(inputs.gear_set, [](v1::GearSet& set) {
    set.mutable_flank_slots(1)->set_load_share(40, 0.5);
  });
  EXPECT_NE(hash, input_hash(other));
  for (const SimulationInputs& each : {inputs, same, other, inputs}) {
    EXPECT_EQ(input_hash(each), sha256(canonical_inputs(each))) << "whatever is kept of it";
  }
}

TEST(Hash, DependsOnTheRangeOfTheMeasurements) {
  const SimulationInputs paper = inputs_of(point_simulation());
  SimulationInputs stated = paper;
  stated.lubricant =
      changed(paper.lubricant, [](v1::Lubricant& fluid) { fluid.clear_provenance(); });
  EXPECT_NE(input_hash(paper), input_hash(stated)) << "the results' warnings differ";
}

TEST(FluidGrounds, OfThePapersFluidsAreThoseOfThePaper) {
  for (const char* name :
       {"lubricants/paper-fluid-1", "lubricants/paper-fluid-2", "lubricants/paper-fluid-3"}) {
    const FluidGrounds grounds = fluid_grounds(seed<v1::Lubricant>(name));
    ASSERT_TRUE(grounds.viscosity_measured) << name;
    EXPECT_DOUBLE_EQ(grounds.viscosity_measured->lowest, 283.15);
    EXPECT_DOUBLE_EQ(grounds.viscosity_measured->highest, 413.15);
    EXPECT_EQ(grounds.limiting_stress, FluidGrounds::LimitingStress::kMeasuredAtForty);
  }
}

TEST(FluidGrounds, OfAFittedFluidAreItsMeasurements) {
  v1::Lubricant stated;
  stated.set_name("lubricants/own");
  stated.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  v1::LubricantMeasurements* measured = stated.mutable_measurements();
  measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(103);
  measured->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(15.1);
  measured->set_density_15_celsius_kilograms_per_cubic_metre(868);
  const auto grounds_of = [](const v1::Lubricant& lubricant) {
    Violations violations;
    const auto accepted = accept(lubricant, static_cast<const v1::Lubricant*>(nullptr),
                                 seed_lookup(), "lubricant", violations);
    if (!accepted) throw std::runtime_error(violations.front().description);
    return fluid_grounds(*accepted);
  };
  FluidGrounds grounds = grounds_of(stated);
  ASSERT_TRUE(grounds.viscosity_measured);
  EXPECT_DOUBLE_EQ(grounds.viscosity_measured->lowest, 313.15);
  EXPECT_DOUBLE_EQ(grounds.viscosity_measured->highest, 373.15);
  EXPECT_EQ(grounds.limiting_stress, FluidGrounds::LimitingStress::kEstimated);
  v1::BrookfieldViscosity* cold = measured->add_brookfield_viscosities();
  cold->set_temperature_celsius(-40);
  cold->set_dynamic_viscosity_millipascal_seconds(98'000);
  grounds = grounds_of(stated);
  EXPECT_DOUBLE_EQ(grounds.viscosity_measured->lowest, 233.15);
  EXPECT_DOUBLE_EQ(grounds.viscosity_measured->highest, 373.15);
}

TEST(FluidGrounds, OfAFluidWithGivenLawsAreUnknown) {
  v1::Lubricant stated = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  stated.clear_provenance();
  EXPECT_EQ(fluid_grounds(stated), FluidGrounds());
}

/// Adds the names of fields without a role, in this message and in the messages of its input
/// fields.
void find_unclassified(const google::protobuf::Descriptor& message,
                       std::vector<std::string>& unclassified) {
  for (int i = 0; i < message.field_count(); ++i) {
    const auto& field = *message.field(i);
    const InputRole role = input_role(field);
    if (role == InputRole::kUnclassified) unclassified.push_back(field.full_name());
    if (role == InputRole::kInput && field.message_type() != nullptr) {
      find_unclassified(*field.message_type(), unclassified);
    }
  }
}

/// Returns true if a field of `message` names a resource of this type.
bool is_named_by(const google::protobuf::Descriptor& message,
                 const google::protobuf::Descriptor& type) {
  const std::string& name = type.options().GetExtension(google::api::resource).type();
  for (int i = 0; i < message.field_count(); ++i) {
    const auto& options = message.field(i)->options();
    if (options.GetExtension(google::api::resource_reference).type() == name) return true;
  }
  return false;
}

TEST(Hash, EveryFieldThatItReachesIsClassified) {
  std::vector<std::string> unclassified;
  find_unclassified(*v1::Simulation::descriptor(), unclassified);
  find_unclassified(*v1::CampaignRig::descriptor(), unclassified);
  int kinds = 0;
  for (const auto* type : resource_types()) {
    if (!is_named_by(*v1::Simulation::descriptor(), *type)) continue;
    find_unclassified(*type, unclassified);
    ++kinds;
  }
  EXPECT_GE(kinds, 4);
  for (const std::string& each : unclassified) {
    ADD_FAILURE() << each << ": say in input_fields.cpp whether a result depends on it";
  }
}

TEST(Hash, ANumberOfAResourceThatItDoesNotReachIsMarkedAsOptional) {
  for (const auto* type : resource_types()) {
    if (!is_named_by(*v1::Simulation::descriptor(), *type)) continue;
    for (int i = 0; i < type->field_count(); ++i) {
      const auto& field = *type->field(i);
      if (field.cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
      EXPECT_EQ(is_documentary(field), input_role(field) == InputRole::kLabel) << field.full_name();
    }
  }
}

TEST(Hash, AFieldIsClassifiedByItsMessageAndName) {
  for (const auto* message : {v1::HistorySchema::Column::descriptor(), v1::Label::descriptor()}) {
    for (int i = 0; i < message->field_count(); ++i) {
      EXPECT_EQ(input_role(*message->field(i)), InputRole::kUnclassified)
          << message->field(i)->full_name();
    }
  }
  EXPECT_EQ(input_role(*v1::Lubricant::descriptor()->FindFieldByName("name")), InputRole::kLabel);
  EXPECT_EQ(input_role(*v1::Simulation::descriptor()->FindFieldByName("name")), InputRole::kOutput);
}

TEST(Hash, ExplicitDefaultsHaveTheHashOfImplicitOnes) {
  v1::Simulation stated = point_simulation();
  stated.set_gear_set("gearSets/reference-axle");
  stated.set_sump_temperature_celsius(40);
  stated.set_inlet_temperature_rise_kelvin(20);
  stated.mutable_solver_options()->set_march_step_tolerance(1e-7);
  stated.mutable_operating_point()->set_model(v1::POINT_MODEL_AUTOMATIC);
  stated.mutable_operating_point()->mutable_cruise()->set_ascent_angle_degrees(-0.0);
  EXPECT_EQ(input_hash(inputs_of(stated)), input_hash(inputs_of(point_simulation())));
  stated.mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
  EXPECT_NE(input_hash(inputs_of(stated)), input_hash(inputs_of(point_simulation())));
  stated.mutable_operating_point()->set_model(v1::POINT_MODEL_FULL);
  EXPECT_NE(input_hash(inputs_of(stated)), input_hash(inputs_of(point_simulation())));
}

TEST(Hash, EqualSpeedsHaveEqualHashesHoweverTheyAreSet) {
  v1::Simulation listed = curve_simulation();
  listed.mutable_inefficiency_curve()->Clear();
  for (int speed = 140; speed >= 20; speed -= 10) {
    listed.mutable_inefficiency_curve()->add_speeds_kilometres_per_hour(speed);
  }
  EXPECT_EQ(input_hash(inputs_of(listed)), input_hash(inputs_of(curve_simulation())));
}

TEST(Hash, CanonicalTextNamesEveryValueWithAllItsDigits) {
  const std::string text = canonical_inputs(inputs_of(point_simulation()));
  EXPECT_TRUE(text.starts_with("model_version=" + std::string(kModelVersion) + "\n"));
  EXPECT_NE(text.find("\nsimulation.sump_temperature_celsius=0x1.4p+5\n"), std::string::npos);
  EXPECT_NE(text.find("\ngear_set.flank_slots[2].gear_velocity_y_metres[96]="), std::string::npos);
  EXPECT_NE(text.find("\nsimulation.operating_point.model=POINT_MODEL_AUTOMATIC\n"),
            std::string::npos);
  EXPECT_EQ(text.find("provenance"), std::string::npos);
  EXPECT_EQ(text.find("lubricants/"), std::string::npos);
}

TEST(CostEstimate, OrdersStudiesByTheirDuration) {
  std::vector<v1::Simulation> ascending(5, point_simulation());
  ascending[1].mutable_solver_options()->set_tolerance(1e-6);
  ascending[2].mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  for (const int i : {3, 4}) {
    ascending[i].mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
    auto* history = ascending[i].mutable_operating_point()->mutable_history();
    history->add_columns("mesh_force_newtons");
    history->set_mesh_cycles(i == 3 ? 20 : 100);
    history->set_samples_per_mesh_cycle(10'000);
  }
  double before = 0;
  for (const v1::Simulation& each : ascending) {
    const double seconds = estimate_cost(inputs_of(each)).processor_seconds();
    EXPECT_GT(seconds, 1.5 * before) << each.ShortDebugString();
    before = seconds;
  }
  v1::Simulation slow = point_simulation();
  slow.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(5);
  v1::Simulation quasi_static = slow;
  quasi_static.mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
  EXPECT_LT(estimate_cost(inputs_of(quasi_static)).processor_seconds(),
            estimate_cost(inputs_of(slow)).processor_seconds());
}

TEST(CostEstimate, IsEqualForSimilarStudies) {
  v1::Simulation other = point_simulation();
  other.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(65.01);
  EXPECT_EQ(estimate_cost(inputs_of(point_simulation())).processor_seconds(),
            estimate_cost(inputs_of(other)).processor_seconds());
}

TEST(CostEstimate, IsHigherForSlowPointsAndWideCurves) {
  const auto curve_seconds = [](const std::vector<double>& speeds) {
    v1::Simulation out = curve_simulation();
    out.mutable_inefficiency_curve()->Clear();
    *out.mutable_inefficiency_curve()->mutable_speeds_kilometres_per_hour() = {speeds.begin(),
                                                                               speeds.end()};
    return estimate_cost(inputs_of(out)).processor_seconds();
  };
  EXPECT_GT(curve_seconds({10}), 1.5 * curve_seconds({100}));
  EXPECT_GT(curve_seconds({50, 100}), 2 * curve_seconds({50})) << "what lies between is searched";
  EXPECT_GT(curve_seconds({25, 100}), 1.5 * curve_seconds({50, 100}));
}

TEST(Assumptions, AreSerialisedIdenticallyWithAndWithoutTheCache) {
  v1::Simulation other = point_simulation();
  other.set_lubricant("lubricants/paper-fluid-2");
  other.set_sump_temperature_celsius(90);
  for (const v1::Simulation& each : {point_simulation(), other, point_simulation()}) {
    const SimulationInputs inputs = inputs_of(each);
    v1::SimulationResult expected;
    for (const v1::Assumption& entry : assumptions(inputs)) *expected.add_assumptions() = entry;
    for (const auto& warning : input_warnings(inputs)) *expected.add_input_warnings() = warning;
    v1::SimulationResult serialised;
    ASSERT_TRUE(serialised.ParseFromString(serialised_assumptions(inputs)));
    EXPECT_GT(serialised.limits_size(), 0);
    serialised.clear_limits();
    EXPECT_EQ(serialised.SerializeAsString(), expected.SerializeAsString());
  }
}

std::map<std::string, v1::Assumption> assumptions_of(const v1::Simulation& simulation) {
  std::map<std::string, v1::Assumption> out;
  for (const v1::Assumption& entry : assumptions(inputs_of(simulation))) {
    EXPECT_TRUE(out.emplace(entry.resource() + " " + entry.field(), entry).second) << entry.field();
    EXPECT_NE(entry.provenance(), v1::PROVENANCE_UNSPECIFIED) << entry.field();
    EXPECT_FALSE(entry.source().empty()) << entry.field();
    EXPECT_FALSE(entry.value().empty()) << entry.field();
  }
  return out;
}

/// Returns the canonical text of a message with one number and one name.
std::string text_of(double value, const std::string& name) {
  v1::Simulation simulation;
  simulation.set_display_name(name);
  simulation.set_sump_temperature_celsius(value);
  std::string text;
  add_canonical_text(
      simulation, "s",
      [](const google::protobuf::FieldDescriptor& field) {
        return field.name() != "sump_temperature_celsius" && field.name() != "display_name";
      },
      text);
  return text;
}

TEST(Hash, NumbersAreWrittenLikePrintf) {
  std::mt19937_64 random(20261121);
  const auto expect = [](double value) {
    std::array<char, 128> expected{};
    std::snprintf(expected.data(), expected.size(),
                  "s.display_name=\ns.sump_temperature_celsius=%a\n", value + 0.0);
    EXPECT_EQ(text_of(value, ""), expected.data());
  };
  for (const double value :
       {0.0, -0.0, 1.0, -1.5, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1, 1e10}) {
    expect(value);
  }
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) expect(value);
  }
}

TEST(Hash, ALineFeedInANameIsEscaped) {
  EXPECT_EQ(text_of(1, "a\ns.x=\\n"),
            "s.display_name=a\\ns.x=\\\\n\ns.sump_temperature_celsius=0x1p+0\n");
}

TEST(Assumptions, NameEveryParameterWithValueUnitAndProvenance) {
  auto found = assumptions_of(point_simulation());
  const auto& alpha =
      found.at("lubricants/paper-fluid-1 pressure_viscosity_coefficient_per_pascal");
  EXPECT_EQ(alpha.value(), "1.609e-08 1/Pa");
  EXPECT_EQ(alpha.provenance(), v1::PROVENANCE_PUBLISHED);
  EXPECT_EQ(found.at("lubricants/paper-fluid-1 vogel_reference_temperature_kelvin").provenance(),
            v1::PROVENANCE_DERIVED);
  EXPECT_EQ(found.at("gearSets/reference-axle dynamics.pinion_inertia_kilogram_square_metres")
                .provenance(),
            v1::PROVENANCE_CALIBRATED);
  EXPECT_EQ(found.at("gearSets/reference-axle series").value(), "8 harmonics at 30 N m");
  EXPECT_EQ(found.at("gearSets/reference-axle flank_slots").value(), "3 slots of 97 samples");
  EXPECT_EQ(found.at("surfaces/run-in tribofilm_shear_strength_pascals").value(), "2000000 Pa");
  EXPECT_EQ(found.at("vehicles/passenger-car mass_kilograms").value(), "1300 kg");
  EXPECT_FALSE(found.contains("gearSets/reference-axle series_by_torque"))
      << "not used, so not assumed";
  EXPECT_EQ(found.size(), 6U + 14 + (7 + 2 + 10) + 5 + 7);
}

TEST(Assumptions, MarkDefaultsOfTheRequest) {
  auto found = assumptions_of(point_simulation());
  EXPECT_EQ(found.at("request sump_temperature_celsius").provenance(), v1::PROVENANCE_ASSUMED);
  EXPECT_EQ(found.at("request sump_temperature_celsius").value(), "40 C");
  EXPECT_EQ(found.at("request inlet_temperature_rise_kelvin").provenance(),
            v1::PROVENANCE_PUBLISHED);
  EXPECT_EQ(found.at("request gear_set").provenance(), v1::PROVENANCE_ASSUMED);
  EXPECT_EQ(found.at("request lubricant").provenance(), v1::PROVENANCE_USER);
  v1::Simulation stated = point_simulation();
  stated.set_sump_temperature_celsius(90);
  stated.set_gear_set("gearSets/reference-axle");
  stated.mutable_model_options()->set_load_dependent_mesh_data(true);
  found = assumptions_of(stated);
  EXPECT_EQ(found.at("request sump_temperature_celsius").provenance(), v1::PROVENANCE_USER);
  EXPECT_EQ(found.at("request gear_set").provenance(), v1::PROVENANCE_USER);
  EXPECT_EQ(found.at("gearSets/reference-axle series_by_torque").value(),
            "10, 20, 30, 45, 65, 100 N m");
}

}  // namespace
}  // namespace tribodyn::server
