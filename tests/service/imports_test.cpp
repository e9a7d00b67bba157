// Tests of tables in text: violations name row and column.
#include "server/application/imports.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "google/rpc/error_details.pb.h"
#include "server/resources/imports/csv_table.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(Csv, ReadsTablesOfSpreadsheets) {
  Violations violations;
  const auto table = parse_csv("\xef\xbb\xbf# note\r\n\"a b\" ; c\r\n1;\"x;\"\"y\"\r\n\r\n2; z\r\n",
                               "t", 1000, violations);
  ASSERT_TRUE(table) << violations.front().description;
  EXPECT_THAT(table->columns, ElementsAre("a b", "c"));
  EXPECT_THAT(table->rows[0].cells, ElementsAre("1", "x;\"y"));
  EXPECT_EQ(table->rows[1].line, 5);
  EXPECT_TRUE(parse_csv("a\tb\n1\t\n", "t", 1000, violations));
}

TEST(Csv, NamesInvalidRows) {
  Violations violations;
  const auto rest = parse_csv("a,b\n1,2\n3\n4,5,6\n\"7,8\n", "t", 1000, violations);
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->rows.size(), 1U) << "what can be read is there to be checked as well";
  EXPECT_THAT(rest->rows[0].cells, ElementsAre("1", "2"));
  ASSERT_EQ(violations.size(), 3U);
  EXPECT_EQ(violations[0].field, "t row 3");
  EXPECT_EQ(violations[1].field, "t row 4");
  EXPECT_EQ(violations[2].field, "t row 5");
  for (const char* text : {"", "\n\n", "a,b\n", "#\n"}) {
    violations.clear();
    EXPECT_FALSE(parse_csv(text, "t", 1000, violations));
    EXPECT_EQ(violations.size(), 1U);
  }
  violations.clear();
  EXPECT_FALSE(parse_csv(std::string(1001, 'x'), "t", 1000, violations));
  EXPECT_FALSE(parse_csv(std::string("a\n1\0\n", 5), "t", 1000, violations)) << "no text";
  EXPECT_FALSE(parse_csv("a\n" + std::string(49'999, '"'), "t", 100'000, violations));
  violations.clear();
  std::string many = "a\n";
  for (int i = 0; i < 10'000; ++i) many += "1,2\n";
  EXPECT_FALSE(parse_csv(many, "t", 100'000, violations));
  EXPECT_LE(violations.size(), kMaximumCsvViolations);
}

std::vector<double> column_of(CsvTable table, const char* header, Violations& violations) {
  const CsvColumnForm forms[] = {{header, "x"}};
  const auto columns = match_columns(table, forms, violations);
  check_units_row(table, columns, violations);
  if (columns.empty()) return {};
  return numbers(table, columns.front(), EmptyCells::kAreNaN, violations);
}

TEST(Csv, ReadsDecimalCommasWhereCommasDoNotSeparate) {
  for (const char* text : {"x;y\n0,5;1\n-1,25e1;2\n", "x\ty\n0,5\t1\n-1,25e1\t2\n"}) {
    Violations violations;
    const auto table = parse_csv(text, "t", 1000, violations);
    ASSERT_TRUE(table);
    const CsvColumnForm forms[] = {{"x", "x"}, {"y", "y"}};
    const auto columns = match_columns(*table, forms, violations);
    EXPECT_THAT(numbers(*table, columns[0], EmptyCells::kAreNaN, violations),
                ElementsAre(0.5, -12.5));
    EXPECT_TRUE(violations.empty());
  }
  Violations violations;
  const auto table = parse_csv("x\n\"0,5\"\n\"1,5\"\n\"2,5\"\n", "t", 1000, violations);
  column_of(*table, "x", violations);
  ASSERT_EQ(violations.size(), 1U) << "one for all rows";
  EXPECT_EQ(violations[0].field, "t row 2 column x");
  EXPECT_THAT(violations[0].description,
              testing::AllOf(HasSubstr("decimal point, or semicolons between the cells"),
                             HasSubstr("(and in 2 more rows, the last row 4)")));
  for (const char* cell : {"1,234,5", "1.234,5", ",5", "5,"}) {
    violations.clear();
    const auto wrong = parse_csv(fmt::format("x;y\n{};1\n", cell), "t", 1000, violations);
    const CsvTable& x = *wrong;
    const CsvColumnForm forms[] = {{"x", "x"}, {"y", "y"}};
    numbers(x, match_columns(x, forms, violations)[0], EmptyCells::kAreNaN, violations);
    EXPECT_EQ(violations.size(), 1U) << cell;
  }
}

TEST(Csv, ReportsARowOfUnitsInOneSentence) {
  Violations violations;
  const auto table = parse_csv("x;y\nmm;um\n1;2\n", "t", 1000, violations);
  CsvTable read = *table;
  const CsvColumnForm forms[] = {{"x", "x"}, {"y", "y"}};
  const auto columns = match_columns(read, forms, violations);
  check_units_row(read, columns, violations);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].field, "t row 2");
  EXPECT_THAT(violations[0].description,
              testing::AllOf(HasSubstr("looks like units (\"mm\")"), HasSubstr("begin it with #")));
  EXPECT_THAT(numbers(read, columns[1], EmptyCells::kViolation, violations), ElementsAre(2));
  EXPECT_EQ(violations.size(), 1U) << "and not of its cells";
}

TEST(Csv, NamesWorkbooksAndUtf16) {
  const auto said = [](const std::string& bytes) {
    Violations violations;
    EXPECT_FALSE(parse_csv(bytes, "t", 1000, violations));
    return violations.size() == 1 ? violations[0].description : "";
  };
  EXPECT_THAT(said(std::string("PK\x03\x04\0\0", 6)), HasSubstr("is an Excel workbook"));
  EXPECT_THAT(said(std::string("\xff\xfex\0\n\0", 6)), HasSubstr("is UTF-16"));
  EXPECT_THAT(said(std::string("x\0\n\0", 4)), HasSubstr("is UTF-16"));
}

TEST(Csv, AcceptsHeadersInAnyCaseAndThoseOfInstruments) {
  Violations violations;
  const auto table = parse_csv("X (mm);Z [\u00b5m];Some Name\n1;2;3\n", "t", 1000, violations);
  const CsvColumnForm forms[] = {{"position_metres", "p", 1, 0, "x|position", "m"},
                                 {"position_millimetres", "p", 1e-3, 0, "x|position", "mm"},
                                 {"height_micrometres", "h", 1e-6, 0, "z", "um"},
                                 {"some_name", "n"}};
  const auto columns = match_columns(*table, forms, violations);
  EXPECT_TRUE(violations.empty());
  ASSERT_EQ(columns.size(), 3U);
  EXPECT_EQ(columns[0].form.header, "position_millimetres");
  EXPECT_EQ(columns[1].form.header, "height_micrometres");
  EXPECT_EQ(columns[2].form.header, "some_name");
}

class ImportTest : public testing::Test {
 protected:
  Bench bench_;
  Application app_ = bench_.application();
};

const char* const kColumns[] = {"load_share",
                                "radius_x_metres",
                                "radius_y_metres",
                                "pinion_velocity_x_metres",
                                "pinion_velocity_y_metres",
                                "gear_velocity_x_metres",
                                "gear_velocity_y_metres",
                                "contact_point_velocity_x_metres",
                                "contact_point_velocity_y_metres",
                                "pinion_friction_arm_metres",
                                "gear_friction_arm_metres"};

double value(const v1::GearSet& set, int slot, int sample, const std::string& column) {
  const v1::FlankSlot& from = set.flank_slots(slot);
  return from.GetReflection()->GetRepeatedDouble(
      from, v1::FlankSlot::descriptor()->FindFieldByName(column), sample);
}

/// Returns the table of a gear set by mesh phase and slot.
std::string by_phase(const v1::GearSet& set) {
  std::string out = "mesh_phase,slot";
  for (const char* column : kColumns) out += std::string(",") + column;
  const int samples = set.flank_slots(0).load_share_size();
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < samples; ++j) {
      out += fmt::format("\n{},{}", j / (samples - 1.0), k);
      for (const char* column : kColumns) out += fmt::format(",{}", value(set, k, j, column));
    }
  }
  return out + "\n";
}

/// Returns the table of a gear set as one pair over its roll, in millimetres, without columns that
/// follow from the others.
std::string by_roll(const v1::GearSet& set) {
  std::string out = "pinion_roll_degrees,load_share";
  for (int c = 1; c < 7; ++c) {
    const std::string name = kColumns[c];
    out += "," + name.substr(0, name.size() - 6) + "millimetres";
  }
  const int intervals = set.flank_slots(0).load_share_size() - 1;
  for (int i = 0; i <= 3 * intervals; ++i) {
    const int slot = std::min(i / intervals, 2);
    const int sample = i - slot * intervals;
    out += fmt::format("\n{},{}",
                       (-1.5 + static_cast<double>(i) / intervals) * 360 / set.pinion_teeth(),
                       value(set, slot, sample, "load_share"));
    for (int c = 1; c < 7; ++c)
      out += fmt::format(",{}", 1e3 * value(set, slot, sample, kColumns[c]));
  }
  return out + "\n";
}

std::string series_text(const v1::GearSet& set) {
  std::string out = "quantity,harmonic,sine,cosine\n";
  const auto add = [&](const char* name, const v1::FourierSeries& series) {
    out += fmt::format("{},0,,{}\n", name, series.mean());
    for (int i = 0; i < series.sine_size(); ++i) {
      out += fmt::format("{},{},{},{}\n", name, i + 1, series.sine(i), series.cosine(i));
    }
  };
  add("pinion_contact_radius_metres", set.series().pinion_contact_radius_metres());
  add("gear_contact_radius_metres", set.series().gear_contact_radius_metres());
  add("mesh_stiffness_newtons_per_metre", set.series().mesh_stiffness_newtons_per_metre());
  add("static_transmission_error_metres", set.series().static_transmission_error_metres());
  return out;
}

class GearSetImportTest : public ImportTest {
 protected:
  v1::ImportGearSetRequest request() const {
    v1::ImportGearSetRequest out;
    out.set_gear_set_id("made-elsewhere");
    v1::GearSet* rest = out.mutable_gear_set();
    *rest = original_;
    rest->clear_flank_slots();
    rest->clear_load_share_by_torque();
    rest->clear_series_by_torque();
    out.set_tooth_contact_csv(by_phase(original_));
    return out;
  }
  std::string refused(const v1::ImportGearSetRequest& request) {
    const auto outcome = import_gear_set(app_, request);
    if (outcome.ok()) return "accepted";
    EXPECT_EQ(list_gear_sets(app_, v1::ListGearSetsRequest()).message().gear_sets_size(), 3)
        << "nothing half-written";
    return complaints(outcome.error());
  }
  /// Returns the tables with one number replaced.
  std::string with(int slot, int sample, const std::string& column, double number) const {
    v1::GearSet set = original_;
    v1::FlankSlot* target = set.mutable_flank_slots(slot);
    target->GetReflection()->SetRepeatedDouble(
        target, v1::FlankSlot::descriptor()->FindFieldByName(column), sample, number);
    return by_phase(set);
  }
  const v1::GearSet original_ = seed<v1::GearSet>("gearSets/reference-axle");
};

TEST_F(GearSetImportTest, TablesByPhaseAreReadCompletely) {
  v1::ImportGearSetRequest asked = request();
  asked.set_series_csv(series_text(original_));
  asked.mutable_gear_set()->clear_series();
  asked.mutable_gear_set()->mutable_series()->set_pinion_torque_newton_metres(
      original_.series().pinion_torque_newton_metres());
  const auto made = import_gear_set(app_, asked);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  EXPECT_EQ(made.message().series().SerializeAsString(), original_.series().SerializeAsString());
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(made.message().flank_slots(k).SerializeAsString(),
              original_.flank_slots(k).SerializeAsString());
  }
}

