#include "client/cpp/report/explanation_report.h"

#include <algorithm>
#include <cmath>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kListedInteractions = 3;
constexpr int kCombinationsOfGroups = 64;
/// Most conditions whose shares the report lists side by side.
constexpr int kListedConditions = 10;

/// Least share of a difference that a group needs to be named as its cause [-].
constexpr double kSmallestNamedCause = 0.1;

/// Returns the decimal places with which an error has two significant digits.
int decimals_of(double error) {
  if (!(error > 0) || !std::isfinite(error)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
}

/// Returns the decimal places for a figure and its shares.
int decimals_of(const v1::DrawnFigure& difference) {
  return decimals_of(std::max(difference.standard_uncertainty(), difference.solver_error()));
}

/// Returns the figure with its 95 % interval.
std::string with_uncertainty(const v1::DrawnFigure& figure, int decimals) {
  return fixed(figure.value(), decimals) +
         (figure.standard_uncertainty() > 0
              ? " (" + fixed(figure.interval_minimum(), decimals) + " to " +
                    fixed(figure.interval_maximum(), decimals) + ")"
              : "");
}

std::string percent_of(double part, double whole) {
  return whole == 0 ? "-" : fixed(100 * part / whole, 0);
}

/// The table of the mean: one row for each group.
std::string mean_table(const v1::DifferenceExplanation& mean, bool has_uncertainty) {
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"group of parameters", "", Align::kLeft},
                                        {"share", "% points", Align::kDecimal}};
  if (has_uncertainty) {
    columns.push_back({"95 % interval", "% points", Align::kRight});
  }
  columns.insert(columns.end(), {{"of difference", "%", Align::kRight},
                                 {"alone", "% points", Align::kDecimal},
                                 {"last", "% points", Align::kDecimal},
                                 {"share", "W", Align::kDecimal}});
  Table table(columns);
  const v1::DrawnFigure& percent = mean.inefficiency_difference_percent();
  const v1::DrawnFigure& watts = mean.mesh_loss_power_difference_watts();
  const int decimals = decimals_of(percent), watt_decimals = decimals_of(watts);
  const auto add = [&](const std::string& label, const v1::DrawnFigure& share,
                       const std::string& alone, const std::string& last, double in_watts) {
    std::vector<std::string> row = {label, fixed(share.value(), decimals)};
    if (has_uncertainty) {
      row.push_back(fixed(share.interval_minimum(), decimals) + " to " +
                    fixed(share.interval_maximum(), decimals));
    }
    row.insert(row.end(), {percent_of(share.value(), percent.value()), alone, last,
                           fixed(in_watts, watt_decimals)});
    table.add_row(row);
  };
  for (const v1::DifferenceCause& cause : ranked_causes(mean)) {
    const v1::Attribution& at = cause.inefficiency_percent();
    add(parameter_group_text(cause.group()) + (cause.is_equal() ? " (equal)" : ""),
        at.shapley_value(), fixed(at.first_effect(), decimals), fixed(at.last_effect(), decimals),
        cause.mesh_loss_power_watts().shapley_value().value());
  }
  add("difference", percent, "", "", watts.value());
  return table.text();
}

/// The table of the conditions: one row for each group, one column for each condition.
std::string conditions_table(const v1::ExplainPointsRequest& request,
                             const v1::ExplainPointsResponse& response) {
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"share, % points", "", Align::kLeft}};
  for (int k = 0; k < response.points_size(); ++k) {
    columns.push_back(
        {significant(request.conditions(k).speed_kilometres_per_hour()), "km/h", Align::kDecimal});
  }
  Table table(columns);
  const auto row = [&](const std::string& label, const auto& figure_of) {
    std::vector<std::string> cells = {label};
    for (const v1::DifferenceExplanation& point : response.points()) {
      if (!point.refusal_reason().empty()) {
        cells.emplace_back("-");
        continue;
      }
      const int decimals = decimals_of(point.inefficiency_difference_percent());
      cells.push_back(with_uncertainty(figure_of(point), decimals));
    }
    table.add_row(cells);
  };
  for (const v1::DifferenceCause& cause : ranked_causes(response.mean())) {
    row(parameter_group_text(cause.group()), [&](const v1::DifferenceExplanation& point) {
      return point.causes(static_cast<int>(cause.group()) - 1)
          .inefficiency_percent()
          .shapley_value();
    });
  }
  row("difference", [](const v1::DifferenceExplanation& point) {
    return point.inefficiency_difference_percent();
  });
  return table.text();
}

