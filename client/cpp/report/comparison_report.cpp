#include "client/cpp/report/comparison_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr int kListedShares = 4;
constexpr double kSmallestListedShare = 0.01;
/// Largest relative difference of standard uncertainties by the linear model and by the draws with
/// which the report calls the linear model enough.
constexpr double kLinearEnough = 0.1;

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

std::string spread_text(const v1::UncertainFigure& figure) {
  return fixed(figure.standard_uncertainty(), error_decimals(figure));
}

std::string interval_text(const v1::UncertainFigure& figure) {
  const int decimals = error_decimals(figure);
  return fixed(figure.interval_minimum(), decimals) + " to " +
         fixed(figure.interval_maximum(), decimals);
}

std::string share_text(double share) {
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

std::string verdict_text(v1::ComparedDifference::Verdict verdict) {
  switch (verdict) {
    case v1::ComparedDifference::LOWER:
      return "lower";
    case v1::ComparedDifference::HIGHER:
      return "higher";
    case v1::ComparedDifference::CANNOT_BE_TOLD_APART:
      return "cannot be told apart";
    default:
      return "-";
  }
}

std::string difference_sentence(const v1::ComparedDifference& difference, const std::string& name,
                                const std::string& first, int conditions) {
  const v1::UncertainFigure& figure = difference.difference_percent();
  const std::string where =
      conditions == 1 ? "" : "Mean of " + std::to_string(conditions) + " conditions: ";
  const std::string numbers =
      value_text(figure) + " percentage points (95 %: " + interval_text(figure) + ")";
  const std::string probability = " Probability that " + name +
                                  " loses less: " + share_text(difference.lower_probability()) +
                                  ".";
  switch (difference.verdict()) {
    case v1::ComparedDifference::LOWER:
      return where + name + " loses less than " + first + ": " + numbers + "." + probability;
    case v1::ComparedDifference::HIGHER:
      return where + name + " loses more than " + first + ": " + numbers + "." + probability;
    case v1::ComparedDifference::CANNOT_BE_TOLD_APART:
      return where + "these two cannot be told apart: " + name + " less " + first + " is " +
             numbers + "." + probability;
    default:
      return where + "no difference of " + name + " and " + first +
             ": one of them has no figure, or too many draws are refused.";
  }
}

double sump_of(const v1::PointCondition& condition) {
  return condition.has_sump_temperature_celsius() ? condition.sump_temperature_celsius() : 40;
}

std::string lubricant_id(const v1::ComparedLubricant& lubricant) {
  return resource_id(lubricant.lubricant_revision());
}

std::string table_of(const v1::ComparePointsRequest& request, const v1::ComparedLubricant& first,
                     const v1::ComparedLubricant* other) {
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"speed", "km/h", Align::kDecimal},
                                        {"sump", "C", Align::kDecimal},
                                        {lubricant_id(first), "%", Align::kDecimal},
                                        {"+/- inputs", "%", Align::kDecimal},
                                        {"+/- solver", "%", Align::kDecimal}};
  if (other == nullptr) {
    columns.push_back({"95 % interval", "%", Align::kRight});
  } else {
    columns.insert(columns.end(), {{lubricant_id(*other), "%", Align::kDecimal},
                                   {"+/- inputs", "%", Align::kDecimal},
                                   {"+/- solver", "%", Align::kDecimal},
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
    const auto add = [&](const v1::ComparedPoint& point) {
      const v1::UncertainFigure& figure = point.inefficiency_energy_mean_percent();
      if (!point.refusal_reason().empty()) {
        row.insert(row.end(), {"-", "-", "-"});
        refusal = "no figure: " + point.refusal_message();
      } else {
        row.insert(row.end(), {value_text(figure), spread_text(figure),
                               fixed(figure.solver_error(), decimals_for(figure.solver_error()))});
      }
    };
    add(first.points(k));
    if (other == nullptr) {
      row.push_back(refusal.empty()
                        ? interval_text(first.points(k).inefficiency_energy_mean_percent())
                        : refusal);
    } else {
      add(other->points(k));
      const v1::ComparedDifference& difference = other->differences(k);
      const bool has_difference = difference.has_difference_percent();
      const v1::UncertainFigure& figure = difference.difference_percent();
      row.insert(row.end(), {has_difference ? value_text(figure) : "-",
                             has_difference ? interval_text(figure) : "-",
                             has_difference ? share_text(difference.lower_probability()) : "-",
                             refusal.empty() ? verdict_text(difference.verdict()) : refusal});
    }
    table.add_row(row);
  }
  return table.text();
}

/// Returns the lubricants with a mean, least first.
std::vector<const v1::ComparedLubricant*> ranked(const v1::ComparePointsResponse& response) {
  std::vector<const v1::ComparedLubricant*> out;
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    if (each.has_mean_inefficiency_percent()) out.push_back(&each);
  }
  std::stable_sort(
      out.begin(), out.end(), [](const v1::ComparedLubricant* a, const v1::ComparedLubricant* b) {
        return a->mean_inefficiency_percent().value() < b->mean_inefficiency_percent().value();
      });
  return out;
}

