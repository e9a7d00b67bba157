#include "tests/support/contact_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/consistency/contact_case.h"
#include "tests/support/improved_yasutomi.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/run_length.h"

// The batch kernel against the kernel that solves one contact at a time.
namespace tribodyn {
namespace {

double batch_difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

/// The greatest relative difference of all figures; shares of an area differ absolutely.
/// `negligible`: of the load and of the friction, a part of the asperities that need not agree.
double batch_difference(const ContactSolution& a, const ContactSolution& b, double negligible = 0) {
  if (a.status != b.status || a.limiting_stress_at_centre != b.limiting_stress_at_centre) {
    return std::numeric_limits<double>::infinity();
  }
  const auto of_asperities = [&](double x, double y, double whole) {
    return std::abs(x - y) <= negligible * whole ? 0 : batch_difference(x, y);
  };
  return std::max({batch_difference(a.friction, b.friction),
                   batch_difference(a.viscous_friction, b.viscous_friction),
                   of_asperities(a.boundary_friction, b.boundary_friction, b.friction),
                   batch_difference(a.contact_temperature, b.contact_temperature),
                   batch_difference(a.central_film_thickness, b.central_film_thickness),
                   batch_difference(a.film_ratio, b.film_ratio),
                   batch_difference(a.maximum_pressure, b.maximum_pressure),
                   batch_difference(a.ellipse_load, b.ellipse_load),
                   of_asperities(a.asperity_load, b.asperity_load, b.ellipse_load),
                   batch_difference(a.sliding_speed, b.sliding_speed),
                   batch_difference(a.shear_rate, b.shear_rate),
                   batch_difference(a.mean_shear_stress, b.mean_shear_stress),
                   std::abs(a.limiting_stress_area_share - b.limiting_stress_area_share)});
}

/// The greatest difference of a batch.
double tolerance_of(Digits digits) { return digits == Digits::kFull ? 1e-10 : 3e-5; }

/// The greatest differences that were seen with all and with half of the digits.
struct Worst {
  double full = 0, half = 0;
};

std::ostream& operator<<(std::ostream& out, const Worst& worst) {
  return out << worst.full << ", with half of the digits " << worst.half;
}

/// Compares every instruction set with the scalar kernel, with all and with half of the digits.
/// Returns how many contacts the last one left to the scalar kernel with all digits.
std::size_t expect_agreement(const ContactCase& c, const std::vector<ContactConditions>& conditions,
                             Worst* worst = nullptr) {
  const FlankContactModel model = c.model();
  ContactArrays arrays(conditions, c.solid, c.options);
  std::vector<ContactSolution> reference;
  for (const ContactConditions& k : conditions) reference.push_back(model.solve(k));
  std::size_t by_scalar_kernel = 0;
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    for (const Digits digits : {Digits::kHalf, Digits::kFull}) {
      by_scalar_kernel = arrays.solve(FlankContactBatch(model, set), digits);
      double most = 0;
      for (std::size_t i = 0; i < conditions.size(); ++i) {
        const double negligible = digits == Digits::kFull ? 0 : 1e-7;
        const double off = batch_difference(arrays.solution(i), reference[i], negligible);
        EXPECT_LE(off, tolerance_of(digits))
            << (digits == Digits::kFull ? "all" : "half of the") << " digits, contact " << i << ", "
            << contact_status_name(arrays.solution(i).status) << ", friction "
            << arrays.solution(i).friction << " N for " << reference[i].friction << " N";
        most = std::max(most, off);
      }
      if (worst == nullptr) continue;
      double& of_digits = digits == Digits::kFull ? worst->full : worst->half;
      of_digits = std::max(of_digits, most);
    }
  }
  return by_scalar_kernel;
}

std::size_t expect_agreement(const ContactCase& c) { return expect_agreement(c, {c.conditions}); }

TEST(ContactBatch, RandomStates) {
  constexpr int kCases = kShortRun ? 40 : 1000, kEach = 20;
  Draw draw(71);
  SCOPED_TRACE(draw.seed());
  std::size_t by_scalar_kernel = 0;
  Worst worst;
  for (int n = 0; n < kCases; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    ContactCase c = random_contact_case(draw);
    const auto one_in = [&](int count) { return draw.between(0, count) < 1; };
    c.options.newtonian = one_in(8);
    c.options.isothermal = one_in(8);
    c.options.no_limiting_shear_stress = one_in(8);
    c.options.no_boundary_friction = one_in(8);
    if (one_in(4)) c.options.hertz_solution = HertzSolution::kExact;
    c.options.inlet_shear_heating = n % 3 == 1;
    c.options.closed_load_sharing = n % 5 < 3;
    std::vector<ContactConditions> conditions;
    for (int i = 0; i < kEach; ++i) conditions.push_back(random_contact_case(draw).conditions);
    try {
      by_scalar_kernel += expect_agreement(c, conditions, &worst);
    } catch (const Refusal&) {
      --n;  // a fluid without a model
    }
  }
  RecordProperty("share_by_scalar_kernel",
                 std::to_string(1.0 * by_scalar_kernel / (kCases * kEach)));
  RecordProperty("greatest_difference", std::to_string(worst.full));
  std::cout << "left to the scalar kernel: " << 100.0 * by_scalar_kernel / (kCases * kEach)
            << " %, greatest difference " << worst << "\n";
  EXPECT_LT(by_scalar_kernel, kCases * kEach / 2);
}

TEST(ContactBatch, RealisticContactsNeverNeedTheScalarKernel) {
  Worst worst;
  for (const int fluid : {1, 2, 3}) {
    for (const double sump : {20.0, 40.0, 90.0}) {
      const Scene scene = reference_scene(fluid, sump);
      ContactCase c;
      c.lubricant = scene.lubricant;
      c.sump_temperature = scene.sump_temperature;
      for (double speed = 20; speed <= 140; speed += kShortRun ? 40 : 10) {
        SCOPED_TRACE("fluid " + std::to_string(fluid) + ", sump " + std::to_string(sump) + ", " +
                     std::to_string(speed) + " km/h");
        const RealisticContacts contacts = realistic_contacts(scene, speed, 40);
        EXPECT_EQ(expect_agreement(c, contacts.conditions, &worst), 0u);
      }
    }
  }
  EXPECT_LT(worst.half, 2e-6);
  std::cout << "greatest difference " << worst << "\n";
}

std::vector<ContactConditions> mixed_conditions(Draw& draw, int count) {
  std::vector<ContactConditions> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(random_contact_case(draw).conditions);
    if (i % 7 == 3) out.back().load = 0;
    if (i % 11 == 5) out.back().radius_x = -1;
    if (i % 13 == 6) out.back().velocity_2_y = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

bool same_bits(const ContactSolution& a, const ContactSolution& b) {
  return std::bit_cast<std::uint64_t>(a.friction) == std::bit_cast<std::uint64_t>(b.friction) &&
         a.status == b.status && batch_difference(a, b) == 0;
}

TEST(ContactBatch, RandomStatesUnderTheImprovedYasutomiLaw) {
  constexpr int kEach = 20;
  const int cases = full_run() ? 400 : kShortRun ? 40 : 120;
  Draw draw(75);
  SCOPED_TRACE(draw.seed());
  std::size_t by_scalar_kernel = 0;
  Worst worst;
  for (int n = 0; n < cases; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    ContactCase c = random_contact_case(draw);
    set_yasutomi(gear_oil_80w90(), c.lubricant);
    c.lubricant.law_parameters[kGlassTemperatureRise] *= draw.between(0.8, 1.2);
    c.lubricant.law_parameters[kExpansivityExponent] *= draw.between(0.8, 1.2);
    c.sump_temperature = draw.between(273.15, 403.15);
    c.options.newtonian = n % 8 == 1;
    c.options.isothermal = n % 8 == 2;
    c.options.no_limiting_shear_stress = n % 8 == 3;
    c.options.inlet_shear_heating = n % 3 == 1;
    std::vector<ContactConditions> conditions;
    for (int i = 0; i < kEach; ++i) conditions.push_back(random_contact_case(draw).conditions);
    by_scalar_kernel += expect_agreement(c, conditions, &worst);
  }
  std::cout << "left to the scalar kernel: " << 100.0 * by_scalar_kernel / (cases * kEach)
            << " %, greatest difference " << worst << "\n";
  EXPECT_LT(by_scalar_kernel, cases * kEach / 2);
}

// The table of the law ends near 1 GPa in cold oil: a contact beyond it whose stress is nearly
// nowhere limited goes to the scalar kernel.
TEST(ContactBatch, RealisticContactsUnderTheImprovedYasutomiLawRarelyNeedTheScalarKernel) {
  Worst worst;
  std::size_t by_scalar_kernel = 0, all = 0;
  for (const double sump : {20.0, 40.0, 90.0}) {
    const Scene scene = reference_scene(1, sump);
    ContactCase c;
    c.lubricant = scene.lubricant;
    set_yasutomi(gear_oil_80w90(), c.lubricant);
    c.sump_temperature = scene.sump_temperature;
    for (double speed = 20; speed <= 140; speed += kShortRun ? 40 : 10) {
      SCOPED_TRACE("sump " + std::to_string(sump) + ", " + std::to_string(speed) + " km/h");
      const RealisticContacts contacts = realistic_contacts(scene, speed, 40);
      by_scalar_kernel += expect_agreement(c, contacts.conditions, &worst);
      all += contacts.conditions.size();
    }
  }
  std::cout << by_scalar_kernel << " of " << all
            << " left to the scalar kernel, greatest difference " << worst << "\n";
  EXPECT_LT(by_scalar_kernel, all / 100);
}

// With tau_L0 = 0 the rim is always on the limit; with a small one, under a high stress.
TEST(ContactBatch, RimsOnTheLimitOfRandomStates) {
  constexpr int kCases = kShortRun ? 20 : 120, kEach = 20;
  for (const bool yasutomi : {false, true}) {
    Draw draw(76);
    SCOPED_TRACE(draw.seed());
    std::size_t by_scalar_kernel = 0;
    Worst worst;
    for (int n = 0; n < kCases; ++n) {
      SCOPED_TRACE("case " + std::to_string(n) + (yasutomi ? ", Yasutomi" : ""));
      ContactCase c = random_contact_case(draw);
      c.sump_temperature = draw.between(273.15, 403.15);
      if (yasutomi) set_yasutomi(gear_oil_80w90(), c.lubricant);
      c.lubricant.limiting_shear_stress_at_zero_pressure =
          n % 2 == 0 ? 0 : draw.log_between(1, 1e6);
      c.options.newtonian = n % 8 == 4;
      c.options.isothermal = n % 8 == 7;
      std::vector<ContactConditions> conditions;
      for (int i = 0; i < kEach; ++i) conditions.push_back(random_contact_case(draw).conditions);
      try {
        by_scalar_kernel += expect_agreement(c, conditions, &worst);
      } catch (const Refusal&) {
        --n;  // a fluid without a model
      }
    }
    std::cout << "left to the scalar kernel: " << 100.0 * by_scalar_kernel / (kCases * kEach)
              << " %, greatest difference " << worst << "\n";
    EXPECT_LT(by_scalar_kernel, kCases * kEach / 2);
  }
}

TEST(ContactBatch, RealisticRimsOnTheLimitRarelyNeedTheScalarKernel) {
  Worst worst;
  std::size_t by_scalar_kernel = 0, all = 0;
  for (const int fluid : {1, 2, 3}) {
    for (const double sump : {20.0, 40.0, 90.0}) {
      for (const double coefficient : {0.029, 0.083}) {
        const Scene scene = reference_scene(fluid, sump);
        ContactCase c;
        c.lubricant = scene.lubricant;
        c.lubricant.limiting_shear_stress_at_zero_pressure = 0;
        c.lubricant.limiting_shear_stress_coefficient = coefficient;
        c.sump_temperature = scene.sump_temperature;
        for (double speed = 20; speed <= 140; speed += kShortRun ? 40 : 10) {
          SCOPED_TRACE("fluid " + std::to_string(fluid) + ", sump " + std::to_string(sump) + ", " +
                       std::to_string(speed) + " km/h");
          const RealisticContacts contacts = realistic_contacts(scene, speed, 40);
          by_scalar_kernel += expect_agreement(c, contacts.conditions, &worst);
          all += contacts.conditions.size();
        }
      }
    }
  }
  std::cout << by_scalar_kernel << " of " << all
            << " left to the scalar kernel, greatest difference " << worst << "\n";
  EXPECT_LT(by_scalar_kernel, all / 500);
  EXPECT_LT(worst.half, 2e-6);
}

// Shell T9, which has no thinning and a limit in proportion to the pressure.
TEST(ContactBatch, RealisticContactsOfANewtonianOilNeverNeedTheScalarKernel) {
  ContactCase c;
  c.lubricant = {8.128e-5, 643.9, 172.57, 2.03e-8, 313.15, 0,    1,
                 0,        298,   0,      0.083,   0.111,  1073, -0.6744};
  for (const double sump : {20.0, 40.0, 90.0}) {
    Scene scene = reference_scene(1, sump);
    c.sump_temperature = scene.sump_temperature;
    for (double speed = 20; speed <= 140; speed += kShortRun ? 40 : 10) {
      SCOPED_TRACE("sump " + std::to_string(sump) + ", " + std::to_string(speed) + " km/h");
      EXPECT_EQ(expect_agreement(c, realistic_contacts(scene, speed, 40).conditions), 0u);
    }
  }
}

TEST(ContactBatch, SameBitsAloneAndInAnyCompany) {
  Draw draw(72);
  SCOPED_TRACE(draw.seed());
  for (int n = 0; n < (kShortRun ? 2 : 20); ++n) {
    ContactCase c = n % 2 == 0 ? ContactCase() : random_contact_case(draw);
    if (n % 4 == 0) set_yasutomi(gear_oil_80w90(), c.lubricant);
    if (n % 3 == 0) c.lubricant.limiting_shear_stress_at_zero_pressure = 1e5 * (n % 2);
    const std::vector<ContactConditions> conditions = mixed_conditions(draw, 150);
    for (const InstructionSet set : supported_instruction_sets()) {
      SCOPED_TRACE(FlankContactBatch::name(set));
      const FlankContactBatch batch(c.model(), set);
      ContactArrays together(conditions, c.solid, c.options);
      together.solve(batch);
      for (std::size_t i = 0; i < conditions.size(); ++i) {
        ContactArrays alone({conditions[i]}, c.solid, c.options);
        alone.solve(batch);
        EXPECT_TRUE(same_bits(alone.solution(0), together.solution(i))) << i;
      }
      // Pieces of every size: every place in a block comes about.
      ContactArrays pieces(conditions, c.solid, c.options);
      std::size_t first = 0;
      for (std::size_t count = 1; first < conditions.size(); ++count) {
        const std::size_t here = std::min(count, conditions.size() - first);
        batch.solve(pieces.geometries(), first, here, pieces.conditions(first),
                    pieces.results(first));
        first += here;
      }
      // And among others, in another order.
      std::vector<ContactConditions> reversed(conditions.rbegin(), conditions.rend());
      ContactArrays backwards(reversed, c.solid, c.options);
      backwards.solve(batch);
      for (std::size_t i = 0; i < conditions.size(); ++i) {
        EXPECT_TRUE(same_bits(pieces.solution(i), together.solution(i))) << i;
        EXPECT_TRUE(same_bits(backwards.solution(conditions.size() - 1 - i), together.solution(i)))
            << i;
      }
    }
  }
}

TEST(ContactBatch, EveryWidthWithFusedMultiplyAddsGivesTheSameBits) {
  if (!FlankContactBatch::supported(InstructionSet::kAvx512)) GTEST_SKIP() << "no AVX-512 here";
  Draw draw(73);
  SCOPED_TRACE(draw.seed());
  for (int n = 0; n < 20; ++n) {
    ContactCase c = random_contact_case(draw);
    if (n % 4 == 3) {
      set_yasutomi(gear_oil_80w90(), c.lubricant);
      c.sump_temperature = draw.between(273.15, 403.15);
    }
    if (n % 3 == 0) c.lubricant.limiting_shear_stress_at_zero_pressure = 1e5 * (n % 2);
    const std::vector<ContactConditions> conditions = mixed_conditions(draw, 100);
    ContactArrays narrow(conditions, c.solid, c.options), wide(conditions, c.solid, c.options);
    narrow.solve(FlankContactBatch(c.model(), InstructionSet::kAvx2));
    wide.solve(FlankContactBatch(c.model(), InstructionSet::kAvx512));
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      EXPECT_TRUE(same_bits(narrow.solution(i), wide.solution(i))) << i;
    }
  }
}

TEST(ContactBatch, HardContacts) {
  std::vector<ContactConditions> hard;
  const ContactConditions typical = ContactCase().conditions;
  for (double load = 1e-300; load < 1e6; load *= 1e3) {  // vanishing loads
    hard.push_back(typical);
    hard.back().load = load;
  }
  for (const double load : {0.0, -0.0, -1e-300, -2000.0}) {  // none
    hard.push_back(typical);
    hard.back().load = load;
  }
  hard.push_back({2000, 0.015, 0.3, 5, 1, 5, 1});         // pure rolling
  for (const double creep : {1e-3, 1e-6, 1e-9, 1e-12}) {  // nearly
    hard.push_back({2000, 0.015, 0.3, 5, 1, 5 - creep, 1});
  }
  for (const double load : {1e-6, 1.0, 2000.0, 2e4}) {  // zero entrainment, and nearly
    hard.push_back({load, 0.015, 0.3, 3, 2, -3, -2});
    for (const double speed : {1e-3, 1e-6, 1e-12, 1e-50, 1e-300}) {
      hard.push_back({load, 0.015, 0.3, 3, speed, -3 + speed, 0});
    }
  }
  hard.push_back({2000, 0.015, 0.3, 5, 1, 0, 0});  // a surface at rest, both at rest
  hard.push_back({2000, 0.015, 0.3, 0, 0, 5, 1});
  hard.push_back({2000, 0.015, 0.3, 1e-20, 0, 5, 1});
  hard.push_back({2000, 0.015, 0.3, 0, 0, 0, 0});
  for (double ratio = 0.4; ratio <= 1000; ratio *= 1.5) {  // wide to needle-like
    hard.push_back(typical);
    hard.back().radius_y = ratio * typical.radius_x;
  }
  for (const double load : {1.0, 100.0, 5000.0}) {  // 300 m/s of sliding
    hard.push_back({load, 0.015, 0.3, 40, 200, 40, -100});
  }
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double radius : {0.0, -0.015, 1e-170, kMost}) {
    hard.push_back(typical);
    hard.back().radius_y = radius;
  }
  hard.push_back({2000, kMost, kMost, 5, 6, 4, -1});
  for (const double bad : {std::numeric_limits<double>::infinity(), -kMost, kMost,
                           std::numeric_limits<double>::quiet_NaN()}) {
    for (int j = 0; j < 7; ++j) {
      ContactConditions k = typical;
      double* const members[] = {&k.load,         &k.radius_x,     &k.radius_y,    &k.velocity_1_x,
                                 &k.velocity_1_y, &k.velocity_2_x, &k.velocity_2_y};
      *members[j] = bad;
      hard.push_back(k);
    }
  }

