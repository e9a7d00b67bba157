#pragma once

#include <string>
#include <vector>

#include "client/cpp/plot/svg.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// What stands below a picture of results so that it can be used without its table: each warning in
/// plain words with the speeds at which it holds, then the model's version and the hash of each
/// simulation's inputs. One entry a sentence; not yet wrapped.
std::vector<std::string> footer_texts(const std::vector<v1::Simulation>& simulations);

/// The texts wrapped to the width, a line each.
std::vector<std::string> footer_lines(const std::vector<std::string>& texts, double width);

inline constexpr double kFooterPitch = 16;  ///< from one line of a footer to the next

/// Draws the lines from `first` (the base line of the first one) downwards.
void draw_footer(const std::vector<std::string>& lines, Point first, Svg& svg);

/// "Lubricant 1: ester-olefin copolymer" becomes a label and a note. A label that is too long is
/// cut, with an ellipsis; the id stands for an empty title.
struct FluidTitle {
  std::string label;
  std::string note;
};
FluidTitle fluid_title(const std::string& lubricant, const std::string& title);

}  // namespace tribodyn::client
