#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/study/screening.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/simulation/point_elasticities.h"
#include "server/simulation/prepared_gear_sets.h"
#include "server/simulation/simulation_inputs.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Largest number of points of one request: candidates times conditions. They take 0.1 to 1 s.
inline constexpr int kMaximumEvaluatedPoints = 2000;
/// The same with elasticities. They take about 0.1 s.
inline constexpr int kMaximumDifferentiatedPoints = 500;

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
  /// Of candidates that are lubricants: their columns are for people.
  std::vector<std::shared_ptr<const v1::Lubricant>> lubricants;
  int candidates = 1;
  int conditions = 0;
  /// Whether other lubricants follow at the same few conditions: by screen_point(), or else by
  /// solve_point_figures().
  bool shares_orbits = true;
  bool with_contact = false;             ///< figures have PointFigures::contact
  bool with_sentences = true;            ///< warnings have sentences
  std::vector<Elasticity> elasticities;  ///< that each point has
};

/// The figures of one point, or why it has none.
struct EvaluatedPoint {
  std::optional<PointFigures> figures;  ///< without sensitivities
  /// Those of the evaluation; NaN where the point has none. Empty if there are no figures.
  std::vector<double> elasticities;
  bool is_one_sided = false;   ///< as PointSensitivities::one_sided
  std::string refusal_reason;  ///< UPPER_SNAKE_CASE; empty if there are figures
  std::string refusal_message;
};

/// Errors that are added to the temperatures of all conditions.
struct TemperatureErrors {
  double sump_kelvin = 0;
  double inlet_rise_kelvin = 0;
};

/// Reads the columns of candidates of a request. Adds all violations.
std::vector<PointEvaluation::Column> read_columns(const v1::EvaluatePointsRequest& request,
                                                  Violations& violations);
/// Adds a violation for each column that has no effect, because the base follows another
/// pressure-viscosity law or boundary friction of the oil overrides that of the surface.
void check_columns_of_base(const v1::EvaluatePointsRequest& request, const v1::Lubricant& base,
                           Violations& violations);

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid or has more than `most` points; `remedy` says what to do then.
std::optional<PointEvaluation> read_points(const v1::EvaluatePointsRequest& request,
                                           const ResourceLookup& lookup, Violations& violations,
                                           int most = kMaximumEvaluatedPoints,
                                           const char* remedy = "in one request; send several");

/// Returns "lubricant.relaxation_time_seconds" and so on for each parameter in which candidates may
/// differ, sorted.
std::vector<std::string> candidate_parameter_names();
/// Returns the field of such a parameter; null if there is none of this name.
const google::protobuf::FieldDescriptor* find_candidate_parameter(const std::string& path);
/// Returns the sentence that there is no such parameter, with the name that may be meant.
std::string unknown_parameter_text(const std::string& path);

/// Returns the options of all points of an evaluation, without progress.
PointOptions point_options(const PointEvaluation& evaluation);

/// Computes the points of a lubricant at all conditions of the evaluation, or only at those
/// `wanted`: other points are then empty.
/// `physical` is the scene, whose lubricant and temperatures are set here; `options` are its
/// point_options() with progress set. Throws Cancelled as soon as that returns false.
std::vector<EvaluatedPoint> evaluate_conditions(const PointEvaluation& evaluation,
                                                const v1::Lubricant& lubricant, Scene& physical,
                                                const TemperatureErrors& errors,
                                                const PointOptions& options,
                                                const std::shared_ptr<PreparedGearSet>& gear_set,
                                                const std::vector<bool>* wanted = nullptr);

/// Lubricant and surface of a candidate.
struct CandidateResources {
  v1::Lubricant lubricant;
  v1::Surface surface;

  /// Takes the lubricant of a candidate, counted from 0, or replaces the parameters that have
  /// columns by those of the candidate.
  void set(const PointEvaluation& evaluation, int candidate);
};

/// The candidates of an evaluation, one at a time. Not safe for concurrent access.
class CandidateScene {
 public:
  /// `evaluation` must outlive the object. `goes_on` is called at least once for each point.
  CandidateScene(const PointEvaluation& evaluation, std::function<bool()> goes_on);
  CandidateScene(const CandidateScene&) = delete;
  CandidateScene& operator=(const CandidateScene&) = delete;

  /// Makes the scene that of a candidate, counted from 0.
  void set_candidate(int candidate);
  /// Makes it that of any lubricant and surface.
  void set_resources(const v1::Lubricant& lubricant, const v1::Surface& surface);
  /// Computes the candidate at one group of conditions. Throws Cancelled as soon as `goes_on`
  /// returns false; then the gear set may be half prepared.
  void evaluate(const PointEvaluation::Group& group,
                const std::shared_ptr<PreparedGearSet>& gear_set, std::vector<EvaluatedPoint>& out);
  const Scene& scene() const { return physical_; }

 private:
  void set_scene();

  const PointEvaluation& evaluation_;
  PointOptions options_;
  Scene physical_;
  CandidateResources resources_;
};

/// Computes all points by screen_point(). A point that the core refuses is a refused row. Throws
/// Cancelled soon after `is_over` returns true.
v1::EvaluatePointsResponse evaluate_points(const PointEvaluation& evaluation,
                                           PreparedGearSets& gear_sets,
                                           const std::function<bool()>& is_over);

}  // namespace tribodyn::server
