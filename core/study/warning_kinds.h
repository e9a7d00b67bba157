#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace tribodyn {

/// A code of RangeWarning.
struct WarningKind {
  /// How far figures with the warning may be relied on.
  enum class Level {
    kNote,             ///< how the figure was computed, or how its inputs are known
    kCaution,          ///< a law is used outside the range in which it was measured or checked
    kWithholdsVerdict  ///< it decides nothing between lubricants: no verdict, no probability
  };
  std::string_view code;
  std::string_view summary;  ///< what it means, in a few words
  Level level;
};

/// Every code that a point, a contact, a rig or a cycle can have, then those of inputs. Databases
/// hold the places of the first 32: their order never changes.
std::span<const WarningKind> warning_kinds();

/// The place of a code in warning_kinds(); -1 if it is none.
int warning_number(std::string_view code);

bool withholds_verdict(std::string_view code);

/// Whether one of several warnings does; they have a member `code`.
template <class Warnings>
bool any_withholds_verdict(const Warnings& warnings) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [](const auto& each) { return withholds_verdict(each.code); });
}

/// What figures of tooth contacts leave out and rankings of oils must say, one sentence.
inline constexpr char kToothContactOnly[] =
    "Tooth contact only: churning, bearings and seals are not included, and what they lose grows "
    "with viscosity.";

}  // namespace tribodyn
