#include "client/cpp/report/comparison_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

constexpr int kListedShares = 4;
constexpr double kSmallestListedShare = 0.01;
/// Largest relative difference of standard uncertainties by the linear model and by the draws with
/// which the report calls the linear model enough.
constexpr double kLinearEnough = 0.1;
constexpr char kNotStated[] = "not stated";

/// Returns the decimal places with which an error has two significant digits.
int decimals_for(double error) {
  if (!(error > 0) || !std::isfinite(error)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
}

int error_decimals(const v1::UncertainFigure& figure) {
  // std::max returns the first argument if the second one is NaN.
  return decimals_for(std::max(figure.standard_uncertainty(), figure.solver_error()));
}

std::string value_text(const v1::UncertainFigure& figure) {
  return fixed(figure.value(), error_decimals(figure));
}

/// Returns what the inputs leave open with a probability of 95 %: the half width of the interval,
/// or the interval where it is asymmetric.
std::string spread_text(const v1::UncertainFigure& figure) {
  constexpr double kAsymmetric = 0.1;  // of the half width
  const double half = 0.5 * (figure.interval_maximum() - figure.interval_minimum());
  const double middle = 0.5 * (figure.interval_maximum() + figure.interval_minimum());
  const int decimals = error_decimals(figure);
  return std::abs(middle - figure.value()) > kAsymmetric * half
             ? fixed(figure.interval_minimum(), decimals) + " to " +
                   fixed(figure.interval_maximum(), decimals)
             : fixed(half, decimals);
}

/// Returns the same for a figure of a lubricant.
std::string spread_text(const v1::ComparedLubricant& lubricant, const v1::UncertainFigure& figure) {
  return lubricant.uncertainty_stated() ? spread_text(figure) : kNotStated;
}

std::string solver_error_text(const v1::UncertainFigure& figure) {
  return fixed(figure.solver_error(), decimals_for(figure.solver_error()));
}

std::string interval_text(const v1::UncertainFigure& figure) {
  const int decimals = error_decimals(figure);
  return fixed(figure.interval_minimum(), decimals) + " to " +
         fixed(figure.interval_maximum(), decimals);
}

std::string share_text(double share) {
  if (std::isnan(share)) return "-";
  const double percent = 100 * share;
  if (percent > 99.5 && share < 1) return "> 99 %";
  if (percent < 0.5 && share > 0) return "< 1 %";
  return fixed(percent, 0) + " %";
}

template <class Shares>
std::string shares_text(const Shares& shares) {
  std::vector<std::string> parts;
  for (const v1::InputShare& share : shares) {
    if (static_cast<int>(parts.size()) == kListedShares) break;
    if (share.variance_share() < kSmallestListedShare) break;
    const std::string& of = share.lubricant_revision();
    parts.push_back(input_text(share.input()) + (of.empty() ? "" : " of " + resource_id(of)) + " " +
                    share_text(share.variance_share()));
  }
  return joined(parts, ", ");
}

/// Returns what to measure; empty if no input has an uncertainty.
template <class Shares>
std::string advice_text(const Shares& shares) {
  if (shares.empty() || !(shares[0].variance_share() > 0)) return "";
  const std::string of = shares[0].lubricant_revision();
  return "The inputs that make the variance: " + shares_text(shares) +
         ". To know better, measure first: " + input_text(shares[0].input()) +
         (of.empty() ? "" : " of " + resource_id(of)) + ".";
}

std::string linearity_text(const v1::UncertainFigure& figure, int draws) {
  const double linear = figure.linear_standard_uncertainty(), drawn = figure.standard_uncertainty();
  if (!(drawn > 0)) return "";
  const bool is_enough = std::abs(linear - drawn) <= kLinearEnough * drawn;
  return "The standard uncertainty comes from " + std::to_string(draws) +
         " draws of all inputs. The linear model gives " + fixed(linear, decimals_for(linear)) +
         (is_enough ? ": it is enough here." : ": it is not enough here; trust the draws.");
}

/// Returns the words for a warning that withholds a verdict on one of the lubricants at condition
/// k, or at any condition if k is below 0; empty if none does.
std::string summary_withholding(const std::vector<const v1::ComparedLubricant*>& lubricants,
                                int k = -1) {
  for (const v1::ComparedLubricant* lubricant : lubricants) {
    for (int i = std::max(k, 0); i < (k < 0 ? lubricant->points_size() : k + 1); ++i) {
      std::string summary = withheld_by(lubricant->points(i).warnings());
      if (!summary.empty()) return summary;
    }
  }
  return "";
}

/// Returns an input of a difference with its owner, e.g. "relaxation time of both".
template <class Input>
std::string owned_input_text(const Input& input) {
  const std::string& of = input.lubricant_revision();
  const bool is_of_both = of.empty() && input.input().starts_with("lubricant.");
  return input_text(input.input()) + (is_of_both   ? " of both"
                                      : of.empty() ? ""
                                                   : " of " + resource_id(of));
}

/// Returns e.g. "pressure viscosity coefficient of both with a standard uncertainty of 0.4 1/GPa
/// (now 2.1)".
std::string deciding_input_text(const v1::DecidingInput& input) {
  const std::string field = input.input().substr(input.input().rfind('.') + 1);
  const std::string start = owned_input_text(input) + " with ";
  if (input.input().find(' ') != std::string::npos || !(input.standard_uncertainty() > 0)) {
    return start + significant(input.factor(), 2) + " times the present uncertainty";
  }
  const std::string unit = trade_unit_of_field(field);
  const auto shown = [&field](double value) {
    return significant(difference_in_trade_unit(field, value), 2);
  };
  return start + "a standard uncertainty of " + shown(input.standard_uncertainty()) +
         (unit.empty() ? "" : " " + unit) +
         (input.factor() > 0 ? " (now " + shown(input.standard_uncertainty() / input.factor()) + ")"
                             : "");
}

/// Returns what would tell two lubricants apart; empty if they can be or nothing is known of it.
std::string deciding_text(const v1::ComparedDifference& difference, const std::string& name,
                          const std::string& other) {
  if (difference.verdict() != v1::ComparedDifference::CANNOT_BE_TOLD_APART) return "";
  if (difference.deciding_inputs().empty()) {
    return "No input, known better, would tell " + name + " from " + other +
           ": the difference is too small.";
  }
  std::vector<std::string> inputs;
  for (const v1::DecidingInput& each : difference.deciding_inputs()) {
    inputs.push_back(deciding_input_text(each));
  }
  return "What would tell " + name + " from " + other +
         (difference.all_needed() ? ", all of it together: " + joined(inputs, " and ")
                                  : ": " + joined(inputs, "; or ")) +
         ".";
}

double sump_of(const v1::PointCondition& condition) {
  return condition.has_sump_temperature_celsius() ? condition.sump_temperature_celsius() : 40;
}

std::string lubricant_id(const v1::ComparedLubricant& lubricant) {
  return resource_id(lubricant.lubricant_revision());
}

/// Returns why a difference is not known.
std::string no_difference_text(const v1::ComparePointsRequest& request,
                               const v1::ComparedLubricant& one,
                               const v1::ComparedLubricant& other) {
  std::vector<std::string> causes;
  for (const v1::ComparedLubricant* each : {&one, &other}) {
    const std::string refusal = refusal_text(request, *each);
    if (!refusal.empty()) causes.push_back("no figure of " + lubricant_id(*each) + ": " + refusal);
  }
  return causes.empty() ? "too many draws are refused" : joined(causes, "; ");
}

/// Returns the sentence on a difference; `withheld`: by which warning; `missing`: why there is
/// none.
std::string difference_sentence(const v1::ComparedDifference& difference, const std::string& name,
                                const std::string& first, int conditions,
                                const std::string& withheld, const std::string& missing) {
  const v1::UncertainFigure& figure = difference.difference_percent();
  const std::string where =
      conditions == 1 ? "" : "Mean of " + std::to_string(conditions) + " conditions: ";
  const std::string numbers =
      value_text(figure) + " percentage points (95 %: " + interval_text(figure) + ")";
  const std::string probability = " Probability that " + name +
                                  " loses less: " + share_text(difference.lower_probability()) +
                                  ".";
  const std::string bare =
      name + " less " + first + " is " + value_text(figure) + " percentage points";
  switch (difference.verdict()) {
    case v1::ComparedDifference::LOWER:
      return where + name + " loses less than " + first + ": " + numbers + "." + probability;
    case v1::ComparedDifference::HIGHER:
      return where + name + " loses more than " + first + ": " + numbers + "." + probability;
    case v1::ComparedDifference::CANNOT_BE_TOLD_APART:
      return where + "these two cannot be told apart: " + name + " less " + first + " is " +
             numbers + "." + probability;
    case v1::ComparedDifference::WITHHELD:
      return where + "verdict " + withheld_text(withheld) +
             (difference.has_difference_percent() ? ". " + bare + ", which decides nothing." : ".");
    case v1::ComparedDifference::UNCERTAINTY_NOT_STATED:
      return where + bare +
             "; how sure that is is not known, because nobody stated an uncertainty of one of the "
             "two.";
    default:
      return "No difference of " + name + " and " + first + ": " + missing + ".";
  }
}

std::string table_of(const v1::ComparePointsRequest& request, const v1::ComparedLubricant& first,
                     const v1::ComparedLubricant* other) {
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"speed", "km/h", Align::kDecimal},
                                        {"sump", "C", Align::kDecimal},
                                        {lubricant_id(first), "%", Align::kDecimal},
                                        {"+/- 95 %", "%", Align::kDecimal},
                                        {"solver error", "%", Align::kDecimal}};
  if (other == nullptr) {
    columns.push_back({"95 % interval", "%", Align::kRight});
  } else {
    columns.insert(columns.end(), {{lubricant_id(*other), "%", Align::kDecimal},
                                   {"+/- 95 %", "%", Align::kDecimal},
                                   {"solver error", "%", Align::kDecimal},
                                   {"difference", "%", Align::kDecimal},
                                   {"95 % interval", "%", Align::kRight},
                                   {"P(lower)", "", Align::kRight},
                                   {"verdict", "", Align::kLeft}});
  }
  Table table(columns);
  for (int k = 0; k < first.points_size(); ++k) {
    const v1::PointCondition& condition = request.conditions(k);
    std::vector<std::string> row = {significant(condition.speed_kilometres_per_hour()),
                                    significant(sump_of(condition))};
    std::string refusal;
    const auto add = [&](const v1::ComparedLubricant& lubricant) {
      const v1::ComparedPoint& point = lubricant.points(k);
      const v1::UncertainFigure& figure = point.inefficiency_energy_mean_percent();
      if (!point.refusal_reason().empty()) {
        row.insert(row.end(), {"-", "-", "-"});
        refusal = "no figure: " + point.refusal_message();
      } else {
        row.insert(row.end(),
                   {value_text(figure), spread_text(lubricant, figure), solver_error_text(figure)});
      }
    };
    add(first);
    if (other == nullptr) {
      row.push_back(refusal.empty()
                        ? interval_text(first.points(k).inefficiency_energy_mean_percent())
                        : refusal);
    } else {
      add(*other);
      const v1::ComparedDifference& difference = other->differences(k);
      const bool has_difference = difference.has_difference_percent();
      const v1::UncertainFigure& figure = difference.difference_percent();
      row.insert(row.end(), {has_difference ? value_text(figure) : "-",
                             states_interval(difference) ? interval_text(figure) : "-",
                             has_difference ? share_text(difference.lower_probability()) : "-",
                             refusal.empty()
                                 ? verdict_text(difference, summary_withholding({&first, other}, k))
                                 : refusal});
    }
    table.add_row(row);
  }
  return table.text();
}

