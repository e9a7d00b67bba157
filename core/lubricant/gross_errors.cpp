#include "core/lubricant/gross_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_temperature.h"
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

/// The measurement that says most of a temperature.
const MeasuredViscosity& nearest(const CharacterisedFluid& known, double temperature) {
  return *std::min_element(known.measured_viscosities.begin(), known.measured_viscosities.end(),
                           [temperature](const auto& a, const auto& b) {
                             return std::abs(a.point.temperature - temperature) <
                                    std::abs(b.point.temperature - temperature);
                           });
}

/// KV100 and the viscosity index: measured, or those of the law fitted to a table.
void check_standard_viscosities(const FluidMeasurements& fluid, const CharacterisedFluid& known,
                                std::vector<GrossError>& errors) {
  const bool measured = fluid.kinematic_viscosity_40 && fluid.kinematic_viscosity_100;
  if (!measured && !known.viscosity_fit) return;  // a stated law is held against measurements
  const auto refuse = [&](const GrossErrorLimit& limit, double temperature,
                          const std::string& sentence) {
    const MeasuredViscosity& about = nearest(known, temperature);
    errors.push_back({limit.code, about.measurement, about.row, sentence});
  };
  const double v40 = known.kinematic_viscosity_40, v100 = known.kinematic_viscosity_100;
  const auto text = [](double viscosity) { return number_text(1e6 * viscosity, 5); };
  const GrossErrorLimit& viscosity = gross_error_limit("VISCOSITY_IMPLAUSIBLE");
  if (v100 < viscosity.least || v100 > viscosity.most) {
    constexpr double kLeastUsual = 1.5e-6, kMostUsual = 100e-6;  // KV100 of lubricants
    const double corrected = v100 > viscosity.most ? v100 / 1000 : v100 * 1000;
    const bool is_slip = corrected >= kLeastUsual && corrected <= kMostUsual;
    refuse(viscosity, kHundredCelsius,
           std::string(measured ? "KV100 is " : "The viscosities make a KV100 of ") + text(v100) +
               " mm2/s; allowed: " + viscosity.bound + "." +
               (is_slip ? " Are mPa s and Pa s exchanged? A factor of 1000 makes it " +
                              text(corrected) + " mm2/s."
                        : ""));
    return;
  }
  const GrossErrorLimit& limit = gross_error_limit("VISCOSITY_INDEX_IMPLAUSIBLE");
  if (!known.viscosity_index) return;  // not defined below 2 mm2/s
  const double index = *known.viscosity_index;
  if (index >= limit.least && index <= limit.most) return;
  refuse(limit, kFortyCelsius,
         std::string(measured ? "" : "By the law through all viscosities, ") + "KV40 = " +
             text(v40) + " and KV100 = " + text(v100) + " mm2/s make a viscosity index of " +
             number_text(index, 3) + "; allowed: " + limit.bound +
             (index > limit.most
                  ? ". Is one viscosity given twice, or measured at another temperature?"
                  : ". Is a digit missing or one too many?"));
}

constexpr double kColdest = kZeroCelsius + 10;  // where ASTM D341 holds for all oils

/// ASTM D341 through the coldest and the warmest of the viscosities where it holds; nullopt if they
/// are too close to extrapolate from.
std::optional<ViscosityTemperatureLine> warm_line(const CharacterisedFluid& known) {
  constexpr double kApart = 40;  // K
  std::optional<ViscosityPoint> coldest, warmest;
  for (const MeasuredViscosity& each : known.measured_viscosities) {
    const ViscosityPoint& point = each.point;
    if (point.temperature < kColdest) continue;
    if (!coldest || point.temperature < coldest->temperature) coldest = point;
    if (!warmest || point.temperature > warmest->temperature) warmest = point;
  }
  if (!coldest || warmest->temperature - coldest->temperature < kApart) return std::nullopt;
  const auto kinematic = [&](const ViscosityPoint& point) {
    return KinematicViscosityPoint{point.temperature,
                                   point.viscosity / density(known.lubricant, point.temperature)};
  };
  try {
    return viscosity_temperature_line(kinematic(*coldest), kinematic(*warmest));
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

/// " Did you mean 98000 mPa s, 1/100 of it?" where a power of ten brings a cold viscosity nearest
/// to the ratio to ASTM D341 that oils have; empty if none does.
std::string power_of_ten_text(const ViscosityPoint& point, double walther,
                              const GrossErrorLimit& limit) {
  constexpr double kUsualRatio = 2;
  double best = 0, lowest = INFINITY;
  for (const double factor : {1e-3, 1e-2, 0.1, 10.0, 100.0, 1000.0}) {
    const double ratio = factor * point.viscosity / walther;
    const double off = std::abs(std::log(ratio / kUsualRatio));
    if (ratio < limit.least || ratio > limit.most || off >= lowest) continue;
    best = factor;
    lowest = off;
  }
  if (best == 0) return "";
  return " Did you mean " + millipascals(best * point.viscosity) + ", " +
         (best < 1 ? "1/" + number_text(1 / best) + " of it?" : number_text(best) + " times it?");
}

/// Viscosities that the fit follows, as nothing else says what they should be.
void check_cold_viscosities(const CharacterisedFluid& known, std::vector<GrossError>& errors) {
  const auto line = warm_line(known);
  if (!line) return;
  const GrossErrorLimit& limit = gross_error_limit("COLD_VISCOSITY_IMPLAUSIBLE");
  for (const MeasuredViscosity& each : known.measured_viscosities) {
    const double temperature = each.point.temperature;
    const bool is_known = std::any_of(errors.begin(), errors.end(), [&](const GrossError& error) {
      return error.measurement == each.measurement && error.row == each.row;
    });
    if (temperature >= kColdest || is_known) continue;
    try {
      const double walther =
          kinematic_viscosity(*line, temperature) * density(known.lubricant, temperature);
      if (!contradicts(limit, each.point, walther)) continue;
      errors.push_back({limit.code, each.measurement, each.row,
                        millipascals(each.point.viscosity) + " at " + celsius_text(temperature) +
                            " is " + number_text(each.point.viscosity / walther, 3) +
                            " times what ASTM D341 extrapolates from the warm viscosities, " +
                            number_text(1e3 * walther, 3) + " mPa s; allowed: " + limit.bound +
                            "." + power_of_ten_text(each.point, walther, limit)});
    } catch (const Refusal&) {  // the line ends before
    }
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
  check_standard_viscosities(fluid, known, errors);
  check_sheared(fluid, errors);
  check_viscosities(known, errors);
  check_cold_viscosities(known, errors);
  return errors;
}

}  // namespace tribodyn
