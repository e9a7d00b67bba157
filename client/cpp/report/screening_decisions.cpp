#include "client/cpp/report/screening_decisions.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "core/decisions/main_effects.h"
#include "core/decisions/pareto_front.h"
#include "core/decisions/ranking.h"

namespace tribodyn::client {
namespace {

constexpr double kEffectCoverage = 0.95;
/// Most words of a column of which the effects are computed.
constexpr std::size_t kMostLevels = 12;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double number_or_nan(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number && std::isfinite(value) ? value : kNoValue;
}

/// Returns the numbers of a column by candidate: of a parameter its values, else the cells; NaN
/// where there is none.
std::vector<double> numbers_of_column(const CandidateTable& table, std::size_t column) {
  for (const CandidateParameter& each : table.parameters) {
    if (each.column == column) return each.values;
  }
  std::vector<double> out;
  for (const auto& cells : table.cells) out.push_back(number_or_nan(cells[column]));
  return out;
}

/// The columns of the linear model, and what each of them stands for.
struct EffectModel {
  std::vector<ScreeningEffect> labels;
  std::vector<std::vector<double>> columns;  // by candidate of the model
  std::vector<std::string> left_out;
};

void add_numbers(const CandidateTable& table, std::size_t column,
                 const std::vector<std::size_t>& candidates, const std::vector<double>& numbers,
                 EffectModel& model) {
  const auto less = [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; };
  const auto [low, high] = std::minmax_element(candidates.begin(), candidates.end(), less);
  const double range = numbers[*high] - numbers[*low];
  const auto typed = [&](std::size_t candidate) {
    const std::string& cell = table.cells[candidate][column];
    return cell.empty() ? "base" : cell;
  };
  model.labels.push_back({table.headers[column], typed(*low), typed(*high), 0, 0, 0});
  std::vector<double>& shares = model.columns.emplace_back();
  for (const std::size_t each : candidates) {
    shares.push_back((numbers[each] - numbers[*low]) / range);
  }
}

void add_words(const CandidateTable& table, std::size_t column,
               const std::vector<std::size_t>& candidates, EffectModel& model) {
  std::map<std::string, std::size_t> counts;
  for (const std::size_t each : candidates) ++counts[table.cells[each][column]];
  if (counts.size() > kMostLevels) {
    model.left_out.push_back(table.headers[column] + " (" + std::to_string(counts.size()) +
                             " different texts)");
    return;
  }
  const auto usual =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto shown = [](const std::string& cell) { return cell.empty() ? "(empty)" : cell; };
  for (const auto& [word, count] : counts) {
    if (word == usual->first) continue;
    model.labels.push_back({table.headers[column], shown(usual->first), shown(word), 0, 0, 0});
    std::vector<double>& has_word = model.columns.emplace_back();
    for (const std::size_t each : candidates) {
      has_word.push_back(table.cells[each][column] == word ? 1 : 0);
    }
  }
}

EffectModel effect_model(const CandidateTable& table, const std::vector<std::size_t>& candidates) {
  EffectModel out;
  for (std::size_t k = 0; k < table.headers.size(); ++k) {
    const bool is_uncertainty = std::any_of(table.uncertainties.begin(), table.uncertainties.end(),
                                            [k](const auto& each) { return each.column == k; });
    if (is_uncertainty) continue;
    const std::vector<double> numbers = numbers_of_column(table, k);
    const bool all_are_numbers = std::all_of(candidates.begin(), candidates.end(), [&](auto each) {
      return std::isfinite(numbers[each]);
    });
    const bool differs = std::any_of(candidates.begin(), candidates.end(), [&](auto each) {
      return all_are_numbers ? numbers[each] != numbers[candidates.front()]
                             : table.cells[each][k] != table.cells[candidates.front()][k];
    });
    if (!differs) {
      out.left_out.push_back(table.headers[k] + " (the same for all)");
    } else if (all_are_numbers) {
      add_numbers(table, k, candidates, numbers, out);
    } else {
      add_words(table, k, candidates, out);
    }
  }
  return out;
}

int effect_places(double error) {
  if (!(error > 0)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
}

std::string plus_text(double value, int places) {
  return (value > 0 ? "+" : "") + fixed(value, places);
}

/// Returns the numbers of a column of the table, or else of a contact figure, by candidate.
std::vector<double> front_values(const Screening& screening,
                                 const std::vector<CandidateFigures>& ranking,
                                 const std::string& column) {
  check_front_column(screening, column);
  const CandidateTable& table = screening.table;
  const auto found = std::find(table.headers.begin(), table.headers.end(), column);
  if (found != table.headers.end()) {
    return numbers_of_column(table, static_cast<std::size_t>(found - table.headers.begin()));
  }
  const auto& figures = contact_figures_of_points();
  const auto figure =
      static_cast<std::size_t>(std::find(figures.begin(), figures.end(), column) - figures.begin());
  std::vector<double> out(table.size(), kNoValue);
  for (const CandidateFigures& each : ranking) {
    if (each.refusal.empty()) out[each.candidate] = each.contact[figure];
  }
  return out;
}

}  // namespace

RankingConfidence ranking_confidence(const std::vector<CandidateFigures>& ranking,
                                     const std::vector<UncertainInput>& inputs,
                                     const std::vector<std::vector<double>>& effects,
                                     double confidence) {
  RankingConfidence out;
  out.confidence = confidence;
  for (const UncertainInput& input : inputs) {
    (input.is_shared ? out.shared : out.own).push_back(label_of_field(input.field->name()));
  }
  out.of.resize(effects.size());
  std::vector<std::size_t> positions;  // in the ranking, of candidates with all effects
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const bool is_whole = std::all_of(effects[i].begin(), effects[i].end(),
                                      [](double each) { return std::isfinite(each); });
    if (is_whole) positions.push_back(i);
  }
  // Without the best one there is nothing to compare with.
  if (positions.empty() || positions.front() != 0) return out;
  const auto rows = static_cast<Eigen::Index>(positions.size());
  UncertainCandidates candidates{
      Eigen::VectorXd(rows), Eigen::VectorXd(rows),
      Eigen::MatrixXd(rows, static_cast<Eigen::Index>(out.own.size())),
      Eigen::MatrixXd(rows, static_cast<Eigen::Index>(out.shared.size()))};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t position = positions[static_cast<std::size_t>(row)];
    candidates.values(row) = ranking[position].inefficiency;
    candidates.solver_errors(row) = ranking[position].solver_error;
    Eigen::Index own = 0, shared = 0;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (inputs[k].is_shared) {
        candidates.shared_effects(row, shared++) = effects[position][k];
      } else {
        candidates.own_effects(row, own++) = effects[position][k];
      }
    }
  }
  for (const RankedCandidate& each : ranked_candidates(candidates, confidence)) {
    const double uncertainty = std::sqrt(candidates.own_effects.row(each.index).squaredNorm() +
                                         candidates.shared_effects.row(each.index).squaredNorm());
    out.of[positions[static_cast<std::size_t>(each.index)]] = {
        uncertainty, each.to_best.higher_probability, each.is_tied};
  }
  return out;
}

