#include "client/cpp/report/screening_plot.h"

#include <algorithm>
#include <cmath>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kScreeningWidth = 960;
constexpr double kScreeningLeft = 80;
constexpr double kFrontHeight = 420;
constexpr double kEffectHeight = 26;  ///< from one effect to the next
constexpr std::size_t kDrawnEffects = 20;
constexpr char kOtherColour[] = "#9a9a9a";
constexpr char kEffectInk[] = "#444";

std::string shortened_column(const std::string& column, std::size_t width) {
  return column.size() <= width ? column : column.substr(0, width - 3) + "...";
}

Panel front_panel(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                  const ScreeningFront& front, double top) {
  Panel panel;
  panel.corner = {kScreeningLeft, top};
  panel.width = 690;
  panel.height = kFrontHeight;
  panel.title = "Mesh inefficiency, energy mean, %";
  panel.x_title = front.column;
  Series others, base, best;
  others.colour = kOtherColour;
  others.width = 0;
  others.marker = Marker::kCircle;
  for (const CandidateFigures& each : ranking) {
    const double value = front.values[each.candidate];
    if (!each.refusal.empty() || !std::isfinite(value)) continue;
    others.x.push_back(value);
    others.y.push_back(each.inefficiency);
    others.hollow.push_back(each.is_withheld);
  }
  const Look look = look_of(0);
  best.label = "Pareto front";
  best.note = std::string("least loss, ") + (front.wants_most ? "most " : "least ") +
              shortened_column(front.column, 14);
  best.colour = look.colour;
  best.marker = Marker::kCircle;
  for (const std::size_t candidate : front.front) {
    const auto at = std::find_if(ranking.begin(), ranking.end(), [candidate](const auto& each) {
      return each.candidate == candidate;
    });
    best.x.push_back(front.values[candidate]);
    best.y.push_back(at->inefficiency);
  }
  if (best.x.front() > best.x.back()) {  // the label stands at the right end
    std::reverse(best.x.begin(), best.x.end());
    std::reverse(best.y.begin(), best.y.end());
  }
  const CandidateFigures figures = base_figures(screening);
  if (figures.refusal.empty()) panel.line_at = figures.inefficiency;
  panel.series = {others, best};
  return panel;
}

std::string effect_label(const ScreeningEffect& effect) {
  return shortened_column(effect.column, 30) + ": " + effect.from + " to " + effect.to;
}

/// Draws a bar and its interval for each effect about a common zero.
void draw_effects(const ScreeningEffects& effects, double top, Svg& svg) {
  constexpr double kLeft = 380, kRight = kScreeningWidth - 60;
  const std::size_t count = std::min(effects.effects.size(), kDrawnEffects);
  double low = 0, high = 0;
  for (std::size_t i = 0; i < count; ++i) {
    low = std::min(low, effects.effects[i].low);
    high = std::max(high, effects.effects[i].high);
  }
  const std::vector<double> ticks = nice_ticks(low, high, 6);
  const std::vector<std::string> labels = tick_labels(ticks);
  const double bottom = top + kEffectHeight * static_cast<double>(count);
  const auto at = [&](double value) {
    return kLeft + (kRight - kLeft) * (value - ticks.front()) / (ticks.back() - ticks.front());
  };
  svg.text({kScreeningLeft, top - 10},
           "Main effects on the mean inefficiency, percentage points, with 95 % intervals",
           {13, "start", "#222", true, 0});
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    svg.line({at(ticks[i]), top}, {at(ticks[i]), bottom}, {"#e4e4e4", 1, ""});
    svg.text({at(ticks[i]), bottom + 18}, labels[i], {12, "middle", kEffectInk, false, 0});
  }
  svg.line({at(0), top}, {at(0), bottom}, {kEffectInk, 1, ""});
  const Look look = look_of(0);
  for (std::size_t i = 0; i < count; ++i) {
    const ScreeningEffect& each = effects.effects[i];
    const double y = top + kEffectHeight * (static_cast<double>(i) + 0.5);
    const bool is_clear = each.low > 0 || each.high < 0;
    const double start = std::min(at(0), at(each.effect)), end = std::max(at(0), at(each.effect));
    svg.rectangle({start, y - 7}, end - start, 14, is_clear ? look.colour : kOtherColour, 0.75);
    svg.line({at(each.low), y}, {at(each.high), y}, {"#222", 1.5, ""});
    for (const double edge : {each.low, each.high}) {
      svg.line({at(edge), y - 4}, {at(edge), y + 4}, {"#222", 1.5, ""});
    }
    svg.text({kLeft - 10, y + 4}, effect_label(each), {12, "end", kEffectInk, false, 0});
  }
}

std::vector<std::string> screening_footer(const Screening& screening,
                                          const std::vector<CandidateFigures>& ranking,
                                          const ScreeningFront* front,
                                          const ScreeningEffects* effects) {
  const auto with_figures = std::count_if(ranking.begin(), ranking.end(),
                                          [](const auto& each) { return each.refusal.empty(); });
  std::vector<std::string> out;
  out.push_back(std::to_string(with_figures) + " candidates like " +
                resource_id(screening.base.lubricant_revision()) + " at " +
                std::to_string(screening.conditions()) +
                (screening.conditions() == 1 ? " condition." : " conditions, weighted mean.") +
                (front != nullptr ? " Dotted: the base." : "") +
                (front != nullptr && !withheld_by(screening.warnings).empty()
                     ? " Hollow: a warning withholds the verdict."
                     : ""));
  if (effects != nullptr) {
    out.push_back("A linear model without interactions explains " +
                  fixed(100 * effects->explained_share, 1) +
                  " % of the variance. Grey: cannot be told from zero." +
                  (effects->effects.size() > kDrawnEffects
                       ? " The " + std::to_string(kDrawnEffects) + " largest effects."
                       : ""));
  }
  if (!screening.base.not_included().empty()) out.push_back(screening.base.not_included());
  for (std::string& each : warning_footers(screening.warnings)) out.push_back(std::move(each));
  out.push_back("Model version " + screening.base.model_version() + "; hash of inputs " +
                screening.input_hash.substr(0, 12) + ".");
  return out;
}

}  // namespace

std::string screening_plot(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                           const ScreeningFront* front, const ScreeningEffects* effects) {
  constexpr double kFrontTop = 90;
  const double effects_top = kFrontTop + (front == nullptr ? 0 : kFrontHeight + 96);
  const std::size_t drawn =
      effects == nullptr ? 0 : std::min(effects->effects.size(), kDrawnEffects);
  const double footer_top = effects == nullptr
                                ? kFrontTop + kFrontHeight + 66
                                : effects_top + kEffectHeight * static_cast<double>(drawn) + 50;
  const std::vector<std::string> lines = footer_lines(
      screening_footer(screening, ranking, front, effects), kScreeningWidth - 2 * kScreeningLeft);
  Svg svg(kScreeningWidth, footer_top + kFooterPitch * static_cast<double>(lines.size()));
  svg.text({kScreeningLeft, 40}, "Screening", {21, "start", "#111", true, 0});
  if (front != nullptr) draw_panel(front_panel(screening, ranking, *front, kFrontTop), svg);
  if (effects != nullptr) draw_effects(*effects, effects_top, svg);
  draw_footer(lines, {kScreeningLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