/// Returns the sentence that names the lubricant with the least mean loss, and those whose
/// differences from it have the verdict CANNOT_BE_TOLD_APART.
std::string best_sentence(const std::vector<const v1::ComparedLubricant*>& ranked) {
  std::vector<std::string> apart, ties;
  for (const v1::ComparedLubricant* each : ranked) {
    if (!each->has_mean_difference_from_best()) continue;
    const bool is_apart =
        each->mean_difference_from_best().verdict() == v1::ComparedDifference::HIGHER;
    (is_apart ? apart : ties).push_back(lubricant_id(*each));
  }
  const std::string best = lubricant_id(*ranked.front());
  return (ties.empty() ? best + " loses least"
                       : "Which one is the best is not sure: " + best + " has the least mean") +
         "; probability that it is the best of all " + std::to_string(ranked.size()) + ": " +
         share_text(ranked.front()->best_probability()) + "." +
         (ties.empty() ? "" : " " + joined(ties, ", ") + " cannot be told apart from it.") +
         (apart.empty()
              ? ""
              : " " + joined(apart, ", ") + (apart.size() == 1 ? " loses more." : " lose more."));
}

/// Returns the sentence that names the input to measure first, so that the best lubricant and the
/// next one that ties with it can be distinguished; empty if none ties or no input is uncertain.
std::string decisive_measurement(const std::vector<const v1::ComparedLubricant*>& ranked) {
  for (const v1::ComparedLubricant* each : ranked) {
    const v1::ComparedDifference& difference = each->mean_difference_from_best();
    if (difference.verdict() != v1::ComparedDifference::CANNOT_BE_TOLD_APART) continue;
    if (difference.shares().empty() || !(difference.shares(0).variance_share() > 0)) continue;
    const v1::InputShare& share = difference.shares(0);
    const bool is_of_both =
        share.lubricant_revision().empty() && share.input().starts_with("lubricant.");
    return "What to measure next, to tell " + lubricant_id(*each) + " from " +
           lubricant_id(*ranked.front()) + ": " + input_text(share.input()) +
           (is_of_both ? " of both"
            : share.lubricant_revision().empty()
                ? ""
                : " of " + resource_id(share.lubricant_revision())) +
           ", which makes " + share_text(share.variance_share()) +
           " of the variance of their difference.";
  }
  return "";
}

