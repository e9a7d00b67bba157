#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/uncertainty/normal_draws.h"
#include "server/simulation/compared_fluid.h"
#include "server/simulation/point_comparison.h"

namespace tribodyn::server {

/// Computes the figures of all fluids with the stated inputs, with each input moved by its standard
/// uncertainty both ways, and with all inputs drawn. `fluids` are those of the comparison, with
/// their sources set; all else is set here. Throws Cancelled soon after `is_over` returns true.
///
/// Of many conditions only a few are solved with all draws:
///  1. The condition whose point takes the least work is solved with all draws and moves.
///  2. At every other condition a dozen draws are solved, from the least to the largest loss.
///  3. There each figure is fitted, over those draws, as a combination of the same figure at the
///     conditions that are solved with all draws (ColumnBase). A fit is good enough if it predicts
///     each draw that is left out of it within 3 % of the figure's standard deviation and the
///     solver's error (root mean square), and likewise the differences of the fluids.
///  4. Of the conditions with a fit that is not good enough, the one with the largest error for its
///     work is solved with all draws and moves, and all others are fitted again, until all are.
///  5. The fits give the figures of all other draws and moves.
/// A condition at which some draws follow another branch, or are refused, is thus solved with all
/// draws; so are all conditions if they or the draws are few.
void compute_drawn_figures(const PointComparison& comparison, const NormalDraws& draws,
                           const std::shared_ptr<PreparedGearSet>& gear_set,
                           const std::function<bool()>& is_over,
                           std::vector<ComputedFluid>& fluids);

}  // namespace tribodyn::server