/// Returns a sentence about the largest interactions.
std::string interactions_text(const v1::DifferenceExplanation& mean, int decimals) {
  std::vector<v1::CauseInteraction> sorted(mean.interactions().begin(), mean.interactions().end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::abs(a.inefficiency_percent()) > std::abs(b.inefficiency_percent());
  });
  std::vector<std::string> parts;
  for (const v1::CauseInteraction& each : sorted) {
    if (parts.size() == kListedInteractions) break;
    const std::string number = fixed(each.inefficiency_percent(), decimals);
    if (number == fixed(0, decimals)) break;
    parts.push_back(parameter_group_text(each.group()) + " with " +
                    parameter_group_text(each.other_group()) + " " + number);
  }
  if (parts.empty()) return "The groups do not interact: each adds the same in every order.";
  return "Largest interactions, what two groups add together beyond what each adds alone, in "
         "percentage points: " +
         joined(parts, ", ") + ".";
}

/// Returns a sentence about the conditions at which some combinations vibrate apart.
std::string contact_loss_text(const v1::ExplainPointsRequest& request,
                              const v1::ExplainPointsResponse& response) {
  std::vector<std::string> speeds;
  for (int k = 0; k < response.points_size(); ++k) {
    const int losses = response.points(k).contact_loss_combinations();
    if (losses == 0 || losses == kCombinationsOfGroups) continue;
    speeds.push_back(significant(request.conditions(k).speed_kilometres_per_hour()) + " km/h (" +
                     std::to_string(losses) + " of " + std::to_string(kCombinationsOfGroups) +
                     " combinations)");
  }
  return speeds.empty()
             ? ""
             : "Flanks part in some combinations and not in others at " + joined(speeds, ", ") +
                   ": shares there depend on where the vibration sets in.";
}

/// Returns which lubricant loses more and by which groups of parameters most.
std::string main_cause_text(const v1::DifferenceExplanation& mean, const std::string& a,
                            const std::string& b) {
  const v1::DrawnFigure& difference = mean.inefficiency_difference_percent();
  const double total = difference.value();
  if (std::abs(total) <= difference.solver_error()) return "";
  const int decimals = decimals_of(difference);
  std::string with, against;
  for (const v1::DifferenceCause& cause : ranked_causes(mean)) {
    const double share = cause.inefficiency_percent().shapley_value().value();
    if (std::abs(share) < kSmallestNamedCause * std::abs(total)) continue;
    std::string& text = (share > 0) == (total > 0) ? with : against;
    if (text.empty()) {
      text = "its " + parameter_group_text(cause.group()) + ", " + signed_fixed(share, decimals);
    }
  }
  const bool is_sure = difference.interval_minimum() > 0 || difference.interval_maximum() < 0;
  // A share exceeds the difference where others work against it.
  return b + " loses " + fixed(std::abs(total), decimals) + " percentage points " +
         (total > 0 ? "more" : "less") + " than " + a + ". The largest share: " + with +
         (against.empty() ? "" : "; the largest against it: " + against) + "." +
         (is_sure ? ""
                  : " Which of the two loses more is not sure: the 95 % interval of the difference "
                    "contains 0.");
}

}  // namespace

std::string parameter_group_text(v1::ParameterGroup group) {
  switch (group) {
    case v1::PARAMETER_GROUP_VISCOSITY:
      return "viscosity and its temperature law";
    case v1::PARAMETER_GROUP_PRESSURE_RESPONSE:
      return "pressure response";
    case v1::PARAMETER_GROUP_SHEAR_THINNING:
      return "shear thinning";
    case v1::PARAMETER_GROUP_LIMITING_STRESS:
      return "limiting shear stress";
    case v1::PARAMETER_GROUP_THERMAL_PROPERTIES:
      return "thermal properties";
    case v1::PARAMETER_GROUP_BOUNDARY_FILM:
      return "boundary film";
    default:
      return "other";
  }
}

std::vector<v1::DifferenceCause> ranked_causes(const v1::DifferenceExplanation& explanation) {
  std::vector<v1::DifferenceCause> out(explanation.causes().begin(), explanation.causes().end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return std::abs(a.inefficiency_percent().shapley_value().value()) >
           std::abs(b.inefficiency_percent().shapley_value().value());
  });
  return out;
}

