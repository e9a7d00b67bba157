// For every row of the table of constraints, and for every rule between fields, a request violates
// it.
#include "server/contract/constraints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <set>

#include "server/contract/check_message.h"
#include "server/contract/output_only.h"
#include "server/resources/gear_set_checks.h"
#include "server/resources/imports/import_surface.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/cycle_evaluation.h"
#include "server/simulation/point_comparison.h"
#include "server/simulation/point_evaluation.h"
#include "server/simulation/point_explanation.h"
#include "server/simulation/profile_evaluation.h"
#include "server/simulation/rig_evaluation.h"
#include "server/simulation/viscosity_evaluation.h"
#include "tests/service/checked_requests.h"
#include "tests/service/contract_methods.h"
#include "tests/service/support.h"
#include "tribodyn/v1/schemas.pb.h"
#include "tribodyn/v1/spectra.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

v1::EvaluatePointsRequest one_point() {
  v1::EvaluatePointsRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  out.add_conditions()->set_speed_kilometres_per_hour(50);
  return out;
}

v1::EvaluateRigRequest one_rig() {
  v1::EvaluateRigRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  out.set_surface("surfaces/run-in");
  out.set_radius_x_metres(0.0127);
  v1::RigCondition& condition = *out.add_conditions();
  condition.set_load_newtons(38);
  condition.set_entrainment_speed_metres_per_second(2);
  condition.set_slide_roll_ratio_percent(10);
  condition.set_supply_temperature_celsius(40);
  v1::RigBody& ball = *out.mutable_body_1();
  ball.set_youngs_modulus_pascals(210e9);
  ball.set_poissons_ratio(0.3);
  ball.set_thermal_conductivity_watts_per_metre_kelvin(46);
  ball.set_density_kilograms_per_cubic_metre(7850);
  ball.set_specific_heat_capacity_joules_per_kilogram_kelvin(470);
  return out;
}

/// A request with the message of a row inside it, and the check that applies.
struct Subject {
  v1::Simulation simulation = point_simulation();
  v1::EvaluateContactRequest contact = contact_request();
  v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  v1::Surface surface = seed<v1::Surface>("surfaces/run-in");
  v1::ImportSurfaceProfilesRequest profiles;
  v1::Vehicle vehicle = seed<v1::Vehicle>("vehicles/passenger-car");
  v1::GearSet gear_set = seed<v1::GearSet>("gearSets/reference-axle");
  v1::EvaluatePointsRequest points = one_point();
  v1::EvaluateRigRequest rig = one_rig();
  v1::EvaluateViscosityRequest viscosity;
  v1::EvaluateCycleRequest cycle;
  v1::EvaluateProfilesRequest profile_evaluation;
  v1::ReadSpectrumRequest spectrum;
  v1::ComparePointsRequest comparison;
  v1::ExplainPointsRequest explanation;
  v1::Campaign campaign;
  std::unique_ptr<Message> batch, decision, other;
  Message* message = nullptr;
  std::string path;

