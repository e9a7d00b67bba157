#include "client/cpp/paper/study.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

void switch_on(const std::string& path, v1::ModelOptions& options) {
  google::protobuf::Message* message = &options;
  for (const std::string& name : split(path, '.')) {
    const auto* field = message->GetDescriptor()->FindFieldByName(name);
    if (field == nullptr) throw std::logic_error("ModelOptions has no field " + path);
    if (field->message_type() != nullptr) {
      message = message->GetReflection()->MutableMessage(message, field);
    } else {
      message->GetReflection()->SetBool(message, field, true);
    }
  }
}

v1::ModelOptions model_options_of(const std::vector<std::string>& switches) {
  v1::ModelOptions out;
  out.set_preset(v1::ModelOptions::PAPER);
  for (const std::string& path : switches) {
    if (path == "houpert") {
      out.set_pressure_viscosity_index(v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
    } else {
      switch_on(path, out);
    }
  }
  return out;
}

}  // namespace

std::vector<double> paper_speeds(double last) {
  std::vector<double> out{20};
  const auto add = [&out](double end, double step) {
    while (out.back() < end) out.push_back(out.back() + step);
  };
  add(30, 2.5);
  add(45, 1);
  add(55, 2.5);
  add(85, 0.5);
  add(95, 1);
  add(last, 2.5);
  return out;
}

v1::Simulation simulation_of(const PaperCurve& curve) {
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-" + std::to_string(curve.fluid));
  out.set_gear_set("gearSets/" + curve.gear_set);
  out.set_sump_temperature_celsius(curve.sump_temperature_celsius);
  *out.mutable_model_options() = model_options_of(curve.switches);
  v1::InefficiencyCurveStudy& study = *out.mutable_inefficiency_curve();
  const std::vector<double> speeds = curve.speeds.empty() ? paper_speeds() : curve.speeds;
  study.mutable_speeds_kilometres_per_hour()->Add(speeds.begin(), speeds.end());
  study.set_direction(curve.is_down_sweep ? v1::SWEEP_DIRECTION_DOWN : v1::SWEEP_DIRECTION_UP);
  return out;
}

v1::EvaluateRigRequest request_of(const PaperRig& rig) {
  v1::EvaluateRigRequest out;
  out.set_lubricant("lubricants/" + rig.lubricant);
  out.set_radius_x_metres(rig.ball_radius_metres);
  *out.mutable_model_options() = model_options_of(rig.switches);
  if (rig.has_glass_disc) {
    v1::RigBody& disc = *out.mutable_body_2();
    disc.set_youngs_modulus_pascals(75e9);
    disc.set_poissons_ratio(0.22);
    disc.set_thermal_conductivity_watts_per_metre_kelvin(1.1);
    disc.set_density_kilograms_per_cubic_metre(2500);
    disc.set_specific_heat_capacity_joules_per_kilogram_kelvin(840);
  }
  for (const double load : rig.loads_newtons) {
    for (const double speed : rig.speeds_metres_per_second) {
      for (const double ratio : rig.slide_roll_ratios_percent) {
        v1::RigCondition& condition = *out.add_conditions();
        condition.set_load_newtons(load);
        condition.set_entrainment_speed_metres_per_second(speed);
        condition.set_slide_roll_ratio_percent(ratio);
        condition.set_supply_temperature_celsius(rig.supply_temperature_celsius);
      }
    }
  }
  return out;
}

double PaperLine::at(double place) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(x[i] - place) < 1e-9 * (1 + std::abs(place))) return y[i];
  }
  throw std::out_of_range("a study of the paper has no figure at " + significant(place));
}

double PaperLine::largest() const { return *std::max_element(y.begin(), y.end()); }
double PaperLine::least() const { return *std::min_element(y.begin(), y.end()); }
double PaperLine::place_of_largest() const {
  return x[static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin())];
}

void PaperResults::add(const PaperCurve& curve, const v1::Simulation& simulation) {
  curves_[simulation_of(curve).SerializeAsString()] = simulation;
  model_version_ = simulation.result().model_version();
}

void PaperResults::add(const PaperRig& rig, const v1::EvaluateRigResponse& response) {
  rigs_[request_of(rig).SerializeAsString()] = response;
  model_version_ = response.model_version();
}

const v1::Simulation& PaperResults::of(const PaperCurve& curve) const {
  return curves_.at(simulation_of(curve).SerializeAsString());
}

const v1::EvaluateRigResponse& PaperResults::of(const PaperRig& rig) const {
  return rigs_.at(request_of(rig).SerializeAsString());
}

PaperLine PaperResults::traction(const PaperRig& rig, double load_newtons) const {
  const v1::EvaluateRigRequest request = request_of(rig);
  const v1::EvaluateRigResponse& response = of(rig);
  PaperLine out;
  for (int i = 0; i < request.conditions_size(); ++i) {
    if (request.conditions(i).load_newtons() != load_newtons) continue;
    out.x.push_back(request.conditions(i).slide_roll_ratio_percent());
    out.y.push_back(response.traction_coefficient(i));
  }
  return out;
}

PaperLine PaperResults::film(const PaperRig& rig) const {
  const v1::EvaluateRigRequest request = request_of(rig);
  const v1::EvaluateRigResponse& response = of(rig);
  PaperLine out;
  for (int i = 0; i < request.conditions_size(); ++i) {
    out.x.push_back(request.conditions(i).entrainment_speed_metres_per_second());
    out.y.push_back(response.central_film_thickness_metres(i));
  }
  return out;
}

double PaperResults::largest_error(const PaperCurve& curve) const {
  double out = 0;
  for (const v1::CurvePoint& point : of(curve).result().points()) {
    out = std::max(out, point.result().estimated_relative_error());
  }
  return out;
}

}  // namespace tribodyn::client