  std::vector<ModelOptions> options(7);
  options[1].isothermal = true;
  options[2].newtonian = true;
  options[3].no_limiting_shear_stress = true;
  options[4].newtonian = options[4].no_limiting_shear_stress = true;
  options[5].hertz_solution = HertzSolution::kExact;
  options[6].no_boundary_friction = options[6].isothermal = true;
  for (std::size_t n = 0; n < options.size(); ++n) {
    SCOPED_TRACE("options " + std::to_string(n));
    ContactCase c;
    c.options = options[n];
    expect_agreement(c, hard);
  }
  for (const int fluid : {1, 2, 3}) {  // arctic to scorching
    for (double celsius = -70; celsius <= 200; celsius += 15) {
      SCOPED_TRACE(std::to_string(fluid) + " at " + std::to_string(celsius));
      ContactCase c;
      c.lubricant = reference_lubricant(fluid);
      c.sump_temperature = celsius + 273.15;
      expect_agreement(c, hard);
    }
  }
}

TEST(ContactBatch, FilmRatiosFromNothingToAHundredThousand) {
  for (double height = 1e-3; height > 1e-12; height /= 1.1) {
    SCOPED_TRACE(height);
    ContactCase c;
    c.roughness.composite_rms_height = height;
    c.roughness.asperity_density = 0.04 / (height * c.roughness.asperity_radius);
    expect_agreement(c);
  }
  ContactCase full;
  full.roughness.asperity_density *= 12;  // asperities that fill the footprint
  full.conditions = {2000, 0.015, 0.3, 1e-4, 0, 0, 0};
  expect_agreement(full);
  for (const double speed : {1.0, 1e-2, 1e-4, 1e-6}) {
    ContactCase thin;
    thin.roughness = {5e8, 15e-6, 5e-6};
    thin.conditions = {2000, 0.015, 0.3, 1.2 * speed, 0.1 * speed, 0.8 * speed, 0.1 * speed};
    expect_agreement(thin);
  }
}