  explicit Subject(std::string_view name) {
    v1::OperatingPointStudy* point = simulation.mutable_operating_point();
    if (name == "Lubricant") {
      *contact.mutable_lubricant_parameters() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
      use(contact.mutable_lubricant_parameters(), "lubricant_parameters.");
    } else if (name == "ParameterProvenance") {
      use(lubricant.mutable_provenance(0), "provenance[0].");
    } else if (name == "ImprovedYasutomi") {
      use(lubricant.mutable_improved_yasutomi(), "improved_yasutomi.");
    } else if (name == "LubricantMeasurements") {
      use(lubricant.mutable_measurements(), "measurements.");
    } else if (name == "BrookfieldViscosity") {
      use(lubricant.mutable_measurements()->add_brookfield_viscosities(),
          "measurements.brookfield_viscosities[0].");
    } else if (name == "ViscosityMeasurement") {
      use(lubricant.mutable_measurements()->add_viscosities(), "measurements.viscosities[0].");
    } else if (name == "DensityMeasurement") {
      use(lubricant.mutable_measurements()->add_densities(), "measurements.densities[0].");
    } else if (name == "SurfaceMeasurement") {
      use(surface.add_measurements(), "measurements[0].");
    } else if (name == "ImportSurfaceProfilesRequest") {
      use(&profiles, "");
    } else if (name == "EvaluateContactRequest") {
      use(&contact, "");
    } else if (name == "EvaluatePointsRequest") {
      use(&points, "");
    } else if (name == "ComparePointsRequest") {
      comparison.add_lubricants(points.lubricant());
      *comparison.mutable_conditions() = points.conditions();
      comparison.add_condition_weights(1);
      use(&comparison, "");
    } else if (name == "ExplainPointsRequest") {
      explanation.set_lubricant(points.lubricant());
      explanation.set_other_lubricant(points.lubricant());
      *explanation.mutable_conditions() = points.conditions();
      explanation.add_condition_weights(1);
      use(&explanation, "");
    } else if (name == "Campaign" || name == "CampaignBudget") {
      campaign.set_lubricant(points.lubricant());
      *campaign.mutable_conditions() = points.conditions();
      campaign.add_condition_weights(1);
      use(&campaign, "");
      if (name == "CampaignBudget") use(campaign.mutable_budget(), "budget.");
    } else if (name == "PointCondition") {
      use(points.mutable_conditions(0), "conditions[0].");
    } else if (name == "EvaluateRigRequest") {
      use(&rig, "");
    } else if (name == "CampaignRig") {
      campaign.set_lubricant(points.lubricant());
      campaign.set_surface(rig.surface());
      campaign.mutable_rig()->set_radius_x_metres(rig.radius_x_metres());
      *campaign.mutable_rig()->mutable_conditions() = rig.conditions();
      use(campaign.mutable_rig(), "rig.");
    } else if (name == "EvaluateCycleRequest" || name == "CyclePlace") {
      cycle.add_lubricants(points.lubricant());
      for (const double seconds : {0.0, 60.0}) {
        v1::CyclePlace& place = *cycle.add_places();
        place.set_time_seconds(seconds);
        place.set_speed_kilometres_per_hour(50);
      }
      use(&cycle, "");
      if (name == "CyclePlace") use(cycle.mutable_places(0), "places[0].");
    } else if (name == "EvaluateProfilesRequest") {
      use(&profile_evaluation, "");
    } else if (name == "RigBody") {
      use(rig.mutable_body_1(), "body_1.");
    } else if (name == "RigCondition") {
      use(rig.mutable_conditions(0), "conditions[0].");
    } else if (name == "RigGrid") {
      rig.clear_conditions();
      v1::RigGrid& grid = *rig.mutable_grid();
      grid.add_supply_temperatures_celsius(40);
      grid.add_loads_newtons(38);
      grid.add_entrainment_speeds_metres_per_second(2);
      grid.add_slide_roll_ratios_percent(10);
      use(&grid, "grid.");
    } else if (name == "EvaluateViscosityRequest") {
      viscosity.set_lubricant(points.lubricant());
      viscosity.add_temperatures_celsius(40);
      viscosity.add_pressures_pascals(1e9);
      use(&viscosity, "");
    } else if (name == "ReadSpectrumRequest") {
      use(&spectrum, "");
    } else if (name == "Simulation") {
      use(&simulation, "simulation.");
    } else if (name == "StatedLimits") {
      use(simulation.mutable_stated_limits(), "simulation.stated_limits.");
    } else if (name == "Cruise") {
      use(point->mutable_cruise(), "simulation.operating_point.cruise.");
    } else if (name == "DriveCycleSnapshot") {
      point->mutable_drive_cycle_snapshot()->set_speed_kilometres_per_hour(50);
      use(point->mutable_drive_cycle_snapshot(),
          "simulation.operating_point.drive_cycle_snapshot.");
    } else if (name == "PrescribedTorque") {
      point->mutable_prescribed_torque()->set_pinion_speed_radians_per_second(100);
      use(point->mutable_prescribed_torque(), "simulation.operating_point.prescribed_torque.");
    } else if (name == "HistoryRequest") {
      point->mutable_history()->add_columns("mesh_force_newtons");
      use(point->mutable_history(), "simulation.operating_point.history.");
    } else if (name == "InefficiencyCurveStudy") {
      simulation = curve_simulation();
      use(simulation.mutable_inefficiency_curve(), "simulation.inefficiency_curve.");
    } else if (name == "SolverOptions") {
      use(simulation.mutable_solver_options(), "simulation.solver_options.");
    } else if (name == "Surface") {
      use(&surface, "");
    } else if (name == "Vehicle") {
      use(&vehicle, "");
    } else if (name == "GearSet") {
      use(&gear_set, "");
    } else if (name == "DrivelineDynamics") {
      use(gear_set.mutable_dynamics(), "dynamics.");
    } else if (name == "MeshSeries") {
      use(gear_set.mutable_series(), "series.");
    } else if (name == "FourierSeries") {
      use(gear_set.mutable_series()->mutable_mesh_stiffness_newtons_per_metre(),
          "series.mesh_stiffness_newtons_per_metre.");
    } else if (name == "FlankSlot") {
      use(gear_set.mutable_flank_slots(0), "flank_slots[0].");
    } else if (name == "LoadShareAtTorque") {
      use(gear_set.mutable_load_share_by_torque(0), "load_share_by_torque[0].");
    } else if (name.starts_with("Batch")) {
      batch = new_message(name);
      use(batch.get(), "");
    } else if (name.find("Candidate") != std::string_view::npos) {
      decision = new_message(name);
      decision->GetReflection()->AddDouble(
          decision.get(), decision->GetDescriptor()->FindFieldByName("condition_weights"), 1);
      use(decision.get(), "");
    } else if (name == "LoadShareAtTorque.Slot") {
      use(gear_set.mutable_load_share_by_torque(0)->mutable_slots(0),
          "load_share_by_torque[0].slots[0].");
    } else if (message == nullptr) {
      other = new_message(name);
      use(other.get(), "");
    }
  }