TEST_F(GearSetImportTest, ARollTableMakesThreePairsAndItsFrictionArms) {
  v1::ImportGearSetRequest asked = request();
  asked.set_tooth_contact_csv(by_roll(original_));
  const auto made = import_gear_set(app_, asked);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  for (int k = 0; k < 3; ++k) {
    const v1::FlankSlot& slot = made.message().flank_slots(k);
    ASSERT_EQ(slot.load_share_size(), original_.flank_slots(k).load_share_size());
    for (int j = 0; j < slot.load_share_size(); ++j) {
      EXPECT_NEAR(slot.radius_y_metres(j), original_.flank_slots(k).radius_y_metres(j), 1e-9);
      EXPECT_NEAR(slot.gear_friction_arm_metres(j),
                  original_.flank_slots(k).gear_friction_arm_metres(j), 1e-6);
    }
  }
  bool warned = false;
  for (const auto& entry : made.message().provenance()) {
    warned = warned || (entry.field() == "flank_slots" &&
                        entry.warning().find("friction arms computed") != std::string::npos);
  }
  EXPECT_TRUE(warned);
}

TEST_F(GearSetImportTest, EveryViolationNamesRowAndColumn) {
  const int samples = original_.flank_slots(0).load_share_size();
  v1::ImportGearSetRequest asked = request();
  asked.set_tooth_contact_csv(with(1, 4, "load_share", 0.9));
  // The samples of a slot begin below the header; a wrong sum is reported in the first slot.
  EXPECT_THAT(refused(asked), HasSubstr("tooth_contact_csv row 6 column load_share: load shares"));
  asked.set_tooth_contact_csv(with(0, samples - 1, "radius_x_metres", 0.5));
  EXPECT_THAT(refused(asked), HasSubstr(fmt::format(
                                  "tooth_contact_csv row {} column radius_x_metres", samples + 1)));
  asked.set_tooth_contact_csv(with(2, 3, "gear_friction_arm_metres", 1));
  EXPECT_THAT(refused(asked),
              HasSubstr(fmt::format("row {} column pinion_friction_arm_metres: r_fr,p + r_fr,g",
                                    2 * samples + 5)));
  asked.set_tooth_contact_csv(with(0, 2, "radius_y_metres", -1));
  EXPECT_THAT(refused(asked), HasSubstr("row 4 column radius_y_metres: radius_y_metres = -1 m"));
  asked.set_tooth_contact_csv(with(0, 2, "radius_y_metres", NAN));
  EXPECT_THAT(refused(asked), HasSubstr("row 4 column radius_y_metres: \"nan\""));
}

