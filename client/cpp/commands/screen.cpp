#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/plot/screening_plot.h"
#include "client/cpp/report/part_file.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/report/screening_decisions.h"
#include "client/cpp/report/screening_report.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/candidate_errors.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/service/point_batches.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

/// Candidates that are compared with the best one, from the best on: at least and at most. It takes
/// two points for each input and condition.
constexpr int kLeastCompared = 30, kMostCompared = 200;

struct ScreenFlags {
  std::string path;
  v1::EvaluatePointsRequest request;  ///< without conditions
  std::vector<double> speeds, sumps;
  std::vector<double> speed_weights, sump_weights;
  v1::PointCondition common;
  std::vector<std::string> carried;
  int top = 20;
  std::string csv_path, json_lines_path, plot_path;
  std::vector<StatedUncertainty> uncertainties;
  double confidence = 0.95;
  bool leaves_out_uncertainty = false;
  std::string pareto_column;
  bool wants_most = false;
  bool wants_effects = false;
};

/// Reads "PARAMETER=VALUE", e.g. "pressure-viscosity=0.5/GPa" or "relaxation-time=10%".
void read_uncertainty_flag(const std::string& text, std::vector<StatedUncertainty>& out,
                           Complaints& complaints) {
  const std::string start = "--uncertainty: '" + printable(text) + "' ";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    complaints.push_back(start + "is not PARAMETER=VALUE");
    return;
  }
  const std::string word = text.substr(0, equals);
  std::string value = text.substr(equals + 1), wrong;
  const google::protobuf::FieldDescriptor* field =
      find_parameter(kind_of(*v1::Surface::descriptor()), word, wrong);
  if (field == nullptr) {
    field = find_parameter(kind_of(*v1::Lubricant::descriptor()), word, wrong);
  }
  if (field == nullptr) {
    complaints.push_back(start + wrong);
    return;
  }
  const bool is_relative = value.ends_with("%");
  if (is_relative) value.pop_back();
  const std::string unit = is_relative ? "" : unit_of_field(field->name());
  const std::string trade = trade_unit_of_field(field->name());
  // The uncertainty of a temperature is a difference.
  const std::string bare = unit.empty() ? "" : trade == "C" ? "K" : trade;
  const auto read = read_quantity(value, unit, bare, false, wrong);
  if (!read || !(*read > 0)) {
    complaints.push_back(start + (read ? "must be above 0" : wrong));
    return;
  }
  out.push_back({field, is_relative ? *read / 100 : *read, is_relative});
}

