#include "client/cpp/report/cycle_report.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kSteady = 0.02;  // magnitude of acceleration up to which speed is steady [m/s2]

/// Pieces of a cycle that have something in common.
struct CyclePart {
  std::string name;
  double seconds = 0, metres = 0;
  std::vector<double> input_joules, loss_joules;  // by lubricant
};

CyclePart part_of(const CycleRun& run, const std::string& name,
                  const std::function<bool(std::size_t)>& belongs) {
  CyclePart out;
  out.name = name;
  out.input_joules.resize(run.fluids.size());
  out.loss_joules.resize(run.fluids.size());
  for (std::size_t i = 0; i < run.pieces.size(); ++i) {
    if (!belongs(i)) continue;
    out.seconds += run.pieces[i].duration;
    out.metres += run.pieces[i].duration * run.pieces[i].speed;
    for (std::size_t k = 0; k < run.fluids.size(); ++k) {
      const double loss = run.fluids[k].loss_joules[i], wheel = run.wheel_energies[i];
      out.loss_joules[k] += loss;
      // In drive the pinion supplies what the wheels take and the loss, in coast the wheels.
      out.input_joules[k] += wheel > 0 ? wheel + loss : -wheel;
    }
  }
  return out;
}

std::vector<CyclePart> parts_of(const CycleRun& run) {
  const auto& pieces = run.pieces;
  const auto moves = [&](std::size_t i) { return run.wheel_energies[i] != 0; };
  const auto drives = [&](std::size_t i) { return run.wheel_energies[i] > 0; };
  std::vector<CyclePart> out;
  out.push_back(part_of(run, "all", [](std::size_t) { return true; }));
  out.push_back(part_of(run, "standstill", [&](std::size_t i) { return !moves(i); }));
  out.push_back(part_of(run, "drive, accelerating", [&](std::size_t i) {
    return drives(i) && pieces[i].acceleration > kSteady;
  }));
  out.push_back(part_of(run, "drive, steady", [&](std::size_t i) {
    return drives(i) && std::abs(pieces[i].acceleration) <= kSteady;
  }));
  out.push_back(part_of(run, "drive, decelerating", [&](std::size_t i) {
    return drives(i) && pieces[i].acceleration < -kSteady;
  }));
  out.push_back(
      part_of(run, "coast and braking", [&](std::size_t i) { return run.wheel_energies[i] < 0; }));
  constexpr double kBands[] = {0, 30, 60, 90, 130, 1000};  // [km/h]
  for (std::size_t k = 0; k + 1 < std::size(kBands); ++k) {
    const bool is_last = k + 2 == std::size(kBands);
    CyclePart band =
        part_of(run,
                is_last ? "above " + significant(kBands[k]) + " km/h"
                        : significant(kBands[k]) + " to " + significant(kBands[k + 1]) + " km/h",
                [&](std::size_t i) {
                  const double speed = 3.6 * pieces[i].speed;
                  return moves(i) && speed >= kBands[k] && speed < kBands[k + 1];
                });
    if (band.seconds > 0) out.push_back(std::move(band));
  }
  return out;
}

std::string id_of(const CycleLosses& fluid) {
  return fluid.lubricant.substr(fluid.lubricant.find('/') + 1);
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

CsvRow csv_row_of(const CyclePart& part, const CycleRun& run) {
  CsvRow out{{"part", part.name},
             {"time_seconds", shortest(part.seconds)},
             {"distance_metres", shortest(part.metres)}};
  for (std::size_t k = 0; k < run.fluids.size(); ++k) {
    const std::string start = id_of(run.fluids[k]) + "_";
    out.emplace_back(start + "input_joules", shortest(part.input_joules[k]));
    out.emplace_back(start + "loss_joules", shortest(part.loss_joules[k]));
    out.emplace_back(start + "inefficiency_percent",
                     shortest(percent(part.loss_joules[k], part.input_joules[k])));
  }
  return out;
}

std::string json_of_parts(const std::vector<CyclePart>& parts, const CycleRun& run) {
  std::string out = "{\"parts\": [";
  for (const CyclePart& part : parts) {
    out += &part == &parts.front() ? "\n {" : ",\n {";
    bool is_text = true;  // the name of the part; numbers follow
    for (const auto& [name, value] : csv_row_of(part, run)) {
      out +=
          (is_text ? "" : ", ") + ("\"" + name + "\": ") + (is_text ? "\"" + value + "\"" : value);
      is_text = false;
    }
    out += "}";
  }
  return out + "\n]}\n";
}

}  // namespace

