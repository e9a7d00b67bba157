// Conversion of messages to core values and of results to messages, field by field.
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/version.h"
#include "server/contract/output_only.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Sets every number of a message that the model uses to a different value. Returns their number.
int fill(Message* message, int next = 1) {
  const auto& descriptor = *message->GetDescriptor();
  const auto& reflection = *message->GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor* field = descriptor.field(i);
    if (field->is_repeated() || is_output_only(*field) || is_documentary(*field)) continue;
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      reflection.SetDouble(message, field, next++);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
      reflection.SetInt32(message, field, next++);
    }
  }
  return next - 1;
}

/// The core's plain structs consist of doubles only: seen as an array, they show a forgotten field.
template <class Plain>
std::vector<double> doubles(const Plain& plain) {
  const auto* begin = reinterpret_cast<const double*>(&plain);
  return {begin, begin + sizeof(Plain) / sizeof(double)};
}

std::vector<double> one_to(std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 1; i <= count; ++i) out.push_back(static_cast<double>(i));
  return out;
}

TEST(ToCore, EveryFieldOfPlainResourcesIsConvertedOnce) {
  v1::Lubricant lubricant;
  EXPECT_EQ(fill(&lubricant), 16);
  EXPECT_EQ(fill(lubricant.mutable_improved_yasutomi()), kMostLawParameters);
  const Lubricant oil = to_core(lubricant);
  std::vector<double> of_lubricant = doubles(oil);
  of_lubricant.resize(14);  // the law and its parameters follow
  EXPECT_EQ(of_lubricant, one_to(14));
  EXPECT_EQ(std::vector<double>(oil.law_parameters.begin(), oil.law_parameters.end()),
            one_to(kMostLawParameters));
  EXPECT_EQ(lubricant_boundary(lubricant).asperity_friction_coefficient, 15);
  EXPECT_EQ(lubricant_boundary(lubricant).tribofilm_shear_strength, 16);
  v1::Surface surface;
  EXPECT_EQ(fill(&surface), 5);
  EXPECT_EQ(doubles(roughness(surface)), one_to(3));
  EXPECT_EQ(doubles(boundary_friction(surface)), (std::vector<double>{4, 5, 0}));
  v1::Vehicle vehicle;
  EXPECT_EQ(fill(&vehicle), 7);
  EXPECT_EQ(doubles(to_core(vehicle)), one_to(7));
  v1::GearSet gear_set;
  EXPECT_EQ(fill(&gear_set), 7);
  EXPECT_EQ(doubles(solid(gear_set)), (std::vector<double>{3, 4, 5, 6, 7}));
  EXPECT_EQ(fill(gear_set.mutable_dynamics()), 10);
  EXPECT_EQ(doubles(to_core(gear_set).dynamics), one_to(10));
}

TEST(ToCore, EveryFieldOfAContactIsConvertedOnce) {
  v1::EvaluateContactRequest request;
  EXPECT_EQ(fill(&request), 20);  // the last one is the number of draws
  EXPECT_EQ(doubles(contact_conditions(request)), one_to(7));
  EXPECT_EQ(doubles(solid(request)), (std::vector<double>{10, 11, 12, 13, 14}));
  EXPECT_EQ(doubles(roughness(request)), (std::vector<double>{15, 16, 17}));
  EXPECT_EQ(doubles(boundary_friction(request)), (std::vector<double>{18, 19, 0}));
}

/// Sets one flag of a message and converts it.
ModelOptions with_flag(const std::string& name) {
  v1::ModelOptions options;
  Message* message = &options;
  if (name.starts_with("eq")) message = options.mutable_as_published();
  message->GetReflection()->SetBool(message, message->GetDescriptor()->FindFieldByName(name), true);
  return to_core(options);
}

