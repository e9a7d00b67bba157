#include "client/cpp/report/screening_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

/// Columns of the candidates' table that the ranking shows on a terminal.
constexpr std::size_t kShownColumns = 5;
/// Refusals and names of refused candidates that are listed.
constexpr std::size_t kListedRefusals = 8;
constexpr std::size_t kListedNames = 4;

/// Returns the decimal places with which a figure has one digit more than its error.
int places_for(double error) {
  if (!(error > 0) || !std::isfinite(error)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
}

std::string condition_text(const v1::PointCondition& condition) {
  return significant(condition.speed_kilometres_per_hour()) + " km/h and " +
         significant(condition.sump_temperature_celsius()) + " C";
}

/// Sums the figures of the points of one fluid, which `point_of(k)` returns; `message_of(k)` says
/// why there are none.
template <class PointOf, class MessageOf>
CandidateFigures weighted_figures(const Screening& screening, const PointOf& point_of,
                                  const MessageOf& message_of) {
  CandidateFigures out;
  out.contact[ScreenedPoint::kLeastFilmRatio] = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < screening.conditions(); ++k) {
    const ScreenedPoint point = point_of(k);
    const double energy_mean = point.figures[ScreenedPoint::kEnergyMean];
    if (point.refusal_number != 0 || !std::isfinite(energy_mean)) {
      out.refusal = message_of(k);
      if (out.refusal.empty()) {
        out.refusal = "no power comes in, so that there is no inefficiency";
      }
      out.refusal +=
          " (at " + condition_text(screening.request.conditions(static_cast<int>(k))) + ")";
      return out;
    }
    const double weight = screening.weights[k];
    const double error = point.figures[ScreenedPoint::kError];
    out.inefficiency += weight * energy_mean;
    out.solver_error += weight * std::abs(energy_mean) * (std::isfinite(error) ? error : 0);
    out.loss_power += weight * point.figures[ScreenedPoint::kLossPower];
    out.contact_loss = out.contact_loss || point.contact_loss;
    out.is_withheld = out.is_withheld || point.verdict_withheld;
    for (std::size_t i = 0; i < point.contact.size(); ++i) {
      double& figure = out.contact[i];
      switch (i) {
        case ScreenedPoint::kLeastFilmRatio:
          figure = std::min(figure, point.contact[i]);
          break;
        case ScreenedPoint::kHighestTemperature:
        case ScreenedPoint::kHighestPressure:
        case ScreenedPoint::kHighestFlashTemperature:
          figure = std::max(figure, point.contact[i]);
          break;
        default:
          figure += weight * point.contact[i];
      }
    }
  }
  return out;
}

/// Returns the difference from the base in percent of the base, NaN without one.
double relative_difference(const CandidateFigures& figures, const CandidateFigures& base) {
  if (!base.refusal.empty()) return std::nan("");
  return 100 * (figures.inefficiency - base.inefficiency) / base.inefficiency;
}

std::string signed_text(double value, int decimals) {
  return (value > 0 ? "+" : "") + fixed(value, decimals);
}

std::string distinct(std::vector<double> values, const std::string& unit) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<std::string> out;
  for (const double each : values) out.push_back(significant(each));
  return joined(out, ", ") + " " + unit;
}

std::string conditions_text(const Screening& screening) {
  std::vector<double> speeds, sumps;
  for (const v1::PointCondition& each : screening.request.conditions()) {
    speeds.push_back(each.speed_kilometres_per_hour());
    sumps.push_back(each.sump_temperature_celsius());
  }
  return distinct(speeds, "km/h") + "; sump " + distinct(sumps, "C");
}

/// Returns the headers of the columns that differ between candidates, those of parameters first. Of
/// candidates that differ in many parameters, as whole lubricants do, no parameter.
std::vector<std::size_t> shown_columns(const CandidateTable& table) {
  const bool has_many = table.parameters.size() > 2 * kShownColumns;
  std::vector<std::size_t> out;
  for (const bool carried : {false, true}) {
    if (!carried && has_many) continue;
    for (std::size_t i = 0; i < table.headers.size(); ++i) {
      if (table.is_carried[i] != carried) continue;
      const bool differs =
          std::any_of(table.cells.begin(), table.cells.end(),
                      [&](const auto& cells) { return cells[i] != table.cells.front()[i]; });
      if (differs && out.size() < kShownColumns) out.push_back(i);
    }
  }
  return out;
}

