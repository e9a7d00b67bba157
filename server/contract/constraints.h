#pragma once

#include <google/protobuf/descriptor.h>

#include <span>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Meaning of a zero in a field without presence.
enum class Zero {
  kValue,  ///< the number zero; it must be inside the range
  kUnset,  ///< the default, or unknown; not checked against the range
};

/// One row of the table from which every range check and its message follow. The range is closed.
/// It excludes values that no law of the model can use, and includes unusual ones.
struct Constraint {
  std::string_view message;  ///< message of tribodyn.v1, e.g. "Lubricant", "LoadShareAtTorque.Slot"
  std::string_view field;    ///< field of the message, e.g. "relaxation_time_seconds"
  std::string_view unit;     ///< symbol in messages, e.g. "s"; empty for a pure number
  double minimum;            ///< for a list of messages: the smallest number of elements
  double maximum;
  std::string_view equation;     ///< equation of the paper, with the symbol of the quantity
  std::string_view reason = {};  ///< why a value outside the range is refused; may be empty
  Zero zero = Zero::kValue;

  /// Returns true if the value is in the range; false for NaN.
  bool allows(double value) const { return value >= minimum && value <= maximum; }
};

/// Returns all rows, grouped by message.
std::span<const Constraint> constraints();

/// Returns true for a parameter that the model needs. It is a violation if such a parameter is
/// unset.
bool is_required(const Constraint& row);

/// Returns the row of a field, or null if the table has none.
const Constraint* find_constraint(std::string_view message, std::string_view field);
const Constraint* find_constraint(const google::protobuf::FieldDescriptor& field);

/// Returns the shortest text from which the same number can be read.
std::string number_text(double value);

/// Returns the number with its unit, e.g. "0.3", "46 W/(m K)".
std::string quantity_text(double value, std::string_view unit);

/// Returns e.g. "radius_x_metres = -1 m; allowed: 1e-05 to 10000 m (eq 15, R_zx: ...)". If the
/// value would be usual in another unit, a hint follows: "; 0.895 looks like g/cm3: did you mean
/// 895 kg/m3?".
std::string out_of_range_text(const Constraint& constraint, double value);

/// Returns e.g. "radius_x_metres is not set; allowed: 1e-05 to 10000 m (eq 15, R_zx: ...)".
std::string not_set_text(const Constraint& constraint);

// These limits bound the work and memory of one request.
inline constexpr int kMaximumCurvePoints = 1000;
inline constexpr int kMaximumDifferentiatedCurvePoints = 300;  ///< 10 kB each at most: 3 MB
inline constexpr int kMaximumHistoryColumns = 100;
inline constexpr double kMaximumHistoryValues = 2e7;  ///< rows times columns, 8 bytes each: 160 MB
inline constexpr double kMaximumCurveMeshCycles = 1e7;  ///< points times maximum_mesh_cycles
inline constexpr int kMaximumBatchSize = 20'000;        ///< requests of one batch
inline constexpr int kMaximumTextLength = 200;          ///< bytes of a text without max_bytes
inline constexpr int kMaximumReportedElements = 10;     ///< violations of one repeated field

}  // namespace tribodyn::server