/// Returns the lubricants with a mean, least first; those whose verdict a warning withholds follow.
std::vector<const v1::ComparedLubricant*> ranked(const v1::ComparePointsResponse& response) {
  std::vector<const v1::ComparedLubricant*> out;
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    if (each.has_mean_inefficiency_percent()) out.push_back(&each);
  }
  const auto key = [](const v1::ComparedLubricant* each) {
    return std::pair(!summary_withholding({each}).empty(),
                     each->mean_inefficiency_percent().value());
  };
  std::stable_sort(out.begin(), out.end(),
                   [&key](const auto* a, const auto* b) { return key(a) < key(b); });
  return out;
}

/// Whether two or more lubricants take part in the probabilities of being the best.
bool has_probabilities(const std::vector<const v1::ComparedLubricant*>& ranked) {
  return std::count_if(ranked.begin(), ranked.end(), [](const v1::ComparedLubricant* each) {
           return !std::isnan(each->best_probability());
         }) > 1;
}

/// Returns the sentence that names the lubricant with the least mean loss, and what its difference
/// from each other one amounts to.
std::string best_sentence(const std::vector<const v1::ComparedLubricant*>& ranked) {
  const std::string withheld = summary_withholding({ranked.front()});
  if (!withheld.empty()) return "Which one is the best is " + withheld_text(withheld) + ".";
  std::map<v1::ComparedDifference::Verdict, std::vector<std::string>> names;
  for (const v1::ComparedLubricant* each : ranked) {
    if (!each->has_mean_difference_from_best()) continue;
    names[each->mean_difference_from_best().verdict()].push_back(lubricant_id(*each));
  }
  const std::string best = lubricant_id(*ranked.front());
  if (ranked.size() == 1) return best + " alone has a figure.";
  const double probability = ranked.front()->best_probability();
  const bool has_probability = has_probabilities(ranked) && !std::isnan(probability);
  const auto listed = [&names](v1::ComparedDifference::Verdict verdict, const char* one,
                               const char* several) {
    const std::vector<std::string>& all = names[verdict];
    return all.empty() ? std::string()
                       : " " + joined(all, ", ") + (all.size() == 1 ? one : several);
  };
  const bool is_sure = names[v1::ComparedDifference::CANNOT_BE_TOLD_APART].empty() &&
                       names[v1::ComparedDifference::UNCERTAINTY_NOT_STATED].empty();
  return (is_sure ? best + " loses least"
                  : "Which one is the best is not sure: " + best + " has the least mean") +
         (has_probability ? "; probability that it is the best of all: " + share_text(probability)
                          : std::string()) +
         "." +
         listed(v1::ComparedDifference::CANNOT_BE_TOLD_APART, " cannot be told apart from it.",
                " cannot be told apart from it.") +
         listed(v1::ComparedDifference::HIGHER, " loses more.", " lose more.") +
         listed(v1::ComparedDifference::UNCERTAINTY_NOT_STATED,
                ": uncertainty not stated, and so no verdict.",
                ": uncertainty not stated, and so no verdict.") +
         listed(v1::ComparedDifference::WITHHELD, ": verdict withheld.", ": verdict withheld.");
}