TEST(ContactBatch, LimitingStressOfAnyShape) {
  Draw draw(74);
  SCOPED_TRACE(draw.seed());
  for (const double at_zero : {0.0, 1e3, 1e5, 1e6, 4e6, 4e7}) {
    for (const double slope : {0.0, 0.001, 0.029, 0.083, 0.5}) {
      for (const double celsius : {-40.0, 0.0, 40.0, 120.0}) {
        SCOPED_TRACE(std::to_string(at_zero) + " " + std::to_string(slope) + " at " +
                     std::to_string(celsius));
        ContactCase c;
        c.lubricant.limiting_shear_stress_at_zero_pressure = at_zero;
        c.lubricant.limiting_shear_stress_coefficient = slope;
        c.sump_temperature = celsius + 273.15;
        std::vector<ContactConditions> conditions;
        for (int i = 0; i < (kShortRun ? 3 : 20); ++i) {
          conditions.push_back(random_contact_case(draw).conditions);
        }
        expect_agreement(c, conditions);
        c.options.isothermal = true;
        expect_agreement(c, conditions);
      }
    }
  }
}

TEST(ContactBatch, SeveralEquilibriaOrNone) {
  for (const double beta : {0.25, 1.5, 3.0}) {
    for (const double sump : {-60.0, -40.0, 40.0}) {
      for (double relaxation_time = 5e-7; relaxation_time < 3e-5; relaxation_time *= 4) {
        for (const double load : {10.0, 100.0}) {
          ContactCase c;
          c.lubricant.havriliak_negami_alpha = 1;
          c.lubricant.havriliak_negami_beta = beta;
          c.lubricant.relaxation_time = relaxation_time;
          c.sump_temperature = sump + 273.15;
          c.conditions = {load, 0.015, 0.3, 5, 11, 4, 1};
          expect_agreement(c);
        }
      }
    }
  }
  ContactCase c;
  c.boundary.asperity_friction_coefficient = 0.3;
  c.conditions = {5000, 0.015, 0.3, 2, 20, 2, -20};
  for (double conductivity = 0.05; conductivity < 2; conductivity *= 1.2) {
    c.solid.thermal_conductivity = conductivity;
    expect_agreement(c);
  }
}

