#include "client/cpp/report/cycle_report.h"

#include <algorithm>
#include <cmath>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

/// Returns e.g. "drive, steady", "30 to 60 km/h".
std::string part_name(const v1::CyclePart& part) {
  const std::string low = significant(part.minimum_speed_kilometres_per_hour());
  const std::string high = significant(part.maximum_speed_kilometres_per_hour());
  switch (part.kind()) {
    case v1::CYCLE_PART_KIND_ALL:
      return "all";
    case v1::CYCLE_PART_KIND_STANDSTILL:
      return "standstill";
    case v1::CYCLE_PART_KIND_DRIVE:
      return "drive";
    case v1::CYCLE_PART_KIND_DRIVE_ACCELERATING:
      return "drive, accelerating";
    case v1::CYCLE_PART_KIND_DRIVE_STEADY:
      return "drive, steady";
    case v1::CYCLE_PART_KIND_DRIVE_DECELERATING:
      return "drive, decelerating";
    case v1::CYCLE_PART_KIND_COAST:
      return "coast and braking";
    default:
      return high == "0" ? "above " + low + " km/h" : low + " to " + high + " km/h";
  }
}

std::string cycle_oil(const v1::CycleLubricant& lubricant) {
  const std::string& revision = lubricant.lubricant_revision();
  return revision.substr(revision.find('/') + 1);
}

/// Returns e.g. "sump 40 C", "sump 20 to 80 C".
std::string sump_text(const v1::EvaluateCycleResponse& answer) {
  const auto [low, high] = std::minmax_element(answer.sump_temperature_celsius().begin(),
                                               answer.sump_temperature_celsius().end());
  const std::string from = significant(*low, 4), to = significant(*high, 4);
  return "sump " + (from == to ? from : from + " to " + to) + " C";
}

/// Returns the figure, or the sign for none.
std::string figure_or_dash(double figure, int digits) {
  return std::isnan(figure) ? "-" : significant(figure, digits);
}

CsvRow csv_row_of(const v1::EvaluateCycleResponse& answer, int i) {
  const v1::CyclePart& part = answer.parts(i);
  CsvRow out{{"part", part_name(part)},
             {"time_seconds", shortest(part.duration_seconds())},
             {"distance_metres", shortest(part.distance_metres())}};
  for (const v1::CycleLubricant& lubricant : answer.lubricants()) {
    const std::string start = cycle_oil(lubricant) + "_";
    const auto add = [&](const char* name, double figure) {
      out.emplace_back(start + name, std::isnan(figure) ? "" : shortest(figure));
    };
    const bool is_refused = lubricant.parts().empty();
    const v1::CyclePartLoss none;
    const v1::CyclePartLoss& loss = is_refused ? none : lubricant.parts(i);
    if (is_refused) {
      for (const char* name : {"input_joules", "loss_joules", "inefficiency_percent", "warnings",
                               "verdict_withheld"}) {
        out.emplace_back(start + name, "");
      }
      out.emplace_back(start + "refusal",
                       lubricant.refusal_reason() + ": " + lubricant.refusal_message());
      continue;
    }
    add("input_joules", loss.input_joules());
    add("loss_joules", loss.loss_joules());
    add("inefficiency_percent", loss.inefficiency_percent());
    out.emplace_back(start + "warnings", codes_of(lubricant.warnings()));
    out.emplace_back(start + "verdict_withheld",
                     withheld_by(lubricant.warnings()).empty() ? "false" : "true");
    out.emplace_back(start + "refusal", "");
  }
  return out;
}

void add_cells(const v1::CycleLubricant& lubricant, int part, bool is_first,
               std::vector<std::string>& row) {
  if (lubricant.parts().empty()) {
    row.insert(row.end(), is_first ? 3 : 4, "-");
    return;
  }
  const v1::CyclePartLoss& loss = lubricant.parts(part);
  row.push_back(significant(1e-3 * loss.loss_joules(), 4));
  row.push_back(fixed(loss.loss_share_percent(), 1));
  row.push_back(figure_or_dash(loss.inefficiency_percent(), 4));
  if (is_first) return;
  const double difference = loss.loss_difference_percent();
  row.push_back(std::isnan(difference) ? "-" : signed_fixed(difference, 2));
}

