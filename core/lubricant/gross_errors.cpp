#include "core/lubricant/gross_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

/// Fits are tried with each viscosity in turn only for so many: a table of a thousand rows would
/// take seconds.
constexpr std::size_t kMostTried = 20;
constexpr double kWidening = 3;  // standard deviations of a stated uncertainty

std::string per_cent(double ratio) {
  return number_text(100 * std::abs(ratio - 1), 2) + " % " + (ratio > 1 ? "above" : "below");
}

std::string millipascals(double viscosity) { return number_text(1e3 * viscosity) + " mPa s"; }

bool is_table(const MeasuredViscosity& each) {
  return each.measurement == Measurement::kViscosity ||
         each.measurement == Measurement::kColdViscosity;
}

/// What may have been meant by a viscosity of a table.
struct Slip {
  double factor;     // of the viscosity
  double sign;       // of the temperature in Celsius
  const char* unit;  // that the number was in
};
constexpr Slip kSlips[] = {
    {1000, 1, "Pa s"}, {100, 1, "P"}, {1e-3, 1, "uPa s"}, {1, -1, nullptr}, {1000, -1, "Pa s"}};

MeasuredViscosity corrected(MeasuredViscosity each, const Slip& slip) {
  each.point.viscosity *= slip.factor;
  each.point.temperature = kZeroCelsius + slip.sign * (each.point.temperature - kZeroCelsius);
  return each;
}

/// The largest |ln(measurement/law)| of a law fitted to all; nullopt if one contradicts it, or none
/// can be fitted.
std::optional<double> largest_residual(std::span<const MeasuredViscosity> viscosities) {
  std::vector<ViscosityPoint> points;
  for (const MeasuredViscosity& each : viscosities) points.push_back(each.point);
  try {
    const VogelFit fit = fit_vogel(points);
    const GrossErrorLimit& limit = gross_error_limit("VISCOSITY_CONTRADICTED");
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double law = std::exp(log_viscosity(fit, points[i].temperature));
      if (contradicts(limit, points[i], law)) return std::nullopt;
      largest = std::max(largest, std::abs(fit.residuals[i]));
    }
    return largest;
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

/// Which viscosities to correct, and how, so that all can be fitted.
struct Correction {
  std::vector<std::size_t> which;
  Slip slip;
};

/// Sets of viscosities that may share a slip: all of a kind, then each alone.
std::vector<std::vector<std::size_t>> suspects(std::span<const MeasuredViscosity> viscosities) {
  std::vector<std::vector<std::size_t>> out;
  for (const Measurement kind : {Measurement::kColdViscosity, Measurement::kViscosity}) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < viscosities.size(); ++i) {
      if (viscosities[i].measurement == kind) all.push_back(i);
    }
    if (!all.empty()) out.push_back(std::move(all));
  }
  if (viscosities.size() > kMostTried) return out;
  for (std::size_t i = 0; i < viscosities.size(); ++i) {
    if (is_table(viscosities[i])) out.push_back({i});
  }
  return out;
}

/// The correction after which the law fits best; of those that fit within the scatter of a
/// Brookfield viscosity, the one of the fewest viscosities, then the most usual. Nullopt if none
/// helps or none is needed.
std::optional<Correction> find_correction(std::span<const MeasuredViscosity> viscosities) {
  constexpr double kScatter = 0.05;
  if (largest_residual(viscosities)) return std::nullopt;
  std::optional<Correction> best;
  std::pair<double, std::size_t> lowest;
  for (const Slip& slip : kSlips) {
    for (const std::vector<std::size_t>& which : suspects(viscosities)) {
      std::vector<MeasuredViscosity> changed(viscosities.begin(), viscosities.end());
      for (const std::size_t i : which) changed[i] = corrected(changed[i], slip);
      const std::optional<double> residual = largest_residual(changed);
      if (!residual) continue;
      const std::pair score(std::max(*residual, kScatter), which.size());
      if (best && score >= lowest) continue;
      best = Correction{which, slip};
      lowest = score;
    }
  }
  return best;
}

/// "150 Pa s (150000 mPa s) at -40 C".
std::string meant_text(const MeasuredViscosity& typed, const Slip& slip) {
  const MeasuredViscosity meant = corrected(typed, slip);
  const std::string written =
      slip.unit == nullptr ? "" : number_text(1e3 * typed.point.viscosity) + " " + slip.unit + " (";
  return written + millipascals(meant.point.viscosity) + (slip.unit == nullptr ? "" : ")") +
         " at " + celsius_text(meant.point.temperature);
}

std::string contradiction(const MeasuredViscosity& each, double law, const GrossErrorLimit& limit,
                          const char* which) {
  return millipascals(each.point.viscosity) + " at " + celsius_text(each.point.temperature) +
         " lies " + per_cent(each.point.viscosity / law) + " " + which + ", " +
         number_text(1e3 * law, 4) + " mPa s; allowed: within " + limit.bound + ".";
}

