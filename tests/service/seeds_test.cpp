// Compares every number of the seeds with the files from which they come.
#include "server/storage/seeds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/gear/gear_set.h"
#include "server/contract/check_message.h"
#include "server/mapping/to_core.h"
#include "server/resources/accept_resource.h"
#include "server/resources/provenance.h"
#include "tests/service/reference_data.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

std::vector<double> numbers(const google::protobuf::RepeatedField<double>& column) {
  return {column.begin(), column.end()};
}
using server::numbers;

const JsonValue& gear_data() {
  static const JsonValue kData = load_reference("reference_gear_set.json");
  return kData;
}

const JsonValue& orbit_inputs() {
  static const JsonValue kData = load_reference("worked_points.json");
  return at(kData, "orbit_inputs.values");
}

void expect_series(const v1::FourierSeries& series, const JsonValue& data) {
  EXPECT_EQ(series.mean(), number(data, "c0"));
  EXPECT_EQ(numbers(series.sine()), numbers(at(data, "sin")));
  EXPECT_EQ(numbers(series.cosine()), numbers(at(data, "cos")));
}

void expect_mesh_series(const v1::MeshSeries& series, const JsonValue& data, double torque) {
  EXPECT_EQ(series.pinion_torque_newton_metres(), torque);
  expect_series(series.pinion_contact_radius_metres(), at(data, "R_p"));
  expect_series(series.gear_contact_radius_metres(), at(data, "R_g"));
  expect_series(series.mesh_stiffness_newtons_per_metre(), at(data, "k_m"));
  expect_series(series.static_transmission_error_metres(), at(data, "e"));
}

void expect_tables(const v1::GearSet& set, const JsonValue& load_share) {
  const JsonValue& tables = at(gear_data(), "tables");
  ASSERT_EQ(set.flank_slots_size(), 3);
  for (int k = 0; k < 3; ++k) {
    const v1::FlankSlot& slot = set.flank_slots(k);
    const auto table = [&](const char* name) {
      return numbers(at(tables, name).list_value().values(k));
    };
    EXPECT_EQ(numbers(slot.load_share()), numbers(load_share.list_value().values(k)));
    EXPECT_EQ(numbers(slot.radius_x_metres()), table("Rx"));
    EXPECT_EQ(numbers(slot.radius_y_metres()), table("Ry"));
    EXPECT_EQ(numbers(slot.pinion_velocity_x_metres()), table("A_up"));
    EXPECT_EQ(numbers(slot.pinion_velocity_y_metres()), table("A_vp"));
    EXPECT_EQ(numbers(slot.gear_velocity_x_metres()), table("A_ug"));
    EXPECT_EQ(numbers(slot.gear_velocity_y_metres()), table("A_vg"));
    EXPECT_EQ(numbers(slot.contact_point_velocity_x_metres()), table("A_contact_minor"));
    EXPECT_EQ(numbers(slot.contact_point_velocity_y_metres()), table("A_contact_major"));
    EXPECT_EQ(numbers(slot.pinion_friction_arm_metres()), table("r_fr_p"));
    EXPECT_EQ(numbers(slot.gear_friction_arm_metres()), table("r_fr_g"));
  }
}

void expect_dynamics(const v1::DrivelineDynamics& dynamics, const JsonValue& data) {
  EXPECT_EQ(dynamics.pinion_shaft_inertia_kilogram_square_metres(), number(data, "I_s"));
  EXPECT_EQ(dynamics.pinion_inertia_kilogram_square_metres(), number(data, "I_p"));
  EXPECT_EQ(dynamics.gear_inertia_kilogram_square_metres(), number(data, "I_g"));
  EXPECT_EQ(dynamics.wheel_inertia_kilogram_square_metres(), number(data, "I_w"));
  EXPECT_EQ(dynamics.pinion_shaft_stiffness_newton_metres_per_radian(), number(data, "k_t1"));
  EXPECT_EQ(dynamics.gear_shaft_stiffness_newton_metres_per_radian(), number(data, "k_t2"));
  EXPECT_EQ(dynamics.pinion_shaft_damping_newton_metre_seconds_per_radian(), number(data, "c_t1"));
  EXPECT_EQ(dynamics.gear_shaft_damping_newton_metre_seconds_per_radian(), number(data, "c_t2"));
  EXPECT_EQ(dynamics.mesh_damping_newton_seconds_per_metre(), number(data, "c_mesh"));
  EXPECT_EQ(dynamics.half_backlash_metres(), number(data, "b"));
}