/// Returns e.g. "my-oil@1: estimated error of the map 0.13 kJ, of the solver 0.04 kJ, 583 points".
std::string error_text(const v1::CycleLubricant& lubricant) {
  std::string out = cycle_oil(lubricant) + ": ";
  if (!lubricant.refusal_reason().empty()) {
    return out + "refused: " + lubricant.refusal_message() + "\n";
  }
  out += lubricant.map_error_joules() > 0
             ? "estimated error of the map " + significant(1e-3 * lubricant.map_error_joules(), 2) +
                   " kJ, "
             : std::string("point by point, ");
  out += std::isnan(lubricant.solver_error_joules())
             ? std::string("of the solver not known, ")
             : "of the solver at most " + significant(1e-3 * lubricant.solver_error_joules(), 2) +
                   " kJ, ";
  return out + std::to_string(lubricant.points()) + " points\n";
}

/// Returns the warnings of the points, and of the inputs if `has_inputs`, with the lubricants that
/// have them.
std::vector<ShownWarning> cycle_warnings(const v1::EvaluateCycleResponse& answer, bool has_inputs) {
  std::vector<std::string> names;
  for (const v1::CycleLubricant& each : answer.lubricants()) names.push_back(cycle_oil(each));
  WarningCollector out({""}, "", "", names);
  for (int k = 0; k < answer.lubricants_size(); ++k) {
    const auto subject = static_cast<std::size_t>(k);
    out.add(answer.lubricants(k).warnings(), subject, 0);
    if (has_inputs) out.add(answer.lubricants(k).input_warnings(), subject, 0);
  }
  return out.warnings();
}

/// Returns the notes about the lubricants, each once with those that have it.
std::string notes_text(const v1::EvaluateCycleResponse& answer) {
  std::vector<ShownWarning> notes;
  for (const v1::CycleLubricant& lubricant : answer.lubricants()) {
    const std::string name = answer.lubricants_size() == 1 ? "" : cycle_oil(lubricant);
    for (const v1::RangeWarning& each : lubricant.input_warnings()) {
      const auto known = std::find_if(notes.begin(), notes.end(), [&each](const auto& note) {
        return note.code == each.code() && note.message == each.message();
      });
      if (known == notes.end()) {
        notes.push_back(shown_warning(each));
        notes.back().where = name;
      } else {
        known->where += ", " + name;
      }
    }
  }
  if (notes.empty()) return "";
  Sheet sheet;
  sheet.heading("Notes on lubricant and surface");
  for (const ShownWarning& each : notes) sheet.remark(note_sentence(each));
  return "\n" + sheet.text();
}

/// Returns the words for a warning that withholds the verdict on one of two lubricants; empty if
/// none does.
std::string withheld_of_two(const v1::CycleLubricant& one, const v1::CycleLubricant& other) {
  const std::string summary = withheld_by(one.warnings());
  return summary.empty() ? withheld_by(other.warnings()) : summary;
}

}  // namespace

std::string cycle_refusals(const CycleRun& run) {
  std::string out;
  for (const v1::CycleLubricant& each : run.answer.lubricants()) {
    if (!each.refusal_reason().empty()) out += error_text(each);
  }
  return out;
}

std::string cycle_text(const CycleRun& run, OutputFormat format) {
  const v1::EvaluateCycleResponse& answer = run.answer;
  if (format == OutputFormat::kJson) return json_text(answer);
  if (format == OutputFormat::kCsv) {
    std::vector<CsvRow> rows;
    for (int i = 0; i < answer.parts_size(); ++i) rows.push_back(csv_row_of(answer, i));
    return csv_text(rows);
  }
  using enum Table::Align;
  std::vector<Table::Column> columns{{"part", "", kLeft},
                                     {"time", "s", kDecimal},
                                     {"distance", "km", kDecimal},
                                     {"energy in", "kJ", kDecimal}};
  for (int k = 0; k < answer.lubricants_size(); ++k) {
    columns.push_back({"loss, kJ", cycle_oil(answer.lubricants(k)), kDecimal});
    columns.push_back({"share, %", "", kDecimal});
    columns.push_back({"inefficiency, %", "", kDecimal});
    if (k > 0) columns.push_back({"difference, %", "", kDecimal});
  }
  Table table(columns);
  for (int i = 0; i < answer.parts_size(); ++i) {
    const v1::CyclePart& part = answer.parts(i);
    const v1::CycleLubricant& first = answer.lubricants(0);
    std::vector<std::string> row{
        part_name(part), significant(part.duration_seconds(), 5),
        fixed(1e-3 * part.distance_metres(), 3),
        first.parts().empty() ? "-" : significant(1e-3 * first.parts(i).input_joules(), 5)};
    for (int k = 0; k < answer.lubricants_size(); ++k) {
      add_cells(answer.lubricants(k), i, k == 0, row);
    }
    table.add_row(std::move(row));
  }
  std::string out = run.name + ", " + sump_text(answer) + ": mesh loss, quasi-steady, " +
                    answer.model_version() + "\n\n" + table.text() + "\n";
  const v1::CycleLubricant& first = answer.lubricants(0);
  for (const v1::CycleLubricant& each : answer.lubricants()) {
    out += error_text(each);
    const std::string withheld = withheld_of_two(first, each);
    if (&each != &first && !withheld.empty()) {
      out += wrapped("verdict " + withheld_text(withheld), 2);
    }
  }
  out += wrapped(answer.not_included(), 0) +
         wrapped(
             "Energy in: at the pinion in drive, at the wheels in coast, where the axle "
             "counts as transmitting all of the braking. Standstill: speeds below 0.1 km/h.",
             0);
  const std::string warnings = warnings_text(cycle_warnings(answer, false));
  return out + notes_text(answer) + (warnings.empty() ? "" : "\n" + warnings);
}

