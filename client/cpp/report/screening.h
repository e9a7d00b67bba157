#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// One candidate at one condition.
struct ScreenedPoint {
  /// Numbers of the columns of v1::EvaluatePointsResponse, in the order of screened_figures().
  static constexpr std::size_t kFigures = 8;
  enum Figure { kPinionTorque, kWheelTorque, kRms, kEnergyMean, kLossPower, kLeast, kMost, kError };
  std::array<double, kFigures> figures = {};
  /// Numbers of the columns that contact_figures adds, in the order of contact_figures_of_points().
  static constexpr std::size_t kContactFigures = 9;
  enum ContactFigure {
    kLeastFilmRatio,
    kMeanFilmRatio,
    kHighestTemperature,
    kMeanTemperature,
    kViscousLoss,
    kBoundaryLoss,
    kFriction,
    kHighestPressure,
    kHighestFlashTemperature
  };
  std::array<double, kContactFigures> contact = {};
  bool contact_loss = false;
  bool settled = false;
  bool verdict_withheld = false;
  int period_in_mesh_cycles = 0;
  v1::PointModel model = v1::POINT_MODEL_UNSPECIFIED;
  /// 0: there are figures; n: Screening::refusals[n - 1] says why not; -1: not computed.
  int refusal_number = 0;
};

/// Returns the names of the figures, which end in their units.
const std::array<const char*, ScreenedPoint::kFigures>& screened_figures();
const std::array<const char*, ScreenedPoint::kContactFigures>& contact_figures_of_points();

/// Returns row `row` of an answer.
ScreenedPoint screened_point(const v1::EvaluatePointsResponse& answer, int row);

/// Returns the columns of a campaign that hold its points, those of contact_figures last.
std::vector<std::string> screened_columns(bool has_contact_figures);
/// Returns row `row` of these columns.
ScreenedPoint screened_point(const std::vector<std::vector<double>>& columns, std::size_t row);

/// Candidates at conditions, and what is known of them so far.
struct Screening {
  CandidateBase bases;
  CandidateTable table;
  v1::EvaluatePointsRequest request;  ///< the base at all conditions; revisions in place of names
  std::vector<double> weights;        ///< of the conditions; their sum is 1
  v1::EvaluatePointsResponse base;    ///< the base at all conditions
  std::string campaign;               ///< its name; empty: no candidate could be evaluated
  std::string input_hash;             ///< of the campaign
  std::string program = "tribodyn";   ///< how the command line is called for its project
  std::vector<ScreenedPoint> points;  ///< by candidate, then by condition
  std::vector<v1::PointRefusal> refusals;
  std::vector<ShownWarning> warnings;  ///< of candidates, with their names
  std::map<std::size_t, std::vector<ShownWarning>> warnings_of;  ///< by candidate

  std::size_t conditions() const { return weights.size(); }
  bool has_contact_figures() const { return request.contact_figures(); }
  const ScreenedPoint& point(std::size_t candidate, std::size_t condition) const {
    return points[candidate * conditions() + condition];
  }
};

/// Returns why a candidate has no figures at a condition; without a reason if it has.
v1::PointRefusal refusal_of(const Screening& screening, std::size_t candidate,
                            std::size_t condition);

/// Writes the table of all points as CSV with a header, or as JSON objects, one a line.
void write_screening_csv(const Screening& screening, std::ostream& out);
void write_screening_json_lines(const Screening& screening, std::ostream& out);

}  // namespace tribodyn::client
