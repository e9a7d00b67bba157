#pragma once

#include <string>
#include <vector>

#include "client/cpp/plot/map_plot.h"
#include "client/cpp/report/rig_rows.h"

namespace tribodyn::client {

/// What the machine sets if the flags do not: lists of which every combination is a condition.
struct RigSettings {
  std::vector<double> loads, speeds, slide_roll_ratios, temperatures;
  std::vector<double> mean_pressures = {};  ///< in place of loads
};

/// A setting as axis of a map.
struct RigAxis {
  const char* word;
  const char* title;
  std::vector<double> RigSettings::*values;
  bool is_logarithmic;
  std::vector<double> standard;  ///< unless the flag of the setting gives several values
  double factor;                 ///< from the unit of the setting to that of the title
  int loop;                      ///< of RigGrid, 0 outermost
};
const std::vector<RigAxis>& rig_axes();
/// Returns the axis of a word; nullptr if there is none.
const RigAxis* rig_axis(const std::string& word);

/// Returns `per_decade` numbers for each power of ten, from `first` to `last`.
std::vector<double> powers(double first, double last, int per_decade);

/// Returns the maps of the rows, one for each fluid and model, which hold all combinations of the
/// settings in the order of RigGrid.
MapPicture map_of(const std::vector<RigRow>& rows, const RigView& view, const RigAxis& x,
                  const RigAxis& y, const RigSettings& settings, const std::string& model_version);

/// Returns a table for each map, its x across and its y downwards, both at most 13 values of all.
std::string map_table(const MapPicture& picture);

}  // namespace tribodyn::client