TEST_F(GearSetImportTest, TheRatioOfTheRadiiIsSetToThatOfTheTeeth) {
  v1::ImportGearSetRequest asked = request();
  auto* radius = asked.mutable_gear_set()->mutable_series()->mutable_gear_contact_radius_metres();
  const double exact = radius->mean();
  radius->set_mean(exact * 1.001);
  EXPECT_THAT(refused(asked), HasSubstr("R_p0 N_g/N_p"));
  radius->set_mean(exact * (1 + 1e-7));
  const auto made = import_gear_set(app_, asked);
  ASSERT_TRUE(made.ok()) << "as many digits as tables have";
  EXPECT_NEAR(made.message().series().gear_contact_radius_metres().mean(), exact, 1e-12 * exact);
}

TEST_F(GearSetImportTest, TextsThatAreNotTablesAreRefused) {
  const auto said = [&](const std::string& tables, const std::string& series = "") {
    v1::ImportGearSetRequest asked = request();
    asked.set_tooth_contact_csv(tables);
    asked.set_series_csv(series);
    return refused(asked);
  };
  const std::string good = by_phase(original_);
  EXPECT_THAT(said(""), HasSubstr("has no rows"));
  EXPECT_THAT(said("load_share\n1\n"), HasSubstr("has no column radius_x_metres"));
  EXPECT_THAT(said("load_share\n1\n"), HasSubstr("exactly one of roll_pitches"));
  EXPECT_THAT(said("load_shares\n1\n"), HasSubstr("did you mean \"load_share\"?"));
  EXPECT_THAT(said("load_share,load_share\n1,1\n"), HasSubstr("given twice"));
  EXPECT_THAT(said(good.substr(0, good.size() / 2)), HasSubstr("cells"));
  EXPECT_THAT(said(good, "quantity,harmonic,sine,cosine\nmesh_stiffness,0,,1\n"),
              HasSubstr("did you mean \"mesh_stiffness_newtons_per_metre\"?"));
  EXPECT_THAT(said(good, "quantity,harmonic,sine,cosine\nmesh_stiffness_newtons_per_metre,1,0,1\n"),
              HasSubstr("series_csv row 2 column harmonic: 1; allowed: 0"));
}