TEST(ToCore, EveryModelOptionIsConverted) {
  EXPECT_TRUE(with_flag("isothermal").isothermal);
  EXPECT_TRUE(with_flag("newtonian").newtonian);
  EXPECT_TRUE(with_flag("no_limiting_shear_stress").no_limiting_shear_stress);
  EXPECT_TRUE(with_flag("no_boundary_friction").no_boundary_friction);
  EXPECT_TRUE(with_flag("damping_in_contact_only").damping_in_contact_only);
  EXPECT_TRUE(with_flag("energy_consistent").energy_consistent);
  EXPECT_TRUE(with_flag("subtract_contact_point_motion").subtract_contact_point_motion);
  EXPECT_TRUE(with_flag("load_dependent_mesh_data").load_dependent_mesh_data);
  EXPECT_TRUE(with_flag("tabulated_friction_arms").tabulated_friction_arms);
  EXPECT_TRUE(with_flag("inlet_shear_heating").inlet_shear_heating);
  EXPECT_EQ(with_flag("exact_hertz").hertz_solution, HertzSolution::kExact);
  EXPECT_EQ(with_flag("hertz_from_total_load").hertz_load, HertzLoad::kTotalLoad);
  EXPECT_TRUE(with_flag("eq17_atan").as_published.eq17_atan);
  EXPECT_TRUE(with_flag("eq20_semi_major").as_published.eq20_semi_major);
  EXPECT_TRUE(with_flag("eq22_inverted_ratio").as_published.eq22_inverted_ratio);
  EXPECT_TRUE(with_flag("eq31_32_logarithm").as_published.eq31_32_logarithm);
  EXPECT_TRUE(with_flag("eq43_44_polynomials").as_published.eq43_44_polynomials);
  EXPECT_FALSE(with_flag("newtonian").isothermal);
  v1::ModelOptions houpert;
  houpert.set_pressure_viscosity_index(v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
  EXPECT_EQ(to_core(houpert).pressure_viscosity_index, PressureViscosityIndex::kHoupert);
  EXPECT_EQ(to_core(v1::ModelOptions()).pressure_viscosity_index,
            PressureViscosityIndex::kReciprocalAsymptotic);
}

TEST(ToCore, GearSetTablesAndSeriesAreConvertedCompletely) {
  const auto message = seed<v1::GearSet>("gearSets/reference-axle");
  const GearSet set = to_core(message);
  EXPECT_EQ(set.pinion_teeth, 13);
  EXPECT_EQ(set.gear_teeth, 36);
  EXPECT_EQ(set.series_by_torque.size(), 6U);
  EXPECT_EQ(set.load_share_by_torque.size(), 6U);
  EXPECT_EQ(set.load_share_by_torque[2].load_share, set.tables.load_share);
  EXPECT_EQ(set.series.mesh_stiffness.mean,
            message.series().mesh_stiffness_newtons_per_metre().mean());
  EXPECT_EQ(set.series.static_transmission_error.cosine.size(), 8U);
  EXPECT_EQ(set.tables.gear_velocity_y[2][5], message.flank_slots(2).gear_velocity_y_metres(5));
  EXPECT_EQ(set.tables.gear_friction_arm[0][90],
            message.flank_slots(0).gear_friction_arm_metres(90));
  EXPECT_EQ(set.tables.contact_point_velocity_x[1][96],
            message.flank_slots(1).contact_point_velocity_x_metres(96));
}

TEST(FromCore, EveryFieldOfASolvedContactIsConvertedOnce) {
  using S = ContactSolution;
  // In the order of the field numbers.
  constexpr double S::*kNumbers[] = {&S::film_load,
                                     &S::asperity_load,
                                     &S::contact_area,
                                     &S::asperity_area,
                                     &S::semi_major_axis,
                                     &S::semi_minor_axis,
                                     &S::maximum_pressure,
                                     &S::entrainment_angle,
                                     &S::entrainment_radius,
                                     &S::side_leakage_radius,
                                     &S::entrainment_speed,
                                     &S::sliding_speed,
                                     &S::inlet_viscosity,
                                     &S::inlet_pressure_viscosity_coefficient,
                                     &S::pressure_viscosity_index,
                                     &S::reduced_modulus,
                                     &S::central_film_thickness,
                                     &S::film_ratio,
                                     &S::shear_rate,
                                     &S::contact_temperature,
                                     &S::flash_temperature_rise,
                                     &S::oil_temperature_rise,
                                     &S::active_length_1,
                                     &S::active_length_2,
                                     &S::film_thermal_resistance,
                                     &S::thermal_resistance_1,
                                     &S::thermal_resistance_2,
                                     &S::heat_partition,
                                     &S::mean_shear_stress,
                                     &S::viscous_friction,
                                     &S::boundary_friction,
                                     &S::friction,
                                     &S::heat_rate,
                                     &S::friction_coefficient,
                                     &S::limiting_stress_area_share};
  ContactSolution solution;
  solution.status = ContactStatus::kOk;
  int number = 0;
  for (const auto member : kNumbers) solution.*member = ++number;
  EXPECT_EQ(number, 35);
  solution.limiting_stress_switches = 36;
  solution.limiting_stress_at_centre = true;
  solution.thermal_roots = 37;
  solution.specific_sliding_1 = 42;
  solution.specific_sliding_2 = 43;
  const v1::EvaluateContactResponse response = to_message(solution);
  const auto& descriptor = *response.GetDescriptor();
  const auto& reflection = *response.GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor* field = descriptor.field(i);
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE &&
        field->name() != "inlet_heating_factor") {  // which is no figure of the solution
      EXPECT_EQ(reflection.GetDouble(response, field), field->number() - 1) << field->name();
    }
  }
  EXPECT_EQ(response.limiting_stress_switches(), 36);
  EXPECT_TRUE(response.limiting_stress_at_centre());
  EXPECT_EQ(response.thermal_roots(), 37);
  EXPECT_EQ(response.status(), v1::CONTACT_STATUS_OK);
  EXPECT_EQ(response.model_version(), kModelVersion);
}

