#include "server/simulation/input_errors.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "core/celsius.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/input_draw.h"
#include "server/contract/constraints.h"
#include "server/resources/provenance.h"
#include "server/resources/viscosity_fit.h"
#include "server/simulation/input_fields.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr double kDensityPivot = kZeroCelsius + 15;  // [K], of the density at 15 C

/// Temperatures that say where another parameter was measured.
const std::set<std::string_view> kDefiningTemperatures = {"pressure_viscosity_temperature_kelvin",
                                                          "rheology_reference_temperature_kelvin"};
constexpr char kVogelInputs[] =
    "lubricant.vogel_viscosity_prefactor_pascal_seconds "
    "lubricant.vogel_temperature_coefficient_kelvin lubricant.vogel_reference_temperature_kelvin";
constexpr char kDensityInputs[] =
    "lubricant.density_at_zero_kelvin_kilograms_per_cubic_metre "
    "lubricant.density_slope_kilograms_per_cubic_metre_kelvin";

/// Returns the value moved into the allowed range of its field.
double within_range(const FieldDescriptor& field, double value) {
  const Constraint* row = find_constraint(field);
  return row == nullptr ? value : std::clamp(value, row->minimum, row->maximum);
}

double allowed(const char* lubricant_field, double value) {
  return within_range(*v1::Lubricant::descriptor()->FindFieldByName(lubricant_field), value);
}

const v1::ParameterProvenance* entry_of(const Provenances& all, const std::string& field) {
  const v1::ParameterProvenance* entry = find_provenance(all, field);
  return entry != nullptr && entry->field() == field ? entry : nullptr;
}

bool is_computed(const v1::Lubricant& lubricant, const char* field) {
  const v1::ParameterProvenance* entry = entry_of(lubricant.provenance(), field);
  return entry != nullptr && entry->computed();
}

/// Adds the error of each parameter of a resource or of a message in it that states an uncertainty,
/// but of those in `done`. `prefix` is the path of the resource or message, e.g. "lubricant.";
/// `resource_of` returns it in the inputs.
void add_stated(const Message& resource, const Provenances& provenance, const std::string& prefix,
                const std::set<std::string>& done, InputError::Sharing sharing,
                const std::string& base_oil, Message& (*resource_of)(UncertainInputs&),
                InputErrors& out) {
  const std::string block = prefix.substr(prefix.find('.') + 1);
  const auto& type = *resource.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor* field = type.field(i);
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE || field->is_repeated() ||
        input_role(*field) != InputRole::kInput || kDefiningTemperatures.contains(field->name())) {
      continue;
    }
    const std::string input = prefix + field->name();
    if (done.contains(input)) continue;
    if (field->has_presence() && !resource.GetReflection()->HasField(resource, field)) continue;
    const v1::ParameterProvenance* entry = entry_of(provenance, block + field->name());
    const double uncertainty = entry == nullptr ? 0 : entry->standard_uncertainty();
    if (!(uncertainty > 0)) {
      out.without_uncertainty.push_back(input);
      continue;
    }
    const bool is_estimate = sharing == InputError::Sharing::kOwn && entry->computed() &&
                             entry->provenance() == v1::PROVENANCE_ASSUMED;
    const double value = resource.GetReflection()->GetDouble(resource, field);
    out.errors.push_back(
        {input, is_estimate ? InputError::Sharing::kEstimate : sharing,
         is_estimate ? input + " " + base_oil : "", 1,
         [field, value, uncertainty, resource_of](std::span<const double> deviations,
                                                  UncertainInputs& inputs) {
           Message& moved = resource_of(inputs);
           moved.GetReflection()->SetDouble(
               &moved, field, within_range(*field, drawn_value(value, uncertainty, deviations[0])));
         },
         uncertainty});
  }
}

void add_temperature(const char* input, double uncertainty, double UncertainInputs::*rise,
                     InputErrors& out) {
  if (!(uncertainty > 0)) {
    out.without_uncertainty.emplace_back(input);
    return;
  }
  out.errors.push_back(
      {input, InputError::Sharing::kScene, "", 1,
       [uncertainty, rise](std::span<const double> deviations, UncertainInputs& inputs) {
         inputs.*rise = uncertainty * deviations[0];
       }});
}

InputError vogel_error(const VogelFit& fit) {
  return {kVogelInputs, InputError::Sharing::kOwn, "", 3,
          [fit](std::span<const double> deviations, UncertainInputs& inputs) {
            const VogelDraw drawn = drawn_vogel(fit, {deviations[0], deviations[1], deviations[2]});
            inputs.lubricant.set_vogel_viscosity_prefactor_pascal_seconds(
                allowed("vogel_viscosity_prefactor_pascal_seconds", drawn.viscosity_prefactor));
            inputs.lubricant.set_vogel_temperature_coefficient_kelvin(
                allowed("vogel_temperature_coefficient_kelvin", drawn.temperature_coefficient));
            inputs.lubricant.set_vogel_reference_temperature_kelvin(
                allowed("vogel_reference_temperature_kelvin", drawn.reference_temperature));
          }};
}