  static std::unique_ptr<Message> new_message(std::string_view name) {
    const auto* type = google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(
        "tribodyn.v1." + std::string(name));
    return std::unique_ptr<Message>(
        google::protobuf::MessageFactory::generated_factory()->GetPrototype(type)->New());
  }

  void use(Message* inside, const std::string& prefix) {
    message = inside;
    path = prefix;
  }

  Violations check() const {
    if (path.starts_with("simulation.")) return server::check(simulation);
    if (path == "lubricant_parameters." || message == &contact) return server::check(contact);
    Violations violations;
    if (message == &viscosity) {
      read_viscosity(viscosity, seed_lookup(), violations);
      return violations;
    }
    if (message == &cycle || path == "places[0].") {
      read_cycle(cycle, seed_lookup(), violations);
      return violations;
    }
    if (message == &profile_evaluation) {
      evaluate_profiles(
          profile_evaluation, [] { return false; }, violations);
      return violations;
    }
    if (message == &rig || message == &rig.body_1() || path == "grid." ||
        (!rig.conditions().empty() && message == &rig.conditions(0))) {
      read_rig(rig, seed_lookup(), violations);
      return violations;
    }
    if (message == &points || path == "conditions[0].") {
      read_points(points, seed_lookup(), violations);
      return violations;
    }
    if (message == &explanation) {
      read_explanation(explanation, seed_lookup(), violations);
      return violations;
    }
    if (message == &comparison) {
      read_comparison(comparison, seed_lookup(), violations);
      return violations;
    }
    if (message == &campaign || path == "budget." || path == "rig.") {
      read_campaign(campaign, seed_lookup(), "", violations);
      return violations;
    }
    if (message == &profiles) {
      import_surface(profiles, "surfaces/x", seed_lookup(), violations);
      return violations;
    }
    if (decision) {
      check_message(*decision, "", violations);
      return violations;
    }
    if (batch) {
      check_size(*batch, "requests", violations);
      return violations;
    }
    if (other) {
      check_message(*other, "", violations, Missing::kAllowed);
      return violations;
    }
    check_gear_set(gear_set, "", violations);
    for (const Message* whole : std::initializer_list<const Message*>{
             &lubricant, &surface, &vehicle, &gear_set, &spectrum}) {
      check_message(*whole, "", violations);
    }
    return violations;
  }
};

}  // namespace

