#include "core/contact/asperity_functions.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/chebyshev.h"

namespace tribodyn {
namespace {

// With s = l + t and l = c + d, c the nearest of a grid of centres,
//
//   F_n(c + d) = exp(-c^2/2) exp(-d (c + d/2)) P_n(d),
//   P_n(d) = (2 pi)^(-1/2) int_0^inf t^n exp(-t^2/2 - c t) exp(-d t) dt.
//
// P_n is entire in d and nearly exponential, so that a short polynomial represents it on |d| <=
// 1/8. The Gaussian factor is split so that no rounding error is multiplied by l^2/2 (which reaches
// 700): c and d are exact, and |d (c + d/2)| < 5.
// Below the mean plane, where c < 0, F_n itself is as smooth as that and represented by
// polynomials, until its expansion far below takes over.
constexpr double kCentreSpacing = 0.25;
constexpr double kHalfWidth = kCentreSpacing / 2;
constexpr double kFarBelow = -12;
constexpr double kVanishes = 38.75;  // beyond, F_2 is below half the smallest subnormal number
constexpr int kCentresBelow = 48;    // centres -12, -11.75 ... -0.25
constexpr int kCentres = 156;        // centres 0, 0.25 ... 38.75
constexpr int kPolynomialTerms = 12;

struct Piece {
  std::array<double, kPolynomialTerms> f2;    // coefficients of P_2 or F_2 in d
  std::array<double, kPolynomialTerms> f5_2;  // coefficients of P_5/2 or F_5/2 in d
  double root_of_gaussian;                    // exp(-c^2/4): its square would underflow too early
};

using Extended = long double;

constexpr int kTaylorTerms = 18;  // the next is below 1e-22 of the first
using TaylorSeries = std::array<Extended, kTaylorTerms>;

// Coefficients of the Chebyshev polynomials T_m(x) in powers of x.
using ChebyshevTable = std::array<TaylorSeries, kTaylorTerms>;

// Lanczos economisation: takes a series in x, |x| <= 1, to kPolynomialTerms by subtracting
// multiples of T_m from the top down, and returns the coefficients in d = kHalfWidth x.
std::array<double, kPolynomialTerms> economised(TaylorSeries series,
                                                const ChebyshevTable& chebyshev) {
  for (int m = kTaylorTerms - 1; m >= kPolynomialTerms; --m) {
    const Extended multiple = series[m] / chebyshev[m][m];
    for (int j = m; j >= 0; j -= 2) series[j] -= multiple * chebyshev[m][j];
  }
  std::array<double, kPolynomialTerms> coefficients;
  Extended power = 1;
  for (int j = 0; j < kPolynomialTerms; ++j) {
    coefficients[j] = static_cast<double>(series[j] / power);
    power *= kHalfWidth;
  }
  return coefficients;
}

// The Taylor series of P_n about c has the coefficients (-1)^j/j! int t^(n+j) exp(-t^2/2 - c t) dt.
// All of them come from one double-exponential quadrature, t = exp(x - exp(-x))/(1 + c) with the
// trapezoidal rule in x (Takahasi and Mori, Publ. RIMS 9 (1974) 721-741). Halving the step changes
// no coefficient by more than a few units of extended precision.
template <int kStepsPerUnit>
struct Quadrature {
  // t (1 + c) = 2e-13: the integrand t^2 dt is below 1e-37
  static constexpr int kFirst = -13 * kStepsPerUnit / 4;
  // t (1 + c) = 61: exp(-t^2/2 - c t) is below 1e-25 for all c
  static constexpr int kLast = 33 * kStepsPerUnit / 8;
  std::array<Extended, kLast - kFirst + 1> node;    // t (1 + c)
  std::array<Extended, kLast - kFirst + 1> weight;  // (2 pi)^(-1/2) (1 + c) dt

  Quadrature() {
    constexpr Extended kStep = Extended{1} / kStepsPerUnit;
    const Extended scale = kStep / std::sqrt(2 * std::numbers::pi_v<Extended>);
    for (int i = kFirst; i <= kLast; ++i) {
      const Extended x = i * kStep, inner = std::exp(-x);
      node[i - kFirst] = std::exp(x - inner);
      weight[i - kFirst] = scale * node[i - kFirst] * (1 + inner);
    }
  }
};

Piece economised(TaylorSeries series_2, TaylorSeries series_5_2, const ChebyshevTable& chebyshev) {
  Extended factorial = 1;
  for (int j = 2; j < kTaylorTerms; ++j) {
    factorial *= j;
    series_2[j] /= factorial;
    series_5_2[j] /= factorial;
  }
  return {economised(series_2, chebyshev), economised(series_5_2, chebyshev), 1};
}

Piece make_piece(Extended centre, const Quadrature<16>& rule, const ChebyshevTable& chebyshev) {
  TaylorSeries series_2{};
  TaylorSeries series_5_2{};
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const Extended t = rule.node[i] / (1 + centre);
    const Extended root_t = std::sqrt(t);
    Extended term = rule.weight[i] / (1 + centre) * t * t * std::exp(-t * (t / 2 + centre));
    for (int j = 0; j < kTaylorTerms; ++j) {
      series_2[j] += term;
      series_5_2[j] += term * root_t;
      term *= -t * Extended{kHalfWidth};
    }
  }
  Piece piece = economised(series_2, series_5_2, chebyshev);
  piece.root_of_gaussian = static_cast<double>(std::exp(-centre * centre / 4));
  return piece;
}

// Below the mean plane: the derivatives of F_n are
//   (2 pi)^(-1/2) int_0^inf t^n (-1)^j He_j(c + t) exp(-(c + t)^2/2) dt.
Piece make_piece_below(Extended centre, const Quadrature<64>& rule,
                       const ChebyshevTable& chebyshev) {
  TaylorSeries series_2{};
  TaylorSeries series_5_2{};
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const Extended t = rule.node[i], s = centre + t;
    const Extended root_t = std::sqrt(t);
    const Extended weight = rule.weight[i] * t * t * std::exp(-s * s / 2);
    Extended before = 0, hermite = weight, power = 1;
    for (int j = 0; j < kTaylorTerms; ++j) {
      series_2[j] += hermite * power;
      series_5_2[j] += hermite * power * root_t;
      const Extended next = s * hermite - j * before;
      before = hermite;
      hermite = next;
      power *= -Extended{kHalfWidth};
    }
  }
  return economised(series_2, series_5_2, chebyshev);
}