std::string shortened(std::string header) {
  constexpr std::size_t kWidth = 18;
  for (const char* kind : {"lubricant.", "surface."}) {
    if (header.size() > kWidth && header.starts_with(kind)) header.erase(0, header.find('.') + 1);
  }
  return header.size() <= kWidth ? header : header.substr(0, kWidth - 3) + "...";
}

void add_refusals(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                  Sheet& sheet) {
  std::map<std::string, std::vector<std::string>> names_by_refusal;
  std::vector<std::string> order;
  std::size_t refused = 0;
  for (const CandidateFigures& each : ranking) {
    if (each.refusal.empty()) continue;
    ++refused;
    auto& names = names_by_refusal[each.refusal];
    if (names.empty()) order.push_back(each.refusal);
    names.push_back(screening.table.names[each.candidate]);
  }
  if (refused == 0) return;
  sheet.heading(std::to_string(refused) + (refused == 1 ? " candidate" : " candidates") +
                " without figures");
  for (std::size_t i = 0; i < order.size() && i < kListedRefusals; ++i) {
    std::vector<std::string> names = names_by_refusal[order[i]];
    const std::size_t count = names.size();
    if (count > kListedNames) names.resize(kListedNames);
    sheet.remark(joined(names, ", ") +
                 (count > kListedNames ? " and " + std::to_string(count - kListedNames) + " more"
                                       : std::string()) +
                 ": " + order[i]);
  }
  if (order.size() > kListedRefusals) {
    sheet.remark("... and " + std::to_string(order.size() - kListedRefusals) +
                 " other reasons; --output csv lists all.");
  }
}

/// Returns the confidence of a position in the ranking; null if it is not known.
const CandidateConfidence* confidence_at(const RankingConfidence& confidence,
                                         std::size_t position) {
  const bool is_known = position < confidence.of.size() && confidence.of[position];
  return is_known ? &*confidence.of[position] : nullptr;
}

const std::vector<ShownWarning>& warnings_of(const Screening& screening, std::size_t candidate) {
  static const std::vector<ShownWarning> none;
  const auto found = screening.warnings_of.find(candidate);
  return found == screening.warnings_of.end() ? none : found->second;
}

/// Returns the verdict on a candidate; without a position, on the base.
std::string verdict_of(const Screening& screening, const CandidateFigures& figures,
                       const RankingConfidence& confidence, std::optional<std::size_t> position) {
  if (figures.is_withheld) {
    return withheld_text(!position ? withheld_by(screening.base.warnings())
                                   : withheld_by(warnings_of(screening, figures.candidate)));
  }
  if (!position) return "";
  const CandidateConfidence* sure = confidence_at(confidence, *position);
  if (sure == nullptr) return *position < confidence.of.size() ? "uncertainty not stated" : "-";
  if (*position == 0) return "the best";
  return sure->is_tied ? "cannot be told apart" : "loses more";
}

/// Returns the probability that a candidate loses more than the best one.
std::string more_text(const CandidateConfidence* confidence, std::optional<std::size_t> position) {
  if (confidence == nullptr || position == 0U) return "";
  const double percent = 100 * confidence->higher_probability;
  return percent > 99.5 ? "> 99 %" : fixed(percent, 0) + " %";
}

/// Returns the contact figures that the ranking shows on a terminal.
std::vector<std::string> contact_cells(const CandidateFigures& figures) {
  constexpr double kZeroCelsius = 273.15;  // [K]
  return {significant(figures.contact[ScreenedPoint::kBoundaryLoss], 3),
          fixed(figures.contact[ScreenedPoint::kLeastFilmRatio], 2),
          fixed(figures.contact[ScreenedPoint::kHighestTemperature] - kZeroCelsius, 0),
          fixed(figures.contact[ScreenedPoint::kFriction], 4)};
}