/// Returns what would tell the best lubricant from the next one that ties with it; empty if none
/// does.
std::string deciding_text(const std::vector<const v1::ComparedLubricant*>& ranked) {
  for (const v1::ComparedLubricant* each : ranked) {
    std::string text = deciding_text(each->mean_difference_from_best(), lubricant_id(*each),
                                     lubricant_id(*ranked.front()));
    if (!text.empty()) return text;
  }
  return "";
}

std::string ranking_table(const v1::ComparePointsRequest& request,
                          const v1::ComparePointsResponse& response,
                          const std::vector<const v1::ComparedLubricant*>& ranked) {
  using Align = Table::Align;
  const bool has_best = has_probabilities(ranked);
  Table table({{"rank", "", Align::kRight},
               {"lubricant", "", Align::kLeft},
               {"mean", "%", Align::kDecimal},
               {"+/- 95 %", "%", Align::kDecimal},
               {"P(best)", "", Align::kRight},
               {"more than the best", "% points", Align::kDecimal},
               {"95 % interval", "% points", Align::kRight},
               {"against the best", "", Align::kLeft}});
  int rank = 0;
  for (const v1::ComparedLubricant* each : ranked) {
    const v1::UncertainFigure& mean = each->mean_inefficiency_percent();
    const v1::ComparedDifference& difference = each->mean_difference_from_best();
    const bool has_difference = difference.has_difference_percent();
    const std::string withheld = summary_withholding({each});
    table.add_row(
        {std::to_string(++rank), lubricant_id(*each), value_text(mean), spread_text(*each, mean),
         has_best ? share_text(each->best_probability()) : "-",
         has_difference ? value_text(difference.difference_percent()) : "",
         states_interval(difference) ? interval_text(difference.difference_percent()) : "",
         !withheld.empty()                        ? withheld_text(withheld)
         : !each->has_mean_difference_from_best() ? "the best"
                                                  : verdict_text(difference, "")});
  }
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    if (each.has_mean_inefficiency_percent()) continue;
    const std::string refusal = refusal_text(request, each);
    table.add_row({"-", lubricant_id(each), "-", "-", "-", "", "",
                   "no figure" + (refusal.empty() ? "" : ": " + refusal)});
  }
  return table.text();
}