using Table = std::array<Piece, kCentresBelow + kCentres>;

Table make_table() {
  const ChebyshevTable chebyshev = chebyshev_powers<Extended, kTaylorTerms>();
  const Quadrature<16> rule;
  const Quadrature<64> fine_rule;
  Table table;
  for (int k = 0; k < kCentresBelow + kCentres; ++k) {
    const Extended centre = (k - kCentresBelow) * Extended{kCentreSpacing};
    table[k] = centre < 0 ? make_piece_below(centre, fine_rule, chebyshev)
                          : make_piece(centre, rule, chebyshev);
  }
  return table;
}

const Table& table() {
  static const Table table = make_table();
  return table;
}

// Estrin's scheme: four levels deep where Horner's is eleven.
template <class Real>
Real polynomial(const std::array<double, kPolynomialTerms>& a, Real d) {
  static_assert(kPolynomialTerms == 12);
  const Real d2 = d * d;
  const Real d4 = d2 * d2;
  const Real low = (a[0] + a[1] * d) + (a[2] + a[3] * d) * d2;
  const Real high = (a[4] + a[5] * d) + (a[6] + a[7] * d) * d2;
  const Real top = (a[8] + a[9] * d) + (a[10] + a[11] * d) * d2;
  return low + (high + top * d4) * d4;
}

// Both functions on the table, which covers [kFarBelow, kVanishes).
template <class Real>
AsperityFunctionsOf<Real> in_table(Real film_ratio) {
  // The nearest centre. (lround would cost a call on the hot path.)
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  const int k = static_cast<int>((laws::value_of(film_ratio) - kFarBelow) / kCentreSpacing + 0.5);
  const Piece& piece = table()[k];
  const double centre = (k - kCentresBelow) * kCentreSpacing, root = piece.root_of_gaussian;
  const Real offset = film_ratio - centre;  // d
  if (centre < 0) return {polynomial(piece.f2, offset), polynomial(piece.f5_2, offset)};
  const Real gaussian = laws::exponential(-offset * (centre + 0.5 * offset));
  return {polynomial(piece.f2, offset) * gaussian * root * root,
          polynomial(piece.f5_2, offset) * gaussian * root * root};
}

// With x = -l: x^n (1 + n (n - 1)/(2 x^2) + ...), from the moments of the heights; summits above
// the mean plane of the other surface are all but e^(-72) of them.
template <class Real>
AsperityFunctionsOf<Real> far_below(Real film_ratio) {
  const Real square = film_ratio * film_ratio;
  Real term = 1.0, sum = 1.0;
  for (int k = 0; k < 8; ++k) {
    term = term * ((2.5 - 2 * k) * (1.5 - 2 * k) / (2 * k + 2)) / square;
    sum = sum + term;
  }
  return {square + 1.0, square * laws::root(-film_ratio) * sum};
}

template <class Real>
AsperityFunctionsOf<Real> anywhere(Real film_ratio) {
  const double l = laws::value_of(film_ratio);
  if (l >= kFarBelow && l < kVanishes) return in_table(film_ratio);
  if (l < kFarBelow) return far_below(film_ratio);
  const Real outside = l >= kVanishes ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  return {outside, outside};
}

}  // namespace

AsperityFunctions asperity_functions(double film_ratio) { return anywhere(film_ratio); }

AsperityFunctionsOf<laws::Dual<double, 1>> asperity_functions_and_slopes(double film_ratio) {
  return anywhere(laws::Dual<double, 1>::variable(film_ratio, 0));
}

double separation_under_load(double f5_2, double above) {
  // ln F_5/2 falls with l and is concave: Newton's method from above never passes the root.
  const double log_load = std::log(f5_2);
  double l = above;
  constexpr int kMostSteps = 100;
  for (int n = 0; n < kMostSteps; ++n) {
    const auto f = asperity_functions_and_slopes(l).f5_2;
    const double change = (log_load - std::log(f.value)) * f.value / f.slope[0];
    l += change;
    if (!(std::abs(change) > 1e-9 * (1 + std::abs(l)))) break;  // the next is its square
  }
  return l;
}

}  // namespace tribodyn