void expect_by_torque(const v1::GearSet& set, const JsonValue& torques, const JsonValue& series,
                      const JsonValue& load_shares) {
  ASSERT_EQ(set.series_by_torque_size(), torques.list_value().values_size());
  ASSERT_EQ(set.load_share_by_torque_size(), torques.list_value().values_size());
  for (int i = 0; i < set.series_by_torque_size(); ++i) {
    const double torque = torques.list_value().values(i).number_value();
    expect_mesh_series(set.series_by_torque(i), series.list_value().values(i), torque);
    const v1::LoadShareAtTorque& shares = set.load_share_by_torque(i);
    EXPECT_EQ(shares.pinion_torque_newton_metres(), torque);
    ASSERT_EQ(shares.slots_size(), 3);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(numbers(shares.slots(k).load_share()),
                numbers(load_shares.list_value().values(i).list_value().values(k)));
    }
  }
}

void expect_teeth_and_steel(const v1::GearSet& set) {
  const JsonValue& inputs = orbit_inputs();
  EXPECT_EQ(set.pinion_teeth(), number(gear_data(), "blank_geometry.N_p"));
  EXPECT_EQ(set.gear_teeth(), number(gear_data(), "blank_geometry.N_g"));
  EXPECT_EQ(set.youngs_modulus_pascals(), number(inputs, "E"));
  EXPECT_EQ(set.poissons_ratio(), number(inputs, "nu"));
  EXPECT_EQ(set.solid_thermal_conductivity_watts_per_metre_kelvin(), number(inputs, "k_s"));
  EXPECT_EQ(set.solid_density_kilograms_per_cubic_metre(), number(inputs, "rho_s"));
  EXPECT_EQ(set.solid_specific_heat_capacity_joules_per_kilogram_kelvin(), number(inputs, "cp_s"));
}

TEST(Seeds, GearSetAIsTheReferenceData) {
  const auto set = seed<v1::GearSet>("gearSets/reference-axle");
  expect_teeth_and_steel(set);
  expect_mesh_series(set.series(), at(gear_data(), "fourier"), 30);
  expect_tables(set, at(gear_data(), "tables.load_share"));
  expect_dynamics(set.dynamics(), at(gear_data(), "dynamics"));
  expect_by_torque(set, at(gear_data(), "fourier_by_torque.torques"),
                   at(gear_data(), "fourier_by_torque.sets"),
                   at(gear_data(), "load_share_by_torque.load_share"));
}

TEST(Seeds, GearSetBIsCalibrationBOnTheTablesOfA) {
  const auto set = seed<v1::GearSet>("gearSets/reference-axle-loaded-error");
  expect_teeth_and_steel(set);
  expect_mesh_series(set.series(), at(gear_data(), "calibration_B.fourier"), 30);
  expect_tables(set, at(gear_data(), "tables.load_share"));
  expect_dynamics(set.dynamics(), at(gear_data(), "calibration_B.dynamics"));
  EXPECT_TRUE(set.series_by_torque().empty());
  EXPECT_TRUE(set.load_share_by_torque().empty());
}

TEST(Seeds, ConformalGearSetIsItsEntryAt30NewtonMetresOnTheRestOfA) {
  const auto set = seed<v1::GearSet>("gearSets/reference-axle-conformal");
  const JsonValue& variant = at(gear_data(), "variant_conformal_easeoff");
  ASSERT_EQ(number(variant, "torques.2"), 30);
  expect_teeth_and_steel(set);
  expect_mesh_series(set.series(), at(variant, "fourier.2"), 30);
  expect_tables(set, at(variant, "load_share.2"));
  expect_dynamics(set.dynamics(), at(gear_data(), "dynamics"));
  expect_by_torque(set, at(variant, "torques"), at(variant, "fourier"), at(variant, "load_share"));
}

