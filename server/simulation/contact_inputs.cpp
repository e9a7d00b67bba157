#include "server/simulation/contact_inputs.h"

#include <fmt/format.h>

#include <utility>

#include "core/numerics/square.h"
#include "core/refusal.h"
#include "core/study/range_warnings.h"
#include "server/contract/check_message.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/resources/lubricant_parameters.h"
#include "server/simulation/contact_uncertainty.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/study_checks.h"

namespace tribodyn::server {

std::optional<v1::Lubricant> read_contact(const v1::EvaluateContactRequest& request,
                                          const ResourceLookup& lookup, Violations& violations) {
  const std::size_t before = violations.size();
  check_message(request, "", violations);
  check_model_options(request.model_options(), "model_options", violations);
  std::optional<v1::Lubricant> lubricant;
  std::string path = "lubricant_parameters";
  if (request.has_lubricant_parameters()) {
    lubricant = request.lubricant_parameters();
    check_law_of_pressure(*lubricant, path, violations);
  } else if (request.fluid_case() == v1::EvaluateContactRequest::kLubricant) {
    path = "lubricant";
    auto found =
        find_resource<v1::Lubricant>(lookup, request.lubricant(), kLubricants, path, violations);
    if (found) lubricant = *found->resource;
  } else {
    violations.add("fluid", "not set; allowed: lubricant or lubricant_parameters");
  }
  if (lubricant) {
    check_law_options(*lubricant, request.model_options(), "model_options", violations);
    check_fluid_at_inlet(*lubricant, request.sump_temperature_celsius(),
                         request.inlet_temperature_rise_kelvin(), path, violations);
    check_pour_point(*lubricant, request.sump_temperature_celsius(), path, violations);
  }
  if (violations.size() > before) return std::nullopt;
  return lubricant;
}

namespace {

/// Returns the figures of the contact alone. Throws as evaluate_contact() does.
v1::EvaluateContactResponse solve_contact(const v1::EvaluateContactRequest& request,
                                          const v1::Lubricant& lubricant) {
  const double sump = request.sump_temperature_celsius() + kZeroCelsius;
  const double inlet = sump + request.inlet_temperature_rise_kelvin();
  const FlankContactModel model(
      to_core(lubricant), solid(request), roughness(request),
      boundary_friction(boundary_friction(request), lubricant_boundary(lubricant), inlet), sump,
      request.inlet_temperature_rise_kelvin(), to_core(request.model_options()));
  const ContactSolution solution = model.solve(contact_conditions(request));
  if (solution.status != ContactStatus::kOk && solution.status != ContactStatus::kNoLoad) {
    throw Refusal(contact_status_name(solution.status), contact_status_sentence(solution.status));
  }
  if (solution.contact_temperature > kHottestContact) {
    throw Refusal("CONTACT_TOO_HOT",
                  fmt::format("the contact would have {:.4g} K, and the model is not valid above "
                              "{} K, where steel melts; check the units of the fluid's parameters "
                              "(eq 23, eq 34), of the velocities and of the load",
                              solution.contact_temperature, kHottestContact));
  }
  v1::EvaluateContactResponse response = to_message(solution);
  if (solution.status == ContactStatus::kOk) {
    const RangeFigures figures =
        range_figures(solution, model.inlet_heating_factor(square(solution.entrainment_speed),
                                                           square(solution.sliding_speed),
                                                           solution.maximum_pressure));
    response.set_inlet_heating_factor(figures.inlet_heating_factor);
    add_warnings(range_warnings({fluid_grounds(lubricant), model.options(),
                                 model.parameters().roughness, inlet},
                                figures),
                 response.mutable_range_warnings());
  }
  const std::string bad = first_not_finite(response);
  if (!bad.empty()) throw Refusal("RESULT_NOT_FINITE", bad + " is not finite");
  return response;
}

}  // namespace

v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request,
                                             const v1::Lubricant& lubricant) {
  v1::EvaluateContactResponse response = solve_contact(request, lubricant);
  for (v1::RangeWarning& each : fluid_warnings(lubricant)) {
    *response.add_input_warnings() = std::move(each);
  }
  if (request.draws() > 0) {
    const auto solve = [&request](const v1::Lubricant& drawn) {
      return solve_contact(request, drawn);
    };
    add_uncertainties(lubricant, request.draws(), solve, response);
  }
  return response;
}

}  // namespace tribodyn::server