/// Prints a row in the output of GoogleTest.
void PrintTo(const Constraint& row, std::ostream* out) { *out << row.message << "." << row.field; }

namespace {

class ConstraintRow : public testing::TestWithParam<Constraint> {
 protected:
  const FieldDescriptor& field(const Subject& subject) const {
    return *subject.message->GetDescriptor()->FindFieldByName(std::string(GetParam().field));
  }

  Violations with(double value) const {
    Subject subject(GetParam().message);
    const auto* reflection = subject.message->GetReflection();
    const FieldDescriptor& target = field(subject);
    if (is_list()) {
      for (int i = 0; i < value; ++i) reflection->AddMessage(subject.message, &target);
    } else if (target.is_repeated() && reflection->FieldSize(*subject.message, &target) > 0) {
      reflection->SetRepeatedDouble(subject.message, &target, 0, value);
    } else if (target.is_repeated()) {
      auto* curve = subject.simulation.mutable_inefficiency_curve();
      curve->Clear();
      reflection->AddDouble(subject.message, &target, value);
    } else if (target.cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
      reflection->SetInt32(subject.message, &target, static_cast<int>(value));
    } else {
      reflection->SetDouble(subject.message, &target, value);
    }
    return subject.check();
  }

  std::string path() const {
    const Subject subject(GetParam().message);
    const std::string name = subject.path + std::string(GetParam().field);
    return field(subject).is_repeated() && !is_list() ? name + "[0]" : name;
  }

  /// Returns true if the row limits the size of a list.
  bool is_list() const {
    return field(Subject(GetParam().message)).cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  }
  bool is_integer() const {
    return is_list() ||
           field(Subject(GetParam().message)).cpp_type() == FieldDescriptor::CPPTYPE_INT32;
  }

  double below() const {
    const double minimum = GetParam().minimum;
    if (is_list()) return minimum - 1;
    if (is_integer()) return minimum - 1 == 0 ? -1 : minimum - 1;
    if (minimum == 0) return -1e-9;
    return minimum - 1e-6 * std::abs(minimum);
  }
  double above() const {
    const double maximum = GetParam().maximum;
    if (is_integer()) return maximum + 1;
    return maximum == 0 ? 1e-9 : maximum + 1e-6 * std::abs(maximum);
  }
};

TEST_P(ConstraintRow, RefusesNumbersBelowAndAboveItsRangeAndNaN) {
  const std::string name(GetParam().field);
  EXPECT_THAT(with(below()), violation(path(), name + " = "));
  EXPECT_THAT(with(above()), violation(path(), name + " = "));
  if (is_integer()) return;
  EXPECT_THAT(with(kNaN), violation(path(), name + " = nan"));
  EXPECT_THAT(with(kInfinity), violation(path(), name + " = inf"));
  EXPECT_THAT(with(-kInfinity), violation(path(), name + " = -inf"));
}

TEST_P(ConstraintRow, NamesUnitRangeAndEquation) {
  const Constraint& row = GetParam();
  const Violations found = with(above());
  ASSERT_THAT(found, violation(path(), quantity_text(row.maximum, row.unit)));
  EXPECT_THAT(found, violation(path(), "allowed: " + number_text(row.minimum) + " to "));
  EXPECT_THAT(found, violation(path(), std::string(row.equation)));
}

TEST_P(ConstraintRow, AllowsTheEndsOfItsRange) {
  for (const double end : {GetParam().minimum, GetParam().maximum}) {
    for (const Violation& found : with(end)) {
      EXPECT_FALSE(found.description.starts_with(out_of_range_text(GetParam(), end)))
          << found.description;
    }
  }
}

std::string row_name(const testing::TestParamInfo<Constraint>& info) {
  std::string name = std::string(info.param.message) + "_" + std::string(info.param.field);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::vector<Constraint> all_rows() { return {constraints().begin(), constraints().end()}; }

INSTANTIATE_TEST_SUITE_P(Table, ConstraintRow, testing::ValuesIn(all_rows()), row_name);

/// Numbers without a row in the table; the comment names the test of their check.
const std::set<std::string>& checked_elsewhere() {
  static const std::set<std::string> kNames = {
      "page_size",           // paging.h; all_methods_test.cpp
      "after_sequence",      // compared with the existing events: jobs_test.cpp
      "after_event_number",  // compared with the existing events: watch_test.cpp
      // compared with the length of the history: app_test.cpp
      "start_row", "row_count", "max_points"};
  return kNames;
}

/// Collects every number that a client can send.
void collect_numbers(const Descriptor& descriptor, std::set<std::string>& out) {
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    if (is_output_only(field) || checked_elsewhere().contains(field.name())) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      collect_numbers(*field.message_type(), out);
    } else if (field.cpp_type() != FieldDescriptor::CPPTYPE_STRING &&
               field.cpp_type() != FieldDescriptor::CPPTYPE_BOOL &&
               field.cpp_type() != FieldDescriptor::CPPTYPE_ENUM) {
      out.insert(descriptor.full_name().substr(std::string("tribodyn.v1.").size()) + "." +
                 field.name());
    }
  }
}