std::string ranking_table(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                          const RankingConfidence& confidence, std::size_t top) {
  using Align = Table::Align;
  const CandidateTable& candidates = screening.table;
  const CandidateFigures base = base_figures(screening);
  std::vector<Table::Column> columns = {{"rank", "", Align::kRight},
                                        {"candidate", "", Align::kLeft},
                                        {"inefficiency", "%", Align::kDecimal},
                                        {"solver error", "%", Align::kDecimal},
                                        {"vs base", "%", Align::kDecimal},
                                        {"mesh loss", "W", Align::kDecimal}};
  const bool is_sure = !confidence.of.empty();
  if (is_sure) columns.insert(columns.begin() + 3, {"std. uncertainty", "%", Align::kDecimal});
  const bool has_verdicts = is_sure || base.is_withheld ||
                            std::any_of(ranking.begin(), ranking.end(),
                                        [](const auto& each) { return each.is_withheld; });
  if (is_sure) columns.push_back({"P(loses more)", "", Align::kRight});
  if (has_verdicts) columns.push_back({"against the best", "", Align::kLeft});
  const bool has_contact = screening.has_contact_figures();
  if (has_contact) {
    columns.insert(columns.end(), {{"boundary loss", "W", Align::kDecimal},
                                   {"least film ratio", "-", Align::kDecimal},
                                   {"hottest contact", "C", Align::kDecimal},
                                   {"friction", "-", Align::kDecimal}});
  }
  const std::vector<std::size_t> shown = shown_columns(candidates);
  for (const std::size_t each : shown) {
    columns.push_back({shortened(candidates.headers[each]), "", Align::kDecimal});
  }
  const bool has_contact_loss =
      base.contact_loss || std::any_of(ranking.begin(), ranking.end(),
                                       [](const auto& each) { return each.contact_loss; });
  if (has_contact_loss) columns.push_back({"flanks part", "", Align::kLeft});
  Table table(columns);
  // `position` is that in the ranking; absent of the base.
  const auto row = [&](std::optional<std::size_t> position, const std::string& name,
                       const CandidateFigures& each, const std::vector<std::string>* cells) {
    const CandidateConfidence* sure = position ? confidence_at(confidence, *position) : nullptr;
    const int places = places_for(each.solver_error);
    std::vector<std::string> out = {position ? std::to_string(*position + 1) : "", name,
                                    fixed(each.inefficiency, places)};
    if (is_sure) {
      out.push_back(sure == nullptr ? "" : significant(sure->standard_uncertainty, 2));
    }
    out.push_back(fixed(each.solver_error, places));
    out.push_back(cells == nullptr ? "" : signed_text(relative_difference(each, base), 2));
    out.push_back(fixed(each.loss_power,
                        places_for(each.loss_power * each.solver_error / each.inefficiency)));
    if (is_sure) out.push_back(more_text(sure, position));
    if (has_verdicts) out.push_back(verdict_of(screening, each, confidence, position));
    if (has_contact) {
      for (const std::string& cell : contact_cells(each)) out.push_back(cell);
    }
    for (const std::size_t k : shown) out.push_back(cells == nullptr ? "" : (*cells)[k]);
    if (has_contact_loss) out.emplace_back(each.contact_loss ? "yes" : "no");
    table.add_row(out);
  };
  if (base.refusal.empty()) {
    row(std::nullopt, resource_id(screening.base.lubricant_revision()), base, nullptr);
  }
  for (std::size_t i = 0; i < ranking.size() && i < top; ++i) {
    if (!ranking[i].refusal.empty()) break;
    const std::size_t candidate = ranking[i].candidate;
    row(i, candidates.names[candidate], ranking[i], &candidates.cells[candidate]);
  }
  return table.text();
}