TEST(Seeds, GearSetsHaveConsistentRadiiAndPassTheCoresCheck) {
  for (const std::string& name : seed_lookup().names(kGearSets)) {
    const auto set = seed<v1::GearSet>(name);
    const auto wind_up = [&](const v1::MeshSeries& series) {
      const double expected =
          series.pinion_contact_radius_metres().mean() * set.gear_teeth() / set.pinion_teeth();
      return series.gear_contact_radius_metres().mean() / expected - 1;
    };
    EXPECT_NEAR(wind_up(set.series()), 0, 2.3e-16) << name;
    for (const auto& series : set.series_by_torque()) EXPECT_NEAR(wind_up(series), 0, 2.3e-16);
    EXPECT_NO_THROW(check(to_core(set))) << name;
  }
}

void expect_shared_fluid_values(const v1::Lubricant& fluid) {
  const JsonValue& inputs = orbit_inputs();
  EXPECT_EQ(fluid.pressure_viscosity_temperature_kelvin(), number(inputs, "T_alpha"));
  EXPECT_EQ(fluid.relaxation_time_seconds(), number(inputs, "HN_lambda"));
  EXPECT_EQ(fluid.havriliak_negami_alpha(), number(inputs, "HN_alpha"));
  EXPECT_EQ(fluid.havriliak_negami_beta(), number(inputs, "HN_beta"));
  EXPECT_EQ(fluid.rheology_reference_temperature_kelvin(), number(inputs, "T_ref"));
  EXPECT_EQ(fluid.limiting_shear_stress_at_zero_pressure_pascals(), number(inputs, "tau_L0"));
  EXPECT_EQ(fluid.limiting_shear_stress_coefficient(), number(inputs, "gamma_L"));
  EXPECT_EQ(fluid.thermal_conductivity_watts_per_metre_kelvin(), number(inputs, "k_f"));
  EXPECT_EQ(fluid.density_at_zero_kelvin_kilograms_per_cubic_metre(), number(inputs, "rho_0"));
  EXPECT_EQ(fluid.density_slope_kilograms_per_cubic_metre_kelvin(), number(inputs, "rho_slope"));
}

TEST(Seeds, Lubricant1IsTheFluidOfTheWorkedOrbits) {
  const auto fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const JsonValue& inputs = orbit_inputs();
  EXPECT_EQ(fluid.vogel_viscosity_prefactor_pascal_seconds(), number(inputs, "eta_ref"));
  EXPECT_EQ(fluid.vogel_temperature_coefficient_kelvin(), number(inputs, "A1"));
  EXPECT_EQ(fluid.vogel_reference_temperature_kelvin(), number(inputs, "T0"));
  EXPECT_EQ(fluid.pressure_viscosity_coefficient_per_pascal(), number(inputs, "alpha_star"));
}

TEST(Seeds, LubricantsHaveThePublishedViscosities) {
  struct Row {
    const char* name;
    double prefactor, coefficient, reference, alpha;
  };
  for (const Row& row : {Row{"lubricants/paper-fluid-1", 1.55e-4, 944.8, 159, 1.609e-8},
                         Row{"lubricants/paper-fluid-2", 7.47e-5, 1105.0, 157, 1.931e-8},
                         Row{"lubricants/paper-fluid-3", 1.34e-4, 943.0, 160, 1.627e-8}}) {
    const auto fluid = seed<v1::Lubricant>(row.name);
    EXPECT_EQ(fluid.vogel_viscosity_prefactor_pascal_seconds(), row.prefactor);
    EXPECT_EQ(fluid.vogel_temperature_coefficient_kelvin(), row.coefficient);
    EXPECT_EQ(fluid.vogel_reference_temperature_kelvin(), row.reference);
    EXPECT_EQ(fluid.pressure_viscosity_coefficient_per_pascal(), row.alpha);
    EXPECT_EQ(fluid.base_oil_class(), v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN)
        << "as the paper says";
    EXPECT_EQ(
        find_provenance(fluid.provenance(), "rheology_reference_temperature_kelvin")->provenance(),
        v1::PROVENANCE_PUBLISHED)
        << "70 C is printed below eq 24";
    expect_shared_fluid_values(fluid);
  }
}