void add_screen_flags(FlagList& list, ScreenFlags& flags) {
  v1::EvaluatePointsRequest& request = flags.request;
  list.group("Arguments");
  list.text("table", "FILE.csv",
            "Table of candidates, one a row; - is standard input. `tribodyn help screening` "
            "describes its columns.",
            [&flags](const std::string& path) { flags.path = path; });
  Flag& like = list.text("--like", "LUBRICANT",
                         "The base: what a candidate does not state is as in this lubricant.",
                         [&request](const std::string& name) {
                           request.set_lubricant(resource_name("lubricants", name));
                         });
  like.collection = "lubricants";
  like.field = "lubricant";
  list.texts("--carry", "COLUMN",
             "Columns that are carried along although their names resemble those of parameters",
             [&flags](const std::string& name) { flags.carried.push_back(name); });
  list.group("Conditions (every speed at every sump temperature)");
  list.numbers("--speed-kilometres-per-hour,--speeds,--speed", {"km/h", "0.1 to 400", "60"},
               "Vehicle speeds separated by commas",
               [&flags](double value) { flags.speeds.push_back(value); });
  list.numbers("--sump-temperature-celsius,--sumps,--sump", {"C", "-70 to 200", "40"},
               "Temperatures of the oil bath separated by commas",
               [&flags](double value) { flags.sumps.push_back(value); });
  list.numbers("--weights", {"-", "above 0", "equal"},
               "Weights of the speeds in the mean, one for each",
               [&flags](double value) { flags.speed_weights.push_back(value); });
  list.numbers("--sump-weights", {"-", "above 0", "equal"},
               "Weights of the sump temperatures in the mean, one for each",
               [&flags](double value) { flags.sump_weights.push_back(value); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&flags](double value) { flags.common.set_ascent_angle_degrees(value); });
  flags.common.set_inlet_temperature_rise_kelvin(20);
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
              [&flags](double value) { flags.common.set_inlet_temperature_rise_kelvin(value); });
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&request](const std::string& name) {
              request.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  request.set_surface("surfaces/run-in");
  list.text("--surface", "NAME",
            "Surface of all candidates where they state no roughness or boundary friction of their "
            "own. Default: run-in.",
            [&request](const std::string& name) {
              request.set_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [&request](const std::string& name) {
              request.set_vehicle(resource_name("vehicles", name));
            })
      .collection = "vehicles";
  list.group("Decisions");
  Flag& uncertainty = list.raw("--uncertainty", "PARAMETER=VALUE",
                               "Standard uncertainty of a parameter, e.g. "
                               "pressure-viscosity=0.5/GPa or relaxation-time=10%; "
                               "repeatable. Of a parameter in the table it is each candidate's "
                               "own, of another one common to "
                               "all, as are those that the base states.");
  uncertainty.is_repeatable = true;
  uncertainty.read = [&flags](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      read_uncertainty_flag(text, flags.uncertainties, complaints);
    }
  };
  list.number("--confidence", {"-", "0.5 to 0.9999", "0.95"},
              "Probability from which on two candidates can be told apart; others are ties",
              [&flags](double value) { flags.confidence = value; });
  list.toggle("--no-uncertainty", "Leave out the uncertainty of the inputs.",
              [&flags] { flags.leaves_out_uncertainty = true; });
  list.text("--pareto", "COLUMN",
            "Also print the Pareto front of least inefficiency and least COLUMN, a column of the "
            "table, e.g. cost.",
            [&flags](const std::string& column) { flags.pareto_column = column; });
  list.toggle("--pareto-most", "In the Pareto front more of the column is better.",
              [&flags] { flags.wants_most = true; });
  list.toggle("--effects",
              "Also print the main effects of all columns on the mean inefficiency, with their "
              "intervals.",
              [&flags] { flags.wants_effects = true; });
  add_plot_flag(list, "Also draw what --pareto and --effects compute, as SVG.", flags.plot_path);
  list.group("Results");
  list.whole_number("--top", {"candidates", "1 to 1000000", "20"},
                    "Candidates that the table shows, the best first; --output csv and json have "
                    "all of them",
                    [&flags](int value) { flags.top = value; });
  add_result_file_flag(list, "--csv", "FILE",
                       "Also write every candidate at every condition as CSV. After an "
                       "interruption the same command goes on where it ended.",
                       flags.csv_path);
  add_result_file_flag(list, "--jsonl", "FILE",
                       "The same as JSON, one object a line, with the same resumption.",
                       flags.json_lines_path);
  list.group("Solver");
  list.number("--tolerance", {"-", "1e-8 to 0.01", "0.001"},
              "Target of the relative solver error of every point",
              [&request](double value) { request.set_tolerance(value); });
  add_model_flags(list, *request.mutable_model_options());
}

void check_weights(const char* flag, std::size_t weights, std::size_t values, const char* what,
                   Complaints& complaints) {
  if (weights == 0 || weights == std::max<std::size_t>(values, 1)) return;
  complaints.push_back(std::string(flag) + ": " + std::to_string(weights) + " weights of " +
                       std::to_string(std::max<std::size_t>(values, 1)) + " " + what +
                       "; give one for each");
}

void check_screen_flags(const ScreenFlags& flags, Complaints& complaints) {
  if (flags.path.empty()) {
    complaints.emplace_back("give a table: tribodyn screen candidates.csv --like LUBRICANT");
  }
  if (flags.request.lubricant().empty()) complaints.emplace_back("--like is missing");
  check_weights("--weights", flags.speed_weights.size(), flags.speeds.size(), "speeds", complaints);
  check_weights("--sump-weights", flags.sump_weights.size(), flags.sumps.size(),
                "sump temperatures", complaints);
  for (const auto* weights : {&flags.speed_weights, &flags.sump_weights}) {
    for (const double weight : *weights) {
      if (weight > 0) continue;
      complaints.push_back(
          std::string(weights == &flags.speed_weights ? "--weights" : "--sump-weights") + " = " +
          significant(weight) + "; allowed: above 0");
    }
  }
  const std::size_t conditions =
      std::max<std::size_t>(flags.speeds.size(), 1) * std::max<std::size_t>(flags.sumps.size(), 1);
  if (conditions > kMostPointsOfACall) {
    complaints.push_back(std::to_string(conditions) +
                         " conditions of --speeds and --sumps; allowed: at most " +
                         std::to_string(kMostPointsOfACall));
  }
  if (flags.top < 1) complaints.emplace_back("--top must be at least 1");
  if (!flags.csv_path.empty() && !flags.json_lines_path.empty()) {
    complaints.emplace_back("give either --csv or --jsonl");
  }
  if (!(flags.confidence >= 0.5 && flags.confidence <= 0.9999)) {
    complaints.push_back("--confidence = " + significant(flags.confidence) +
                         "; allowed: 0.5 to 0.9999");
  }
  if (flags.wants_most && flags.pareto_column.empty()) {
    complaints.emplace_back("--pareto-most applies to --pareto, which is missing");
  }
  if (!flags.plot_path.empty() && flags.pareto_column.empty() && !flags.wants_effects) {
    complaints.emplace_back("--plot draws what --pareto COLUMN and --effects compute; give one");
  }
}

