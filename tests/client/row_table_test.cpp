// Tests of tables of resources that people and spreadsheets write.
#include "client/cpp/resources/row_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "client/cpp/failure.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/text/table_text.h"

namespace tribodyn::client {
namespace {

const ResourceKind& oil_kind() { return kind_of(*v1::Lubricant::descriptor()); }

const v1::Lubricant& as_lubricant(const FileResource& read) {
  return dynamic_cast<const v1::Lubricant&>(*read.resource);
}

std::string table_error(const std::string& text) {
  try {
    read_row_table(text, "t.csv", oil_kind());
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitUsage);
    return failure.what();
  }
  return "";
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
  return found;
}

double kv40(const v1::Lubricant& oil) {
  return oil.measurements().kinematic_viscosity_40_celsius_square_millimetres_per_second();
}

TEST(RowTable, AcceptsDataSheetNamesInAnyCase) {
  const RowTable table = read_row_table(
      "Name,KV40,kv100,Density15 (g/cm3),Base Oil Class,Condition,Pressure-Viscosity "
      "[1/GPa],Brookfield -40 C,brookfield_-26\n"
      "a,73.3,8.86,0.87,PAO,Fresh,20,150 Pas,21000\n",
      "t.csv", oil_kind());
  const v1::Lubricant& oil = as_lubricant(table.resources.at(0));
  EXPECT_EQ(oil.name(), "lubricants/a");
  EXPECT_EQ(kv40(oil), 73.3);
  EXPECT_EQ(oil.measurements().density_15_celsius_kilograms_per_cubic_metre(), 870);
  EXPECT_EQ(oil.base_oil_class(), v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  EXPECT_EQ(oil.condition(), v1::Lubricant::FRESH);
  EXPECT_DOUBLE_EQ(oil.pressure_viscosity_coefficient_per_pascal(), 20e-9);
  ASSERT_EQ(oil.measurements().brookfield_viscosities_size(), 2);
  EXPECT_EQ(oil.measurements().brookfield_viscosities(0).temperature_celsius(), -40);
  EXPECT_EQ(oil.measurements().brookfield_viscosities(0).dynamic_viscosity_millipascal_seconds(),
            150000);
  EXPECT_EQ(oil.measurements().brookfield_viscosities(1).temperature_celsius(), -26);
  EXPECT_EQ(table.note, "");
}

TEST(RowTable, AcceptsTheUsualSpellingsOfBaseOils) {
  const struct {
    const char* text;
    v1::Lubricant::BaseOilClass meant;
  } kSpellings[] = {{"PAO", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
                    {"Group IV", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
                    {"Group III", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
                    {"Gr. III", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
                    {"III", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
                    {"Gruppe III", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
                    {"group-iii", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
                    {"GROUP_II", v1::Lubricant::BASE_OIL_CLASS_GROUP_II},
                    {"API Group 1", v1::Lubricant::BASE_OIL_CLASS_GROUP_I},
                    {"Ester", v1::Lubricant::BASE_OIL_CLASS_ESTER},
                    {"Naphthenic", v1::Lubricant::BASE_OIL_CLASS_NAPHTHENIC},
                    {"pag", v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL}};
  for (const auto& each : kSpellings) {
    const auto* found = find_base_oil_class(each.text);
    ASSERT_NE(found, nullptr) << each.text;
    EXPECT_EQ(found->number(), each.meant) << each.text;
  }
  for (const char* each : {"", "group v", "mineral", "gr", "iiii"}) {
    EXPECT_EQ(find_base_oil_class(each), nullptr) << each;
  }
}

TEST(RowTable, ReadsDecimalCommasWhereCommasDoNotSeparate) {
  for (const char separator : {';', '\t'}) {
    std::string text = "name;kv40;kv100\na;73,3;8,86\nb;100;14,5\n";
    std::replace(text.begin(), text.end(), ';', separator);
    const RowTable table = read_row_table(text, "t.csv", oil_kind());
    EXPECT_EQ(kv40(as_lubricant(table.resources.at(0))), 73.3);
    EXPECT_EQ(kv40(as_lubricant(table.resources.at(1))), 100);
    EXPECT_NE(table.note.find("3 cells"), std::string::npos) << table.note;
  }
  const std::string said = table_error("name,kv40,kv100\na,\"73,3\",\"8,86\"\nb,\"100,1\",14\n");
  EXPECT_NE(said.find("3 cells"), std::string::npos) << said;
  EXPECT_NE(said.find("row 2 column kv40: '73,3'"), std::string::npos) << said;
  EXPECT_EQ(count(said, "row "), 1U) << said;
  EXPECT_NE(table_error("name;kv40;kv100\na;1.103;8,86\n").find("'1.103'"), std::string::npos);
  EXPECT_NE(table_error("name;kv40;kv100\na;1.103,5;8,86\n").find("'1.103,5'"), std::string::npos);
}

TEST(RowTable, AcceptsARowOfUnits) {
  const RowTable table = read_row_table(
      "name;kv40;density15;pressure_viscosity_coefficient_per_pascal\n"
      ";cSt;g/cm3;1/GPa\na;73.3;0.87;20\n",
      "t.csv", oil_kind());
  ASSERT_EQ(table.resources.size(), 1U);
  const v1::Lubricant& oil = as_lubricant(table.resources[0]);
  EXPECT_EQ(kv40(oil), 73.3);
  EXPECT_EQ(oil.measurements().density_15_celsius_kilograms_per_cubic_metre(), 870);
  EXPECT_DOUBLE_EQ(oil.pressure_viscosity_coefficient_per_pascal(), 20e-9);
  const std::string said = table_error("name,kv40,density15\nUnits,furlong,kg\na,1,2\n");
  EXPECT_NE(said.find("row 2 column kv40: 'furlong'"), std::string::npos) << said;
  EXPECT_NE(said.find("#"), std::string::npos) << said;
}

TEST(RowTable, ListsAnErrorOfManyRowsOnce) {
  std::string text = "name,kv40,base_oil_class\n";
  for (int i = 0; i < 30; ++i)
    text += "oil-" + std::to_string(i) + ",x" + (i == 7 ? "x" : "") + ",none\n";
  const std::string said = table_error(text);
  for (const char* part : {"60 errors of 2 ", "row 2 column kv40: 'x'", " 28 more", "row 31",
                           "row 9 column kv40: 'xx'"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
  EXPECT_EQ(count(said, "'none'"), 1U) << said;
}

TEST(RowTable, SumsUpErrorsThatDifferInTheCellAlone) {
  std::string text = "name,kv40,relaxation_time\n";
  for (int i = 0; i < 90; ++i) {
    text += "oil-" + std::to_string(i) + ",73.3," + std::to_string(100 + i) + "\n";
  }
  const std::string said = table_error(text);
  for (const char* part :
       {"90 errors of 1 ", "row 2 column relaxation_time: '100'", " 87 more", "row 91"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
  EXPECT_EQ(count(said, "column relaxation_time"), 3U) << said;
}

TEST(RowTable, NamesHeadersThatAreUnknownRepeatedOrInAWrongUnit) {
  const std::string said =
      table_error("name,kv4O,kv100,KV100,density15 (m),display_nme\na,1,2,3,4,5\n");
  for (const char* part : {"'kv4O'", "column KV100 ", "kg/m3", "display_name"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
}

TEST(RowTable, RestoresStatedAndMeasuredValues) {
  std::vector<ResourcePointer> oils;
  auto oil = std::make_unique<v1::Lubricant>();
  oil->set_name("lubricants/a");
  oil->set_description("two\nlines, \"quoted\"");
  oil->set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_ESTER);
  v1::LubricantMeasurements& measured = *oil->mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(1.0 / 3);
  measured.set_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(8.1);
  for (const auto& [celsius, viscosity] : {std::pair(-40.0, 1.5e5), {-26.0, 1e4 / 3}, {-26.0, 9}}) {
    auto& row = *measured.add_brookfield_viscosities();
    row.set_temperature_celsius(celsius);
    row.set_dynamic_viscosity_millipascal_seconds(viscosity);
  }
  auto* row = measured.add_viscosities();
  row->set_temperature_celsius(20);
  row->set_kinematic_viscosity_square_millimetres_per_second(205);
  row->set_relative_standard_uncertainty(0.01);
  row = measured.add_viscosities();
  row->set_temperature_celsius(-0.1);
  row->set_dynamic_viscosity_millipascal_seconds(0.1 + 0.2);
  auto& density = *measured.add_densities();
  density.set_temperature_celsius(100);
  density.set_density_kilograms_per_cubic_metre(815);
  oil->set_pressure_viscosity_coefficient_per_pascal(1.0 / 3e8);
  oil->set_havriliak_negami_beta(0);
  auto* known = oil->add_provenance();
  known->set_field("pressure_viscosity_coefficient_per_pascal");
  known->set_provenance(v1::PROVENANCE_MEASURED);
  known->set_source("Laboratory X; report 12");
  known->set_standard_uncertainty(1e-9 / 3);
  known->set_warning("old sample");
  auto* label = oil->add_labels();
  label->set_key("project");
  label->set_value("axle");
  v1::Lubricant kept = *oil;
  // The cell of a computed value is empty.
  oil->set_thermal_conductivity_watts_per_metre_kelvin(0.15);
  known = oil->add_provenance();
  known->set_field("thermal_conductivity_watts_per_metre_kelvin");
  known->set_computed(true);
  known->set_source("an estimate");
  oils.push_back(std::move(oil));
  std::string lost;
  const std::string text = row_table(oil_kind(), oils, lost);
  EXPECT_EQ(lost, "");
  EXPECT_EQ(text.find("an estimate"), std::string::npos);
  const RowTable again = read_row_table(text, "t.csv", oil_kind());
  EXPECT_EQ(as_lubricant(again.resources.at(0)).SerializeAsString(), kept.SerializeAsString())
      << text;
  // A spreadsheet must not read any cell as a formula.
  EXPECT_NE(text.find("150000 mPa s at -40 C; "), std::string::npos) << text;
}

TEST(RowTable, HoldsNoBoundaryFrictionByTemperature) {
  std::vector<ResourcePointer> oils;
  auto oil = std::make_unique<v1::Lubricant>();
  oil->set_name("lubricants/by-temperature");
  oil->add_asperity_friction_by_temperature()->set_asperity_friction_coefficient(0.1);
  oils.push_back(std::move(oil));
  std::string lost;
  try {
    row_table(oil_kind(), oils, lost);
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("by-temperature. Export JSON"), std::string::npos);
  }
}

TEST(RowTable, ReadsABarePourPointInDegreesCelsius) {
  const RowTable table = read_row_table("name,pour_point\na,-30\n", "t.csv", oil_kind());
  EXPECT_EQ(as_lubricant(table.resources.at(0)).pour_point_celsius(), -30);
}

TEST(RowTable, GivesALawOnlyToTheRowsThatStateOne) {
  const RowTable table = read_row_table(
      "name,kv40,kv100,glass viscosity [Pa s],glass_temperature_rise [K],glass pressure factor "
      "[1/GPa],"
      "expansivity_pressure_factor [1/GPa],expansivity_exponent\n"
      "law,140,14.5,1e12,210.6,0.455,7.606,-0.4193\n"
      "plain,140,14.5,,,,,\n",
      "t.csv", oil_kind());
  const v1::Lubricant& law = as_lubricant(table.resources.at(0));
  EXPECT_EQ(law.improved_yasutomi().glass_viscosity_pascal_seconds(), 1e12);
  EXPECT_DOUBLE_EQ(law.improved_yasutomi().glass_pressure_factor_per_pascal(), 0.455e-9);
  EXPECT_EQ(law.improved_yasutomi().expansivity_exponent(), -0.4193);
  const v1::Lubricant& plain = as_lubricant(table.resources.at(1));
  EXPECT_FALSE(plain.has_improved_yasutomi());
  std::vector<ResourcePointer> oils;
  for (const FileResource& each : table.resources) {
    oils.push_back(std::make_unique<v1::Lubricant>(as_lubricant(each)));
  }
  std::string lost;
  const std::string text = row_table(oil_kind(), oils, lost);
  const RowTable again = read_row_table(text, "t.csv", oil_kind());
  EXPECT_EQ(as_lubricant(again.resources.at(0)).improved_yasutomi().SerializeAsString(),
            law.improved_yasutomi().SerializeAsString());
  EXPECT_FALSE(as_lubricant(again.resources.at(1)).has_improved_yasutomi());
}

TEST(RowTable, TakesMissingValuesFromTheBase) {
  v1::Lubricant like;
  like.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_ESTER);
  like.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73);
  like.set_thermal_conductivity_watts_per_metre_kelvin(0.15);
  like.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  for (const char* field : {"thermal_conductivity_watts_per_metre_kelvin",
                            "pressure_viscosity_coefficient_per_pascal"}) {
    auto& known = *like.add_provenance();
    known.set_field(field);
    known.set_source("measured");
  }
  RowBases bases;
  bases.like = &like;
  const RowTable table =
      read_row_table("name,kv40,pressure_viscosity_coefficient_per_pascal\na,,1e-8\nb,80,\n",
                     "t.csv", oil_kind(), bases);
  const v1::Lubricant& a = as_lubricant(table.resources.at(0));
  const v1::Lubricant& b = as_lubricant(table.resources.at(1));
  EXPECT_EQ(kv40(a), 73);
  EXPECT_EQ(kv40(b), 80);
  EXPECT_EQ(a.pressure_viscosity_coefficient_per_pascal(), 1e-8);
  EXPECT_EQ(b.pressure_viscosity_coefficient_per_pascal(), 2e-8);
  EXPECT_EQ(a.base_oil_class(), v1::Lubricant::BASE_OIL_CLASS_ESTER);
  ASSERT_EQ(a.provenance_size(), 1) << "the provenance of the old value is cleared";
  EXPECT_EQ(a.provenance(0).field(), "thermal_conductivity_watts_per_metre_kelvin");
  EXPECT_EQ(b.provenance_size(), 2);
  EXPECT_TRUE(table.resources[0].fields.empty()) << "all fields are written";
}

TEST(TableText, IsUtf8ForEveryEncodingOfSpreadsheets) {
  std::string note;
  EXPECT_EQ(table_text("name\n\xc3\xa4\n", "t", note), "name\n\xc3\xa4\n");
  EXPECT_EQ(note, "");
  EXPECT_EQ(table_text("name\n\xe4l, 15\xb0\x43\n", "t", note),
            "name\n\xc3\xa4l, 15\xc2\xb0\x43\n");
  EXPECT_NE(note.find("Latin-1"), std::string::npos);
  const std::string utf16("\xff\xfen\0a\0\xe4\0\n\0", 10);
  EXPECT_EQ(table_text(utf16, "t", note), "na\xc3\xa4\n");
  EXPECT_EQ(table_text(utf16.substr(2), "t", note), "na\xc3\xa4\n");
  EXPECT_EQ(table_text(std::string("\xfe\xff\0n\0a", 6), "t", note), "na");
  EXPECT_NE(note.find("UTF-16"), std::string::npos);
}

TEST(TableText, RejectsWorkbooks) {
  for (const std::string& bytes : {std::string("PK\x03\x04\x14\0\x06\0", 8),
                                   std::string("\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")}) {
    std::string note;
    try {
      table_text(bytes, "oils.csv", note);
      FAIL() << "a workbook was accepted";
    } catch (const Failure& failure) {
      EXPECT_NE(std::string(failure.what()).find("oils.csv"), std::string::npos);
    }
  }
  std::string note;
  EXPECT_THROW(table_text(std::string("name\0x", 6), "t", note), Failure);
  EXPECT_THROW(table_text(std::string("\xff\xfe\x00\xd8", 4), "t", note), Failure)
      << "half a surrogate";
}

}  // namespace
}  // namespace tribodyn::client
