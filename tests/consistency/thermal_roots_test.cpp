#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/consistency/plain_contact.h"

// Thermal equilibria where there may be several or none: each count is held against a scan.
namespace tribodyn {
namespace {

double end_of_density_law(const Lubricant& oil) {
  return -oil.density_at_zero_kelvin / oil.density_temperature_slope;
}

/// T_in + heating - T of eqs 38 and 39.
class Excess {
 public:
  explicit Excess(const ContactCase& c) : case_(c) {
    ContactCase cold = c;
    cold.options.isothermal = true;
    film_ = cold.solve();
    EXPECT_EQ(film_.status, ContactStatus::kOk);
  }
  double flash_resistance() const { return film_.thermal_resistance_1 * film_.heat_partition; }
  double base() const {
    return case_.inlet_temperature() +
           flash_resistance() * film_.boundary_friction * film_.sliding_speed;
  }
  /// At base() + rise, with the mean stress by 150 rings: good to 1e-4.
  double coarse(double rise) const {
    const plain::Shear shear = sheared_at(base() + rise);
    constexpr int kRings = 150;
    double stress = 0;
    for (int i = 0; i < kRings; ++i) {
      const double xi = (i + 0.5) / kRings;
      stress += 2 * xi * shear.stress(film_.maximum_pressure * xi) / kRings;
    }
    return heating(stress) - rise;
  }
  /// At a temperature, to the last digits.
  double fine(double temperature) const {
    return base() + heating(plain::mean_stress(sheared_at(temperature), film_.maximum_pressure)) -
           temperature;
  }

 private:
  plain::Shear sheared_at(double temperature) const {
    return {case_, film_.pressure_viscosity_index, film_.shear_rate, temperature};
  }
  double heating(double stress) const {
    return film_.sliding_speed * stress *
           (flash_resistance() * (film_.contact_area - film_.asperity_area) +
            film_.central_film_thickness / (8 * case_.lubricant.thermal_conductivity));
  }