PointResult full_result() {
  PointResult out;
  out.vehicle_speed = 67.5 / 3.6;
  out.inefficiency_rms = 1.25;
  out.inefficiency_energy_mean = 1.125;
  out.estimated_relative_error = 1e-5;
  out.contact_losses.assign(25, {.start_mesh_phase = 0.25, .end_mesh_phase = 1.5, .duration = 3});
  out.coexisting_response = CoexistingResponse{.inefficiency_rms = 2,
                                               .inefficiency_energy_mean = 3,
                                               .pinion_torque = 4,
                                               .dte_minimum = 5,
                                               .dte_maximum = 6,
                                               .contact_loss = true};
  out.warnings = {{"CODE", "sentence"}};
  out.flank_losses = {FlankLoss{1, 2, 0.1}, FlankLoss{3, 4, 0.2}, FlankLoss{5, 6, 0.3}};
  return out;
}

TEST(FromCore, OptionalAndRepeatedPartsOfAPointAreConverted) {
  const v1::CurvePoint point = to_curve_point(full_result());
  EXPECT_EQ(point.speed_kilometres_per_hour(), 67.5);
  const v1::PointResult& result = point.result();
  EXPECT_EQ(result.inefficiency_rms_percent(), 1.25);
  EXPECT_EQ(result.inefficiency_energy_mean_percent(), 1.125);
  EXPECT_EQ(result.estimated_relative_error(), 1e-5);
  EXPECT_EQ(result.contact_losses_size(), 25);
  EXPECT_EQ(result.contact_losses(7).end_mesh_phase(), 1.5);
  EXPECT_EQ(result.coexisting_response().dynamic_transmission_error_maximum_metres(), 6);
  EXPECT_TRUE(result.coexisting_response().contact_loss());
  EXPECT_EQ(result.warnings(0).code(), "CODE");
  EXPECT_EQ(result.flank_losses(2).boundary_watts(), 6);
  EXPECT_EQ(result.flank_losses(2).friction_coefficient(), 0.3);
  EXPECT_FALSE(to_curve_point(PointResult()).result().has_inefficiency_rms_percent());
  EXPECT_FALSE(to_curve_point(PointResult()).result().has_coexisting_response());
}

