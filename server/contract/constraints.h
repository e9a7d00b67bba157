#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// What a zero in a field without presence stands for.
enum class Zero {
  kValue,  ///< the number zero; allowed when inside the range
  kUnset,  ///< "take the default" or "not stated"; never checked against the range
};

/// One row of the table that drives every range check and its message. The range is closed and wide
/// enough for hard cases: it keeps out what no law of the model can mean, not what is unusual.
struct Constraint {
  std::string_view message;  ///< message of tribodyn.v1, e.g. "Lubricant", "LoadShareAtTorque.Slot"
  std::string_view field;    ///< its field, e.g. "relaxation_time_seconds"
  std::string_view unit;     ///< symbol for people, e.g. "s"; empty for a pure number
  double minimum;            ///< of a list of messages: how many it has at least
  double maximum;
  std::string_view equation;  ///< of the paper, with the symbol
  std::string_view reason;    ///< why a value outside makes no sense; may be empty
  Zero zero = Zero::kValue;
};

/// All rows, grouped by message.
std::span<const Constraint> constraints();

/// True for a parameter that the model needs: unset, it is a violation.
bool is_required(const Constraint& row);

/// The row of a field, or null.
const Constraint* find_constraint(std::string_view message, std::string_view field);

/// Shortest text that reads back as the same number.
std::string number_text(double value);

/// "0.3", "46 W/(m K)".
std::string quantity_text(double value, std::string_view unit);

/// "radius_x_metres = -1 m; allowed: 1e-05 to 10000 m (eq 15, R_zx: ...)". Where the value would be
/// usual in another unit, also that: "; 0.895 looks like g/cm3: did you mean 895 kg/m3?".
std::string out_of_range_text(const Constraint& constraint, double value);

/// "radius_x_metres is not set; allowed: 1e-05 to 10000 m (eq 15, R_zx: ...)".
std::string not_set_text(const Constraint& constraint);

// Limits on counts, so that no request can starve the server.
inline constexpr int kMaximumCurvePoints = 1000;
inline constexpr int kMaximumHistoryColumns = 100;
inline constexpr double kMaximumHistoryValues = 2e7;    ///< rows times columns: 160 MB
inline constexpr double kMaximumCurveMeshCycles = 1e7;  ///< points times maximum_mesh_cycles
inline constexpr int kMaximumBatchSize = 20'000;        ///< requests of one batch
inline constexpr int kMaximumTextLength = 200;          ///< bytes of a name
inline constexpr int kMaximumProseLength = 4000;        ///< bytes of a description or a source
inline constexpr int kMaximumReportedElements = 10;     ///< violations of one repeated field

}  // namespace tribodyn::server