TEST(ContactBatch, ModelsThatItCannotCertifyAreSolvedByTheScalarKernel) {
  std::vector<ContactCase> cases(6);
  cases[0].options.as_published.eq17_atan = true;
  cases[1].options.as_published.eq31_32_logarithm = true;
  cases[2].options.as_published.eq43_44_polynomials = true;
  cases[3].options.hertz_load = HertzLoad::kTotalLoad;
  cases[4].lubricant.limiting_shear_stress_at_zero_pressure = 0;
  cases[4].lubricant.limiting_shear_stress_coefficient = 0;
  cases[5].lubricant.density_temperature_slope = 0.1;
  for (const ContactCase& c : cases) {
    ContactArrays arrays({c.conditions}, c.solid, c.options);
    EXPECT_EQ(arrays.solve(FlankContactBatch(c.model())), 1u);
    EXPECT_TRUE(same_bits(arrays.solution(0), c.solve()));
  }
  // Other misprints are in the geometry, which was prepared with them.
  ContactCase c;
  c.options.as_published.eq20_semi_major = c.options.as_published.eq22_inverted_ratio = true;
  EXPECT_EQ(expect_agreement(c), 0u);
}

TEST(ContactBatch, GeometryOfAnotherMaterialIsNotUsed) {
  ContactCase c;
  Solid soft = c.solid;
  soft.youngs_modulus /= 2;
  ContactArrays arrays({c.conditions}, soft, c.options);
  EXPECT_EQ(arrays.solve(FlankContactBatch(c.model())), 1u);
  EXPECT_TRUE(same_bits(arrays.solution(0), c.solve()));
}

