#include "core/lubricant/vogel_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/celsius.h"
#include "core/laws/laws.h"
#include "core/number_text.h"
#include "core/numerics/bracketed_root.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kLowestReferenceTemperature = 50;  // K
constexpr double kGap = 20;                         // K, of T_0 below the coldest row
constexpr double kDistinct = 0.5;                   // K
constexpr double kUnstatedScatter = 0.03;           // relative, of rows that state no uncertainty
constexpr double kDeviations = 4;                   // standard deviations that are beyond noise
constexpr double kUndetermined = 2;  // standard uncertainties of a typical T_0: data that know less
constexpr double kSteepest = 0.15;   // |d ln eta/dT| of a cold oil [1/K]

using Eigen::ArrayXd;

std::string row_text(std::span<const ViscosityPoint> points, std::size_t i) {
  return "row " + std::to_string(i + 1) + " (" + celsius_text(points[i].temperature) + ", " +
         number_text(1e3 * points[i].viscosity) + " mPa s)";
}

void check_ranges(std::span<const ViscosityPoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [temperature, viscosity, uncertainty] = points[i];
    const auto refuse = [&](const char* what) {
      throw Refusal("VISCOSITY_TABLE_OUT_OF_RANGE", row_text(points, i) + ": " + what);
    };
    if (!(temperature >= 200 && temperature <= 620)) {
      refuse("the temperature must be from -73.15 to 346.85 C.");
    }
    if (!(viscosity >= 1e-5 && viscosity <= 1e7)) {
      refuse("the viscosity must be from 0.01 to 1e10 mPa s.");
    }
    if (!(uncertainty >= 0 && uncertainty <= 1)) {
      refuse("the relative standard uncertainty must be from 0 to 1.");
    }
  }
}

// Rows from cold to warm.
std::vector<std::size_t> by_temperature(std::span<const ViscosityPoint> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].temperature < points[b].temperature;
  });
  return order;
}

int distinct_temperatures(std::span<const ViscosityPoint> points,
                          const std::vector<std::size_t>& order) {
  int count = 0;
  double last = -1;
  for (const std::size_t i : order) {
    if (count > 0 && points[i].temperature - last < kDistinct) continue;
    last = points[i].temperature;
    ++count;
  }
  return count;
}

void check_monotone(std::span<const ViscosityPoint> points, const std::vector<std::size_t>& order) {
  const auto scatter = [&](std::size_t i) {
    const double u = points[i].relative_standard_uncertainty;
    return u > 0 ? u : kUnstatedScatter;
  };
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const std::size_t cold = order[a], warm = order[b];
      const double rise = std::log(points[warm].viscosity / points[cold].viscosity);
      const double noise = kDeviations * std::hypot(scatter(cold), scatter(warm));
      const double apart = points[warm].temperature - points[cold].temperature;
      if (rise > noise || (apart < kDistinct && -rise > noise + kSteepest * apart)) {
        throw Refusal("VISCOSITY_TABLE_NOT_MONOTONE",
                      row_text(points, warm) + " does not fit " + row_text(points, cold) +
                          ": viscosity falls as temperature rises, and the two differ by more "
                          "than their uncertainty.");
      }
    }
  }
}

// The table as arrays, with the weight of every row.
struct Table {
  ArrayXd temperature, log_viscosity;
  ArrayXd deviation;    // of ln eta by which rows are weighted and judged
  bool stated = false;  // some row states its uncertainty
  double coldest = 0;   // K
  std::size_t coldest_row = 0;
  int distinct = 0;

  explicit Table(std::span<const ViscosityPoint> points) {
    check_ranges(points);
    const std::vector<std::size_t> order = by_temperature(points);
    distinct = distinct_temperatures(points, order);
    if (distinct < 2) {
      throw Refusal("VISCOSITY_TABLE_TOO_SHORT",
                    "Viscosities at " + std::to_string(distinct) +
                        " distinct temperatures (0.5 K apart): a law of temperature wants two, "
                        "and three to fit all its parameters.");
    }
    check_monotone(points, order);
    coldest_row = order.front();
    coldest = points[coldest_row].temperature;
    const auto count = static_cast<Eigen::Index>(points.size());
    temperature.resize(count);
    log_viscosity.resize(count);
    deviation.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const ViscosityPoint& point = points[static_cast<std::size_t>(i)];
      temperature[i] = point.temperature;
      log_viscosity[i] = std::log(point.viscosity);
      const double u = point.relative_standard_uncertainty;
      stated = stated || u > 0;
      deviation[i] = u > 0 ? u : kTypicalViscosityUncertainty;
    }
  }
};