TEST_F(GearSetImportTest, InvalidCellsHideNoOtherViolation) {
  v1::ImportGearSetRequest asked = request();
  std::string text = by_phase(original_);
  const auto line_2 = text.find('\n') + 1;
  const auto line_3 = text.find('\n', line_2) + 1;
  std::vector<std::string> cells;
  std::stringstream row(text.substr(line_2, line_3 - line_2 - 1));
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  cells[2] = "half";
  cells[3] = "-1";
  std::string changed;
  for (const std::string& cell : cells) changed += (changed.empty() ? "" : ",") + cell;
  text.replace(line_2, line_3 - line_2 - 1, changed);
  asked.set_tooth_contact_csv(text);
  asked.mutable_gear_set()->set_youngs_modulus_pascals(1);
  asked.mutable_gear_set()->mutable_series()->mutable_gear_contact_radius_metres()->set_mean(1);
  const std::string said = refused(asked);
  EXPECT_THAT(said, HasSubstr("row 2 column load_share: \"half\"; allowed: a finite number"));
  EXPECT_THAT(said, HasSubstr("row 2 column radius_x_metres: radius_x_metres = -1"));
  EXPECT_THAT(said, HasSubstr("youngs_modulus_pascals = 1 Pa"));
  EXPECT_THAT(said, HasSubstr("R_p0 N_g/N_p"));
}

TEST_F(ImportTest, AllViolationsOfAViscosityTableAreReportedTogether) {
  v1::ImportLubricantRequest asked;
  asked.set_lubricant_id("oil");
  asked.mutable_lubricant()
      ->mutable_measurements()
      ->set_density_15_celsius_kilograms_per_cubic_metre(-5);
  asked.set_viscosity_table_csv(
      "temperature_celsius,kinematic_viscosity_square_millimetres_per_second\n"
      "40,73.3\nforty,8\n100,nan\n80,-2\n900,3\n1\nwarm,-7\n");
  const std::string said = complaints(import_lubricant(app_, asked).error());
  for (const char* each :
       {"row 3 column temperature_celsius: \"forty\"", "row 4 column kinematic",
        "row 5 column kinematic", "row 6 column temperature_celsius: temperature_celsius = 900",
        "row 7: 1 cells", "row 8 column temperature_celsius: \"warm\"", "row 8 column kinematic",
        "density_15_celsius_kilograms_per_cubic_metre = -5"}) {
    EXPECT_THAT(said, HasSubstr(each));
  }
  EXPECT_THAT(said, Not(HasSubstr("row 2")));
  EXPECT_FALSE(bench_.store().resource("lubricants/oil")) << "nothing half-written";
}

TEST_F(ImportTest, AViscosityThatContradictsTheOthersIsNamedByItsRow) {
  v1::ImportLubricantRequest asked;
  asked.set_lubricant_id("oil");
  asked.mutable_lubricant()
      ->mutable_measurements()
      ->set_density_15_celsius_kilograms_per_cubic_metre(868);
  asked.set_viscosity_table_csv(
      "T (C);KV (mm2/s);Viscosity (mPa s)\n100;15;\n40;103;\n20;283;\n0;;1000\n-40;;1200\n");
  EXPECT_THAT(complaints(import_lubricant(app_, asked).error()),
              testing::AllOf(HasSubstr("viscosity_table_csv row 6 column dynamic_viscosity_"
                                       "millipascal_seconds: 1200 mPa s at -40 C"),
                             HasSubstr("Did you mean 1200 P (120000 mPa s) at -40 C?")));
}