/// Returns the sump temperatures of a request, each once.
std::vector<double> sumps_of(const v1::ComparePointsRequest& request) {
  std::vector<double> out;
  for (const v1::PointCondition& each : request.conditions()) {
    const double sump = sump_of(each);
    if (std::find(out.begin(), out.end(), sump) == out.end()) out.push_back(sump);
  }
  return out;
}

/// Returns the flags of speeds and weights of a request at one sump temperature.
std::string speed_flags(const v1::ComparePointsRequest& request, double sump) {
  std::vector<std::string> speeds, weights;
  for (int k = 0; k < request.conditions_size(); ++k) {
    if (sump_of(request.conditions(k)) != sump) continue;
    speeds.push_back(shortest(request.conditions(k).speed_kilometres_per_hour()));
    if (k < request.condition_weights_size()) {
      weights.push_back(shortest(request.condition_weights(k)));
    }
  }
  const bool are_equal =
      std::adjacent_find(weights.begin(), weights.end(), std::not_equal_to<>()) == weights.end();
  return " --speed " + joined(speeds, ",") +
         (are_equal ? "" : " --weights " + joined(weights, ","));
}

/// Returns the flags of the scene of a request at one sump temperature.
std::string scene_flags(const v1::ComparePointsRequest& request, double sump) {
  std::string out;
  const v1::PointCondition& first = request.conditions(0);
  if (first.has_sump_temperature_celsius()) out += " --sump " + shortest(sump);
  if (first.ascent_angle_degrees() != 0) {
    out += " --ascent " + shortest(first.ascent_angle_degrees());
  }
  if (first.has_inlet_temperature_rise_kelvin()) {
    out += " --inlet-temperature-rise-kelvin " + shortest(first.inlet_temperature_rise_kelvin());
  }
  for (const auto& [flag, name] :
       {std::pair{" --gear-set ", request.gear_set()}, std::pair{" --surface ", request.surface()},
        std::pair{" --vehicle ", request.vehicle()}}) {
    if (!name.empty()) out += flag + resource_id(name);
  }
  return out + (request.sheared_lubricant() ? " --condition sheared" : "");
}