// The best eta_ref and A_1 for a T_0, and what is left.
struct Projection {
  double log_prefactor, coefficient;
  ArrayXd inverse;    // 1/(T - T_0)
  ArrayXd residual;   // ln(measured/law)
  double squares;     // weighted sum
  double derivative;  // of the sum with respect to T_0; eta_ref and A_1 are stationary

  Projection(const Table& table, double reference_temperature)
      : inverse((table.temperature - reference_temperature).inverse()) {
    const ArrayXd weight = table.deviation.square().inverse();
    const double total = weight.sum();
    const double mean_x = (weight * inverse).sum() / total;
    const double mean_y = (weight * table.log_viscosity).sum() / total;
    const ArrayXd x = inverse - mean_x, y = table.log_viscosity - mean_y;
    coefficient = (weight * x * y).sum() / (weight * x.square()).sum();
    log_prefactor = mean_y - coefficient * mean_x;
    residual = y - coefficient * x;
    squares = (weight * residual.square()).sum();
    derivative = -2 * coefficient * (weight * residual * inverse.square()).sum();
  }
};

[[noreturn]] void refuse_law(const std::string& sentence) {
  throw Refusal("VISCOSITY_TABLE_NOT_VOGEL", sentence);
}

// T_0 known beforehand to a standard uncertainty.
struct Prior {
  double value, standard_uncertainty;
};

VogelFit finish(const Table& table, double reference_temperature, const Prior* prior) {
  const Projection law(table, reference_temperature);
  const Eigen::Index count = table.temperature.size();
  VogelFit fit;
  fit.viscosity_prefactor = std::exp(law.log_prefactor);
  fit.temperature_coefficient = law.coefficient;
  fit.reference_temperature = reference_temperature;
  if (!(fit.viscosity_prefactor >= 1e-12 && fit.viscosity_prefactor <= 1e3 &&
        fit.temperature_coefficient >= 1 && fit.temperature_coefficient <= 1e5)) {
    refuse_law("The viscosities give eta_ref = " + number_text(fit.viscosity_prefactor) +
               " Pa s and A_1 = " + number_text(fit.temperature_coefficient) +
               " K at T_0 = " + number_text(reference_temperature) +
               " K; a liquid has 1e-12 to 1000 Pa s and 1 to 1e5 K.");
  }
  fit.residuals.assign(law.residual.begin(), law.residual.end());
  fit.root_mean_square_residual = std::sqrt(law.residual.square().mean());
  fit.degrees_of_freedom = static_cast<int>(count) - (prior ? 2 : 3);
  fit.reduced_chi_square = fit.degrees_of_freedom > 0 ? law.squares / fit.degrees_of_freedom : 0;
  fit.reference_temperature_assumed = prior != nullptr;

  // The standard deviations that scale the Jacobian: the stated ones, multiplied by the observed
  // scatter if it exceeds 1; without stated ones the observed scatter alone.
  double widening = 1;
  if (fit.degrees_of_freedom > 0) {
    const double observed = std::sqrt(fit.reduced_chi_square);
    widening = table.stated || prior ? std::max(1.0, observed) : observed;
  }
  Eigen::MatrixXd jacobian(count + (prior ? 1 : 0), 3);
  jacobian.topRows(count).col(0) = table.deviation.inverse();
  jacobian.topRows(count).col(1) = law.inverse / table.deviation;
  jacobian.topRows(count).col(2) = law.coefficient * law.inverse.square() / table.deviation;
  if (prior) jacobian.row(count) << 0, 0, widening / prior->standard_uncertainty;
  const Eigen::Vector3d norm = jacobian.colwise().norm();
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(jacobian * norm.cwiseInverse().asDiagonal(),
                                                        Eigen::ComputeThinV);
  const Eigen::Vector3d singular = decomposition.singularValues();
  const Eigen::Matrix3d root = norm.cwiseInverse().asDiagonal() * decomposition.matrixV() *
                               singular.cwiseInverse().asDiagonal();
  fit.condition_number = singular[0] / singular[2];
  fit.covariance = widening * widening * root * root.transpose();
  if (!fit.covariance.allFinite() || !std::isfinite(fit.condition_number)) {
    refuse_law("The temperatures do not tell the parameters of the law apart.");
  }
  return fit;
}