std::string ranking_table(const std::vector<const v1::ComparedLubricant*>& ranked) {
  using Align = Table::Align;
  Table table({{"rank", "", Align::kRight},
               {"lubricant", "", Align::kLeft},
               {"mean", "%", Align::kDecimal},
               {"+/- inputs", "%", Align::kDecimal},
               {"P(best)", "", Align::kRight},
               {"more than the best", "% points", Align::kDecimal},
               {"95 % interval", "% points", Align::kRight},
               {"against the best", "", Align::kLeft}});
  int rank = 0;
  for (const v1::ComparedLubricant* each : ranked) {
    const v1::UncertainFigure& mean = each->mean_inefficiency_percent();
    const v1::ComparedDifference& difference = each->mean_difference_from_best();
    const bool has_difference = difference.has_difference_percent();
    table.add_row({std::to_string(++rank), lubricant_id(*each), value_text(mean), spread_text(mean),
                   share_text(each->best_probability()),
                   has_difference ? value_text(difference.difference_percent()) : "",
                   has_difference ? interval_text(difference.difference_percent()) : "",
                   !each->has_mean_difference_from_best() ? "the best"
                   : difference.verdict() == v1::ComparedDifference::HIGHER
                       ? "loses more"
                       : verdict_text(difference.verdict())});
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

/// Adds each warning of the points with the lubricants and speeds that have it.
void add_point_warnings(const v1::ComparePointsRequest& request,
                        const v1::ComparePointsResponse& response, Sheet& sheet) {
  std::map<std::string, std::set<std::string>> places;  // by sentence
  for (const v1::ComparedLubricant& lubricant : response.lubricants()) {
    for (int k = 0; k < lubricant.points_size(); ++k) {
      for (const v1::RangeWarning& each : lubricant.points(k).warnings()) {
        const double speed = request.conditions(k).speed_kilometres_per_hour();
        places[printable(each.message()) + ". [" + printable(each.code()) + "]"].insert(
            lubricant_id(lubricant) + " at " + significant(speed) + " km/h");
      }
    }
  }
  if (places.empty()) return;
  sheet.heading("Warnings");
  for (const auto& [sentence, where] : places) {
    sheet.remark(joined(std::vector<std::string>(where.begin(), where.end()), ", ") + ": " +
                 sentence);
  }
}

}  // namespace

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
  return value_text(figure) + (unit.empty() ? "" : " " + unit) + " +/- " +
         (figure.standard_uncertainty() > 0 ? spread_text(figure) : "0") + " (inputs)" +
         (std::isnan(figure.solver_error()) ? ""
          : figure.solver_error() > 0
              ? " +/- " + fixed(figure.solver_error(), decimals_for(figure.solver_error()) - 1) +
                    " (solver)"
              : " +/- 0 (solver)");
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
  if (order.size() > 2) {
    out += title("Ranking by the mean inefficiency, energy mean" +
                 (conditions == 1 ? std::string()
                                  : ", of " + std::to_string(conditions) + " conditions")) +
           ranking_table(order) + "\n";
    Sheet best;
    best.remark(best_sentence(order));
    best.remark(decisive_measurement(order));
    out += best.text() + "\n";
  }
  for (int i = 1; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& other = response.lubricants(i);
    out += title("Inefficiency, energy mean: " + lubricant_id(other) + " less " +
                 lubricant_id(first)) +
           table_of(request, first, &other) + "\n";
    sheet.heading(lubricant_id(other) + " against " + lubricant_id(first));
    const v1::ComparedDifference& mean = other.mean_difference();
    sheet.remark(difference_sentence(mean, lubricant_id(other), lubricant_id(first), conditions));
    if (mean.has_difference_percent()) {
      sheet.remark(linearity_text(mean.difference_percent(), response.draws()));
      sheet.remark(advice_text(mean.shares()));
    }
  }
  add_point_warnings(request, response, sheet);
  sheet.heading("What is common, and what is not");
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
      append_fields(request.conditions(k), "condition.", row);
      v1::ComparedPoint point = lubricant.points(k);
      point.clear_shares();
      append_fields(point, "", row);
      v1::ComparedDifference difference;
      if (k < lubricant.differences_size()) difference = lubricant.differences(k);
      difference.clear_shares();
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
    sheet.remark("friction coefficient: " + with_errors(each.value(), "") +
                 ", 95 %: " + interval_text(each.value()));
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
  const auto line = [&sheet](const char* label, const v1::UncertainFigure& figure,
                             const char* unit) {
    sheet.remark(std::string(label) + ": " + with_errors(figure, unit) +
                 (figure.standard_uncertainty() > 0 ? ", 95 %: " + interval_text(figure) : ""));
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
  sheet.remark(linearity_text(point.inefficiency_energy_mean_percent(), response.draws()));
  sheet.remark(advice_text(point.shares()));
  add_exact_inputs(response, sheet);
  sheet.remark(kModelErrorRemark);
  return sheet.text();
}

std::string input_error_text(const v1::UncertainFigure& figure) {
  return "+/- " + (figure.standard_uncertainty() > 0 ? spread_text(figure) : "0");
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