TEST(Constraints, EveryNumberThatAClientCanSendHasARow) {
  std::set<std::string> sent;
  std::set<const google::protobuf::FileDescriptor*> files = {
      v1::Simulation::descriptor()->file(), v1::EvaluateContactRequest::descriptor()->file(),
      v1::Schema::descriptor()->file()};
  for (const auto* type : resource_types()) files.insert(type->file());
  for (const auto* method : all_methods()) {
    if (files.contains(method->file())) collect_numbers(*method->input_type(), sent);
  }
  for (const std::string& name : sent) {
    const std::size_t dot = name.rfind('.');
    EXPECT_NE(find_constraint(name.substr(0, dot), name.substr(dot + 1)), nullptr) << name;
  }
}

/// The work of a batch grows with its list of requests.
TEST(Constraints, EveryBatchHasARowForItsSize) {
  std::size_t batches = 0;
  for (const auto* type : resource_types()) {
    for (int i = 0; i < type->file()->message_type_count(); ++i) {
      const Descriptor& message = *type->file()->message_type(i);
      if (message.FindFieldByName("requests") == nullptr) continue;
      EXPECT_NE(find_constraint(message.name(), "requests"), nullptr) << message.name();
      ++batches;
    }
  }
  EXPECT_EQ(batches, 2 * resource_types().size());
}

/// A zero that means the default or "not stated" takes no number from clients.
TEST(Constraints, NoZeroThatMeansUnsetIsAValueOfItsRange) {
  int rows = 0;
  for (const Constraint& row : constraints()) {
    if (row.zero != Zero::kUnset) continue;
    ++rows;
    EXPECT_TRUE(row.minimum > 0 || row.maximum < 0) << row.message << "." << row.field;
  }
  EXPECT_GT(rows, 40);
}

TEST(Constraints, EveryRowNamesAFieldThatExists) {
  const auto* pool = google::protobuf::DescriptorPool::generated_pool();
  for (const Constraint& row : constraints()) {
    const Descriptor* message =
        pool->FindMessageTypeByName("tribodyn.v1." + std::string(row.message));
    ASSERT_NE(message, nullptr) << row.message;
    EXPECT_NE(message->FindFieldByName(std::string(row.field)), nullptr) << row.field;
  }
}

}  // namespace
}  // namespace tribodyn::server