TEST_F(ImportTest, ATableOfMillipascalSecondsThatSaysPascalSecondsIsRefusedByARow) {
  v1::ImportLubricantRequest asked;
  asked.set_lubricant_id("oil");
  std::string csv = "T (C);Viscosity (Pa s)\n";
  for (const double celsius : {20.0, 40.0, 60.0, 100.0}) {
    csv += fmt::format("{};{}\n", celsius, 0.155 * std::exp(944.8 / (celsius + 273.15 - 159)));
  }
  asked.set_viscosity_table_csv(csv);
  EXPECT_THAT(complaints(import_lubricant(app_, asked).error()),
              testing::AllOf(HasSubstr("viscosity_table_csv row 5 column dynamic_viscosity_"
                                       "pascal_seconds: "),
                             HasSubstr("A factor of 1000")));
}

std::string waves(double amplitude, double wave_length, int samples,
                  const std::string& header = "position_micrometres,height_nanometres") {
  std::string out = header + "\n";
  for (int i = 0; i < samples; ++i) {
    const double x = 0.5 * i;  // [um]
    out += fmt::format("{},{}\n", x,
                       amplitude * std::sin(2 * std::numbers::pi * x / wave_length) + 20 + 0.1 * x);
  }
  return out;
}

TEST_F(ImportTest, AProfileBecomesASurfaceOfItsMoments) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("measured");
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  request.add_profiles()->set_csv(waves(300, 50, 4001));
  const auto made = import_surface_profiles(app_, request);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  // Both flanks are equal: their mean squares add up.
  EXPECT_NEAR(made.message().composite_rms_height_metres(), 300e-9, 3e-9);
  EXPECT_EQ(made.message().measurements(0).samples(), 4001);
  EXPECT_NEAR(made.message().measurements(0).spacing_metres(), 0.5e-6, 1e-15);
  bool warned = false;
  for (const auto& entry : made.message().provenance()) {
    if (entry.field() == "asperity_radius_metres") {
      warned = entry.warning().find("both flanks") != std::string::npos;
      EXPECT_EQ(entry.provenance(), v1::PROVENANCE_FITTED);
    }
  }
  EXPECT_TRUE(warned);

  request.set_surface_id("both");
  request.mutable_profiles(0)->set_member(v1::FLANK_MEMBER_PINION);
  v1::SurfaceProfile* gear = request.add_profiles();
  gear->set_member(v1::FLANK_MEMBER_GEAR);
  gear->set_csv(waves(400, 50, 4001));
  const auto both = import_surface_profiles(app_, request);
  ASSERT_TRUE(both.ok()) << complaints(both.error());
  EXPECT_NEAR(both.message().composite_rms_height_metres(), std::sqrt(0.5) * 500e-9, 5e-9);
}

TEST_F(ImportTest, SixProfilesGiveTheParametersTheUncertaintyOfTheirSpread) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("six");
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  for (const v1::FlankMember member : {v1::FLANK_MEMBER_PINION, v1::FLANK_MEMBER_GEAR}) {
    for (const double amplitude : {280, 300, 320}) {  // heel, middle, toe
      v1::SurfaceProfile& profile = *request.add_profiles();
      profile.set_member(member);
      profile.set_direction(v1::PROFILE_DIRECTION_AXIAL);
      profile.set_csv(waves(amplitude, 50, 2001));
    }
  }
  const auto uncertainty_of = [](const v1::Surface& surface, const char* field) {
    double out = 0;
    for (const auto& entry : surface.provenance()) {
      if (entry.field() == field) out = entry.standard_uncertainty();
    }
    return out;
  };
  const auto made = import_surface_profiles(app_, request);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  const v1::Surface& six = made.message();
  // The mean squares of 280, 300 and 320 nm scatter by 13.3 %, the mean of three by 13.3 %/sqrt(3),
  // the sum of two such means by 13.3 %/sqrt(6); sigma_G and beta_G by half of that.
  constexpr double kScatter = 0.133;
  const double expected = 0.5 * kScatter / std::sqrt(6);
  EXPECT_NEAR(
      uncertainty_of(six, "composite_rms_height_metres") / six.composite_rms_height_metres(),
      expected, 1e-3);
  EXPECT_NEAR(uncertainty_of(six, "asperity_radius_metres") / six.asperity_radius_metres(),
              expected, 1e-3);
  for (const auto& entry : six.provenance()) {
    if (entry.field() == "asperity_radius_metres") {
      EXPECT_THAT(entry.source(), HasSubstr("uncertainty from the spread of 6 profiles"));
    }
  }

  request.set_surface_id("four");
  request.mutable_profiles()->DeleteSubrange(4, 2);  // the gear was measured once
  const auto four = import_surface_profiles(app_, request);
  ASSERT_TRUE(four.ok()) << complaints(four.error());
  EXPECT_EQ(uncertainty_of(four.message(), "composite_rms_height_metres"), 0) << "not known";
}

