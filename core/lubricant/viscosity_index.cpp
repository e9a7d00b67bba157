#include "core/lubricant/viscosity_index.h"

#include <array>
#include <cmath>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

struct ReferencePiece {
  double from;     // valid from this Y [mm2/s] to the next piece's
  double a, b, c;  // L
  double d, e, f;  // H
};

constexpr std::array<ReferencePiece, 16> kPieces = {{
    {2.0, 1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077},
    {3.8, 3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183},
    {4.4, 2.50000, -7.2143, 13.812, 0.82143, 1.5679, 0.119},
    {5.0, 0.10100, 16.6350, -45.469, 0.04985, 9.1613, -18.557},
    {6.4, 3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656},
    {7.0, 0.01191, 21.4750, -72.870, 0.79762, -0.7321, 14.610},
    {7.7, 0.41858, 16.1558, -56.040, 0.05794, 10.5156, -28.240},
    {9.0, 0.88779, 7.5527, -16.600, 0.26665, 6.7015, -10.810},
    {12.0, 0.76720, 10.7972, -38.180, 0.20073, 8.4658, -22.490},
    {15.0, 0.97305, 5.3135, -2.200, 0.28889, 5.9741, -4.930},
    {18.0, 0.97256, 5.2500, -0.980, 0.24504, 7.4160, -16.730},
    {22.0, 0.91413, 7.4759, -21.820, 0.20323, 9.1267, -34.230},
    {28.0, 0.87031, 9.7157, -50.770, 0.18411, 10.1015, -46.750},
    {40.0, 0.84703, 12.6752, -133.310, 0.17029, 11.4866, -80.620},
    {55.0, 0.85921, 11.1009, -83.190, 0.17130, 11.3680, -76.940},
    {70.0, 0.83531, 14.6731, -216.246, 0.16841, 11.8493, -96.947},
}};

}  // namespace

ViscosityIndexReferences viscosity_index_references(double kinematic_viscosity_100) {
  const double y = kinematic_viscosity_100;
  if (!(y >= kPieces.front().from && std::isfinite(y))) {
    throw Refusal("VISCOSITY_INDEX_UNDEFINED",
                  "A kinematic viscosity at 100 C of " + number_text(y) +
                      " mm2/s: ASTM D2270 defines the viscosity index from 2 mm2/s up.");
  }
  const ReferencePiece* piece = &kPieces.front();
  for (const ReferencePiece& candidate : kPieces) {
    if (y >= candidate.from) piece = &candidate;
  }
  return {(piece->a * y + piece->b) * y + piece->c, (piece->d * y + piece->e) * y + piece->f};
}

double viscosity_index(double kinematic_viscosity_40, double kinematic_viscosity_100) {
  const auto [index_0, index_100] = viscosity_index_references(kinematic_viscosity_100);
  const double u = kinematic_viscosity_40;
  if (!(u > kinematic_viscosity_100 && std::isfinite(u))) {
    throw Refusal("VISCOSITY_INDEX_UNDEFINED",
                  "A kinematic viscosity at 40 C of " + number_text(u) +
                      " mm2/s: it must be above that at 100 C, " +
                      number_text(kinematic_viscosity_100) + " mm2/s (ASTM D2270).");
  }
  if (u > index_100) return 100 * (index_0 - u) / (index_0 - index_100);
  const double n = std::log(index_100 / u) / std::log(kinematic_viscosity_100);
  return 100 + std::expm1(n * std::log(10.0)) / 0.00715;
}

}  // namespace tribodyn
