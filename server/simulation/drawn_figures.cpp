#include "server/simulation/drawn_figures.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/numerics/square.h"
#include "core/uncertainty/column_fit.h"
#include "server/mapping/to_core.h"

namespace tribodyn::server {
namespace {

/// Draws that are solved at every condition, where one fluid is computed. With ten more fits fail;
/// with sixteen the errors are the same.
constexpr std::size_t kCheckedDraws = 12;
constexpr std::size_t kLeastCheckedDrawsOfAFluid = 4;  // of several fluids
/// Conditions and draws below which nothing is gained by leaving out points.
constexpr std::size_t kLeastConditions = 5, kLeastDraws = 4 * kCheckedDraws;
/// Largest root mean square of the errors of left-out draws, relative to the standard deviation of
/// the figure or difference [-]. The ends of the 95 % intervals of the curves of seven lubricants
/// then err by at most 7 % of it.
constexpr double kLargestError = 0.03;

using Flags = std::vector<bool>;  // by condition

/// The points of one fluid by row and condition: rows are the draws, then for each deviation of
/// each source a move by 1 and one by -1.
class FluidRows {
 public:
  FluidRows(const PointComparison& comparison, const PointEvaluation& evaluation,
            const NormalDraws& draws, const std::shared_ptr<PreparedGearSet>& gear_set,
            const std::function<bool()>& is_over, ComputedFluid& fluid)
      : weights_(comparison.weights),
        evaluation_(evaluation),
        draws_(draws),
        gear_set_(gear_set),
        physical_(scene(evaluation.base)),
        options_(point_options(evaluation)),
        fluid_(fluid) {
    options_.progress = [&is_over](double) { return !is_over(); };
    inputs_.lubricant = *evaluation.base.lubricant;
    inputs_.lubricant.clear_measurements();
    inputs_.lubricant.clear_provenance();
    inputs_.surface = *evaluation.base.surface;
    inputs_.vehicle = *evaluation.base.vehicle;
    for (std::size_t s = 0; s < fluid.sources.size(); ++s) {
      for (std::size_t i = 0; i < fluid.sources[s].mixtures.size(); ++i) moved_.emplace_back(s, i);
    }
    fluid_.points = evaluate(Flags(conditions(), true));
    options_.warning_sentences = false;  // of draws
    for (const EvaluatedPoint& point : fluid_.points) {
      fluid_.stated.push_back(stated_figures(point));
    }
    if (moved_.empty()) return;
    values_.resize(draw_count() + 2 * moved_.size(), ValuesByCondition(conditions()));
    is_solved_.resize(values_.size(), Flags(conditions(), false));
  }

  std::size_t conditions() const { return weights_.size(); }
  bool is_uncertain() const { return !moved_.empty(); }
  const std::optional<StatedFigures>& stated(std::size_t condition) const {
    return fluid_.stated[condition];
  }
  const std::optional<FigureValues>& at(std::size_t row, std::size_t condition) const {
    return values_[row][condition];
  }
  std::size_t rows() const { return values_.size(); }
  /// Contact solutions that the point with the stated inputs took.
  double work(std::size_t condition) const {
    const auto& figures = fluid_.points[condition].figures;
    return figures ? static_cast<double>(figures->contact_solutions) : 0;
  }
  std::size_t figures() const { return evaluation_.with_contact ? kComparedFigures : kFilmRatio; }

  /// Solves those points of a row at `wanted` conditions that are not solved yet.
  void solve(std::size_t row, Flags wanted) {
    for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = wanted[k] && !is_solved_[row][k];
    if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return;
    apply(row);
    const std::vector<EvaluatedPoint> points = evaluate(wanted);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (!wanted[k]) continue;
      is_solved_[row][k] = true;
      if (const auto figures = stated_figures(points[k])) values_[row][k] = figures->value;
    }
  }
  /// Sets the points of a condition that are not solved: each figure is its stated value and the
  /// weighted changes of the figure at other conditions. `weights` by figure.
  void set_unsolved(std::size_t condition, const std::vector<std::size_t>& base,
                    const std::vector<Eigen::VectorXd>& weights) {
    for (std::size_t row = 0; row < rows(); ++row) {
      if (is_solved_[row][condition]) continue;
      FigureValues out = fluid_.stated[condition]->value;
      for (std::size_t f = 0; f < figures(); ++f) {
        for (std::size_t j = 0; j < base.size(); ++j) {
          out[f] += weights[f](static_cast<Eigen::Index>(j)) *
                    ((*values_[row][base[j]])[f] - fluid_.stated[base[j]]->value[f]);
        }
      }
      values_[row][condition] = out;
    }
  }
  /// Adds weighted means, draws and effects to the fluid.
  void finish() {
    add_stated_mean();
    fluid_.solved_draws.assign(conditions(), 0);
    if (!is_uncertain()) return;
    for (ValuesByCondition& row : values_) add_mean(row);
    for (std::size_t n = 0; n < draw_count(); ++n) {
      for (std::size_t k = 0; k < conditions(); ++k) {
        if (is_solved_[n][k]) ++fluid_.solved_draws[k];
      }
      fluid_.drawn.push_back(std::move(values_[n]));
    }
    for (std::size_t m = 0; m < moved_.size(); ++m) {
      fluid_.sources[moved_[m].first].effects.push_back(
          effects(values_[draw_count() + 2 * m], values_[draw_count() + 2 * m + 1]));
    }
  }

