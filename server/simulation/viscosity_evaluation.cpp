#include "server/simulation/viscosity_evaluation.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/lubricant/pressure_response.h"
#include "core/lubricant/viscosity.h"
#include "core/refusal.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/mapping/to_core.h"
#include "server/resources/lubricant_parameters.h"
#include "server/simulation/refused_rows.h"
#include "server/simulation/study_checks.h"

namespace tribodyn::server {
namespace {

using google::protobuf::RepeatedField;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

double positive_or_missing(double value) {
  return value > 0 && std::isfinite(value) ? value : kMissing;
}

}  // namespace

std::optional<ViscosityEvaluation> read_viscosity(const v1::EvaluateViscosityRequest& request,
                                                  const ResourceLookup& lookup,
                                                  Violations& violations) {
  const std::size_t before = violations.size();
  check_message(request, "", violations);
  check_model_options(request.model_options(), "model_options", violations);
  const double temperatures = request.temperatures_celsius_size();
  const double pressures = request.pressures_pascals_size();
  if (temperatures == 0) {
    violations.add("temperatures_celsius", "not set; allowed: at least one");
  }
  if (temperatures * pressures > kMaximumViscosities) {
    violations.add("pressures_pascals",
                   "{} temperatures x {} pressures; allowed: at most {} combinations", temperatures,
                   pressures, kMaximumViscosities);
  }
  ViscosityEvaluation out;
  if (request.has_lubricant_parameters()) {
    out.lubricant = std::make_shared<v1::Lubricant>(request.lubricant_parameters());
    check_law_of_pressure(*out.lubricant, "lubricant_parameters", violations);
  } else if (request.fluid_case() == v1::EvaluateViscosityRequest::kLubricant) {
    auto found = find_resource<v1::Lubricant>(lookup, request.lubricant(), kLubricants, "lubricant",
                                              violations);
    if (found) {
      out.lubricant = found->resource;
      out.lubricant_revision = found->revision_name;
    }
  } else {
    violations.add("fluid", "not set; allowed: lubricant or lubricant_parameters");
  }
  if (out.lubricant) {
    check_law_options(*out.lubricant, request.model_options(), "model_options", violations);
  }
  if (violations.size() > before) return std::nullopt;
  return out;
}

v1::EvaluateViscosityResponse evaluate_viscosity(const v1::EvaluateViscosityRequest& request,
                                                 const ViscosityEvaluation& evaluation,
                                                 const std::function<bool()>& is_over) {
  const Lubricant lubricant = to_core(*evaluation.lubricant);
  const PressureResponse response(lubricant, to_core(request.model_options()));
  v1::EvaluateViscosityResponse out;
  const int rows = request.temperatures_celsius_size();
  const int pressures = request.pressures_pascals_size();
  RefusedRows refused(rows, *out.mutable_refusal_numbers(), *out.mutable_refusals());
  for (RepeatedField<double>* each :
       {out.mutable_ambient_dynamic_viscosity_pascal_seconds(),
        out.mutable_ambient_kinematic_viscosity_square_millimetres_per_second(),
        out.mutable_ambient_density_kilograms_per_cubic_metre(),
        out.mutable_pressure_viscosity_coefficient_per_pascal()}) {
    each->Resize(rows, kMissing);
  }
  out.mutable_dynamic_viscosity_pascal_seconds()->Resize(rows * pressures, kMissing);
  for (int i = 0; i < rows; ++i) {
    if (is_over()) throw Cancelled();
    const double temperature = request.temperatures_celsius(i) + kZeroCelsius;
    try {
      response.check_at(temperature);
    } catch (const Refusal& refusal) {
      refused.add(i, refusal.reason(), refusal.what());
      continue;
    }
    const double log_ambient = log_ambient_viscosity(lubricant, temperature);
    const double ambient = positive_or_missing(std::exp(log_ambient));
    const double density_there = positive_or_missing(density(lubricant, temperature));
    out.set_ambient_dynamic_viscosity_pascal_seconds(i, ambient);
    out.set_ambient_kinematic_viscosity_square_millimetres_per_second(
        i, 1e6 * ambient / density_there);
    out.set_ambient_density_kilograms_per_cubic_metre(i, density_there);
    out.set_pressure_viscosity_coefficient_per_pascal(
        i, positive_or_missing(response.coefficient(temperature)));
    for (int k = 0; k < pressures; ++k) {
      const double log_viscosity =
          log_ambient + response.log_growth(temperature, request.pressures_pascals(k));
      out.set_dynamic_viscosity_pascal_seconds(i * pressures + k,
                                               positive_or_missing(std::exp(log_viscosity)));
    }
  }
  out.set_lubricant_revision(evaluation.lubricant_revision);
  out.set_model_version(kModelVersion);
  for (v1::RangeWarning& each : fluid_warnings(*evaluation.lubricant)) {
    *out.add_input_warnings() = std::move(each);
  }
  return out;
}

}  // namespace tribodyn::server