/// Returns the commands that go on from a comparison at each sump temperature: why the best differs
/// from the second and the last, and the page of all.
std::string next_commands(const v1::ComparePointsRequest& request,
                          const std::vector<const v1::ComparedLubricant*>& ranked) {
  if (ranked.size() < 2) return "";
  std::string all, why, pages;
  for (const std::string& each : request.lubricants()) all += " " + resource_id(each);
  const std::vector<double> sumps = sumps_of(request);
  for (const double sump : sumps) {
    const std::string scene = scene_flags(request, sump);
    std::vector<const v1::ComparedLubricant*> others = {ranked[1]};
    if (ranked.size() > 2) others.push_back(ranked.back());
    for (const v1::ComparedLubricant* other : others) {
      why += "  tribodyn explain " + lubricant_id(*ranked[0]) + " " + lubricant_id(*other) +
             speed_flags(request, sump) + scene +
             (request.sheared_lubricant() ? " --other-condition sheared" : "") + "\n";
    }
    pages += "  tribodyn report" + all + scene + " --html report" +
             (sumps.size() == 1 ? "" : "-" + shortest(sump)) + ".html\n";
  }
  return "Why they differ:\n" + why + "All of it on one page, with plots:\n" + pages;
}

/// Returns the figure times `factor`, plus `offset`.
v1::UncertainFigure scaled(v1::UncertainFigure figure, double factor, double offset) {
  figure.set_value(factor * figure.value() + offset);
  figure.set_interval_minimum(factor * figure.interval_minimum() + offset);
  figure.set_interval_maximum(factor * figure.interval_maximum() + offset);
  figure.set_standard_uncertainty(factor * figure.standard_uncertainty());
  figure.set_linear_standard_uncertainty(factor * figure.linear_standard_uncertainty());
  figure.set_solver_error(factor * figure.solver_error());
  return figure;
}

