#include "core/study/speed_sweep.h"

#include <algorithm>

#include "core/refusal.h"

namespace tribodyn {

std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point) {
  std::sort(vehicle_speeds.begin(), vehicle_speeds.end());
  vehicle_speeds.erase(std::unique(vehicle_speeds.begin(), vehicle_speeds.end()),
                       vehicle_speeds.end());
  if (options.direction == SweepDirection::kDown) {
    std::reverse(vehicle_speeds.begin(), vehicle_speeds.end());
  }
  std::optional<PreparedScene> prepared;
  std::vector<SweepPoint> out;
  PointOptions point = options.point;
  // A branch is followed from point to point.
  if (point.model == PointModel::kAutomatic) point.model = PointModel::kFull;
  const double count = static_cast<double>(vehicle_speeds.size());
  for (const double speed : vehicle_speeds) {
    const double done = static_cast<double>(out.size());
    if (options.point.progress) {
      point.progress = [&](double fraction) {
        return options.point.progress((done + fraction) / count);
      };
    }
    OperatingCondition condition;
    condition.kind = OperatingCondition::Kind::kCruise;
    condition.vehicle_speed = speed;
    condition.ascent_angle = ascent_angle;
    SweepPoint next;
    next.vehicle_speed = speed;
    try {
      if (!prepared) prepared.emplace(scene);
      next.result = solve_prepared_point(*prepared, condition, point);
      const PointResult& r = *next.result;
      point.carried_state = CarriedState{r.section_state, r.mean_pinion_speed,     r.pinion_torque,
                                         r.wheel_torque,  r.period_in_mesh_cycles, r.contact_loss};
    } catch (const Refusal& refusal) {
      next.refusal_reason = refusal.reason();
      next.refusal_sentence = refusal.what();
      point.carried_state.reset();
    }
    if (on_point) on_point(next);
    out.push_back(std::move(next));
  }
  std::sort(out.begin(), out.end(), [](const SweepPoint& a, const SweepPoint& b) {
    return a.vehicle_speed < b.vehicle_speed;
  });
  return out;
}

}  // namespace tribodyn