/// Adds which candidates cannot be told apart from the best one, and by which errors.
void add_confidence(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                    const RankingConfidence& confidence, Sheet& sheet) {
  const auto& of = confidence.of;
  if (confidence.is_not_stated) {
    sheet.heading("How sure the ranking is");
    sheet.remark(
        (confidence.own.empty()
             ? "Nobody states an uncertainty of what the candidates differ in"
             : "No uncertainty of " + screening.table.names[ranking.front().candidate] +
                   ", which has the least mean, is stated") +
        ", so that no ties can be found. State it with --uncertainty PARAMETER=VALUE or in columns "
        "PARAMETER.standard_uncertainty.");
  }
  if (ranking.front().is_withheld) {
    sheet.heading("How sure the ranking is");
    sheet.remark("Every verdict is withheld.");
  }
  if (of.empty() || !of.front()) return;
  std::vector<std::string> tied, not_stated;
  std::size_t ties = 0, others = 0;
  for (std::size_t i = 1; i < of.size(); ++i) {
    if (!of[i]) {
      if (!ranking[i].is_withheld) {
        not_stated.push_back(screening.table.names[ranking[i].candidate]);
      }
      continue;
    }
    ++others;
    if (!of[i]->is_tied) continue;
    if (ties++ < 2 * kListedNames) tied.push_back(screening.table.names[ranking[i].candidate]);
  }
  const std::string& best = screening.table.names[ranking.front().candidate];
  const std::string percent = significant(100 * confidence.confidence, 4) + " %";
  sheet.heading("How sure the ranking is");
  sheet.remark(
      others == 0 ? best + " has the least mean."
      : ties == 0
          ? "At " + percent + " " + best +
                (others + 1 < ranking.size() ? " loses less than every other one that was compared."
                                             : " loses less than every other candidate.")
          : std::to_string(ties) + " of " + std::to_string(others) +
                (others == 1 ? " other" : " others") + " cannot be told apart from " + best +
                " at " + percent + ": " + joined(tied, ", ") +
                (ties > tied.size() ? " and " + std::to_string(ties - tied.size()) + " more."
                                    : "."));
  if (!not_stated.empty()) {
    const std::size_t more = not_stated.size() - std::min(not_stated.size(), kListedNames);
    not_stated.resize(not_stated.size() - more);
    sheet.remark("Uncertainty not stated, and so no verdict: " + joined(not_stated, ", ") +
                 (more == 0 ? "." : " and " + std::to_string(more) + " more."));
  }
  if (of.size() < ranking.size()) {
    sheet.remark("Compared: the best " + std::to_string(of.size()) + " candidates.");
  }
  sheet.remark(
      (confidence.own.empty()
           ? "The values in the table count as exact; --uncertainty PARAMETER=VALUE states "
             "their uncertainty."
           : "Errors of each candidate alone: " + joined(confidence.own, ", ") + ".") +
      (confidence.shared.empty()
           ? std::string()
           : " Errors that all candidates have in common and that nearly cancel: " +
                 joined(confidence.shared, ", ") + ".") +
      " P(loses more): the probability that a candidate loses more than the best one, from " +
      std::to_string(confidence.draws) +
      " draws of the inputs; the solver's error counts against each difference.");
}

std::string ranking_text(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                         const RankingConfidence& confidence, std::size_t top) {
  const std::size_t with_figures = static_cast<std::size_t>(std::count_if(
      ranking.begin(), ranking.end(), [](const auto& each) { return each.refusal.empty(); }));
  Sheet title;
  title.heading("Mesh inefficiency, energy mean over " + std::to_string(screening.conditions()) +
                (screening.conditions() == 1 ? " condition: " : " conditions: ") +
                best_of_text(std::min(top, with_figures), screening.table.size(), " best"));
  Sheet sheet;
  add_confidence(screening, ranking, confidence, sheet);
  add_refusals(screening, ranking, sheet);
  add_warnings(screening.warnings, sheet);
  sheet.heading("What was computed");
  if (!screening.base.not_included().empty()) sheet.remark(screening.base.not_included());
  std::vector<std::string> varied, carried;
  for (const CandidateParameter& each : screening.table.parameters) varied.push_back(each.path());
  for (std::size_t i = 0; i < screening.table.headers.size(); ++i) {
    if (screening.table.is_carried[i]) carried.push_back(screening.table.headers[i]);
  }
  sheet.remark("At " + conditions_text(screening) + ", each with " +
               screening.base.lubricant_revision() + ", " + screening.base.surface_revision() +
               ", " + screening.base.gear_set_revision() + " and " +
               screening.base.vehicle_revision() + ", except for: " + joined(varied, ", ") + "." +
               (carried.empty() ? "" : " Carried along: " + joined(carried, ", ") + "."));
  if (!screening.campaign.empty()) {
    const std::string id = resource_id(screening.campaign);
    sheet.remark("The server keeps the figures as " + screening.campaign + ": `" +
                 screening.program + " screen --campaign " + id + "` ranks them again, `" +
                 screening.program + " campaigns delete " + id + "` deletes them.");
  }
  sheet.remark("Model " + screening.base.model_version() +
               ". \"vs base\" is the difference in percent of the base, the first line.");
  const CandidateFigures base = base_figures(screening);
  if (!base.refusal.empty()) sheet.remark("The base has no figures: " + base.refusal);
  return title.text() + ranking_table(screening, ranking, confidence, top) + "\n" + sheet.text();
}