template <class Inputs>
std::string inputs_text_of(const Inputs& inputs) {
  std::vector<std::string> labels;
  for (const std::string& input : inputs) labels.push_back(input_text(input));
  return joined(labels, ", ");
}

/// Adds the fields that count as exact.
void add_exact_inputs(const v1::ComparePointsResponse& response, Sheet& sheet) {
  for (const v1::ComparedLubricant& lubricant : response.lubricants()) {
    if (lubricant.inputs_without_uncertainty().empty()) continue;
    sheet.remark("Taken as exact, because no uncertainty is stated, of " + lubricant_id(lubricant) +
                 ": " + inputs_text_of(lubricant.inputs_without_uncertainty()) + ".");
  }
  if (!response.inputs_without_uncertainty().empty()) {
    sheet.remark("Taken as exact, because no uncertainty is stated, of the scene: " +
                 inputs_text_of(response.inputs_without_uncertainty()) + ".");
  }
}

/// Returns e.g. "60" of one sump temperature, "60 km/h at 90 C" of several.
std::string place_text(const v1::PointCondition& condition, bool has_sumps) {
  const std::string speed = significant(condition.speed_kilometres_per_hour());
  return has_sumps ? speed + " km/h at " + significant(sump_of(condition)) + " C" : speed;
}

}  // namespace

std::string verdict_text(const v1::ComparedDifference& difference, const std::string& withheld) {
  switch (difference.verdict()) {
    case v1::ComparedDifference::LOWER:
      return "loses less";
    case v1::ComparedDifference::HIGHER:
      return "loses more";
    case v1::ComparedDifference::CANNOT_BE_TOLD_APART:
      return "cannot be told apart";
    case v1::ComparedDifference::WITHHELD:
      return withheld_text(withheld);
    case v1::ComparedDifference::UNCERTAINTY_NOT_STATED:
      return "uncertainty not stated";
    default:
      return "-";
  }
}

bool states_interval(const v1::ComparedDifference& difference) {
  return difference.has_difference_percent() &&
         difference.verdict() != v1::ComparedDifference::WITHHELD &&
         difference.verdict() != v1::ComparedDifference::UNCERTAINTY_NOT_STATED;
}

std::string refusal_text(const v1::ComparePointsRequest& request,
                         const v1::ComparedLubricant& lubricant) {
  for (int k = 0; k < lubricant.points_size(); ++k) {
    const std::string& message = lubricant.points(k).refusal_message();
    if (lubricant.points(k).refusal_reason().empty()) continue;
    const v1::PointCondition& at = request.conditions(k);
    return lubricant.points_size() == 1
               ? message
               : message + " (at " + significant(at.speed_kilometres_per_hour()) + " km/h and " +
                     significant(sump_of(at)) + " C)";
  }
  return "";
}

std::string withheld_by(const v1::ComparedLubricant& one, const v1::ComparedLubricant& other) {
  return summary_withholding({&one, &other});
}

std::vector<ShownWarning> comparison_warnings(const v1::ComparePointsRequest& request,
                                              const v1::ComparePointsResponse& response) {
  const bool has_sumps = sumps_of(request).size() > 1;
  std::vector<std::string> places, names;
  for (const v1::PointCondition& each : request.conditions()) {
    places.push_back(place_text(each, has_sumps));
  }
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    names.push_back(lubricant_id(each));
  }
  WarningCollector out(places, has_sumps ? "" : "km/h", "all conditions", names);
  for (int i = 0; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& lubricant = response.lubricants(i);
    for (int k = 0; k < lubricant.points_size(); ++k) {
      out.add(lubricant.points(k).warnings(), static_cast<std::size_t>(i),
              static_cast<std::size_t>(k));
    }
  }
  return out.warnings();
}

std::string input_text(const std::string& input) {
  std::vector<std::string> labels;
  for (const std::string& field : split(input, ' ')) {
    labels.push_back(label_of_field(field.substr(field.rfind('.') + 1)));
  }
  if (labels.size() == 3) return "fitted viscosity law";
  if (labels.size() == 2) return "density law";
  return joined(labels, ", ");
}

