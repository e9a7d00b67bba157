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
constexpr double kCentreSpacing = 0.25;
constexpr double kHalfWidth = kCentreSpacing / 2;
constexpr double kVanishes = 38.75;  // beyond, F_2 is below half the smallest subnormal number
constexpr int kCentres = 156;        // centres 0, 0.25 ... 38.75
constexpr int kPolynomialTerms = 12;

struct Piece {
  std::array<double, kPolynomialTerms> f2;    // coefficients of P_2 in d
  std::array<double, kPolynomialTerms> f5_2;  // coefficients of P_5/2 in d
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
struct Quadrature {
  static constexpr int kFirst = -52;  // t (1 + c) = 2e-13: the integrand t^2 dt is below 1e-37
  static constexpr int kLast = 66;    // t (1 + c) = 61: exp(-t^2/2 - c t) is below 1e-25 for all c
  std::array<Extended, kLast - kFirst + 1> node;    // t (1 + c)
  std::array<Extended, kLast - kFirst + 1> weight;  // (2 pi)^(-1/2) (1 + c) dt

  Quadrature() {
    constexpr Extended kStep = Extended{1} / 16;
    const Extended scale = kStep / std::sqrt(2 * std::numbers::pi_v<Extended>);
    for (int i = kFirst; i <= kLast; ++i) {
      const Extended x = i * kStep, inner = std::exp(-x);
      node[i - kFirst] = std::exp(x - inner);
      weight[i - kFirst] = scale * node[i - kFirst] * (1 + inner);
    }
  }
};

Piece make_piece(Extended centre, const Quadrature& rule, const ChebyshevTable& chebyshev) {
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
  Extended factorial = 1;
  for (int j = 2; j < kTaylorTerms; ++j) {
    factorial *= j;
    series_2[j] /= factorial;
    series_5_2[j] /= factorial;
  }
  Piece piece;
  piece.f2 = economised(series_2, chebyshev);
  piece.f5_2 = economised(series_5_2, chebyshev);
  piece.root_of_gaussian = static_cast<double>(std::exp(-centre * centre / 4));
  return piece;
}

using Table = std::array<Piece, kCentres>;

Table make_table() {
  const ChebyshevTable chebyshev = chebyshev_powers<Extended, kTaylorTerms>();
  const Quadrature rule;
  Table table;
  for (int k = 0; k < kCentres; ++k) {
    table[k] = make_piece(k * Extended{kCentreSpacing}, rule, chebyshev);
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

// Both functions on the table, which covers [0, kVanishes).
template <class Real>
AsperityFunctionsOf<Real> in_table(Real film_ratio) {
  // The nearest centre; film_ratio is not negative here. (lround would cost a call on the hot
  // path.)
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  const int k = static_cast<int>(laws::value_of(film_ratio) / kCentreSpacing + 0.5);
  const Piece& piece = table()[k];
  const double centre = k * kCentreSpacing, root = piece.root_of_gaussian;
  const Real offset = film_ratio - centre;  // d
  const Real gaussian = laws::exponential(-offset * (centre + 0.5 * offset));
  return {polynomial(piece.f2, offset) * gaussian * root * root,
          polynomial(piece.f5_2, offset) * gaussian * root * root};
}

template <class Real>
AsperityFunctionsOf<Real> anywhere(Real film_ratio) {
  const double l = laws::value_of(film_ratio);
  if (l >= 0 && l < kVanishes) return in_table(film_ratio);
  const Real outside = l >= kVanishes ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  return {outside, outside};
}

}  // namespace

AsperityFunctions asperity_functions(double film_ratio) { return anywhere(film_ratio); }

AsperityFunctionsOf<laws::Dual<double, 1>> asperity_functions_and_slopes(double film_ratio) {
  return anywhere(laws::Dual<double, 1>::variable(film_ratio, 0));
}

}  // namespace tribodyn