TEST(FromCore, ModelAndMethodOfAPointAreConverted) {
  PointResult core = full_result();
  core.method = SteadyStateMethod::kShooting;
  const auto arrived = [&](PointModel model) {
    core.model = model;
    return to_message(core, 20);
  };
  EXPECT_EQ(arrived(PointModel::kFull).model(), v1::POINT_MODEL_FULL);
  EXPECT_EQ(arrived(PointModel::kFull).steady_state_method(), v1::STEADY_STATE_METHOD_SHOOTING);
  EXPECT_EQ(arrived(PointModel::kQuasiStatic).model(), v1::POINT_MODEL_QUASI_STATIC);
  EXPECT_EQ(arrived(PointModel::kQuasiStatic).steady_state_method(),
            v1::STEADY_STATE_METHOD_UNSPECIFIED);
}

TEST(FromCore, NoFieldOfAPointIsForgotten) {
  PointResult core = full_result();
  // All other fields get values other than zero.
  for (double* number :
       {&core.mean_pinion_speed, &core.mesh_frequency, &core.pinion_torque, &core.wheel_torque,
        &core.input_power, &core.mesh_loss_power, &core.mesh_loss_torque, &core.viscous_loss_power,
        &core.boundary_loss_power, &core.boundary_to_viscous_friction_ratio,
        &core.contact_loss_time_share, &core.limiting_stress_time_share,
        &core.limiting_stress_area_share, &core.statistics.periodicity_defect}) {
    *number = 7;
  }
  for (Extremes* extremes :
       {&core.dynamic_transmission_error, &core.mesh_force, &core.pinion_friction_torque,
        &core.gear_friction_torque, &core.central_film_thickness, &core.film_ratio,
        &core.contact_temperature, &core.maximum_pressure, &core.shear_rate,
        &core.flash_temperature_rise, &core.friction_coefficient, &core.pinion_specific_sliding,
        &core.gear_specific_sliding}) {
    *extremes = {1, 2, 3};
  }
  core.contact_loss = core.coast_side_contact = core.settled = true;
  core.period_in_mesh_cycles = core.recorded_mesh_cycles = 9;
  core.statistics = {{1, 2, 3, 4, 5, 6}, 7, 8, 9, 10};
  core.power_balance = {1, 2, 3, 4, 5, 6, 7};
  core.section_state = {1, 2, 3, 4, 5, 6, 7};
  core.sensitivities = PointSensitivities{{}, {{"lubricant.x", "K", 3, {}}}, true};
  const v1::PointResult result = to_message(core, 20);
  EXPECT_EQ(result.contact_losses_size(), 20);
  EXPECT_EQ(result.contact_losses_left_out(), 5);
  const std::function<void(const Message&)> expect_all = [&](const Message& message) {
    const auto& descriptor = *message.GetDescriptor();
    const auto& reflection = *message.GetReflection();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const FieldDescriptor* field = descriptor.field(i);
      if (field->is_repeated()) {
        EXPECT_GT(reflection.FieldSize(message, field), 0) << field->full_name();
      } else {
        EXPECT_TRUE(reflection.HasField(message, field)) << field->full_name();
        if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
          expect_all(reflection.GetMessage(message, field));
        }
      }
    }
  };
  expect_all(result);
}