// T_0 from data and prior together; the data alone where they leave no doubt.
double with_prior(const Table& table, const Prior& prior) {
  const auto slope = [&](double t) {
    return Projection(table, t).derivative +
           2 * (t - prior.value) / (prior.standard_uncertainty * prior.standard_uncertainty);
  };
  const double lower = kLowestReferenceTemperature, upper = table.coldest - kGap;
  if (table.distinct == 2 && prior.value > lower && prior.value < upper) return prior.value;
  const double at_lower = slope(lower), at_upper = slope(upper);
  if (!(at_lower < 0)) return lower;
  if (!(at_upper > 0)) return upper;
  return bracketed_root(slope, lower, upper, at_lower, at_upper);
}

}  // namespace

VogelFit fit_vogel(std::span<const ViscosityPoint> points) {
  const Table table(points);
  const Prior typical{kTypicalVogelReferenceTemperature,
                      kTypicalVogelReferenceTemperatureUncertainty};
  if (table.distinct == 2) return finish(table, with_prior(table, typical), &typical);

  // Minima of the sum: where its derivative turns positive, on a grid dense towards the pole.
  constexpr int kSteps = 120;
  const double widest = table.coldest - kLowestReferenceTemperature;
  const double ratio = std::pow(kGap / widest, 1.0 / kSteps);
  double last = kLowestReferenceTemperature;
  Projection before(table, last);
  const double at_lower = before.squares;
  double best = NAN, lowest = INFINITY;
  for (int i = 1; i <= kSteps; ++i) {
    const double next = table.coldest - widest * std::pow(ratio, i);
    const Projection here(table, next);
    if (before.derivative < 0 && here.derivative >= 0) {
      const double root = bracketed_root([&](double t) { return Projection(table, t).derivative; },
                                         last, next, before.derivative, here.derivative);
      const double squares = Projection(table, root).squares;
      if (squares < lowest) {
        best = root;
        lowest = squares;
      }
    }
    last = next;
    before = here;
  }
  if (before.squares < lowest && before.squares < at_lower) {
    refuse_law(row_text(points, table.coldest_row) +
               " is so thick that no Vogel law with T_0 20 K below it fits the others.");
  }
  if (lowest <= at_lower) {
    VogelFit fit = finish(table, best, nullptr);
    if (fit.covariance(2, 2) < std::pow(kUndetermined * typical.standard_uncertainty, 2)) {
      return fit;
    }
  }
  return finish(table, with_prior(table, typical), &typical);
}

VogelFit fit_vogel_at(std::span<const ViscosityPoint> points, double reference_temperature,
                      double standard_uncertainty) {
  const Table table(points);
  if (!(reference_temperature > 0 && reference_temperature <= table.coldest - kGap)) {
    refuse_law("T_0 = " + number_text(reference_temperature) + " K is not 20 K below " +
               row_text(points, table.coldest_row) + ".");
  }
  const Prior prior{reference_temperature, std::max(standard_uncertainty, 1e-3)};
  return finish(table, reference_temperature, &prior);
}

double log_viscosity(const VogelFit& fit, double temperature) {
  return laws::log_vogel_viscosity(std::log(fit.viscosity_prefactor), fit.temperature_coefficient,
                                   fit.reference_temperature, temperature)
      .value;
}

double relative_viscosity_uncertainty(const VogelFit& fit, double temperature) {
  const double inverse = 1 / (temperature - fit.reference_temperature);
  const Eigen::Vector3d gradient(1, inverse, fit.temperature_coefficient * inverse * inverse);
  return std::sqrt(std::max(0.0, gradient.dot(fit.covariance * gradient)));
}

}  // namespace tribodyn
