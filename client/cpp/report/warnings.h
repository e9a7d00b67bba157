#pragma once

#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/table.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// What the code of a warning means, in a few words: "cold inlet, do not rank oils here" of
/// COLD_INLET. A code that this client does not know becomes words: "new code" of NEW_CODE.
std::string warning_words(const std::string& code);

/// Whether a warning says that a law is used outside the range in which it was measured or
/// checked. The others tell how the figure was computed (PERIOD, QUASI_STATIC, ...). An unknown
/// code counts as outside.
bool is_outside_range(const std::string& code);

/// Whether figures under this warning must not be used to put fluids in an order.
bool forbids_ranking(const std::string& code);

/// One warning of curves, with the speeds at which it holds for any of them.
struct CurveWarning {
  std::string code;
  int speeds = 0;                  ///< results that have it
  double first_speed = 0;          ///< of the first one in the order of the curve [km/h]
  std::string first_message;       ///< of that one
  std::string speeds_text;         ///< "20 to 45 and 60 km/h", "all speeds"
  std::vector<std::string> names;  ///< lubricants concerned; empty: all of them
  std::string mark;                ///< "a", "b", ...: of a range that a picture marks by a strip
  /// The same speeds as ranges, each reaching half way to its neighbours [km/h].
  std::vector<std::pair<double, double>> bands;
};

/// Every warning of the curves: those outside a range first, then by code.
std::vector<CurveWarning> curve_warnings(const std::vector<v1::Simulation>& simulations);

/// Ranges of speed [km/h] in which `holds` is true of a result of some simulation, each reaching
/// half way to the neighbouring speeds; ascending, not overlapping.
template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds);

/// Joins ranges that touch or overlap.
std::vector<std::pair<double, double>> merged_bands(std::vector<std::pair<double, double>> spans);

/// The warnings of one point or one curve, under headings: plain words first, the code last.
void add_warnings(const v1::Simulation& simulation, Sheet& sheet);

template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds) {
  std::vector<std::pair<double, double>> spans;
  for (const v1::Simulation& simulation : simulations) {
    const auto& points = simulation.result().points();
    for (int i = 0; i < points.size(); ++i) {
      if (!points[i].has_result() || !holds(points[i].result())) continue;
      const double speed = points[i].speed_kilometres_per_hour();
      const double before = i > 0 ? points[i - 1].speed_kilometres_per_hour() : speed;
      const double after =
          i + 1 < points.size() ? points[i + 1].speed_kilometres_per_hour() : speed;
      spans.emplace_back((before + speed) / 2, (speed + after) / 2);
    }
  }
  return merged_bands(std::move(spans));
}

}  // namespace tribodyn::client