TEST(ContactBatch, AnyStartLeadsToTheSameAnswer) {
  Draw draw(75);
  SCOPED_TRACE(draw.seed());
  for (int n = 0; n < (kShortRun ? 5 : 50); ++n) {
    ContactCase c = n == 0 ? ContactCase() : random_contact_case(draw);
    if (n % 3 == 2) c.lubricant.limiting_shear_stress_at_zero_pressure = 0;
    const FlankContactModel model = c.model();
    const FlankContactBatch batch(model);
    ContactArrays arrays(mixed_conditions(draw, 100), c.solid, c.options);
    std::vector<ContactSolution> cold;
    arrays.solve(batch);
    for (std::size_t i = 0; i < arrays.size(); ++i) cold.push_back(arrays.solution(i));
    for (const double factor : {1.0, 1.001, 0.99, 1.3, 0.0, -1.0, 1e300}) {
      arrays.solve(batch);
      arrays.start_from_last_temperature(factor);
      arrays.solve(batch);
      for (std::size_t i = 0; i < arrays.size(); ++i) {
        EXPECT_LE(batch_difference(arrays.solution(i), cold[i]), tolerance_of(Digits::kFull))
            << factor << " " << i;
      }
    }
  }
}

TEST(ContactBatch, FiguresThatAreNotWantedMayBeNull) {
  ContactCase c;
  ContactArrays arrays({c.conditions, c.conditions}, c.solid, c.options);
  const FlankContactBatch batch(c.model());
  double friction[2] = {-1, -1};
  FlankContactBatchResults results;
  results.friction = friction;
  EXPECT_EQ(batch.solve(arrays.geometries(), 0, 1, arrays.conditions(), results), 0u);
  EXPECT_EQ(friction[1], -1);
  arrays.solve(batch);
  EXPECT_EQ(friction[0], arrays.solution(0).friction);
  EXPECT_EQ(batch.solve(arrays.geometries(), 0, 0, arrays.conditions(), {}), 0u);
}

}  // namespace
}  // namespace tribodyn