 private:
  std::size_t draw_count() const { return static_cast<std::size_t>(draws_.draws()); }

  void apply(std::size_t row) {
    for (std::size_t s = 0; s < fluid_.sources.size(); ++s) {
      const ErrorSource& source = fluid_.sources[s];
      std::vector<double> deviations(source.mixtures.size(), 0.0);
      if (row < draw_count()) {
        for (std::size_t i = 0; i < deviations.size(); ++i) {
          deviations[i] = source.mixtures[i].at(draws_, static_cast<int>(row));
        }
      } else if (const auto& [moved, i] = moved_[(row - draw_count()) / 2]; moved == s) {
        deviations[i] = (row - draw_count()) % 2 == 0 ? 1 : -1;
      }
      source.error->apply(deviations, inputs_);
    }
  }
  std::vector<EvaluatedPoint> evaluate(const Flags& wanted) {
    physical_.roughness = roughness(inputs_.surface);
    physical_.boundary = boundary_friction(inputs_.surface);
    physical_.vehicle = to_core(inputs_.vehicle);
    return evaluate_conditions(
        evaluation_, inputs_.lubricant, physical_,
        {inputs_.sump_temperature_rise_kelvin, inputs_.inlet_temperature_rise_kelvin}, options_,
        gear_set_, &wanted);
  }
  void add_stated_mean() {
    std::optional<StatedFigures> mean = StatedFigures{};
    for (std::size_t k = 0; k < conditions() && mean; ++k) {
      if (!fluid_.stated[k]) {
        mean.reset();
        break;
      }
      const StatedFigures& each = *fluid_.stated[k];
      mean->contact_loss = mean->contact_loss || each.contact_loss;
      for (std::size_t f = 0; f < kComparedFigures; ++f) {
        mean->value[f] += weights_[k] * each.value[f];
        mean->solver_error[f] += weights_[k] * each.solver_error[f];
      }
    }
    fluid_.stated.push_back(mean);
  }
  void add_mean(ValuesByCondition& values) const {
    std::optional<FigureValues> mean = FigureValues{};
    for (std::size_t k = 0; k < weights_.size() && mean; ++k) {
      if (!values[k]) {
        mean.reset();
        break;
      }
      for (std::size_t f = 0; f < kComparedFigures; ++f)
        (*mean)[f] += weights_[k] * (*values[k])[f];
    }
    values.push_back(mean);
  }
  /// Of one deviation; where the model refuses one side, of the other side alone.
  std::vector<FigureValues> effects(const ValuesByCondition& plus,
                                    const ValuesByCondition& minus) const {
    std::vector<FigureValues> out(plus.size());
    for (std::size_t k = 0; k < plus.size(); ++k) {
      if (!fluid_.stated[k] || (!plus[k] && !minus[k])) continue;
      const FigureValues& high = plus[k] ? *plus[k] : fluid_.stated[k]->value;
      const FigureValues& low = minus[k] ? *minus[k] : fluid_.stated[k]->value;
      const double sides = plus[k] && minus[k] ? 2 : 1;
      for (std::size_t f = 0; f < kComparedFigures; ++f) out[k][f] = (high[f] - low[f]) / sides;
    }
    return out;
  }