  const ContactCase& case_;
  ContactSolution film_;
};

/// Rises at which the excess changes sign, on a logarithmic scan up to the end of the density law.
std::vector<double> scanned_roots(const ContactCase& c) {
  const Excess excess(c);
  std::vector<double> roots;
  const double greatest_rise = (end_of_density_law(c.lubricant) - excess.base()) * (1 - 1e-9);
  if (!(greatest_rise > 0)) return roots;
  constexpr int kScan = 700;
  double last = 0;
  bool above = true;  // at no rise the film is always heated
  for (int i = 0; i <= kScan; ++i) {
    const double rise = greatest_rise * std::pow(10, -10.0 * (kScan - i) / kScan);
    if ((excess.coarse(rise) > 0) != above) {
      double low = last, high = rise;
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        ((excess.coarse(middle) > 0) == above ? low : high) = middle;
      }
      roots.push_back(low);
      above = !above;
    }
    last = rise;
  }
  return roots;
}

ContactCase strongly_thinning(double beta, double sump_celsius, double relaxation_time, double load,
                              double slide) {
  ContactCase c;
  c.lubricant.havriliak_negami_alpha = 1;
  c.lubricant.havriliak_negami_beta = beta;
  c.lubricant.relaxation_time = relaxation_time;
  c.sump_temperature = sump_celsius + 273.15;
  c.conditions = {load, 0.015, 0.3, 5, 1 + slide, 4, 1};
  return c;
}

TEST(ThermalRoots, SeveralAreCountedAndTheColdestReturned) {
  int several = 0, cases = 0;
  for (const double beta : {1.5, 2.5, 3.0}) {
    for (const double sump : {-60.0, -40.0}) {
      for (double relaxation_time = 5e-7; relaxation_time < 3e-5; relaxation_time *= 2) {
        for (const double load : {10.0, 100.0}) {
          const ContactCase c = strongly_thinning(beta, sump, relaxation_time, load, 10);
          SCOPED_TRACE("beta " + std::to_string(beta) + " sump " + std::to_string(sump) +
                       " lambda " + std::to_string(relaxation_time * 1e6) + "e-6 load " +
                       std::to_string(load));
          const ContactSolution s = c.solve();
          ASSERT_EQ(s.status, ContactStatus::kOk);
          const std::vector<double> roots = scanned_roots(c);
          ASSERT_EQ(s.thermal_roots, static_cast<int>(roots.size()));
          const double rise = s.contact_temperature - Excess(c).base();
          EXPECT_NEAR(rise, roots.front(), 2e-3 * rise);
          several += s.thermal_roots > 1;
          ++cases;
        }
      }
    }
  }
  EXPECT_GE(several, 4) << "of " << cases;
}

TEST(ThermalRoots, TheColdestOfSeveralIsAnEquilibriumToTheLastDigits) {
  const ContactCase c = strongly_thinning(3, -60, 9.7074e-07, 10, 10);
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  ASSERT_EQ(s.thermal_roots, 3);
  EXPECT_NEAR(Excess(c).fine(s.contact_temperature), 0, 1e-12 * s.contact_temperature);
}

TEST(ThermalRoots, OneWhereThinningIsWeak) {
  Draw draw(61);
  SCOPED_TRACE(draw.seed());
  int solved = 0;
  for (int i = 0; i < kRandomStates / 10; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    ContactCase c = random_contact_case(draw);
    c.lubricant.havriliak_negami_alpha = draw.between(0.8, 1);
    c.lubricant.havriliak_negami_beta =
        draw.between(0.8, 0.99) / c.lubricant.havriliak_negami_alpha;
    const ContactSolution s = c.solve();
    if (s.status != ContactStatus::kOk) continue;
    ++solved;
    EXPECT_EQ(s.thermal_roots, 1);
    EXPECT_EQ(scanned_roots(c).size(), 1u);
  }
  EXPECT_GT(solved, kRandomStates / 20);
}

TEST(ThermalRoots, NoneIsRefusedByName) {
  ContactCase c;
  c.solid.thermal_conductivity = 0.05;  // asperities alone heat the film out of the density law
  c.boundary.asperity_friction_coefficient = 0.3;
  c.conditions = {5000, 0.015, 0.3, 2, 20, 2, -20};
  EXPECT_GT(Excess(c).base(), end_of_density_law(c.lubricant));
  EXPECT_TRUE(scanned_roots(c).empty());
  const ContactSolution s = c.solve();
  EXPECT_STREQ(contact_status_name(s.status), "NO_CONTACT_TEMPERATURE");
  EXPECT_EQ(s.friction, 0);
  c.options.newtonian = true;  // eqs 25 and 26 are not needed
  EXPECT_EQ(c.solve().status, ContactStatus::kOk);
}

TEST(ThermalRoots, AsperitiesThatPullAreNotLeftToCoolTheOilBelowItsViscosityLaw) {
  ContactCase c;
  c.options.as_published.eq43_44_polynomials = true;  // negative at a film ratio of 20
  c.roughness.composite_rms_height = 0.04e-6;
  c.conditions = {2000, 0.015, 0.3, 5, 10, 4, -1};
  EXPECT_STREQ(contact_status_name(c.solve().status), "NO_CONTACT_TEMPERATURE");
}

// A step of 3e-8 in ln(T - base), elsewhere nothing, is not small in the last kelvin of the density
// law: there T_c was once wrong by a third of the rise.
TEST(ThermalRoots, LastKelvinOfTheDensityLaw) {
  ContactCase c;
  c.boundary.asperity_friction_coefficient = 0.3;
  c.conditions = {5000, 0.015, 0.3, 2, 20, 2, -20};
  const double end = end_of_density_law(c.lubricant);
  int close = 0;
  c.lubricant.havriliak_negami_beta = 0.1;  // weak thinning: the stress falls at the very end
  for (double conductivity = 0.05; conductivity < 2; conductivity *= 1.01) {
    SCOPED_TRACE(conductivity);
    c.solid.thermal_conductivity = conductivity;
    const ContactSolution s = c.solve();
    if (s.status != ContactStatus::kOk || s.contact_temperature < end - 1) continue;
    ++close;
    const Excess excess(c);
    EXPECT_GT(excess.fine(s.contact_temperature * (1 - 1e-12)), 0);
    EXPECT_LT(excess.fine(s.contact_temperature * (1 + 1e-12)), 0);
  }
  EXPECT_GT(close, 5);
}

}  // namespace
}  // namespace tribodyn