/// Sets the conditions and their weights.
void set_conditions(ScreenFlags& flags, Screening& screening) {
  if (flags.speeds.empty()) flags.speeds.push_back(60);
  if (flags.sumps.empty()) flags.sumps.push_back(40);
  for (std::size_t j = 0; j < flags.sumps.size(); ++j) {
    for (std::size_t i = 0; i < flags.speeds.size(); ++i) {
      v1::PointCondition& condition = *screening.request.add_conditions();
      condition = flags.common;
      condition.set_sump_temperature_celsius(flags.sumps[j]);
      condition.set_speed_kilometres_per_hour(flags.speeds[i]);
      screening.weights.push_back((flags.speed_weights.empty() ? 1 : flags.speed_weights[i]) *
                                  (flags.sump_weights.empty() ? 1 : flags.sump_weights[j]));
    }
  }
  const double sum = std::accumulate(screening.weights.begin(), screening.weights.end(), 0.0);
  for (double& weight : screening.weights) weight /= sum;
}

/// Evaluates the base and reads the table. Everything that is wrong with the command shows here.
Screening prepared_screening(ScreenFlags& flags, const v1::Schema& schema, Connection& connection) {
  // A table that cannot be read needs no server.
  const std::string text = read_table_file(flags.path, kLargestFile);
  Screening out;
  out.request = flags.request;
  set_conditions(flags, out);
  out.base = connection.evaluate_points(out.request);
  out.request.set_lubricant(out.base.lubricant_revision());
  out.request.set_surface(out.base.surface_revision());
  out.request.set_gear_set(out.base.gear_set_revision());
  out.request.set_vehicle(out.base.vehicle_revision());
  CandidateBase& base = out.bases;
  base.lubricant = connection.get<v1::Lubricant>(out.request.lubricant());
  base.surface = connection.get<v1::Surface>(out.request.surface());
  const ResourcePointer stated =
      base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()), out.request.lubricant());
  base.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  out.table = read_candidates(text, flags.path, base, flags.carried);
  if (!flags.pareto_column.empty()) front_column(out.table, flags.pareto_column);
  if (!out.table.note.empty()) std::cerr << "tribodyn: " << printable(out.table.note) << "\n";
  characterise_candidates(connection, base, out.table);
  check_candidate_ranges(schema, out.table);
  ScreenedPoint none{};
  none.figures.fill(std::nan(""));
  out.points.assign(out.table.size() * out.conditions(), none);
  for (std::size_t i = 0; i < out.table.size(); ++i) {
    for (std::size_t k = 0; k < out.conditions() && !out.table.refusals[i].empty(); ++k) {
      ScreenedPoint& point = out.points[i * out.conditions() + k];
      point.refusal_reason = "INVALID_CANDIDATE";
      point.refusal_message = out.table.refusals[i];
    }
  }
  return out;
}

/// Computes the points of a screening and writes them as they come.
class ScreeningRun {
 public:
  ScreeningRun(Screening& screening, std::string path, bool as_json_lines,
               const CommonOptions& options)
      : screening_(screening),
        path_(std::move(path)),
        as_json_lines_(as_json_lines),
        display_(std::cerr, options.progress_form(), standard_error_width()) {
    // JSON lines are made of the part at the end: a pipe gets nothing but them.
    if (path_.empty() || (as_json_lines_ && PartFile::is_stream(path_))) return;
    file_.emplace(path_, screening_identity(screening_), screening_header(screening_));
    if (file_->rows_there() == 0) return;
    rows_written_ = read_screening_rows(read_file(file_->target()), screening_);
    if (rows_written_ != static_cast<std::size_t>(file_->rows_there())) {
      throw Failure(kExitFailed, file_->target() + ": row " + std::to_string(rows_written_ + 2) +
                                     " is damaged. Remove the file to begin again.");
    }
    first_ = rows_written_ / screening_.conditions();
    std::cerr << "tribodyn: resumes after " << first_ << " of " << screening_.table.size()
              << " candidates in " << printable(file_->target()) << "\n";
  }