TEST(Seeds, ShellT9HasItsAssumedViscosityAndItsLimitingStress) {
  const auto fluid = seed<v1::Lubricant>("lubricants/shell-t9");
  const auto viscosity = [&fluid](double celsius) {
    return fluid.vogel_viscosity_prefactor_pascal_seconds() *
           std::exp(fluid.vogel_temperature_coefficient_kelvin() /
                    (celsius + 273.15 - fluid.vogel_reference_temperature_kelvin()));
  };
  EXPECT_NEAR(viscosity(25), 13.7e-3, 0.05e-3);
  EXPECT_NEAR(viscosity(40), 7.9e-3, 0.05e-3);
  EXPECT_EQ(fluid.limiting_shear_stress_coefficient(), 0.083);
  for (const char* field :
       {"vogel_viscosity_prefactor_pascal_seconds", "vogel_temperature_coefficient_kelvin",
        "vogel_reference_temperature_kelvin", "pressure_viscosity_coefficient_per_pascal"}) {
    EXPECT_EQ(find_provenance(fluid.provenance(), field)->provenance(), v1::PROVENANCE_ASSUMED);
  }
}

TEST(Seeds, SurfaceAndVehicleAreThoseOfTheWorkedOrbits) {
  const JsonValue& inputs = orbit_inputs();
  const auto surface = seed<v1::Surface>("surfaces/run-in");
  EXPECT_EQ(surface.asperity_density_per_square_metre(), number(inputs, "eta_G"));
  EXPECT_EQ(surface.asperity_radius_metres(), number(inputs, "beta_G"));
  EXPECT_EQ(surface.composite_rms_height_metres(), number(inputs, "sigma_G"));
  EXPECT_EQ(surface.tribofilm_shear_strength_pascals(), number(inputs, "tau_0"));
  EXPECT_EQ(surface.asperity_friction_coefficient(), number(inputs, "zeta"));
  const auto vehicle = seed<v1::Vehicle>("vehicles/passenger-car");
  EXPECT_EQ(vehicle.mass_kilograms(), number(inputs, "mv"));
  EXPECT_EQ(vehicle.rolling_resistance_coefficient(), number(inputs, "froll"));
  EXPECT_EQ(vehicle.drag_coefficient(), number(inputs, "cdrag"));
  EXPECT_EQ(vehicle.frontal_area_square_metres(), number(inputs, "Afront"));
  EXPECT_EQ(vehicle.air_density_kilograms_per_cubic_metre(), number(inputs, "rhoair"));
  EXPECT_EQ(vehicle.wheel_radius_metres(), number(inputs, "rw"));
  EXPECT_EQ(vehicle.gravity_metres_per_second_squared(), number(inputs, "grav"));
}

/// Checks that every field with a number, alone or in a block, has a provenance and a source.
template <class Resource>
void expect_provenance(const std::string& name) {
  const auto resource = seed<Resource>(name);
  std::vector<std::string> stated;
  for (const v1::ParameterProvenance& entry : resource.provenance()) {
    EXPECT_NE(Resource::descriptor()->FindFieldByName(entry.field()), nullptr) << entry.field();
    EXPECT_NE(entry.provenance(), v1::PROVENANCE_UNSPECIFIED) << entry.field();
    EXPECT_FALSE(entry.source().empty()) << entry.field();
    stated.push_back(entry.field());
  }
  const auto* reflection = resource.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection->ListFields(resource, &fields);
  for (const auto* field : fields) {
    const bool label = field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING ||
                       field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_ENUM ||
                       field->name() == "provenance";
    if (label) continue;
    EXPECT_THAT(stated, testing::Contains(field->name())) << name;
  }
}

TEST(Seeds, EveryParameterHasAProvenanceAndASource) {
  for (const auto& name : seed_lookup().names(kLubricants)) expect_provenance<v1::Lubricant>(name);
  for (const auto& name : seed_lookup().names(kGearSets)) expect_provenance<v1::GearSet>(name);
  for (const auto& name : seed_lookup().names(kSurfaces)) expect_provenance<v1::Surface>(name);
  for (const auto& name : seed_lookup().names(kVehicles)) expect_provenance<v1::Vehicle>(name);
}

