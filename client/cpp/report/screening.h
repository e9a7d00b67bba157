#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "client/cpp/resources/candidate_table.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// One candidate at one condition.
struct ScreenedPoint {
  /// Numbers of the columns of v1::EvaluatePointsResponse, in the order of screened_figures().
  static constexpr std::size_t kFigures = 8;
  enum Figure { kPinionTorque, kWheelTorque, kRms, kEnergyMean, kLossPower, kLeast, kMost, kError };
  std::array<double, kFigures> figures = {};
  bool contact_loss = false;
  bool settled = false;
  int period_in_mesh_cycles = 0;
  v1::PointModel model = v1::POINT_MODEL_UNSPECIFIED;
  std::string refusal_reason;  ///< empty: there are figures
  std::string refusal_message;
};

/// Returns the names of the figures, which end in their units.
const std::array<const char*, ScreenedPoint::kFigures>& screened_figures();

/// Returns row `row` of an answer.
ScreenedPoint screened_point(const v1::EvaluatePointsResponse& answer, int row);

/// Candidates at conditions, and what is known of them so far.
struct Screening {
  CandidateBase bases;
  CandidateTable table;
  v1::EvaluatePointsRequest request;  ///< the base at all conditions; revisions in place of names
  std::vector<double> weights;        ///< of the conditions; their sum is 1
  v1::EvaluatePointsResponse base;    ///< the base at all conditions
  std::vector<ScreenedPoint> points;  ///< by candidate, then by condition

  std::size_t conditions() const { return weights.size(); }
};

/// Returns a hash of all that decides the points, e.g. "3f1c...": base, candidates, conditions and
/// version of the model. Weights are not in it.
std::string screening_identity(const Screening& screening);

/// Returns the header of the CSV table of all points.
std::string screening_header(const Screening& screening);
/// Returns the rows of the candidates [first, end) as CSV, or as JSON objects, one a line.
std::string screening_rows(const Screening& screening, std::size_t first, std::size_t end);
std::string screening_json_lines(const Screening& screening);
/// Reads the points that screening_rows() wrote. Returns the number of rows; stops at the first one
/// that is not of the screening.
std::size_t read_screening_rows(const std::string& csv, Screening& screening);

/// Returns "\"text\"" as JSON.
std::string json_quoted(const std::string& text);
/// Returns the number as JSON; null if it is not finite.
std::string json_number(double value);

}  // namespace tribodyn::client
