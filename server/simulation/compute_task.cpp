#include "server/simulation/compute_task.h"

#include "core/refusal.h"

namespace tribodyn::server {
namespace {

template <class Resource>
std::shared_ptr<const Resource> resource_of(const std::string& body, const char* name) {
  auto resource = parse_resource<Resource>(body);
  if (!resource) throw Refusal("TASK_UNREADABLE", std::string(name) + " cannot be parsed");
  return resource;
}

}  // namespace

internal::v1::ComputeTask compute_task(const SimulationInputs& inputs, std::int64_t id, int attempt,
                                       const std::string& input_hash, bool force) {
  internal::v1::ComputeTask task;
  task.set_simulation(id);
  task.set_attempt(attempt);
  inputs.lubricant->SerializeToString(task.mutable_lubricant());
  inputs.gear_set->SerializeToString(task.mutable_gear_set());
  inputs.surface->SerializeToString(task.mutable_surface());
  inputs.vehicle->SerializeToString(task.mutable_vehicle());
  *task.mutable_effective() = inputs.effective;
  task.set_input_hash(input_hash);
  task.set_force(force);
  return task;
}

SimulationInputs inputs_of(const internal::v1::ComputeTask& task) {
  SimulationInputs out;
  out.effective = task.effective();
  out.lubricant = resource_of<v1::Lubricant>(task.lubricant(), "lubricant");
  out.gear_set = resource_of<v1::GearSet>(task.gear_set(), "gear_set");
  out.surface = resource_of<v1::Surface>(task.surface(), "surface");
  out.vehicle = resource_of<v1::Vehicle>(task.vehicle(), "vehicle");
  return out;
}

std::int64_t history_bytes(const v1::Simulation& effective) {
  if (!effective.operating_point().has_history()) return 0;
  const v1::HistoryRequest& history = effective.operating_point().history();
  return std::int64_t{history.mesh_cycles()} * history.samples_per_mesh_cycle() *
         (history.columns_size() + 1) * static_cast<std::int64_t>(sizeof(double));
}

std::vector<StoredColumn> take_history(internal::v1::ComputeResult& result) {
  std::vector<StoredColumn> out;
  for (internal::v1::HistoryColumn& column : *result.mutable_history()) {
    out.push_back(
        {std::move(*column.mutable_name()), {column.values().begin(), column.values().end()}});
    google::protobuf::RepeatedField<double>().Swap(column.mutable_values());
  }
  return out;
}

}  // namespace tribodyn::server
