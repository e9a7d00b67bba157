#include "client/cpp/text/units.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace tribodyn::client {
namespace {

double read(const std::string& text, const std::string& unit, bool temperature = false) {
  std::string wrong;
  const auto value = read_quantity(text, unit, "", temperature, wrong);
  EXPECT_TRUE(value) << text << " " << wrong;
  return value.value_or(0);
}

TEST(Units, EveryUsualSpellingIsAccepted) {
  for (const char* text :
       {"20/GPa", "20 1/GPa", "20 GPa^-1", "20GPa-1", "0.02/MPa", "20 GPa\u207b\u00b9"}) {
    EXPECT_EQ(read(text, "1/Pa"), 2e-8) << text;
  }
  for (const char* text : {"8.86mm2/s", "8.86 mm^2/s", "8.86 mm\u00b2/s", "8.86cSt", "0.0886 St"}) {
    EXPECT_EQ(read(text, "mm2/s"), 8.86) << text;
  }
  for (const char* text :
       {"150mPas", "150 mPa s", "150 mPa*s", "150cP", "0.15Pa s", "150 mPa\u00b7s"}) {
    // Laboratory sheets print "mPas" without a blank.
    EXPECT_EQ(read(text, "mPa s"), 150) << text;
  }
  for (const char* text : {"0.14W/(m K)", "0.14 W/mK", "0.14W/m/K", "140 mW/(m K)"}) {
    EXPECT_EQ(read(text, "W/(m K)"), 0.14) << text;
  }
  EXPECT_EQ(read("0.87 g/cm3", "kg/m3"), 870);
  EXPECT_EQ(read("0.87kg/l", "kg/m3"), 870);
  EXPECT_EQ(read("-0.63 kg/(m3 K)", "kg/(m3 K)"), -0.63);
  EXPECT_EQ(read("450ns", "s"), 4.5e-7);
  EXPECT_EQ(read("4e3 kPa", "Pa"), 4e6);
}

TEST(Units, DecimalNumbersStayExact) {
  // Multiplying by a power of ten in binary would be off in the last digit.
  EXPECT_EQ(read("16.09/GPa", "1/Pa"), 1.609e-8);
  EXPECT_EQ(read("0.155 mPa s", "Pa s"), 0.000155);
  EXPECT_EQ(read("0.4um", "m"), 4e-7);
}

TEST(Units, TemperaturesConvertByTheirZeros) {
  EXPECT_EQ(read("40C", "K", true), 313.15);
  EXPECT_EQ(read("40 \u00b0C", "K", true), 313.15);
  EXPECT_EQ(read("313.15 K", "K", true), 313.15);
  EXPECT_EQ(read("-40 F", "C", true), -40);
  EXPECT_TRUE(is_temperature_field("pressure_viscosity_temperature_kelvin"));
  EXPECT_TRUE(is_temperature_field("measurements.temperature_celsius"));
  EXPECT_FALSE(is_temperature_field("vogel_temperature_coefficient_kelvin"));
  EXPECT_FALSE(is_temperature_field("inlet_temperature_rise_kelvin"));
}

TEST(Units, RejectUnitsOfOtherDimensions) {
  const auto complaint = [](const char* text, const char* unit) {
    std::string wrong;
    EXPECT_FALSE(read_quantity(text, unit, "", false, wrong)) << text;
    EXPECT_NE(wrong, "") << text;
    return wrong;
  };
  for (const auto& [text, unit] :
       {std::pair("20 MPa", "1/Pa"), std::pair("7 cSt", "mPa s"), std::pair("20 C", "K"),
        std::pair("fast", "K"), std::pair("", "K"), std::pair("1e999K", "K"), std::pair("3 (", "K"),
        std::pair("3 ()()", "K"), std::pair("3 m99999999999", "m"),
        std::pair("3 km2147483647", "m"), std::pair("3 m-2147483648", "m"),
        std::pair("1e308 h", "s"), std::pair("1,2,3", "K")}) {
    complaint(text, unit);
  }
  // How to write it is a part of the complaint.
  EXPECT_TRUE(complaint("20", "1/Pa").ends_with(" 20/GPa"));
  EXPECT_TRUE(complaint("73,3", "K").ends_with(" 73.3"));
  EXPECT_TRUE(complaint("1,5 K", "K").ends_with(" 1.5 K"));
}

TEST(Units, ASlopeInPercentIsAnAngle) {
  EXPECT_DOUBLE_EQ(read("100%", "degrees"), 45);
  EXPECT_NEAR(read("-6 %", "degrees"), -3.4336, 1e-4);
  EXPECT_EQ(read("1e-323%", "degrees"), 0) << "a hundredth of 1e-323 underflows";
  EXPECT_EQ(read("3.4degrees", "degrees"), 3.4);
  EXPECT_NEAR(read("1000rpm", "rad/s"), 104.7198, 1e-4);
}

TEST(Units, ASlipOfTheUnitIsShownInBothUnits) {
  const auto expect = [](const std::string& slip, const std::string& typed,
                         const std::string& own) {
    EXPECT_NE(slip.find(" " + typed + " "), std::string::npos) << slip;
    EXPECT_TRUE(slip.ends_with(" " + own)) << slip;
  };
  expect(unit_slip("0.895", "kg/m3", "kg/m3", 500, 2000), "0.895g/cm3", "895");
  expect(unit_slip("103e-6", "mm2/s", "mm2/s", 1, 1e5), "103e-6m2/s", "103");
  expect(unit_slip("103e-6 mm2/s", "mm2/s", "mm2/s", 1, 1e5), "103e-6m2/s", "103");
  expect(unit_slip("2e-8", "1/Pa", "1/GPa", 1e-10, 1e-6), "2e-8/Pa", "20");
  expect(unit_slip("363", "C", "C", -70, 200), "363K", "89.85");
  expect(unit_slip("1.5", "kg", "kg", 100, 1e5), "1.5t", "1500");
  EXPECT_EQ(unit_slip("8.7", "kg/m3", "kg/m3", 500, 2000), "")
      << "8700 kg/m3 is outside the range too";
  EXPECT_EQ(unit_slip("3", "m", "m", 1e-9, 1e-2), "") << "um and mm would both fit";
  EXPECT_EQ(unit_slip("3", "", "", 0, 1), "");
}

TEST(Units, RejectAMillionBrackets) { EXPECT_FALSE(unit_ratio(std::string(1'000'000, '('), "m")); }

TEST(Units, FieldNamesEndInTheirUnit) {
  EXPECT_EQ(unit_of_field("kinematic_viscosity_40_celsius_square_millimetres_per_second"), "mm2/s");
  EXPECT_EQ(unit_of_field("density_at_zero_kelvin_kilograms_per_cubic_metre"), "kg/m3");
  EXPECT_EQ(unit_of_field("density_slope_kilograms_per_cubic_metre_kelvin"), "kg/(m3 K)");
  EXPECT_EQ(unit_of_field("havriliak_negami_alpha"), "");
  EXPECT_EQ(label_of_field("thermal_conductivity_watts_per_metre_kelvin"), "thermal conductivity");
}

TEST(Units, FieldsHaveDataSheetUnits) {
  EXPECT_EQ(trade_unit_of_field("pressure_viscosity_coefficient_per_pascal"), "1/GPa");
  EXPECT_DOUBLE_EQ(in_trade_unit("pressure_viscosity_coefficient_per_pascal", 2e-8), 20);
  EXPECT_DOUBLE_EQ(in_trade_unit("pressure_viscosity_temperature_kelvin", 313.15), 40);
  EXPECT_DOUBLE_EQ(difference_in_trade_unit("pressure_viscosity_temperature_kelvin", 2), 2);
  EXPECT_DOUBLE_EQ(in_trade_unit("vogel_reference_temperature_kelvin", 159), 159);
  EXPECT_DOUBLE_EQ(in_trade_unit("wheel_radius_metres", 0.28), 0.28);
}

}  // namespace
}  // namespace tribodyn::client