TEST(FromCore, SensitivitiesKeepTheOrderOfTheirFigures) {
  PointResult core = full_result();
  core.sensitivities = PointSensitivities{{2, 4, 0}, {{"lubricant.x", "K", 3, {6, 8, 5}}}, false};
  const v1::PointSensitivities sensitivities = to_message(core, 20).sensitivities();
  ASSERT_EQ(sensitivities.figures_size(), kOrbitFigures);
  EXPECT_EQ(sensitivities.figures(1), "inefficiency_energy_mean_percent");
  EXPECT_EQ(sensitivities.figures(8), "dynamic_transmission_error_metres.maximum");
  EXPECT_EQ(sensitivities.values(1), 4);
  const v1::ParameterSensitivity& parameter = sensitivities.parameters(0);
  EXPECT_EQ(parameter.parameter(), "lubricant.x");
  EXPECT_EQ(parameter.derivatives(1), 8);
  EXPECT_EQ(parameter.elasticities(0), 9);
  EXPECT_EQ(parameter.elasticities(1), 6);
  EXPECT_EQ(parameter.elasticities(2), 0) << "of a figure that is 0";
}

TEST(FromCore, ACurveOfAThousandPointsFitsIntoOneMessage) {
  SweepPoint worst;
  worst.result = full_result();
  worst.result->contact_losses.assign(1000, {0.123456789, 1.23456789, 1e-3});
  worst.result->warnings.assign(6, {"SOME_RATHER_LONG_CODE", std::string(150, 'x')});
  v1::SimulationResult result;
  for (int i = 0; i < 1000; ++i) *result.add_points() = to_curve_point(worst);
  EXPECT_EQ(result.points(0).result().contact_losses_left_out(), 980);
  EXPECT_LT(result.ByteSizeLong(), 4'000'000U) << "clients accept 4 MB by default";
}

TEST(FromCore, ARefusedPointKeepsItsPositionOnTheCurve) {
  const v1::CurvePoint point = to_curve_point(SweepPoint{.vehicle_speed = 10,
                                                         .result = {},
                                                         .refusal_reason = "WORK_LIMIT",
                                                         .refusal_sentence = "s",
                                                         .branch_end = {}});
  EXPECT_EQ(point.speed_kilometres_per_hour(), 36);
  EXPECT_FALSE(point.has_result());
  EXPECT_EQ(point.refusal_reason(), "WORK_LIMIT");
}

TEST(FromCore, ABranchEndSurvivesSerialisationAndJson) {
  SweepPoint reached;
  reached.vehicle_speed = 75 / 3.6;
  reached.result = full_result();
  EXPECT_FALSE(to_curve_point(reached).has_branch_end());
  reached.branch_end = BranchEnd{.followed_to = 71.29 / 3.6, .gone_at = 71.33 / 3.6};
  const v1::CurvePoint sent = to_curve_point(reached);
  v1::CurvePoint by_bytes, by_json;
  ASSERT_TRUE(by_bytes.ParseFromString(sent.SerializeAsString()));
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(sent, &json).ok());
  EXPECT_NE(json.find("\"branchEnd\":{\"followedToKilometresPerHour\":71.29,"
                      "\"goneAtKilometresPerHour\":71.33}"),
            std::string::npos)
      << json;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json, &by_json).ok());
  for (const v1::CurvePoint& arrived : {by_bytes, by_json}) {
    EXPECT_EQ(arrived.branch_end().followed_to_kilometres_per_hour(), 71.29);
    EXPECT_EQ(arrived.branch_end().gone_at_kilometres_per_hour(), 71.33);
    EXPECT_EQ(arrived.SerializeAsString(), sent.SerializeAsString());
  }
}

TEST(FromCore, SpeedsInAnswersEqualThoseOfTheRequest) {
  for (int tenths = 1; tenths <= 4000; ++tenths) {
    const double speed = tenths / 10.0;
    EXPECT_EQ(kilometres_per_hour(speed / 3.6), speed);
  }
  EXPECT_EQ(kilometres_per_hour(0), 0);
  EXPECT_EQ(kilometres_per_hour(-10 / 3.6), -10);
}

}  // namespace
}  // namespace tribodyn::server