TEST_F(ImportTest, AnUnfilteredProfileCausesAWarningAtTheImportAndWithEveryResult) {
  v1::ImportSurfaceProfilesRequest request;
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  std::string noise = "X (um);Z (nm)\n";
  // A linear congruential generator makes the same white noise on every machine.
  std::uint32_t state = 1;
  for (int i = 0; i < 4000; ++i) {
    state = 1664525U * state + 1013904223U;
    noise += fmt::format("{};{}\n", 0.5 * i, 400 * (state / 4294967296.0 - 0.5));
  }
  const auto warning_of = [](const v1::Surface& surface) {
    std::string out;
    for (const auto& entry : surface.provenance()) {
      if (entry.field() == "asperity_radius_metres") out = entry.warning();
    }
    return out;
  };
  request.set_surface_id("noise");
  request.add_profiles()->set_csv(noise);
  const auto made = import_surface_profiles(app_, request);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  EXPECT_THAT(warning_of(made.message()),
              testing::AllOf(HasSubstr("the waves of the profile are 3 sample spacings"),
                             HasSubstr("was not filtered"), HasSubstr("eta_G beta_G sigma_G is 0."),
                             HasSubstr("filter them")));
  v1::Simulation simulation = point_simulation();
  simulation.set_surface("surfaces/noise");
  const std::string name = bench_.create(simulation);
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  std::vector<std::string> codes;
  const v1::Simulation simulated = bench_.get(name);
  for (const auto& each : simulated.result().input_warnings()) codes.push_back(each.code());
  EXPECT_THAT(codes, ElementsAre("PROFILE_NOT_RESOLVED", "SURFACE_PARTLY_MEASURED"));

  request.set_surface_id("filtered");
  request.set_short_wave_cut_off_metres(5e-6);
  request.set_long_wave_cut_off_metres(80e-6);
  const auto filtered = import_surface_profiles(app_, request);
  ASSERT_TRUE(filtered.ok()) << complaints(filtered.error());
  EXPECT_THAT(warning_of(filtered.message()), Not(HasSubstr("spacings")));
  EXPECT_EQ(filtered.message().measurements(0).short_wave_cut_off_metres(), 5e-6);
  EXPECT_LT(filtered.message().composite_rms_height_metres(),
            0.5 * made.message().composite_rms_height_metres());
  request.set_surface_id("wrong");
  request.set_short_wave_cut_off_metres(-1);
  EXPECT_THAT(complaints(import_surface_profiles(app_, request).error()),
              HasSubstr("short_wave_cut_off_metres = -1 m; allowed: 1e-09 to 0.01 m"));
  request.set_short_wave_cut_off_metres(0.6e-6);
  EXPECT_THAT(complaints(import_surface_profiles(app_, request).error()),
              HasSubstr("must be two sample spacings or more, 1e-06 m"));
  request.clear_short_wave_cut_off_metres();
  request.clear_long_wave_cut_off_metres();

  request.set_surface_id("smooth");
  request.mutable_profiles(0)->set_csv(waves(300, 50, 4001));
  const auto smooth = import_surface_profiles(app_, request);
  ASSERT_TRUE(smooth.ok()) << complaints(smooth.error());
  EXPECT_THAT(warning_of(smooth.message()), Not(HasSubstr("spacings")));
}

TEST_F(ImportTest, Eq46AsPublishedCombinesTwoDirectionsByTheRootOfTheirSum) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("corrected");
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  const auto add = [&request](v1::ProfileDirection direction, double wave_length) {
    v1::SurfaceProfile* profile = request.add_profiles();
    profile->set_direction(direction);
    profile->set_csv(waves(300, wave_length, 4001));
  };
  add(v1::PROFILE_DIRECTION_AXIAL, 50);
  add(v1::PROFILE_DIRECTION_RADIAL, 80);
  const auto corrected = import_surface_profiles(app_, request);
  ASSERT_TRUE(corrected.ok()) << complaints(corrected.error());
  request.set_surface_id("printed");
  request.set_eq46_square_root_of_sum(true);
  const auto printed = import_surface_profiles(app_, request);
  ASSERT_TRUE(printed.ok()) << complaints(printed.error());

  const v1::SurfaceMeasurement& axial = printed.message().measurements(0);
  const v1::SurfaceMeasurement& radial = printed.message().measurements(1);
  // Eq 48 for two equal flanks, whose moments add up (eq 47).
  const auto expect = [](const v1::Surface& surface, double slope, double curvature) {
    EXPECT_NEAR(surface.asperity_density_per_square_metre() * 6 * std::numbers::pi *
                    std::sqrt(3.0) * slope / curvature,
                1, 1e-12);
    EXPECT_NEAR(
        surface.asperity_radius_metres() / (0.375 * std::sqrt(std::numbers::pi / (2 * curvature))),
        1, 1e-12);
  };
  const double m2[] = {axial.mean_square_slope(), radial.mean_square_slope()};
  const double m4[] = {axial.mean_square_curvature_per_square_metre(),
                       radial.mean_square_curvature_per_square_metre()};
  expect(corrected.message(), std::sqrt(m2[0] * m2[1]), std::sqrt(m4[0] * m4[1]));
  expect(printed.message(), std::sqrt(m2[0] + m2[1]), std::sqrt(m4[0] + m4[1]));
  EXPECT_EQ(printed.message().composite_rms_height_metres(),
            corrected.message().composite_rms_height_metres());
  for (const auto& [made, says_so] : {std::pair{&corrected, false}, std::pair{&printed, true}}) {
    for (const auto& entry : made->message().provenance()) {
      if (entry.field() != "asperity_radius_metres") continue;
      EXPECT_EQ(entry.source().find("eq 46 as published") != std::string::npos, says_so);
    }
  }
}