std::string cycle_text(const CycleRun& run, OutputFormat format) {
  const std::vector<CyclePart> parts = parts_of(run);
  if (format == OutputFormat::kJson) return json_of_parts(parts, run);
  if (format == OutputFormat::kCsv) {
    std::vector<CsvRow> rows;
    for (const CyclePart& part : parts) rows.push_back(csv_row_of(part, run));
    return csv_text(rows);
  }
  using enum Table::Align;
  std::vector<Table::Column> columns{{"part", "", kLeft},
                                     {"time", "s", kDecimal},
                                     {"distance", "km", kDecimal},
                                     {"energy in", "kJ", kDecimal}};
  for (const CycleLosses& fluid : run.fluids) {
    columns.push_back({"loss, kJ", id_of(fluid), kDecimal});
    columns.push_back({"share, %", "", kDecimal});
    columns.push_back({"inefficiency, %", "", kDecimal});
    if (&fluid != &run.fluids.front()) columns.push_back({"difference, %", "", kDecimal});
  }
  Table table(columns);
  for (const CyclePart& part : parts) {
    std::vector<std::string> row{part.name, significant(part.seconds, 5),
                                 fixed(1e-3 * part.metres, 3),
                                 significant(1e-3 * part.input_joules.front(), 5)};
    for (std::size_t k = 0; k < run.fluids.size(); ++k) {
      const double loss = part.loss_joules[k];
      row.push_back(significant(1e-3 * loss, 4));
      row.push_back(fixed(percent(loss, parts.front().loss_joules[k]), 1));
      row.push_back(significant(percent(loss, part.input_joules[k]), 4));
      if (k > 0) {
        const double first = part.loss_joules.front();
        row.push_back(first > 0 ? signed_fixed(100 * (loss / first - 1), 2) : "-");
      }
    }
    table.add_row(std::move(row));
  }
  std::string out = run.name + ", sump " + significant(run.sump_temperature_celsius) +
                    " C: mesh loss, quasi-steady\n\n" + table.text() + "\n";
  for (const CycleLosses& fluid : run.fluids) {
    out += id_of(fluid) + ": ";
    out += fluid.estimated_error_joules > 0
               ? "estimated error of the map " +
                     significant(1e-3 * fluid.estimated_error_joules, 2) + " kJ, "
               : std::string("point by point, ");
    out += std::to_string(fluid.points) + " points, " + fluid.model_version + "\n";
  }
  return out + wrapped(
                   "Energy in: at the pinion in drive, at the wheels in coast, where the axle "
                   "counts as transmitting all of the braking. Standstill: speeds below 0.1 km/h.",
                   0);
}

std::string cycle_pieces_csv(const CycleRun& run) {
  std::vector<CsvRow> rows;
  for (std::size_t i = 0; i < run.pieces.size(); ++i) {
    const CyclePiece& piece = run.pieces[i];
    CsvRow row{{"start_seconds", shortest(piece.start)},
               {"duration_seconds", shortest(piece.duration)},
               {"speed_kilometres_per_hour", shortest(3.6 * piece.speed)},
               {"acceleration_metres_per_second_squared", shortest(piece.acceleration)},
               {"wheel_torque_newton_metres", shortest(run.wheel_torques[i])}};
    for (const CycleLosses& fluid : run.fluids) {
      row.emplace_back(id_of(fluid) + "_loss_joules", shortest(fluid.loss_joules[i]));
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
  for (const CyclePiece& piece : run.pieces) {
    driven.x.push_back(piece.start + 0.5 * piece.duration);
    driven.y.push_back(3.6 * piece.speed);
  }
  speed.series.push_back(driven);
  for (std::size_t k = 0; k < run.fluids.size(); ++k) {
    Series series;
    series.colour = look_of(k).colour;
    series.width = 1.6;
    series.label = id_of(run.fluids[k]);
    series.x = driven.x;
    for (std::size_t i = 0; i < run.pieces.size(); ++i) {
      series.y.push_back(run.fluids[k].loss_joules[i] / run.pieces[i].duration);
    }
    loss.series.push_back(std::move(series));
  }
  loss.shows_samples = true;
  const std::vector<std::string> below = footer_lines(
      {"Quasi-steady points of a drive cycle; sump " + significant(run.sump_temperature_celsius) +
       " C; model version " + run.fluids.front().model_version +
       ". Loss at the tooth contact only; it excludes bearings, churning and seals."},
      kWidth - 2 * kLeft);
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