std::vector<ShownWarning> explanation_warnings(const v1::ExplainPointsRequest& request,
                                               const v1::ExplainPointsResponse& response) {
  std::vector<std::string> places;
  for (const v1::PointCondition& each : request.conditions()) {
    places.push_back(significant(each.speed_kilometres_per_hour()));
  }
  WarningCollector out(places, "km/h", "all conditions", {""});
  for (int k = 0; k < response.points_size(); ++k) {
    out.add(response.points(k).warnings(), 0, static_cast<std::size_t>(k));
  }
  return out.warnings();
}

std::string explanation_report(const v1::ExplainPointsRequest& request,
                               const v1::ExplainPointsResponse& response) {
  const std::string a = resource_id(response.lubricant_revision());
  const std::string b = resource_id(response.other_lubricant_revision());
  const v1::DifferenceExplanation& mean = response.mean();
  const int conditions = response.points_size();
  Sheet sheet;
  sheet.heading("Why " + b + " differs from " + a);
  if (!mean.refusal_reason().empty()) {
    sheet.remark("The model refuses a combination of both: " + printable(mean.refusal_message()) +
                 " [" + mean.refusal_reason() + "]");
    return sheet.text();
  }
  const v1::DrawnFigure& difference = mean.inefficiency_difference_percent();
  const int decimals = decimals_of(difference);
  const bool has_uncertainty = response.draws() > 0;
  sheet.remark((conditions == 1
                    ? "Inefficiency, energy mean: "
                    : "Inefficiency, energy mean, mean of " + std::to_string(conditions) +
                          (request.condition_weights().empty() ? "" : " weighted") +
                          " conditions: ") +
               a + " " + with_uncertainty(mean.inefficiency_percent(), decimals) + " %, " + b +
               " " + with_uncertainty(mean.other_inefficiency_percent(), decimals) +
               " %, difference " + with_uncertainty(difference, decimals) +
               " percentage points; solver error of the difference at most " +
               fixed(difference.solver_error(), decimals_of(difference.solver_error())) + ".");
  const std::vector<ShownWarning> warnings = explanation_warnings(request, response);
  const std::string withheld = withheld_by(warnings);
  sheet.remark(withheld.empty()
                   ? main_cause_text(mean, a, b)
                   : "Which of the two loses more is " + withheld_text(withheld) + ".");
  sheet.remark(response.not_included());
  Sheet notes;
  notes.remark(
      "share: what a group of " + b +
      " adds, averaged over all orders in which the six groups of " + a +
      " are exchanged for those of " + b +
      " (Shapley value); the shares sum to the difference. alone: this group exchanged before all "
      "others; last: after all others.");
  notes.remark(interactions_text(mean, decimals));
  const std::string losses = contact_loss_text(request, response);
  if (!losses.empty()) notes.remark(losses);
  notes.remark(has_uncertainty
                   ? "In brackets: 95 % intervals from " + std::to_string(response.draws()) +
                         " draws of the uncertain inputs of both lubricants and of the scene."
                   : "No input has a stated uncertainty: the shares have none but the solver's.");
  add_warnings(warnings, notes);
  std::string out = sheet.text() + "\n" + mean_table(mean, has_uncertainty) + "\n" + notes.text();
  if (conditions > 1 && conditions <= kListedConditions) {
    out += "\n" + conditions_table(request, response);
  }
  return out;
}

std::string explanation_csv(const v1::ExplainPointsRequest& request,
                            const v1::ExplainPointsResponse& response) {
  std::vector<CsvRow> rows;
  const auto add = [&](const v1::DifferenceExplanation& point,
                       const v1::PointCondition* condition) {
    for (const v1::DifferenceCause& cause : point.causes()) {
      CsvRow row;
      row.emplace_back("lubricant", response.lubricant_revision());
      row.emplace_back("other_lubricant", response.other_lubricant_revision());
      row.emplace_back("conditions", condition == nullptr ? "mean" : "one");
      if (condition == nullptr) {
        append_empty_fields(v1::PointCondition(), "condition.", row);
      } else {
        append_fields(*condition, "condition.", row);
      }
      append_fields(cause, "", row);
      append_fields(point.inefficiency_difference_percent(), "inefficiency_difference_percent.",
                    row);
      row.emplace_back("warnings", condition == nullptr
                                       ? codes_of(explanation_warnings(request, response))
                                       : codes_of(point.warnings()));
      rows.push_back(std::move(row));
    }
  };
  for (int k = 0; k < response.points_size(); ++k) add(response.points(k), &request.conditions(k));
  add(response.mean(), nullptr);
  return rows.empty() ? "" : csv_text(rows);
}

}  // namespace tribodyn::client
