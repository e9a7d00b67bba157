// Data sheets with errors: each is refused at its field, and the likely error is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "server/application/contacts.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "server/resources/provenance.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class MeasurementsTest : public testing::Test {
 protected:
  static v1::Lubricant data_sheet(double kv40 = 103, double kv100 = 15, double density = 868) {
    v1::Lubricant out;
    v1::LubricantMeasurements& measured = *out.mutable_measurements();
    measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(kv40);
    measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(kv100);
    measured.set_density_15_celsius_kilograms_per_cubic_metre(density);
    out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
    return out;
  }

  static void add_cold(v1::Lubricant& lubricant, double celsius, double millipascal_seconds) {
    auto& row = *lubricant.mutable_measurements()->add_brookfield_viscosities();
    row.set_temperature_celsius(celsius);
    row.set_dynamic_viscosity_millipascal_seconds(millipascal_seconds);
  }

  static v1::ParameterProvenance& entry(v1::Lubricant& lubricant, const std::string& field) {
    for (auto& each : *lubricant.mutable_provenance()) {
      if (each.field() == field) return each;
    }
    auto& added = *lubricant.add_provenance();
    added.set_field(field);
    return added;
  }

  v1::Lubricant created(const v1::Lubricant& lubricant, const std::string& id) {
    const auto made = create(lubricant, id);
    EXPECT_TRUE(made.ok()) << complaints(made.error());
    return made.ok() ? made.message() : v1::Lubricant();
  }

  /// Returns the violations of a lubricant that must be refused.
  std::string refused(const v1::Lubricant& lubricant) {
    const auto made = create(lubricant, "refused");
    EXPECT_FALSE(made.ok());
    EXPECT_FALSE(bench_.store().resource("lubricants/refused"));
    return made.ok() ? "" : complaints(made.error());
  }

  Outcome<v1::Lubricant> update(const v1::Lubricant& lubricant) {
    v1::UpdateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    return update_lubricant(app_, request);
  }

  Bench bench_;
  Application app_ = bench_.application();

 private:
  Outcome<v1::Lubricant> create(const v1::Lubricant& lubricant, const std::string& id) {
    v1::CreateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    request.mutable_lubricant()->clear_name();
    request.set_lubricant_id(id);
    return create_lubricant(app_, request);
  }
};

TEST_F(MeasurementsTest, TheUnitOfANumberThatIsUsualInAnotherUnitIsSuggested) {
  EXPECT_THAT(refused(data_sheet(103, 15, 0.895)),
              HasSubstr("0.895 looks like g/cm3: did you mean 895 kg/m3?"));
  EXPECT_THAT(refused(data_sheet(103, 15, 8.7)), HasSubstr("did you mean 870 kg/m3?"));
  EXPECT_THAT(refused(data_sheet(103e-6, 15)),
              HasSubstr("0.000103 looks like m2/s: did you mean 103 mm2/s?"));
  EXPECT_THAT(refused(data_sheet(0.733, 8.86)),
              HasSubstr("0.733 looks like St: did you mean 73.3 mm2/s?"));
  v1::Lubricant lubricant = data_sheet();
  lubricant.set_pressure_viscosity_coefficient_per_pascal(20);
  lubricant.set_pressure_viscosity_temperature_kelvin(40);
  add_cold(lubricant, -40, 1.5);
  EXPECT_THAT(refused(lubricant),
              AllOf(HasSubstr("20 looks like 1/GPa: did you mean 2e-08 1/Pa?"),
                    HasSubstr("40 looks like C: did you mean 313.15 K?"),
                    HasSubstr("1.5 looks like Pa s: did you mean 1500 mPa s?")));
  EXPECT_THAT(refused(data_sheet(-1, 15)), Not(HasSubstr("looks like")));
}

TEST_F(MeasurementsTest, AMeasurementWithAGrossErrorIsRefusedAtItsField) {
  v1::Lubricant lubricant = data_sheet();
  add_cold(lubricant, -40, 150);
  EXPECT_THAT(refused(lubricant),
              AllOf(StartsWith("lubricant.measurements.brookfield_viscosities[0].dynamic_viscosity_"
                               "millipascal_seconds: 150 mPa s at -40 C lies 97 % below"),
                    HasSubstr("Did you mean 150 Pa s (150000 mPa s) at -40 C?")));
  EXPECT_THAT(refused(data_sheet(15.01, 15)), AllOf(HasSubstr("kinematic_viscosity_40_celsius"),
                                                    HasSubstr("viscosity index of 948"),
                                                    HasSubstr("Is one viscosity given twice")));
  lubricant = data_sheet();
  lubricant.mutable_measurements()
      ->set_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(17);
  EXPECT_THAT(
      refused(lubricant),
      HasSubstr("17 mm2/s at 100 C after the shear test lies 13 % above the fresh oil's 15"));
  // Violations of table rows that are KV40 or KV100 name the row.
  lubricant.clear_measurements();
  for (const auto& [celsius, viscosity] : {std::pair(100.0, 15.0), {40.0, 15.01}}) {
    auto& row = *lubricant.mutable_measurements()->add_viscosities();
    row.set_temperature_celsius(celsius);
    row.set_kinematic_viscosity_square_millimetres_per_second(viscosity);
  }
  EXPECT_THAT(refused(lubricant),
              HasSubstr("measurements.viscosities[1].kinematic_viscosity_square_millimetres_per_"
                        "second: KV40 = 15.01"));
}

TEST_F(MeasurementsTest, OneColdViscosityInPascalSecondsIsFoundAmongSeveral) {
  v1::Lubricant lubricant = data_sheet(65.8, 11.8, 860);
  add_cold(lubricant, -40, 36);
  EXPECT_THAT(refused(lubricant), HasSubstr("Did you mean 36 Pa s (36000 mPa s) at -40 C?"));
}