  const std::vector<double>& weights_;
  const PointEvaluation& evaluation_;
  const NormalDraws& draws_;
  std::shared_ptr<PreparedGearSet> gear_set_;
  Scene physical_;
  PointOptions options_;
  UncertainInputs inputs_;
  ComputedFluid& fluid_;
  std::vector<std::pair<std::size_t, std::size_t>> moved_;  // source and deviation
  std::vector<ValuesByCondition> values_;                   // by row
  std::vector<Flags> is_solved_;                            // by row
};

/// Returns the ratio of the errors of left-out draws to the largest allowed: above 1 the fit fails.
/// `column` are the numbers that are predicted.
double misfit(const Eigen::VectorXd& left_out_errors, const Eigen::VectorXd& column,
              double solver_error) {
  const double rows = static_cast<double>(column.size());
  const double error = std::sqrt(left_out_errors.squaredNorm() / rows);
  const double variance = (column.array() - column.mean()).square().sum() / (rows - 1);
  const double allowed = std::sqrt(square(kLargestError) * variance + square(solver_error));
  if (!std::isfinite(error)) return std::numeric_limits<double>::infinity();
  return error > 0 ? error / allowed : 0;
}

/// Solves as many points as the draws need. The fluids, all uncertain, have the same conditions and
/// draws.
class SharedDraws {
 public:
  SharedDraws(std::vector<FluidRows*> fluids, std::size_t draws)
      : fluids_(std::move(fluids)), draws_(draws), is_full_(fluids_.front()->conditions(), false) {
    for (std::size_t k = 0; k < is_full_.size(); ++k) {
      double work = has_figures(k, {}) ? 1 : std::numeric_limits<double>::infinity();
      for (const FluidRows* fluid : fluids_) work += fluid->work(k);
      work_.push_back(work);
    }
  }

  void solve() {
    const std::size_t conditions = is_full_.size();
    if (conditions < kLeastConditions || draws_ < kLeastDraws) return solve_fully(all());
    const auto work = [this](std::size_t a, std::size_t b) { return work_[a] < work_[b]; };
    std::vector<std::size_t> numbers(conditions);
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    solve_fully(only(*std::min_element(numbers.begin(), numbers.end(), work)));
    if (base_.empty()) return solve_fully(all());
    checked_ = checked_draws();
    for (FluidRows* fluid : fluids_) {
      for (const std::size_t row : checked_) fluid->solve(row, all());
    }
    Flags refused(conditions, false);
    for (std::size_t k = 0; k < conditions; ++k) refused[k] = !has_figures(k, checked_);
    solve_fully(refused);
    while (const auto worst = worst_fit()) solve_fully(only(*worst));
    set_unsolved();
  }

 private:
  Flags all() const { return Flags(is_full_.size(), true); }
  Flags only(std::size_t condition) const {
    Flags out(is_full_.size(), false);
    out[condition] = true;
    return out;
  }