  void run(Connection& connection) {
    const InterruptGuard guard;
    for (std::size_t i = first_; i < screening_.table.size(); ++i) {
      if (screening_.table.refusals[i].empty()) candidates_.push_back(i);
    }
    start_ = std::chrono::steady_clock::now();
    try {
      evaluate_candidates(
          connection, screening_.request, screening_.table.parameters, candidates_,
          [this](const PointBatch& batch) { take(batch); },
          [this] {
            show("running");
            return !InterruptGuard::interrupted();
          });
    } catch (const ServiceError& error) {
      if (!file_ || error.kind() == ServiceError::Kind::kRefused) throw;
      const Failure failure(error);
      throw Failure(failure.exit_code(),
                    std::string(failure.what()) +
                        "\n  Run the same command again to go on: the candidates so far are in " +
                        file_->target());
    }
    if (InterruptGuard::interrupted()) throw interruption();
    write_until(screening_.table.size());
    show("succeeded");
    display_.finish();
  }

  /// Gives the file its final name and form.
  void finish() {
    if (path_.empty()) return;
    if (!as_json_lines_) return file_->finish();
    write_file(path_, screening_json_lines(screening_));
    if (file_) file_->discard();
  }

 private:
  void take(const PointBatch& batch) {
    const std::size_t conditions = screening_.conditions();
    for (std::size_t i = 0; i < batch.count; ++i) {
      const std::size_t candidate = candidates_[batch.first + i];
      for (std::size_t k = 0; k < conditions; ++k) {
        screening_.points[candidate * conditions + k] =
            screened_point(batch.answer, static_cast<int>(i * conditions + k));
      }
    }
    done_ = batch.first + batch.count;
    write_until(candidates_[done_ - 1] + 1);
  }

  /// Writes the rows of all candidates before `end` that are not in the file.
  void write_until(std::size_t end) {
    if (!file_) return;
    const std::size_t conditions = screening_.conditions();
    std::string rows;
    for (std::size_t i = rows_written_ / conditions; i < end; ++i) {
      const std::string of_candidate = screening_rows(screening_, i, i + 1);
      // A part may end within a candidate.
      std::size_t begin = 0;
      for (std::size_t n = i * conditions; n < rows_written_; ++n) {
        begin = of_candidate.find('\n', begin) + 1;
      }
      rows += of_candidate.substr(begin);
      rows_written_ = (i + 1) * conditions;
    }
    file_->add(rows);
  }

  void show(const std::string& state) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double rate = static_cast<double>(done_ * screening_.conditions()) / seconds;
    JobProgress progress;
    progress.label = "screening";
    progress.state = state;
    progress.stage = std::to_string(first_ + done_) + " of " +
                     std::to_string(screening_.table.size()) + " candidates" +
                     (done_ == 0 ? "" : ", " + significant(rate, 2) + " points/s");
    progress.fraction = candidates_.empty()
                            ? 1
                            : static_cast<double>(done_) / static_cast<double>(candidates_.size());
    progress.ended = state == "succeeded";
    if (progress.ended) progress.state += ", " + progress.stage;
    display_.show({progress});
  }

  Failure interruption() const {
    std::string text = "interrupted after " + std::to_string(first_ + done_) + " of " +
                       std::to_string(screening_.table.size()) + " candidates. ";
    text += file_ ? "Run the same command again to go on: they are in " + file_->target()
                  : "Nothing was kept; with --csv FILE the same command would go on.";
    return {kExitInterrupted, text};
  }

  Screening& screening_;
  const std::string path_;
  const bool as_json_lines_;
  ProgressDisplay display_;
  std::optional<PartFile> file_;
  std::vector<std::size_t> candidates_;  ///< that are to be evaluated
  std::size_t first_ = 0;                ///< candidates that were in the file
  std::size_t done_ = 0;                 ///< of candidates_
  std::size_t rows_written_ = 0;
  std::chrono::steady_clock::time_point start_;
};

/// Returns how sure the ranking is. Where all compared candidates are ties, more are compared.
RankingConfidence confidence_of(const ScreenFlags& flags, const Screening& screening,
                                const std::vector<CandidateFigures>& ranking,
                                const v1::Schema& schema, Connection& connection) {
  RankingConfidence out;
  const std::vector<UncertainInput> inputs = uncertain_inputs(screening, flags.uncertainties);
  out.has_no_inputs = inputs.empty();
  std::vector<std::size_t> candidates;
  for (const CandidateFigures& each : ranking) {
    if (each.refusal.empty()) candidates.push_back(each.candidate);
  }
  if (inputs.empty() || candidates.empty()) return out;
  for (const int most : {std::clamp(flags.top, kLeastCompared, kMostCompared), kMostCompared}) {
    const std::size_t count = std::min(candidates.size(), static_cast<std::size_t>(most));
    const std::vector<std::size_t> compared(
        candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count));
    out = ranking_confidence(ranking, inputs,
                             input_effects(connection, screening, schema, inputs, compared),
                             flags.confidence);
    if (count == candidates.size() || !out.of.back() || !out.of.back()->is_tied) break;
  }
  return out;
}

