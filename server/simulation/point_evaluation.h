#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/simulation/prepared_gear_sets.h"
#include "server/simulation/simulation_inputs.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Largest number of points of one request: candidates times conditions. They take 0.1 to 1 s.
inline constexpr int kMaximumEvaluatedPoints = 2000;

/// Points to evaluate: every candidate at every condition.
struct PointEvaluation {
  /// Parameter of a lubricant or surface, and one value for each candidate.
  struct Column {
    const google::protobuf::FieldDescriptor* field;
    std::vector<double> values;
  };
  /// Conditions with the same temperatures. A scene is prepared once for each candidate and group.
  struct Group {
    double sump_temperature_celsius;
    double inlet_temperature_rise_kelvin;
    std::vector<std::pair<int, OperatingCondition>> conditions;  ///< with their position
  };

  SimulationInputs base;  ///< the base of all candidates, at the first condition
  std::vector<Column> columns;
  std::vector<Group> groups;
  int candidates = 1;
  int conditions = 0;
  bool with_contact = false;  ///< points have ContactExtremes, for some six times the work
};

/// Extremes over the loaded flanks and the steady state, and the friction coefficient of the mesh.
struct ContactExtremes {
  double film_ratio_minimum;           ///< lambda_s [-]
  double contact_temperature_maximum;  ///< T_c [K]
  double friction_coefficient_mean;    ///< weighted with the load [-]
  double pressure_maximum;             ///< p_max [Pa]
  double flash_temperature_maximum;    ///< (dT_f)_av [K]
};

/// The figures of one point, or why it has none.
struct EvaluatedPoint {
  std::optional<PointFigures> figures;
  std::optional<ContactExtremes> contact;  ///< if the evaluation is with_contact
  std::string refusal_reason;              ///< UPPER_SNAKE_CASE; empty if there are figures
  std::string refusal_message;
};

/// Errors that are added to the temperatures of all conditions.
struct TemperatureErrors {
  double sump_kelvin = 0;
  double inlet_rise_kelvin = 0;
};

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid or has more than `most` points; `remedy` says what to do then.
std::optional<PointEvaluation> read_points(const v1::EvaluatePointsRequest& request,
                                           const ResourceLookup& lookup, Violations& violations,
                                           int most = kMaximumEvaluatedPoints,
                                           const char* remedy = "in one request; send several");

/// Returns "lubricant.relaxation_time_seconds" and so on for each parameter in which candidates may
/// differ, sorted.
std::vector<std::string> candidate_parameter_names();

/// Computes the points of a lubricant at one group of conditions by screen_point(), those
/// `with_contact` by solve_prepared_point(), and writes them to their positions in `out`.
/// `physical` is the scene, whose lubricant must be this one and whose temperatures are set here;
/// `options.progress` must be set. Throws Cancelled as soon as it returns false.
void evaluate_group(const PointEvaluation::Group& group, bool with_contact,
                    const v1::Lubricant& lubricant, Scene& physical,
                    const TemperatureErrors& errors, const PointOptions& options,
                    const std::shared_ptr<PreparedGearSet>& gear_set,
                    std::vector<EvaluatedPoint>& out);

/// Computes the points of a lubricant at all conditions of the evaluation by screen_point().
/// `physical` is the scene, whose lubricant and temperatures are set here; `options.progress` must
/// be set. Throws Cancelled as soon as it returns false.
std::vector<EvaluatedPoint> evaluate_conditions(const PointEvaluation& evaluation,
                                                const v1::Lubricant& lubricant, Scene& physical,
                                                const TemperatureErrors& errors,
                                                const PointOptions& options,
                                                const std::shared_ptr<PreparedGearSet>& gear_set);

/// The candidates of an evaluation, one at a time. Not safe for concurrent access.
class CandidateScene {
 public:
  /// `evaluation` must outlive the object. `goes_on` is called at least once for each point.
  CandidateScene(const PointEvaluation& evaluation, std::function<bool()> goes_on);
  CandidateScene(const CandidateScene&) = delete;
  CandidateScene& operator=(const CandidateScene&) = delete;

  /// Makes the scene that of a candidate, counted from 0.
  void set_candidate(int candidate);
  /// Computes the candidate at one group of conditions. Throws Cancelled as soon as `goes_on`
  /// returns false; then the gear set may be half prepared.
  void evaluate(const PointEvaluation::Group& group,
                const std::shared_ptr<PreparedGearSet>& gear_set, std::vector<EvaluatedPoint>& out);
  const Scene& scene() const { return physical_; }

 private:
  const PointEvaluation& evaluation_;
  PointOptions options_;
  Scene physical_;
  v1::Lubricant lubricant_;
  v1::Surface surface_;
};

/// Computes all points by screen_point(). A point that the core refuses is a refused row. Throws
/// Cancelled soon after `is_over` returns true.
v1::EvaluatePointsResponse evaluate_points(const PointEvaluation& evaluation,
                                           PreparedGearSets& gear_sets,
                                           const std::function<bool()>& is_over);

}  // namespace tribodyn::server