  bool has_figures(std::size_t condition, const std::vector<std::size_t>& rows) const {
    return std::all_of(fluids_.begin(), fluids_.end(), [&](const FluidRows* fluid) {
      return fluid->stated(condition) &&
             std::all_of(rows.begin(), rows.end(),
                         [&](std::size_t row) { return fluid->at(row, condition).has_value(); });
    });
  }
  /// Solves conditions with all draws and moves. Those without a refusal are in the base from then.
  void solve_fully(const Flags& wanted) {
    for (FluidRows* fluid : fluids_) {
      for (std::size_t row = 0; row < fluid->rows(); ++row) fluid->solve(row, wanted);
    }
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (!wanted[k] || is_full_[k]) continue;
      is_full_[k] = true;
      const bool has_all = std::all_of(fluids_.begin(), fluids_.end(), [k](const FluidRows* fluid) {
        for (std::size_t row = 0; row < fluid->rows(); ++row) {
          if (!fluid->at(row, k)) return false;
        }
        return fluid->stated(k).has_value();
      });
      if (has_all) base_.push_back(k);
    }
  }
  /// Returns draws that spread evenly from the least to the largest loss of each fluid.
  std::vector<std::size_t> checked_draws() const {
    const std::size_t of_each =
        std::max(kLeastCheckedDrawsOfAFluid, kCheckedDraws / fluids_.size());
    Flags is_checked(draws_, false);
    for (const FluidRows* fluid : fluids_) {
      std::vector<std::size_t> order(draws_);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return (*fluid->at(a, base_.front()))[kEnergyMean] <
               (*fluid->at(b, base_.front()))[kEnergyMean];
      });
      for (std::size_t i = 0; i < of_each; ++i) {
        is_checked[order[i * (draws_ - 1) / (of_each - 1)]] = true;
      }
    }
    std::vector<std::size_t> out;
    for (std::size_t n = 0; n < draws_; ++n) {
      if (is_checked[n]) out.push_back(n);
    }
    return out;
  }
  /// Returns by how much a figure of a condition differs from its stated value in each checked
  /// draw.
  Eigen::VectorXd changes(const FluidRows& fluid, std::size_t condition, std::size_t figure) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(checked_.size()));
    const double stated = fluid.stated(condition)->value[figure];
    for (std::size_t i = 0; i < checked_.size(); ++i) {
      out(static_cast<Eigen::Index>(i)) = (*fluid.at(checked_[i], condition))[figure] - stated;
    }
    return out;
  }
  /// Returns the bases by figure.
  std::vector<ColumnBase> bases(const FluidRows& fluid) const {
    std::vector<ColumnBase> out;
    Eigen::MatrixXd columns(checked_.size(), base_.size());
    for (std::size_t f = 0; f < fluid.figures(); ++f) {
      for (std::size_t j = 0; j < base_.size(); ++j) {
        columns.col(static_cast<Eigen::Index>(j)) = changes(fluid, base_[j], f);
      }
      out.emplace_back(columns);
    }
    return out;
  }
  /// Returns the condition with the largest misfit; nullopt if all fits are good enough.
  std::optional<std::size_t> worst_fit() const {
    std::vector<std::vector<ColumnBase>> by_fluid;
    for (const FluidRows* fluid : fluids_) by_fluid.push_back(bases(*fluid));
    double largest = 0;
    std::optional<std::size_t> out;
    for (std::size_t k = 0; k < is_full_.size(); ++k) {
      if (is_full_[k]) continue;
      const double found = misfit_at(k, by_fluid);
      if (found <= 1 || found / work_[k] <= largest) continue;
      largest = found / work_[k];
      out = k;
    }
    return out;
  }
  double misfit_at(std::size_t condition,
                   const std::vector<std::vector<ColumnBase>>& by_fluid) const {
    double out = 0;
    std::vector<Eigen::VectorXd> columns, errors;  // of the compared figure, by fluid
    for (std::size_t i = 0; i < fluids_.size(); ++i) {
      const StatedFigures& stated = *fluids_[i]->stated(condition);
      for (std::size_t f = 0; f < fluids_[i]->figures(); ++f) {
        const Eigen::VectorXd column = changes(*fluids_[i], condition, f);
        const ColumnFit fit = by_fluid[i][f].fit(column);
        const double solver_error = std::isnan(stated.solver_error[f]) ? 0 : stated.solver_error[f];
        out = std::max(out, misfit(fit.left_out_errors, column, solver_error));
        if (f != kEnergyMean) continue;
        columns.push_back(column);
        errors.push_back(fit.left_out_errors);
      }
      for (std::size_t j = 0; j < i; ++j) {
        const double solver_error = stated.solver_error[kEnergyMean] +
                                    fluids_[j]->stated(condition)->solver_error[kEnergyMean];
        out = std::max(out, misfit(errors[i] - errors[j], columns[i] - columns[j], solver_error));
      }
    }
    return out;
  }
  void set_unsolved() {
    for (FluidRows* fluid : fluids_) {
      const std::vector<ColumnBase> by_figure = bases(*fluid);
      for (std::size_t k = 0; k < is_full_.size(); ++k) {
        if (is_full_[k]) continue;
        std::vector<Eigen::VectorXd> weights;
        for (std::size_t f = 0; f < by_figure.size(); ++f) {
          weights.push_back(by_figure[f].fit(changes(*fluid, k, f)).weights);
        }
        fluid->set_unsolved(k, base_, weights);
      }
    }
  }

  std::vector<FluidRows*> fluids_;
  std::size_t draws_;
  std::vector<double> work_;          // of a point, by condition; infinite without figures
  Flags is_full_;                     // conditions that are solved with all draws and moves
  std::vector<std::size_t> base_;     // of these, those that no draw or move refuses
  std::vector<std::size_t> checked_;  // draws that are solved at all conditions
};

}  // namespace

void compute_drawn_figures(const PointComparison& comparison, const NormalDraws& draws,
                           const std::shared_ptr<PreparedGearSet>& gear_set,
                           const std::function<bool()>& is_over,
                           std::vector<ComputedFluid>& fluids) {
  std::vector<FluidRows> rows;
  rows.reserve(fluids.size());
  for (std::size_t i = 0; i < fluids.size(); ++i) {
    rows.emplace_back(comparison, comparison.fluids[i].evaluation, draws, gear_set, is_over,
                      fluids[i]);
  }
  std::vector<FluidRows*> uncertain;
  for (FluidRows& each : rows) {
    if (each.is_uncertain()) uncertain.push_back(&each);
  }
  if (!uncertain.empty()) {
    SharedDraws(std::move(uncertain), static_cast<std::size_t>(draws.draws())).solve();
  }
  for (FluidRows& each : rows) each.finish();
}

}  // namespace tribodyn::server