std::string cycle_pieces_csv(const CycleRun& run) {
  const v1::EvaluateCycleResponse& answer = run.answer;
  std::vector<CsvRow> rows;
  for (int i = 0; i < answer.start_seconds_size(); ++i) {
    CsvRow row{{"start_seconds", shortest(answer.start_seconds(i))},
               {"duration_seconds", shortest(answer.piece_seconds(i))},
               {"speed_kilometres_per_hour", shortest(answer.speed_kilometres_per_hour(i))},
               {"acceleration_metres_per_second_squared",
                shortest(answer.acceleration_metres_per_second_squared(i))},
               {"sump_temperature_celsius", shortest(answer.sump_temperature_celsius(i))},
               {"wheel_torque_newton_metres", shortest(answer.wheel_torque_newton_metres(i))}};
    for (const v1::CycleLubricant& each : answer.lubricants()) {
      row.emplace_back(cycle_oil(each) + "_loss_joules",
                       each.mesh_loss_power_watts().empty()
                           ? ""
                           : shortest(each.mesh_loss_power_watts(i) * answer.piece_seconds(i)));
    }
    rows.push_back(std::move(row));
  }
  return csv_text(rows);
}

std::string cycle_plot(const CycleRun& run) {
  constexpr double kWidth = 1000, kLeft = 70, kFirstTop = 84, kPanelWidth = 740, kPitch = 300;
  Panel speed, loss;
  speed.title = "Vehicle speed, km/h";
  loss.title = "Mesh loss, W";
  loss.x_title = "Time, s";
  Series driven;
  driven.colour = "#444444";
  driven.width = 1.6;
  const v1::EvaluateCycleResponse& answer = run.answer;
  for (int i = 0; i < answer.start_seconds_size(); ++i) {
    driven.x.push_back(answer.start_seconds(i) + 0.5 * answer.piece_seconds(i));
    driven.y.push_back(answer.speed_kilometres_per_hour(i));
  }
  speed.series.push_back(driven);
  for (int k = 0; k < answer.lubricants_size(); ++k) {
    const v1::CycleLubricant& lubricant = answer.lubricants(k);
    if (!lubricant.refusal_reason().empty()) continue;
    Series series;
    series.colour = look_of(static_cast<std::size_t>(k)).colour;
    series.width = 1.6;
    series.label = cycle_oil(lubricant);
    series.x = driven.x;
    series.y.assign(lubricant.mesh_loss_power_watts().begin(),
                    lubricant.mesh_loss_power_watts().end());
    loss.series.push_back(std::move(series));
  }
  loss.shows_samples = true;
  std::vector<std::string> texts = {"Quasi-steady points of a drive cycle; " + sump_text(answer) +
                                    "; model version " + answer.model_version() + ". " +
                                    answer.not_included()};
  const std::vector<ShownWarning> warnings = cycle_warnings(answer, true);
  for (std::string& each : warning_footers(warnings, true)) texts.push_back(std::move(each));
  if (!withheld_by(warnings).empty() && !driven.x.empty()) {
    hatch({{driven.x.front(), driven.x.back()}}, loss);
  }
  const std::vector<std::string> below = footer_lines(texts, kWidth - 2 * kLeft);
  const double footer_top = kFirstTop + kPitch + 220 + 66;
  Svg svg(kWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kLeft, 36}, "Drive cycle: " + run.name, {17, "start", "#111", true, 0});
  double top = kFirstTop;
  for (Panel* panel : {&speed, &loss}) {
    panel->corner = {kLeft, top};
    panel->width = kPanelWidth;
    panel->height = 220;
    panel->starts_at_zero = true;
    draw_panel(*panel, svg);
    top += kPitch;
  }
  draw_footer(below, {kLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