std::string ranking_csv(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                        const RankingConfidence& confidence) {
  const CandidateFigures base = base_figures(screening);
  std::vector<std::string> header = {"rank", "candidate"};
  header.insert(header.end(), screening.table.headers.begin(), screening.table.headers.end());
  header.insert(header.end(),
                {"inefficiency_energy_mean_percent", "standard_uncertainty_percent",
                 "solver_error_percent", "higher_probability", "is_tied_with_best",
                 "difference_from_base_percent_of_base", "mesh_loss_power_watts", "contact_loss"});
  if (screening.has_contact_figures()) {
    header.insert(header.end(), contact_figures_of_points().begin(),
                  contact_figures_of_points().end());
  }
  header.insert(header.end(), {"verdict_withheld", "warnings", "refusal"});
  std::string out = csv_line(header);
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const CandidateFigures& each = ranking[i];
    const bool has_figures = each.refusal.empty();
    const CandidateConfidence* sure = confidence_at(confidence, i);
    const auto number = [&](double value) { return has_figures ? shortest(value) : ""; };
    std::vector<std::string> cells = {has_figures ? std::to_string(i + 1) : "",
                                      screening.table.names[each.candidate]};
    const std::vector<std::string>& typed = screening.table.cells[each.candidate];
    cells.insert(cells.end(), typed.begin(), typed.end());
    cells.insert(
        cells.end(),
        {number(each.inefficiency), sure == nullptr ? "" : shortest(sure->standard_uncertainty),
         number(each.solver_error), sure == nullptr ? "" : shortest(sure->higher_probability),
         sure == nullptr ? "" : (sure->is_tied ? "true" : "false"),
         number(relative_difference(each, base)), number(each.loss_power),
         has_figures ? (each.contact_loss ? "true" : "false") : ""});
    if (screening.has_contact_figures()) {
      std::transform(each.contact.begin(), each.contact.end(), std::back_inserter(cells), number);
    }
    cells.insert(cells.end(), {has_figures ? (each.is_withheld ? "true" : "false") : "",
                               codes_of(warnings_of(screening, each.candidate)), each.refusal});
    out += csv_line(cells);
  }
  return out;
}