std::string with_errors(const v1::UncertainFigure& figure, const std::string& unit) {
  const std::string unit_text = unit.empty() ? "" : " " + unit;
  return value_text(figure) + unit_text + ", " + input_error_text(figure) +
         (std::isnan(figure.solver_error())
              ? ""
              : "; solver error " + solver_error_text(figure) + unit_text);
}

std::string comparison_report(const v1::ComparePointsRequest& request,
                              const v1::ComparePointsResponse& response) {
  const v1::ComparedLubricant& first = response.lubricants(0);
  const int conditions = first.points_size();
  std::string out;
  const auto title = [](const std::string& text) {
    Sheet sheet;
    sheet.heading(text);
    return sheet.text();
  };
  Sheet sheet;
  if (response.lubricants_size() == 1) {
    out += title("Inefficiency, energy mean, of " + lubricant_id(first)) +
           table_of(request, first, nullptr) + "\n";
    sheet.heading("Uncertainty");
    if (first.has_mean_inefficiency_percent()) {
      const v1::UncertainFigure& mean = first.mean_inefficiency_percent();
      if (conditions > 1) {
        sheet.remark("Mean of " + std::to_string(conditions) +
                     " conditions: " + with_errors(mean, "%") + ".");
      }
      sheet.remark(linearity_text(mean, response.draws()));
      sheet.remark(advice_text(first.mean_shares()));
    }
  }
  const std::vector<const v1::ComparedLubricant*> order = ranked(response);
  if (response.lubricants_size() > 2 && !order.empty()) {
    out += title("Ranking by the mean inefficiency, energy mean" +
                 (conditions == 1 ? std::string()
                                  : ", of " + std::to_string(conditions) + " conditions")) +
           ranking_table(request, response, order) + "\n";
    Sheet best;
    best.remark(best_sentence(order));
    best.remark(deciding_text(order));
    out += best.text() + "\n";
  }
  for (int i = 1; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& other = response.lubricants(i);
    out += title("Inefficiency, energy mean: " + lubricant_id(other) + " less " +
                 lubricant_id(first)) +
           table_of(request, first, &other) + "\n";
    sheet.heading(lubricant_id(other) + " against " + lubricant_id(first));
    const v1::ComparedDifference& mean = other.mean_difference();
    sheet.remark(difference_sentence(mean, lubricant_id(other), lubricant_id(first), conditions,
                                     summary_withholding({&first, &other}),
                                     no_difference_text(request, first, other)));
    if (states_interval(mean)) {
      sheet.remark(linearity_text(mean.difference_percent(), response.draws()));
      sheet.remark(advice_text(mean.shares()));
      sheet.remark(deciding_text(mean, lubricant_id(other), lubricant_id(first)));
    }
  }
  add_warnings(comparison_warnings(request, response), sheet);
  sheet.heading("What is common, and what is not");
  sheet.remark(response.not_included());
  sheet.remark(
      "Errors of the scene are common to all lubricants, measured values of two lubricants are "
      "independent, and estimates of one class of base oil by one estimator are correlated by " +
      significant(response.estimate_correlation()) +
      " (assumed; --estimate-correlation sets it). Intervals of differences include the solver's "
      "error.");
  add_exact_inputs(response, sheet);
  const std::string next = next_commands(request, order);
  return out + sheet.text() + (next.empty() ? "" : "\n" + next);
}

std::string comparison_csv(const v1::ComparePointsRequest& request,
                           const v1::ComparePointsResponse& response) {
  std::vector<CsvRow> rows;
  for (const v1::ComparedLubricant& lubricant : response.lubricants()) {
    for (int k = 0; k < lubricant.points_size(); ++k) {
      CsvRow row;
      row.emplace_back("lubricant", lubricant.lubricant_revision());
      row.emplace_back("uncertainty_stated", lubricant.uncertainty_stated() ? "true" : "false");
      append_fields(request.conditions(k), "condition.", row);
      v1::ComparedPoint point = lubricant.points(k);
      point.clear_shares();
      append_fields(point, "", row);
      v1::ComparedDifference difference;
      if (k < lubricant.differences_size()) difference = lubricant.differences(k);
      difference.clear_shares();
      difference.clear_deciding_inputs();
      append_fields(difference, "difference.", row);
      rows.push_back(std::move(row));
    }
  }
  return csv_text(rows);
}