TEST_F(ImportTest, RepeatsOfADirectionAreAveraged) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("repeated");
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  for (const double amplitude : {200.0, 300.0, 500.0}) {
    v1::SurfaceProfile* profile = request.add_profiles();
    profile->set_direction(v1::PROFILE_DIRECTION_AXIAL);
    profile->set_csv(waves(amplitude, 50, 4001));
  }
  const auto axial = import_surface_profiles(app_, request);
  ASSERT_TRUE(axial.ok()) << complaints(axial.error());
  ASSERT_EQ(axial.message().measurements_size(), 3);
  double m0 = 0, m4 = 0;
  for (const v1::SurfaceMeasurement& each : axial.message().measurements()) {
    m0 += each.mean_square_height_square_metres() / 3;
    m4 += each.mean_square_curvature_per_square_metre() / 3;
  }
  // Both flanks are equal.
  EXPECT_NEAR(axial.message().composite_rms_height_metres() / std::sqrt(2 * m0), 1, 1e-12);
  EXPECT_NEAR(
      axial.message().asperity_radius_metres() / (0.375 * std::sqrt(std::numbers::pi / (2 * m4))),
      1, 1e-12);
  request.set_surface_id("joined");
  v1::SurfaceProfile* radial = request.add_profiles();
  radial->set_direction(v1::PROFILE_DIRECTION_RADIAL);
  radial->set_csv(waves(300, 80, 4001));
  const auto joined = import_surface_profiles(app_, request);
  ASSERT_TRUE(joined.ok()) << complaints(joined.error());
  const double across = joined.message().measurements(3).mean_square_curvature_per_square_metre();
  EXPECT_NEAR(joined.message().asperity_radius_metres() /
                  (0.375 * std::sqrt(std::numbers::pi / (2 * std::sqrt(m4 * across)))),
              1, 1e-12);
}

TEST_F(ImportTest, Eq46AsPublishedNeedsTwoDirectionsOfAMember) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("one");
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  request.set_eq46_square_root_of_sum(true);
  for (const v1::FlankMember member : {v1::FLANK_MEMBER_PINION, v1::FLANK_MEMBER_GEAR}) {
    v1::SurfaceProfile* profile = request.add_profiles();
    profile->set_member(member);
    profile->set_direction(member == v1::FLANK_MEMBER_PINION ? v1::PROFILE_DIRECTION_AXIAL
                                                             : v1::PROFILE_DIRECTION_RADIAL);
    profile->set_csv(waves(300, 50, 4001));
  }
  EXPECT_THAT(
      complaints(import_surface_profiles(app_, request).error()),
      HasSubstr(
          "eq46_square_root_of_sum: true; allowed: false, because eq 46 combines an AXIAL and "
          "a RADIAL profile of one member"));
}

TEST_F(ImportTest, AnInvalidProfileIsReportedByRowAndColumn) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("measured");
  const auto said = [&](const std::string& csv) {
    request.clear_profiles();
    request.add_profiles()->set_csv(csv);
    return complaints(import_surface_profiles(app_, request).error());
  };
  EXPECT_THAT(said("position_metres,height_metres\n0,0\n1,0\n5,0\n6,0\n7,0\n"),
              HasSubstr("profiles[0].csv row 4 column position_metres: a step of 4 m"));
  EXPECT_THAT(said("position_metres,height_metres\n0,0\n1,x\n"),
              HasSubstr("profiles[0].csv row 3 column height_metres: \"x\""));
  EXPECT_THAT(said("position_metres,height_metres\n0,0\n"), HasSubstr("profiles[0].csv"));
  EXPECT_THAT(said(waves(0, 50, 100)), HasSubstr("profiles[0].csv.mean_square_slope"));
  EXPECT_THAT(said("position_metres,height_metres\n0,0\n2,1\n4,0\n6,1\n8,0\n"),
              HasSubstr("profiles[0].csv: spacing_metres = 2 m; allowed: 1e-10 to 0.01 m"));
  EXPECT_THAT(said("position_metres,height_metres\n0,0\n1,0\n2,0\n3,0\n4,0\n5,0\n"),
              HasSubstr("profiles"));
  EXPECT_THAT(said(waves(300, 50, 100)), HasSubstr("tribofilm_shear_strength_pascals is not set"));
  request.add_profiles()->set_member(v1::FLANK_MEMBER_PINION);
  EXPECT_THAT(complaints(import_surface_profiles(app_, request).error()),
              HasSubstr("in all or none"));
}

TEST_F(ImportTest, AProfileOfNoMachinedSurfaceIsRefusedWithTheUnitThatIsMeant) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("measured");
  const auto said = [&](const std::string& header) {
    request.clear_profiles();
    request.add_profiles()->set_csv(waves(300, 50, 4001, header));
    return complaints(import_surface_profiles(app_, request).error());
  };
  EXPECT_THAT(said("position_micrometres,height_micrometres"),
              testing::AllOf(HasSubstr("profiles[0].csv.mean_square_slope: rms height 212 um"),
                             HasSubstr("heights in nm, not in um (a factor of 1000)")));
  EXPECT_THAT(said("position_micrometres,height_millimetres"),
              HasSubstr("heights in nm, not in mm"));
  EXPECT_THAT(said("position_millimetres,height_nanometres"),
              HasSubstr("positions in um, not in mm"));
  EXPECT_THAT(said("position_micrometres,height_nanometres"), Not(HasSubstr("profiles[0]")));
}