void check_front_column(const Screening& screening, const std::string& column) {
  std::vector<std::string> names = screening.table.headers;
  if (screening.has_contact_figures()) {
    names.insert(names.end(), contact_figures_of_points().begin(),
                 contact_figures_of_points().end());
  }
  if (std::find(names.begin(), names.end(), column) != names.end()) return;
  const auto& figures = contact_figures_of_points();
  const bool is_figure = std::find(figures.begin(), figures.end(), column) != figures.end();
  const std::string meant = nearest(column, names);
  throw Failure(kExitUsage,
                "--pareto: the table has no column '" + printable(column) + "'" +
                    (is_figure       ? "; --contact-figures computes it"
                     : meant.empty() ? "; it has " + joined(screening.table.headers, ", ")
                                     : " (is " + meant + " meant?)"));
}

ScreeningFront screening_front(const Screening& screening,
                               const std::vector<CandidateFigures>& ranking,
                               const std::string& column, bool wants_most) {
  ScreeningFront out;
  out.column = column;
  out.wants_most = wants_most;
  out.values = front_values(screening, ranking, column);
  std::vector<double> inefficiencies, values;
  for (const CandidateFigures& each : ranking) {
    const double value = each.refusal.empty() ? out.values[each.candidate] : kNoValue;
    inefficiencies.push_back(each.inefficiency);
    values.push_back(wants_most ? -value : value);
  }
  for (const std::size_t position : pareto_front(inefficiencies, values)) {
    out.front.push_back(ranking[position].candidate);
  }
  if (out.front.empty()) {
    throw Failure(kExitUsage, "--pareto: column '" + printable(column) +
                                  "' has no numbers of ranked candidates");
  }
  return out;
}