TEST_F(MeasurementsTest, AGivenLawMustNotContradictKV40) {
  v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  lubricant.mutable_measurements()
      ->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(150);
  EXPECT_THAT(refused(lubricant), AllOf(HasSubstr("above the stated law"),
                                        HasSubstr("leave the law unset: it is then fitted")));
}

TEST_F(MeasurementsTest, ACopyWithAnotherViscosityGetsANewLaw) {
  const v1::Lubricant original = created(data_sheet(), "original");
  v1::Lubricant copy = original;
  copy.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      120);
  const v1::Lubricant made = created(copy, "copy");
  EXPECT_NEAR(made.characterisation().root_mean_square_residual(), 0, 1e-9);
  EXPECT_NE(made.vogel_temperature_coefficient_kelvin(),
            original.vogel_temperature_coefficient_kelvin());
  EXPECT_EQ(created(original, "same").vogel_temperature_coefficient_kelvin(),
            original.vogel_temperature_coefficient_kelvin());
}

TEST_F(MeasurementsTest, AnUncertaintyWithoutAValueIsRefused) {
  constexpr char kField[] = "pressure_viscosity_coefficient_per_pascal";
  v1::Lubricant lubricant = data_sheet();
  entry(lubricant, kField).set_standard_uncertainty(1e-9);
  EXPECT_THAT(refused(lubricant),
              AllOf(StartsWith("lubricant.provenance[0].standard_uncertainty: pressure_viscosity_"
                               "coefficient_per_pascal is computed, not stated"),
                    HasSubstr("together with the value")));
  lubricant.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  v1::Lubricant made = created(lubricant, "stated");
  EXPECT_EQ(entry(made, kField).standard_uncertainty(), 1e-9);

  made = created(data_sheet(), "estimated");
  entry(made, kField).set_standard_uncertainty(1e-9);
  EXPECT_THAT(complaints(update(made).error()), HasSubstr("is computed, not stated"));
  entry(made, kField).set_computed(false);  // from now on set by the client
  const auto kept = update(made);
  ASSERT_TRUE(kept.ok()) << complaints(kept.error());
  v1::Lubricant after = kept.message();
  EXPECT_EQ(entry(after, kField).standard_uncertainty(), 1e-9);
  after.mutable_measurements()->set_density_15_celsius_kilograms_per_cubic_metre(870);
  const auto later = update(after);
  ASSERT_TRUE(later.ok()) << complaints(later.error());
  after = later.message();
  EXPECT_EQ(entry(after, kField).standard_uncertainty(), 1e-9) << "not estimated again";
}

template <class Message>
std::map<std::string, std::string> warnings_of(const Message& message) {
  std::map<std::string, std::string> out;
  for (const v1::RangeWarning& each : message.input_warnings()) out[each.code()] = each.message();
  return out;
}

TEST_F(MeasurementsTest, EstimatedParametersCauseAWarningWithEveryResult) {
  v1::Lubricant lubricant = data_sheet();
  lubricant.clear_base_oil_class();
  created(lubricant, "sheet");
  const auto expect_all = [](const std::map<std::string, std::string>& warnings) {
    EXPECT_TRUE(warnings.contains("BASE_OIL_UNSPECIFIED"));
    EXPECT_TRUE(warnings.contains("VOGEL_REFERENCE_TEMPERATURE_ASSUMED"));
    ASSERT_TRUE(warnings.contains("PARAMETER_ESTIMATED"));
    EXPECT_THAT(warnings.at("PARAMETER_ESTIMATED"),
                AllOf(HasSubstr("pressure viscosity coefficient, relaxation time"),
                      HasSubstr("thermal conductivity")));
  };
  v1::Simulation point = point_simulation();
  point.set_lubricant("lubricants/sheet");
  point.mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
  const std::string name = bench_.create(point);
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  expect_all(warnings_of(bench_.get(name).result()));
  v1::ReadHistoryRequest history;
  history.set_name(name);
  const auto read = read_history(app_, history);
  ASSERT_TRUE(read.ok());
  v1::ReadHistoryResponse part;
  read.message()->next(part);
  expect_all(warnings_of(part.schema()));
  v1::Simulation curve = curve_simulation();
  curve.set_lubricant("lubricants/sheet");
  const std::string curve_name = bench_.create(curve);
  ASSERT_TRUE(bench_.reaches(curve_name, v1::Simulation::SUCCEEDED));
  expect_all(warnings_of(bench_.get(curve_name).result()));
  v1::EvaluateContactRequest contact = contact_request();
  contact.set_lubricant("lubricants/sheet");
  const auto solved = evaluate_contact(app_, contact);
  ASSERT_TRUE(solved.ok()) << complaints(solved.error());
  expect_all(warnings_of(solved.message()));
  // All parameters of the paper's fluid are known.
  const std::string known = bench_.create(point_simulation());
  ASSERT_TRUE(bench_.reaches(known, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(warnings_of(bench_.get(known).result()).empty());
}

TEST_F(MeasurementsTest, TheOrderOfProvenanceIsThatOfTheFields) {
  v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  std::reverse(lubricant.mutable_provenance()->pointer_begin(),
               lubricant.mutable_provenance()->pointer_end());
  const v1::Lubricant reversed = created(lubricant, "reversed");
  const v1::Lubricant straight =
      created(seed<v1::Lubricant>("lubricants/paper-fluid-1"), "straight");
  ASSERT_EQ(reversed.provenance_size(), straight.provenance_size());
  for (int i = 0; i < straight.provenance_size(); ++i) {
    EXPECT_EQ(reversed.provenance(i).field(), straight.provenance(i).field());
  }
}

}  // namespace
}  // namespace tribodyn::server