std::string ranking_json(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                         const RankingConfidence& confidence,
                         const std::map<std::string, std::string>& members) {
  const CandidateFigures base = base_figures(screening);
  const auto figures = [&screening](const CandidateFigures& each) {
    std::string text = "\"inefficiency_energy_mean_percent\": " + json_number(each.inefficiency) +
                       ", \"solver_error_percent\": " + json_number(each.solver_error) +
                       ", \"mesh_loss_power_watts\": " + json_number(each.loss_power) +
                       ", \"contact_loss\": " + (each.contact_loss ? "true" : "false") +
                       ", \"verdict_withheld\": " + (each.is_withheld ? "true" : "false");
    for (std::size_t i = 0; screening.has_contact_figures() && i < each.contact.size(); ++i) {
      text +=
          ", " + json_quoted(contact_figures_of_points()[i]) + ": " + json_number(each.contact[i]);
    }
    return text;
  };
  const auto refusal = [](const CandidateFigures& each) {
    return "\"refusal\": " + json_quoted(each.refusal);
  };
  std::string out = "{\n  \"campaign\": " + json_quoted(screening.campaign) +
                    ",\n  \"model_version\": " + json_quoted(screening.base.model_version()) +
                    ",\n  \"base\": {\"lubricant_revision\": " +
                    json_quoted(screening.base.lubricant_revision()) + ", " +
                    (base.refusal.empty() ? figures(base) : refusal(base)) +
                    "},\n  \"candidates\": [";
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const CandidateFigures& each = ranking[i];
    out += std::string(i == 0 ? "" : ",") +
           "\n    {\"candidate\": " + json_quoted(screening.table.names[each.candidate]) +
           ", \"columns\": {";
    for (std::size_t k = 0; k < screening.table.headers.size(); ++k) {
      out += (k == 0 ? "" : ", ") + json_quoted(screening.table.headers[k]) + ": " +
             json_quoted(screening.table.cells[each.candidate][k]);
    }
    out +=
        "}, \"warnings\": " + json_quoted(codes_of(warnings_of(screening, each.candidate))) + ", ";
    if (const CandidateConfidence* sure = confidence_at(confidence, i)) {
      out += "\"standard_uncertainty_percent\": " + json_number(sure->standard_uncertainty) +
             ", \"higher_probability\": " + json_number(sure->higher_probability) +
             ", \"is_tied_with_best\": " + (sure->is_tied ? "true, " : "false, ");
    }
    out += each.refusal.empty() ? "\"rank\": " + std::to_string(i + 1) + ", " + figures(each) +
                                      ", \"difference_from_base_percent_of_base\": " +
                                      json_number(relative_difference(each, base)) + "}"
                                : refusal(each) + "}";
  }
  out += "\n  ],\n  \"warnings\": " + warnings_json(screening.warnings) +
         ",\n  \"not_included\": " + json_quoted(screening.base.not_included());
  for (const auto& [name, value] : members) out += ",\n  " + json_quoted(name) + ": " + value;
  return out + "\n}\n";
}

}  // namespace

CandidateFigures candidate_figures(const Screening& screening, std::size_t candidate) {
  CandidateFigures out;
  if (screening.table.refusals[candidate].empty()) {
    out = weighted_figures(
        screening, [&](std::size_t k) { return screening.point(candidate, k); },
        [&](std::size_t k) { return refusal_of(screening, candidate, k).message(); });
  } else {
    out.refusal = screening.table.refusals[candidate];
  }
  out.candidate = candidate;
  return out;
}

CandidateFigures base_figures(const Screening& screening) {
  const v1::EvaluatePointsResponse& base = screening.base;
  return weighted_figures(
      screening, [&](std::size_t k) { return screened_point(base, static_cast<int>(k)); },
      [&](std::size_t k) {
        const int number = base.refusal_numbers(static_cast<int>(k));
        return number == 0 ? std::string() : base.refusals(number - 1).message();
      });
}

std::vector<CandidateFigures> ranked(const Screening& screening) {
  std::vector<CandidateFigures> out;
  for (std::size_t i = 0; i < screening.table.size(); ++i) {
    out.push_back(candidate_figures(screening, i));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const CandidateFigures& a, const CandidateFigures& b) {
                     if (a.refusal.empty() != b.refusal.empty()) return a.refusal.empty();
                     if (a.is_withheld != b.is_withheld) return b.is_withheld;
                     return a.refusal.empty() && a.inefficiency < b.inefficiency;
                   });
  return out;
}

std::string screening_report(const Screening& screening,
                             const std::vector<CandidateFigures>& ranking,
                             const RankingConfidence& confidence, std::size_t top,
                             OutputFormat format,
                             const std::map<std::string, std::string>& members) {
  switch (format) {
    case OutputFormat::kCsv:
      return ranking_csv(screening, ranking, confidence);
    case OutputFormat::kJson:
      return ranking_json(screening, ranking, confidence, members);
    case OutputFormat::kTable:
      break;
  }
  return ranking_text(screening, ranking, confidence, top);
}

}  // namespace tribodyn::client