TEST_F(ImportTest, AllViolationsOfProfilesAreReportedTogether) {
  v1::ImportSurfaceProfilesRequest request;
  request.set_surface_id("measured");
  request.mutable_surface()->set_composite_rms_height_metres(1e-6);
  request.mutable_surface()->set_asperity_friction_coefficient(-1);
  request.mutable_surface()->set_derived_from("surfaces/run-im");
  // Row 4 has no position, row 8 no height, row 6 one cell too many; rows 10 and 12 are not evenly
  // spaced.
  request.add_profiles()->set_csv(
      "position_micrometres,height_nanometres\n0,1\n1,2\nx,3\n3,1\n4,2,5\n5,1\n6,\n7,2\n6.5,1\n"
      "9,2\n12,3\n13,4\n");
  request.add_profiles()->set_csv("position_metres,height_metre\n0,0\n-1,1\n-2,0\n");
  const std::string said = complaints(import_surface_profiles(app_, request).error());
  for (const char* each :
       {"surface.composite_rms_height_metres: composite_rms_height_metres follows",
        "profiles: two of one member without a direction",
        "profiles[0].csv row 6: 3 cells; allowed: 2",
        "profiles[0].csv row 4 column position_micrometres: \"x\"",
        "profiles[0].csv row 8 column height_nanometres: is empty",
        "profiles[0].csv row 10 column position_micrometres: a step of -5e-07 m",
        "profiles[0].csv row 12 column position_micrometres: a step of 3e-06 m; allowed: 1e-06 m",
        "profiles[1].csv column 2: \"height_metre\" is not a known header",
        "profiles[1].csv: samples = 3; allowed: 5 to 1000000",
        "profiles[1].csv row 3 column position_metres: a step of -1 m; allowed: above 0",
        "profiles[1].csv row 4 column position_metres: a step of -1 m; allowed: above 0",
        "surface.asperity_friction_coefficient: asperity_friction_coefficient = -1",
        "surface.tribofilm_shear_strength_pascals: tribofilm_shear_strength_pascals is not set",
        "surface.derived_from: \"surfaces/run-im\" does not exist"}) {
    EXPECT_THAT(said, HasSubstr(each));
  }
  for (const char* right : {"row 5 ", "row 7 ", "row 9 ", "row 13"}) {
    EXPECT_THAT(said, Not(HasSubstr(right)));
  }
  EXPECT_FALSE(bench_.store().resource("surfaces/measured"));
}

TEST_F(ImportTest, AViscosityTableBecomesALubricant) {
  v1::ImportLubricantRequest request;
  request.set_lubricant_id("table");
  request.mutable_lubricant()->set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  const v1::Lubricant known = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  std::string csv =
      "temperature_kelvin,dynamic_viscosity_pascal_seconds,"
      "density_kilograms_per_cubic_metre\n";
  for (double t = 263.15; t < 400; t += 20) {
    csv +=
        fmt::format("{},{},{}\n", t, 0.000155 * std::exp(944.8 / (t - 159)), 1016.1 - 0.6323 * t);
  }
  request.set_viscosity_table_csv(csv);
  const auto made = import_lubricant(app_, request);
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  EXPECT_NEAR(made.message().vogel_reference_temperature_kelvin(), 159, 0.01);
  EXPECT_NEAR(made.message().vogel_temperature_coefficient_kelvin(), 944.8, 0.1);
  EXPECT_NEAR(made.message().density_slope_kilograms_per_cubic_metre_kelvin(), -0.6323, 1e-6);
  EXPECT_LT(made.message().characterisation().root_mean_square_residual(), 1e-6);
  EXPECT_EQ(made.message().measurements().viscosities_size(), 7);

  request.set_lubricant_id("trade");
  request.set_viscosity_table_csv(
      "temperature_celsius,kinematic_viscosity_square_millimetres_per_second\n"
      "20,205\n40,73.3\n100,8.86\n");
  const auto trade = import_lubricant(app_, request);
  ASSERT_TRUE(trade.ok()) << complaints(trade.error());
  EXPECT_EQ(trade.message().characterisation().sae_j306_grade(), "80") << "KV100 is in the table";
  EXPECT_EQ(trade.message()
                .characterisation()
                .kinematic_viscosity_100_celsius_square_millimetres_per_second(),
            8.86);
  EXPECT_EQ(trade.message().characterisation().viscosity_residuals_size(), 3);

  request.set_lubricant_id("bad");
  request.set_viscosity_table_csv(
      "temperature_celsius,kinematic_viscosity_square_millimetres_per_second\n40,70\n999,-1\n");
  const std::string said = complaints(import_lubricant(app_, request).error());
  EXPECT_THAT(said, HasSubstr("viscosity_table_csv row 3 column temperature_celsius"));
  EXPECT_THAT(said, HasSubstr("viscosity_table_csv row 3 column kinematic_viscosity"));
}

}  // namespace
}  // namespace tribodyn::server
