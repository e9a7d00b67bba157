#include "client/cpp/report/limits_report.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <optional>

#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr int kLimitDigits = 3;

/// How one limited figure is shown: value * factor + offset, in `unit`.
struct LimitedQuantity {
  const char* figure;
  const char* label;
  const char* unit;
  double factor;
  double offset;
};

constexpr std::array kLimited = {
    LimitedQuantity{"film_ratio.minimum", "film ratio lambda, smallest", "", 1, 0},
    LimitedQuantity{"maximum_pressure_pascals.maximum", "pressure, greatest", "GPa", 1e-9, 0},
    LimitedQuantity{"contact_temperature_kelvin.minimum", "contact temperature, lowest", "C", 1,
                    -kZeroCelsius},
    LimitedQuantity{"contact_temperature_kelvin.maximum", "contact temperature, highest", "C", 1,
                    -kZeroCelsius},
    LimitedQuantity{"flash_temperature_rise_kelvin.maximum", "flash temperature rise, greatest",
                    "K", 1, 0},
};
constexpr const char* kFlashTemperature = "flash_temperature_rise_kelvin.maximum";

/// Returns the extreme of the point that a limit is about; nullopt for a figure that this program
/// has no name for, and without a flank that carries load.
std::optional<double> figure_of(const v1::PointResult& point, const std::string& figure) {
  const std::size_t dot = figure.rfind('.');
  const auto* field = point.GetDescriptor()->FindFieldByName(figure.substr(0, dot));
  if (field == nullptr || field->message_type() != v1::Extremes::descriptor() ||
      point.film_ratio().maximum() == 0) {
    return std::nullopt;
  }
  const auto& extremes =
      static_cast<const v1::Extremes&>(point.GetReflection()->GetMessage(point, field));
  return figure.substr(dot + 1) == "minimum" ? extremes.minimum() : extremes.maximum();
}

bool is_kept(const v1::FigureLimit& limit, double value) {
  return (!limit.has_minimum() || value >= limit.minimum()) &&
         (!limit.has_maximum() || value <= limit.maximum());
}

/// A figure over all points.
struct FigureOverPoints {
  std::optional<double> value;  ///< the smallest of minima, the greatest of maxima
  int points = 0, outside = 0;
};

FigureOverPoints over_points(const v1::SimulationResult& result, const v1::FigureLimit& limit) {
  const bool is_minimum = limit.figure().ends_with(".minimum");
  FigureOverPoints out;
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_result()) continue;
    const auto value = figure_of(point.result(), limit.figure());
    if (!value) continue;
    ++out.points;
    if (!is_kept(limit, *value)) ++out.outside;
    const double farthest = out.value.value_or(*value);
    out.value = is_minimum ? std::min(farthest, *value) : std::max(farthest, *value);
  }
  return out;
}

std::string limit_text(const v1::FigureLimit& limit, const LimitedQuantity& quantity) {
  const auto shown = [&quantity](double value) {
    return significant(quantity.factor * value + quantity.offset, kLimitDigits);
  };
  if (limit.has_minimum() && limit.has_maximum()) {
    return shown(limit.minimum()) + " to " + shown(limit.maximum());
  }
  if (limit.has_minimum()) return ">= " + shown(limit.minimum());
  return limit.has_maximum() ? "<= " + shown(limit.maximum()) : "none stated";
}

std::string kept_text(const v1::FigureLimit& limit, const FigureOverPoints& figure) {
  if (!limit.has_minimum() && !limit.has_maximum()) return "-";
  if (figure.outside == 0) return "yes";
  if (figure.points == 1) return "no";
  return "not at " + std::to_string(figure.outside) + " of " + std::to_string(figure.points) +
         " speeds";
}

}  // namespace

std::string limits_report(const v1::SimulationResult& result) {
  if (result.limits().empty()) return "";
  Table table({{"Beside their limits", "", Table::Align::kLeft},
               {"unit", "", Table::Align::kLeft},
               {"figure", "", Table::Align::kRight},
               {"limit", "", Table::Align::kRight},
               {"kept", "", Table::Align::kLeft},
               {"what the limit is of", "", Table::Align::kLeft}});
  const auto add = [&](const v1::FigureLimit& limit) {
    const auto* quantity = std::find_if(
        kLimited.begin(), kLimited.end(),
        [&limit](const LimitedQuantity& each) { return limit.figure() == each.figure; });
    if (quantity == kLimited.end()) return;
    const FigureOverPoints figure = over_points(result, limit);
    if (!figure.value) return;
    table.add_row({quantity->label, quantity->unit,
                   significant(quantity->factor * *figure.value + quantity->offset, kLimitDigits),
                   limit_text(limit, *quantity), kept_text(limit, figure), limit.source()});
  };
  bool has_flash_limit = false;
  for (const v1::FigureLimit& limit : result.limits()) {
    has_flash_limit = has_flash_limit || limit.figure() == kFlashTemperature;
    add(limit);
  }
  if (!has_flash_limit) {
    v1::FigureLimit none;
    none.set_figure(kFlashTemperature);
    none.set_source("the fluid's scuffing limit; --flash-temperature-limit states one");
    add(none);
  }
  return table.empty() ? "" : table.text();
}

}  // namespace tribodyn::client