void add_contact_uncertainty(const v1::EvaluateContactResponse& contact, Sheet& sheet) {
  if (contact.uncertainties().empty() && contact.inputs_without_uncertainty().empty()) return;
  sheet.heading("Uncertainty");
  for (const v1::UncertainContactFigure& each : contact.uncertainties()) {
    if (each.figure() != "friction_coefficient") continue;
    sheet.remark("friction coefficient: " + with_errors(each.value(), ""));
    sheet.remark(advice_text(contact.friction_shares()));
  }
  if (!contact.inputs_without_uncertainty().empty()) {
    sheet.remark("Taken as exact, because no uncertainty is stated: " +
                 inputs_text_of(contact.inputs_without_uncertainty()) + ".");
  }
}

std::string uncertainty_report(const v1::ComparePointsResponse& response) {
  const v1::ComparedLubricant& lubricant = response.lubricants(0);
  const v1::ComparedPoint& point = lubricant.points(0);
  if (!point.refusal_reason().empty()) return "";
  Sheet sheet;
  sheet.heading("Uncertainty");
  const auto line = [&](const char* label, v1::UncertainFigure figure, const char* unit) {
    // The figures of the point state their own: this is another, sharper solution.
    figure.set_solver_error(std::nan(""));
    if (!lubricant.uncertainty_stated()) figure.set_standard_uncertainty(0);
    sheet.remark(std::string(label) + ": " + with_errors(figure, unit));
  };
  line("inefficiency, energy mean", point.inefficiency_energy_mean_percent(), "%");
  line("inefficiency, RMS", point.inefficiency_rms_percent(), "%");
  line("mesh loss", point.mesh_loss_power_watts(), "W");
  line("pinion torque", point.pinion_torque_newton_metres(), "N m");
  line("transmission error (DTE), minimum",
       scaled(point.dynamic_transmission_error_minimum_metres(), 1e6, 0), "um");
  line("transmission error (DTE), maximum",
       scaled(point.dynamic_transmission_error_maximum_metres(), 1e6, 0), "um");
  if (point.has_film_ratio_minimum()) {
    line("film ratio lambda, minimum", point.film_ratio_minimum(), "");
    line("contact temperature, maximum",
         scaled(point.contact_temperature_maximum_kelvin(), 1, -kZeroCelsius), "C");
    line("flash temperature rise, maximum", point.flash_temperature_rise_maximum_kelvin(), "K");
    line("pressure, maximum", scaled(point.maximum_pressure_maximum_pascals(), 1e-9, 0), "GPa");
    line("mesh friction coefficient", point.mesh_friction_coefficient(), "");
  }
  if (std::isnan(point.inefficiency_energy_mean_percent().standard_uncertainty())) {
    sheet.remark("The model refuses " + std::to_string(point.refused_draws()) + " of " +
                 std::to_string(response.draws()) +
                 " draws of the inputs: too many to state an uncertainty.");
  }
  sheet.remark(linearity_text(point.inefficiency_energy_mean_percent(), response.draws()));
  sheet.remark(advice_text(point.shares()));
  add_exact_inputs(response, sheet);
  sheet.remark(kModelErrorRemark);
  return sheet.text();
}

std::string input_error_text(const v1::UncertainFigure& figure) {
  if (!(figure.standard_uncertainty() > 0)) {
    return std::string("uncertainty ") +
           (std::isnan(figure.standard_uncertainty()) ? "not known" : kNotStated);
  }
  const std::string text = spread_text(figure);
  return text.find(" to ") == std::string::npos ? "+/- " + text : text;
}

std::string curve_uncertainty_remark(const v1::ComparePointsResponse& response) {
  const v1::ComparedLubricant& lubricant = response.lubricants(0);
  if (lubricant.mean_shares().empty()) {
    return "No uncertainty of the lubricant's parameters is stated.";
  }
  return linearity_text(lubricant.mean_inefficiency_percent(), response.draws()) + " " +
         advice_text(lubricant.mean_shares());
}

}  // namespace tribodyn::client