/// Returns the error of a computed density law. Where the density was measured, the intercept errs
/// only with the slope; where it was estimated, the density at 15 C errs too.
InputError density_error(const v1::Lubricant& lubricant) {
  const v1::ParameterProvenance* at_zero =
      entry_of(lubricant.provenance(), "density_at_zero_kelvin_kilograms_per_cubic_metre");
  const v1::ParameterProvenance* slope =
      entry_of(lubricant.provenance(), "density_slope_kilograms_per_cubic_metre_kelvin");
  const double at_zero_uncertainty = at_zero->standard_uncertainty();
  const double slope_uncertainty = slope == nullptr ? 0 : slope->standard_uncertainty();
  const bool is_estimated = at_zero->provenance() == v1::PROVENANCE_ASSUMED;
  const double pivot = is_estimated || !(slope_uncertainty > 0)
                           ? kDensityPivot
                           : at_zero_uncertainty / slope_uncertainty;
  const DensityDraw law{lubricant.density_at_zero_kelvin_kilograms_per_cubic_metre(),
                        lubricant.density_slope_kilograms_per_cubic_metre_kelvin()};
  return {kDensityInputs, InputError::Sharing::kOwn, "", 2,
          [=](std::span<const double> deviations, UncertainInputs& inputs) {
            const DensityDraw drawn = drawn_density(law, at_zero_uncertainty, slope_uncertainty,
                                                    pivot, {deviations[0], deviations[1]});
            inputs.lubricant.set_density_at_zero_kelvin_kilograms_per_cubic_metre(allowed(
                "density_at_zero_kelvin_kilograms_per_cubic_metre", drawn.density_at_zero_kelvin));
            inputs.lubricant.set_density_slope_kilograms_per_cubic_metre_kelvin(
                allowed("density_slope_kilograms_per_cubic_metre_kelvin", drawn.slope));
          }};
}

void insert_words(std::string_view words, std::set<std::string>& out) {
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    out.emplace(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
}

}  // namespace

InputErrors lubricant_errors(const v1::Lubricant& lubricant) {
  InputErrors out;
  std::set<std::string> done;
  if (const auto fit = viscosity_fit(lubricant)) {
    out.errors.push_back(vogel_error(*fit));
    insert_words(kVogelInputs, done);
  }
  if (is_computed(lubricant, "density_at_zero_kelvin_kilograms_per_cubic_metre")) {
    out.errors.push_back(density_error(lubricant));
    insert_words(kDensityInputs, done);
  }
  if (lubricant.has_improved_yasutomi()) {
    add_stated(
        lubricant.improved_yasutomi(), lubricant.provenance(), "lubricant.improved_yasutomi.", done,
        InputError::Sharing::kOwn, "",
        [](UncertainInputs& inputs) -> Message& {
          return *inputs.lubricant.mutable_improved_yasutomi();
        },
        out);
    done.emplace("lubricant.pressure_viscosity_coefficient_per_pascal");  // without effect
  }
  add_stated(
      lubricant, lubricant.provenance(), "lubricant.", done, InputError::Sharing::kOwn,
      v1::Lubricant::BaseOilClass_Name(lubricant.base_oil_class()),
      [](UncertainInputs& inputs) -> Message& { return inputs.lubricant; }, out);
  return out;
}

InputErrors surface_errors(const v1::Surface& surface) {
  InputErrors out;
  add_stated(
      surface, surface.provenance(), "surface.", {}, InputError::Sharing::kScene, "",
      [](UncertainInputs& inputs) -> Message& { return inputs.surface; }, out);
  return out;
}

InputErrors scene_errors(const v1::Surface& surface, const v1::Vehicle& vehicle,
                         double sump_temperature_uncertainty_kelvin,
                         double inlet_temperature_rise_uncertainty_kelvin) {
  InputErrors out = surface_errors(surface);
  add_stated(
      vehicle, vehicle.provenance(), "vehicle.", {}, InputError::Sharing::kScene, "",
      [](UncertainInputs& inputs) -> Message& { return inputs.vehicle; }, out);
  add_temperature("sump_temperature_celsius", sump_temperature_uncertainty_kelvin,
                  &UncertainInputs::sump_temperature_rise_kelvin, out);
  add_temperature("inlet_temperature_rise_kelvin", inlet_temperature_rise_uncertainty_kelvin,
                  &UncertainInputs::inlet_temperature_rise_kelvin, out);
  return out;
}

}  // namespace tribodyn::server