/// The Pareto front and the main effects that were asked for.
struct Decisions {
  std::optional<ScreeningFront> front;
  std::optional<ScreeningEffects> effects;
};

Decisions decisions_of(const ScreenFlags& flags, const Screening& screening,
                       const std::vector<CandidateFigures>& ranking) {
  Decisions out;
  if (!ranking.front().refusal.empty()) return out;
  if (!flags.pareto_column.empty()) {
    out.front = screening_front(screening, ranking, flags.pareto_column, flags.wants_most);
  }
  if (flags.wants_effects) {
    out.effects = screening_effects(screening, ranking);
    if (!out.effects) {
      throw Failure(kExitUsage,
                    "--effects: too few candidates for as many columns; give at least two more "
                    "candidates with figures than columns that differ");
    }
  }
  return out;
}

int run_screen(ScreenFlags& flags, const CommonOptions& options) {
  const bool has_decisions = !flags.pareto_column.empty() || flags.wants_effects;
  if (options.output_format == OutputFormat::kCsv && has_decisions && flags.plot_path.empty()) {
    throw Failure(
        kExitUsage,
        "--output csv is the ranking alone; use --output json for --pareto and --effects, "
        "or draw them with --plot");
  }
  Connection connection = options.connect();
  const v1::Schema schema = connection.schema();
  Screening screening = prepared_screening(flags, schema, connection);
  const bool as_json_lines = !flags.json_lines_path.empty();
  ScreeningRun run(screening, as_json_lines ? flags.json_lines_path : flags.csv_path, as_json_lines,
                   options);
  run.run(connection);
  run.finish();
  const std::vector<CandidateFigures> ranking = ranked(screening);
  const RankingConfidence confidence =
      flags.leaves_out_uncertainty ? RankingConfidence()
                                   : confidence_of(flags, screening, ranking, schema, connection);
  const auto [front, effects] = decisions_of(flags, screening, ranking);
  std::map<std::string, std::string> members;
  if (front) members["pareto_front"] = front_json(screening, *front);
  if (effects) members["main_effects"] = effects_json(*effects);
  std::cout << screening_report(screening, ranking, confidence, static_cast<std::size_t>(flags.top),
                                options.output_format, members);
  if (options.output_format == OutputFormat::kTable) {
    if (front) std::cout << "\n" << front_report(screening, ranking, *front);
    if (effects) std::cout << "\n" << effects_report(*effects);
  }
  if (!flags.plot_path.empty() && (front || effects)) {
    write_file(flags.plot_path, screening_plot(screening, ranking, front ? &*front : nullptr,
                                               effects ? &*effects : nullptr));
  }
  return ranking.front().refusal.empty() ? kExitOk : kExitFailed;
}

}  // namespace

Command screen_command() {
  const auto flags = std::make_shared<ScreenFlags>();
  Command command{
      "screen",
      "rank candidates of a table by their inefficiency",
      "Evaluates variants of a lubricant, one a row of a table, at every speed and sump "
      "temperature "
      "and ranks them by the weighted mean of the inefficiency. Columns override parameters of the "
      "lubricant and of the surface, or hold measurements; others are carried along. Nothing is "
      "stored on the server.",
      {"tribodyn screen candidates.csv --like my-oil --speeds 20,40,60 --sumps 40,90",
       "tribodyn screen candidates.csv --like my-oil --speeds 20,60,100 --weights 1,2,1 --csv "
       "points.csv",
       "tribodyn screen candidates.csv --like my-oil --uncertainty pressure-viscosity=3% --pareto "
       "cost --effects --plot screening.svg",
       "tribodyn screen candidates.csv --like my-oil --output csv"},
      {},
      {},
      {}};
  add_screen_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) { check_screen_flags(*flags, complaints); };
  command.main_flags = {"table",         "--like",    "--speeds",  "--sumps",   "--weights",
                        "--uncertainty", "--pareto",  "--plot",    "--effects", "--top",
                        "--csv",         "--surface", "--vehicle", "--gear-set"};
  command.run = [flags](const CommonOptions& options) { return run_screen(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