/// Against the law that was fitted to them, or the one that was stated.
void check_viscosities(const CharacterisedFluid& known, std::vector<GrossError>& errors) {
  const auto& viscosities = known.measured_viscosities;
  const bool fitted = known.viscosity_fit.has_value();
  const std::size_t before = errors.size();
  for (const MeasuredViscosity& each : viscosities) {
    const double law = ambient_viscosity(known.lubricant, each.point.temperature);
    const bool loose = fitted || is_table(each);
    const GrossErrorLimit& limit =
        gross_error_limit(loose ? "VISCOSITY_CONTRADICTED" : "LAW_CONTRADICTED");
    if (!contradicts(limit, each.point, law)) continue;
    std::string sentence = contradiction(
        each, law, limit, fitted ? "the law through all viscosities" : "the stated law");
    if (!fitted) sentence += " Correct one of the two, or leave the law unset: it is then fitted.";
    errors.push_back({fitted ? "VISCOSITY_CONTRADICTED" : "LAW_CONTRADICTED", each.measurement,
                      each.row, sentence});
  }
  if (!fitted || errors.size() == before) return;
  const auto correction = find_correction(viscosities);
  if (!correction) return;
  // A wrong viscosity spoils the fit of all: only those to be corrected are complained of.
  errors.erase(errors.begin() + static_cast<std::ptrdiff_t>(before), errors.end());
  for (const std::size_t i : correction->which) {
    const MeasuredViscosity& each = viscosities[i];
    const double law = ambient_viscosity(known.lubricant, each.point.temperature);
    errors.push_back({"VISCOSITY_CONTRADICTED", each.measurement, each.row,
                      contradiction(each, law, gross_error_limit("VISCOSITY_CONTRADICTED"),
                                    "the law through all viscosities") +
                          " Did you mean " + meant_text(each, correction->slip) + "?"});
  }
}

void check_viscosity_index(const FluidMeasurements& fluid, std::vector<GrossError>& errors) {
  if (!fluid.kinematic_viscosity_40 || !fluid.kinematic_viscosity_100) return;
  const double kv40 = 1e6 * *fluid.kinematic_viscosity_40;
  const double kv100 = 1e6 * *fluid.kinematic_viscosity_100;
  try {
    const double index = viscosity_index(kv40, kv100);
    const GrossErrorLimit& limit = gross_error_limit("VISCOSITY_INDEX_IMPLAUSIBLE");
    if (index >= limit.least && index <= limit.most) return;
    errors.push_back(
        {limit.code, Measurement::kKinematicViscosity40, 0,
         "KV40 = " + number_text(kv40) + " and KV100 = " + number_text(kv100) +
             " mm2/s make a viscosity index of " + number_text(index, 3) +
             "; allowed: " + limit.bound +
             (index > limit.most ? ". Is one viscosity given twice, or measured at another "
                                   "temperature?"
                                 : ". Is a digit missing or one too many?")});
  } catch (const Refusal&) {  // not defined below 2 mm2/s
  }
}

void check_sheared(const FluidMeasurements& fluid, std::vector<GrossError>& errors) {
  if (!fluid.kinematic_viscosity_100 || !fluid.sheared_kinematic_viscosity_100) return;
  const double ratio = *fluid.sheared_kinematic_viscosity_100 / *fluid.kinematic_viscosity_100;
  const GrossErrorLimit& limit = gross_error_limit("SHEARED_THICKER_THAN_FRESH");
  if (ratio <= limit.most) return;
  errors.push_back({limit.code, Measurement::kShearedKinematicViscosity100, 0,
                    number_text(1e6 * *fluid.sheared_kinematic_viscosity_100) +
                        " mm2/s at 100 C after the shear test lies " + per_cent(ratio) +
                        " the fresh oil's " + number_text(1e6 * *fluid.kinematic_viscosity_100) +
                        "; allowed: above it by at most " + limit.bound +
                        ". Are the two exchanged?"});
}

}  // namespace

const GrossErrorLimit& gross_error_limit(const std::string& code) {
  return *std::find_if(std::begin(kGrossErrorLimits), std::end(kGrossErrorLimits),
                       [&](const GrossErrorLimit& each) { return each.code == code; });
}

bool contradicts(const GrossErrorLimit& limit, const ViscosityPoint& measured, double law) {
  const double ratio = measured.viscosity / law;
  const double widened = 1 + kWidening * measured.relative_standard_uncertainty;
  const double most = std::max(limit.most, widened);
  const double least = std::min(limit.least, 1 / widened);
  return !(ratio >= least && ratio <= most);
}

std::string likely_slip(std::span<const MeasuredViscosity> viscosities) {
  const auto correction = find_correction(viscosities);
  if (!correction) return "";
  std::string text;
  for (const std::size_t i : correction->which) {
    text += (text.empty() ? " Did you mean " : ", ") + meant_text(viscosities[i], correction->slip);
  }
  return text + "?";
}

std::vector<GrossError> gross_errors(const FluidMeasurements& fluid,
                                     const CharacterisedFluid& known) {
  std::vector<GrossError> errors;
  check_viscosity_index(fluid, errors);
  check_sheared(fluid, errors);
  check_viscosities(known, errors);
  return errors;
}

}  // namespace tribodyn
