#pragma once

#include <string>
#include <vector>

#include "client/cpp/plot/svg.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns the sentences below a plot of results that let it be used without its table: each
/// warning in plain words with its speeds, then the model's version and the hash of each
/// simulation's inputs. One sentence per entry, not wrapped.
std::vector<std::string> footer_texts(const std::vector<v1::Simulation>& simulations);

/// Returns a sentence for each warning. With `is_hatched`, a sentence of a warning that withholds a
/// verdict begins with "Hatched: ".
std::vector<std::string> warning_footers(const std::vector<ShownWarning>& warnings,
                                         bool is_hatched = false);

/// Wraps the texts to `width` pixels; one line per entry.
std::vector<std::string> footer_lines(const std::vector<std::string>& texts, double width);

inline constexpr double kFooterPitch = 16;  ///< from one line of a footer to the next [pixels]

/// Draws the lines downwards; `first` is the start of the first base line.
void draw_footer(const std::vector<std::string>& lines, Point first, Svg& svg);

/// The label and note of a fluid; "Lubricant 1: ester-olefin copolymer" is split at the colon. A
/// long label is cut and ends in an ellipsis; without a title the label contains the id.
struct FluidTitle {
  std::string label;
  std::string note;
};
FluidTitle fluid_title(const std::string& lubricant, const std::string& title);

}  // namespace tribodyn::client
