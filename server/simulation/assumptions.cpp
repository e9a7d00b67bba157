#include "server/simulation/assumptions.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "server/contract/constraints.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/resources/imports/import_surface.h"
#include "server/resources/lubricant_parameters.h"
#include "server/resources/provenance.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/input_fields.h"
#include "server/simulation/solver_defaults.h"
#include "server/support/lru_cache.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Assumptions = std::vector<v1::Assumption>;

void add(Assumptions& out, const std::string& resource, const std::string& field,
         const std::string& value, v1::Provenance provenance, const std::string& source) {
  v1::Assumption entry;
  entry.set_resource(resource);
  entry.set_field(field);
  entry.set_value(value);
  entry.set_provenance(provenance);
  entry.set_source(source);
  out.push_back(std::move(entry));
}

void add(Assumptions& out, const std::string& resource, const Provenances& all,
         const std::string& field, const std::string& value) {
  const v1::ParameterProvenance* entry = find_provenance(all, field);
  add(out, resource, field, value,
      entry == nullptr ? v1::PROVENANCE_UNSPECIFIED : entry->provenance(),
      entry == nullptr ? "" : entry->source());
}

/// Adds every number of a message that the model uses and that is not nested.
void add_numbers(Assumptions& out, const std::string& resource, const Provenances& all,
                 const Message& message, const std::string& prefix) {
  const auto& descriptor = *message.GetDescriptor();
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    const Constraint* row = find_constraint(descriptor.name(), field.name());
    if (field.is_repeated() || row == nullptr || input_role(field) != InputRole::kInput) continue;
    if (field.has_presence() && !reflection.HasField(message, &field)) continue;
    const double value = field.cpp_type() == FieldDescriptor::CPPTYPE_INT32
                             ? reflection.GetInt32(message, &field)
                             : reflection.GetDouble(message, &field);
    add(out, resource, all, prefix + field.name(), quantity_text(value, row->unit));
  }
}

std::string torques(const v1::GearSet& set) {
  std::string text;
  for (const v1::MeshSeries& series : set.series_by_torque()) {
    text += (text.empty() ? "" : ", ") + number_text(series.pinion_torque_newton_metres());
  }
  return text + " N m";
}

void add_gear_set(Assumptions& out, const v1::GearSet& set, bool load_dependent) {
  const Provenances& all = set.provenance();
  add_numbers(out, set.name(), all, set, "");
  add(out, set.name(), all, "series",
      fmt::format("{} harmonics at {}", set.series().mesh_stiffness_newtons_per_metre().sine_size(),
                  quantity_text(set.series().pinion_torque_newton_metres(), "N m")));
  const int samples = set.flank_slots().empty() ? 0 : set.flank_slots(0).load_share_size();
  add(out, set.name(), all, "flank_slots",
      fmt::format("{} slots of {} samples", set.flank_slots_size(), samples));
  add_numbers(out, set.name(), all, set.dynamics(), "dynamics.");
  if (load_dependent) {
    add(out, set.name(), all, "series_by_torque", torques(set));
    add(out, set.name(), all, "load_share_by_torque", torques(set));
  }
}

/// Adds a value of the request, and where it comes from if the request does not set it.
void add_choice(Assumptions& out, const char* field, const std::string& value, bool is_set,
                v1::Provenance of_default = v1::PROVENANCE_ASSUMED,
                const char* default_source = "default: not set in the request") {
  add(out, "request", field, value, is_set ? v1::PROVENANCE_USER : of_default,
      is_set ? "set in the request" : default_source);
}

void add_request(Assumptions& out, const SimulationInputs& inputs) {
  const v1::Simulation& asked = inputs.requested;
  const v1::Simulation& effective = inputs.effective;
  add_choice(out, "lubricant", effective.lubricant(), !asked.lubricant().empty());
  add_choice(out, "gear_set", effective.gear_set(), !asked.gear_set().empty());
  add_choice(out, "surface", effective.surface(), !asked.surface().empty());
  add_choice(out, "vehicle", effective.vehicle(), !asked.vehicle().empty());
  add_choice(out, "sump_temperature_celsius",
             quantity_text(effective.sump_temperature_celsius(), "C"),
             asked.has_sump_temperature_celsius());
  add_choice(out, "inlet_temperature_rise_kelvin",
             quantity_text(effective.inlet_temperature_rise_kelvin(), "K"),
             asked.has_inlet_temperature_rise_kelvin(), v1::PROVENANCE_PUBLISHED,
             "default: the value published with eq 14");
}

void add_resources(Assumptions& out, const SimulationInputs& inputs) {
  const auto add_all = [&out](const auto& resource) {
    add_numbers(out, resource.name(), resource.provenance(), resource, "");
  };
  add_all(*inputs.lubricant);
  if (inputs.lubricant->has_improved_yasutomi()) {
    add_numbers(out, inputs.lubricant->name(), inputs.lubricant->provenance(),
                inputs.lubricant->improved_yasutomi(), "improved_yasutomi.");
  }
  add_gear_set(out, *inputs.gear_set, inputs.effective.model_options().load_dependent_mesh_data());
  add_all(*inputs.surface);
  add_all(*inputs.vehicle);
}

std::string serialised_limits(const SimulationInputs& inputs) {
  v1::SimulationResult out;
  for (const FigureLimit& each :
       figure_limits(fluid_grounds(*inputs.lubricant), to_core(inputs.effective.stated_limits()))) {
    *out.add_limits() = to_message(each);
  }
  return out.SerializeAsString();
}

std::string serialised(Assumptions assumptions, std::vector<v1::RangeWarning> warnings) {
  v1::SimulationResult out;
  for (v1::Assumption& each : assumptions) *out.add_assumptions() = std::move(each);
  for (v1::RangeWarning& each : warnings) *out.add_input_warnings() = std::move(each);
  return out.SerializeAsString();
}

}  // namespace

std::vector<v1::Assumption> assumptions(const SimulationInputs& inputs) {
  Assumptions out;
  add_request(out, inputs);
  add_resources(out, inputs);
  return out;
}

std::vector<v1::RangeWarning> input_warnings(const SimulationInputs& inputs) {
  std::vector<v1::RangeWarning> out = fluid_warnings(*inputs.lubricant);
  for (v1::RangeWarning& each : surface_warnings(*inputs.surface)) out.push_back(std::move(each));
  return out;
}

std::string serialised_assumptions(const SimulationInputs& inputs) {
  static LruCache<std::pair<Resources, bool>, std::string> cache;
  const bool load_dependent = inputs.effective.model_options().load_dependent_mesh_data();
  Assumptions of_request;
  add_request(of_request, inputs);
  // Concatenated serialised messages parse as one merged message.
  return serialised(std::move(of_request), {}) + serialised_limits(inputs) +
         cache.get({resources(inputs), load_dependent}, [&inputs] {
           Assumptions of_resources;
           add_resources(of_resources, inputs);
           return serialised(std::move(of_resources), input_warnings(inputs));
         });
}

}  // namespace tribodyn::server