std::optional<ScreeningEffects> screening_effects(const Screening& screening,
                                                  const std::vector<CandidateFigures>& ranking) {
  std::vector<std::size_t> candidates;
  std::vector<double> responses;
  for (const CandidateFigures& each : ranking) {
    if (!each.refusal.empty()) continue;
    candidates.push_back(each.candidate);
    responses.push_back(each.inefficiency);
  }
  if (candidates.empty()) return std::nullopt;
  EffectModel model = effect_model(screening.table, candidates);
  const auto rows = static_cast<Eigen::Index>(candidates.size());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(model.columns.size()));
  for (std::size_t k = 0; k < model.columns.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXd>(model.columns[k].data(), rows);
  }
  const auto found = main_effects(
      columns, Eigen::Map<const Eigen::VectorXd>(responses.data(), rows), kEffectCoverage);
  if (!found) return std::nullopt;
  ScreeningEffects out;
  out.degrees_of_freedom = found->degrees_of_freedom;
  out.residual_standard_deviation = found->residual_standard_deviation;
  out.explained_share = found->explained_share;
  out.left_out = std::move(model.left_out);
  for (std::size_t k = 0; k < model.labels.size(); ++k) {
    const auto& effect = found->effects[k];
    if (!effect) {
      out.left_out.push_back(model.labels[k].column + " (follows from the columns before it)");
      continue;
    }
    ScreeningEffect& each = out.effects.emplace_back(std::move(model.labels[k]));
    each.effect = effect->effect;
    each.low = effect->low;
    each.high = effect->high;
  }
  std::stable_sort(out.effects.begin(), out.effects.end(), [](const auto& a, const auto& b) {
    return std::abs(a.effect) > std::abs(b.effect);
  });
  return out;
}

std::string front_report(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                         const ScreeningFront& front) {
  using Align = Table::Align;
  Sheet title;
  title.heading("Pareto front: least inefficiency and " +
                std::string(front.wants_most ? "most " : "least ") + front.column);
  Table table({{"candidate", "", Align::kLeft},
               {"inefficiency", "%", Align::kDecimal},
               {front.column, "", Align::kDecimal},
               {"rank", "", Align::kRight}});
  for (const std::size_t candidate : front.front) {
    const auto at = std::find_if(ranking.begin(), ranking.end(), [candidate](const auto& each) {
      return each.candidate == candidate;
    });
    table.add_row(
        {screening.table.names[candidate], fixed(at->inefficiency, effect_places(at->solver_error)),
         significant(front.values[candidate], 6), std::to_string(at - ranking.begin() + 1)});
  }
  Sheet note;
  note.remark("No other candidate has both a lower inefficiency and " +
              std::string(front.wants_most ? "more " : "less ") + front.column + ".");
  return title.text() + table.text() + note.text();
}

std::string effects_report(const ScreeningEffects& effects) {
  using Align = Table::Align;
  Sheet title;
  title.heading("Main effects on the mean inefficiency");
  Table table({{"column", "", Align::kLeft},
               {"from", "", Align::kDecimal},
               {"to", "", Align::kDecimal},
               {"effect", "%", Align::kDecimal},
               {"95 % interval", "%", Align::kRight},
               {"", "", Align::kLeft}});
  for (const ScreeningEffect& each : effects.effects) {
    const int places = effect_places(0.5 * (each.high - each.low));
    table.add_row({each.column, each.from, each.to, plus_text(each.effect, places),
                   plus_text(each.low, places) + " to " + plus_text(each.high, places),
                   each.low > 0 || each.high < 0 ? "" : "cannot be told from zero"});
  }
  Sheet note;
  note.remark("A linear model of all columns without interactions explains " +
              fixed(100 * effects.explained_share, 1) +
              " % of the variance; the rest scatters by " +
              significant(effects.residual_standard_deviation, 2) + " % (standard deviation, " +
              std::to_string(effects.degrees_of_freedom) +
              " degrees of freedom), and the intervals follow from that scatter by Student's t "
              "distribution.");
  if (!effects.left_out.empty()) {
    note.remark("Without an effect: " + joined(effects.left_out, ", ") + ".");
  }
  return title.text() + table.text() + note.text();
}

std::string front_json(const Screening& screening, const ScreeningFront& front) {
  std::string out;
  for (const std::size_t candidate : front.front) {
    out += std::string(out.empty() ? "" : ", ") +
           "{\"candidate\": " + json_quoted(screening.table.names[candidate]) +
           ", \"value\": " + json_number(front.values[candidate]) + "}";
  }
  return "{\"column\": " + json_quoted(front.column) +
         ", \"wants_most\": " + (front.wants_most ? "true" : "false") + ", \"candidates\": [" +
         out + "]}";
}

std::string effects_json(const ScreeningEffects& effects) {
  std::string out;
  for (const ScreeningEffect& each : effects.effects) {
    out += std::string(out.empty() ? "" : ",") +
           "\n      {\"column\": " + json_quoted(each.column) +
           ", \"from\": " + json_quoted(each.from) + ", \"to\": " + json_quoted(each.to) +
           ", \"effect_percent\": " + json_number(each.effect) +
           ", \"low_percent\": " + json_number(each.low) +
           ", \"high_percent\": " + json_number(each.high) + "}";
  }
  return "{\"explained_share\": " + json_number(effects.explained_share) +
         ", \"residual_standard_deviation_percent\": " +
         json_number(effects.residual_standard_deviation) +
         ", \"degrees_of_freedom\": " + std::to_string(effects.degrees_of_freedom) +
         ", \"effects\": [" + out + "]}";
}

}  // namespace tribodyn::client