/// Checks that every number that was assumed or calibrated states its uncertainty. A zero has none,
/// nor has a temperature that says where another number holds, nor a block.
template <class Resource>
void expect_uncertainties(const std::string& name) {
  const auto resource = seed<Resource>(name);
  for (const v1::ParameterProvenance& entry : resource.provenance()) {
    if (entry.provenance() != v1::PROVENANCE_ASSUMED &&
        entry.provenance() != v1::PROVENANCE_CALIBRATED) {
      continue;
    }
    const auto* field = Resource::descriptor()->FindFieldByName(entry.field());
    const bool is_number = field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE;
    if (!is_number || resource.GetReflection()->GetDouble(resource, field) == 0 ||
        entry.field() == "pressure_viscosity_temperature_kelvin" ||
        entry.field() == "rheology_reference_temperature_kelvin") {
      continue;
    }
    EXPECT_GT(entry.standard_uncertainty(), 0) << name << " " << entry.field();
  }
}

TEST(Seeds, EveryAssumedNumberStatesItsUncertainty) {
  for (const auto& name : seed_lookup().names(kLubricants))
    expect_uncertainties<v1::Lubricant>(name);
  for (const auto& name : seed_lookup().names(kGearSets)) expect_uncertainties<v1::GearSet>(name);
  for (const auto& name : seed_lookup().names(kSurfaces)) expect_uncertainties<v1::Surface>(name);
  for (const auto& name : seed_lookup().names(kVehicles)) expect_uncertainties<v1::Vehicle>(name);
}

TEST(Seeds, TheReferenceTemperaturesAreUniformInTheRangesThatTheGradeAllows) {
  const std::pair<const char*, double> widths[] = {{"lubricants/paper-fluid-1", 165 - 149},
                                                   {"lubricants/paper-fluid-2", 163 - 150},
                                                   {"lubricants/paper-fluid-3", 172 - 157}};
  for (const auto& [name, width] : widths) {
    const auto fluid = seed<v1::Lubricant>(name);
    const auto* entry = find_provenance(fluid.provenance(), "vogel_reference_temperature_kelvin");
    EXPECT_NEAR(entry->standard_uncertainty(), width / std::sqrt(12.0), 0.05) << name;
  }
}

template <class Resource>
void expect_accepted_as_they_are(const char* collection) {
  for (const std::string& name : seed_lookup().names(collection)) {
    Violations violations;
    const auto accepted = accept(seed<Resource>(name), static_cast<const Resource*>(nullptr),
                                 seed_lookup(), name, violations);
    ASSERT_TRUE(accepted) << violations.front().field << ": " << violations.front().description;
    EXPECT_EQ(accepted->SerializeAsString(), seed<Resource>(name).SerializeAsString()) << name;
  }
}

TEST(Seeds, AreEqualToResourcesThatAClientCreates) {
  expect_accepted_as_they_are<v1::Lubricant>(kLubricants);
  expect_accepted_as_they_are<v1::GearSet>(kGearSets);
  expect_accepted_as_they_are<v1::Surface>(kSurfaces);
  expect_accepted_as_they_are<v1::Vehicle>(kVehicles);
}

TEST(Seeds, SatisfyTheConstraints) {
  Violations violations;
  for (const auto& name : seed_lookup().names(kLubricants)) {
    check_message(seed<v1::Lubricant>(name), name, violations);
  }
  for (const auto& name : seed_lookup().names(kGearSets)) {
    check_message(seed<v1::GearSet>(name), name, violations);
  }
  check_message(seed<v1::Surface>("surfaces/run-in"), "surface", violations);
  check_message(seed<v1::Vehicle>("vehicles/passenger-car"), "vehicle", violations);
  for (const Violation& violation : violations) {
    ADD_FAILURE() << violation.field << ": " << violation.description;
  }
}

}  // namespace
}  // namespace tribodyn::server
