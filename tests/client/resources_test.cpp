// Tests of flags and files that describe a resource, without a server.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "client/cpp/commands/completion.h"
#include "client/cpp/commands/help.h"
#include "client/cpp/failure.h"
#include "client/cpp/report/fluid_difference.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"

namespace tribodyn::client {
namespace {

const ResourceKind& lubricants() { return kind_of(*v1::Lubricant::descriptor()); }

/// Reads flags as a command line does; expects no complaint unless `complaints` is given.
v1::Lubricant edited(const std::vector<std::pair<std::string, std::string>>& given,
                     v1::Lubricant lubricant = {}, Complaints* complaints = nullptr) {
  ResourceEdits edits;
  FlagList flags;
  add_edit_flags(flags, lubricants(), edits);
  add_removal_flags(flags, lubricants(), edits);
  Complaints own;
  for (const auto& [name, text] : given) {
    const auto flag = std::find_if(
        flags.flags().begin(), flags.flags().end(), [&, wanted = name](const Flag& each) {
          return ("," + each.names + ",").find("," + wanted + ",") != std::string::npos;
        });
    if (flag == flags.flags().end()) {
      ADD_FAILURE() << "no flag " << name;
      continue;
    }
    flag->read({text}, own);
  }
  if (complaints != nullptr) {
    *complaints = own;
  } else {
    EXPECT_TRUE(own.empty()) << own.front();
  }
  edits.apply(lubricant);
  return lubricant;
}

TEST(Edits, FlagsDescribeADataSheet) {
  const v1::Lubricant fluid = edited({{"--kv40", "73.3"},
                                      {"--kv100", "8.86cSt"},
                                      {"--density15", "0.87 g/cm3"},
                                      {"--brookfield", "-40=150000"},
                                      {"--viscosity", "20C=0.2Pas"},
                                      {"--viscosity", "60=31mm2/s"},
                                      {"--density", "100=815"},
                                      {"--base-oil-class", "pao"},
                                      {"--condition", "used"},
                                      {"--derived-from", "fresh"},
                                      {"--label", "project=axle=2"},
                                      {"--pressure-viscosity", "20/GPa"},
                                      {"--pressure-viscosity-temperature", "40C"},
                                      {"--vogel-reference-temperature", "-114.15C"}});
  const auto& measured = fluid.measurements();
  ASSERT_EQ(measured.viscosities_size(), 2);
  EXPECT_EQ(measured.kinematic_viscosity_40_celsius_square_millimetres_per_second(), 73.3);
  EXPECT_EQ(measured.kinematic_viscosity_100_celsius_square_millimetres_per_second(), 8.86);
  EXPECT_EQ(measured.density_15_celsius_kilograms_per_cubic_metre(), 870);
  EXPECT_EQ(measured.brookfield_viscosities(0).temperature_celsius(), -40);
  EXPECT_EQ(measured.brookfield_viscosities(0).dynamic_viscosity_millipascal_seconds(), 150000);
  EXPECT_EQ(measured.viscosities(0).dynamic_viscosity_millipascal_seconds(), 200);
  EXPECT_EQ(measured.viscosities(1).kinematic_viscosity_square_millimetres_per_second(), 31);
  EXPECT_EQ(measured.densities(0).density_kilograms_per_cubic_metre(), 815);
  EXPECT_EQ(fluid.base_oil_class(), v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  EXPECT_EQ(fluid.condition(), v1::Lubricant::USED);
  EXPECT_EQ(fluid.derived_from(), "lubricants/fresh");
  EXPECT_EQ(fluid.labels(0).value(), "axle=2");
  EXPECT_EQ(fluid.pressure_viscosity_coefficient_per_pascal(), 2e-8);
  EXPECT_EQ(fluid.pressure_viscosity_temperature_kelvin(), 313.15);
  EXPECT_DOUBLE_EQ(fluid.vogel_reference_temperature_kelvin(), 159);
}

TEST(Edits, ANumberWithoutUnitIsInTheUnitOfDataSheets) {
  const v1::Lubricant fluid = edited({{"--pressure-viscosity", "20"},
                                      {"--pressure-viscosity-temperature", "40"},
                                      {"--relaxation-time", "0.45"},
                                      {"--vogel-reference-temperature", "159"},
                                      {"--uncertainty", "pressure-viscosity=0.5"},
                                      {"--uncertainty", "pressure-viscosity-temperature=2"}});
  EXPECT_EQ(fluid.pressure_viscosity_coefficient_per_pascal(), 2e-8);
  EXPECT_EQ(fluid.pressure_viscosity_temperature_kelvin(), 313.15);
  EXPECT_EQ(fluid.relaxation_time_seconds(), 4.5e-7);
  EXPECT_EQ(fluid.vogel_reference_temperature_kelvin(), 159);
  EXPECT_EQ(
      provenance_of(fluid, "pressure_viscosity_coefficient_per_pascal")->standard_uncertainty(),
      5e-10);
  EXPECT_EQ(provenance_of(fluid, "pressure_viscosity_temperature_kelvin")->standard_uncertainty(),
            2);
}

TEST(Edits, ANewValueClearsTheProvenanceOfTheOldOne) {
  v1::Lubricant fluid;
  auto& entry = *fluid.add_provenance();
  entry.set_field("thermal_conductivity_watts_per_metre_kelvin");
  entry.set_provenance(v1::PROVENANCE_ASSUMED);
  entry.set_computed(true);
  const v1::Lubricant changed = edited({{"--thermal-conductivity", "0.15W/mK"}}, fluid);
  ASSERT_EQ(changed.provenance_size(), 1);
  EXPECT_EQ(changed.provenance(0).provenance(), v1::PROVENANCE_USER);
  EXPECT_FALSE(changed.provenance(0).computed());
  const v1::Lubricant measured = edited({{"--thermal-conductivity", "0.15W/mK"},
                                         {"--provenance", "thermal-conductivity=measured:Lab: 12"},
                                         {"--uncertainty", "thermal-conductivity=2mW/(m K)"}},
                                        fluid);
  EXPECT_EQ(measured.provenance(0).provenance(), v1::PROVENANCE_MEASURED);
  EXPECT_EQ(measured.provenance(0).source(), "Lab: 12");
  EXPECT_EQ(measured.provenance(0).standard_uncertainty(), 0.002);
  const v1::Lubricant unset = edited({{"--unset", "thermal-conductivity"}}, measured);
  EXPECT_FALSE(unset.has_thermal_conductivity_watts_per_metre_kelvin());
  EXPECT_EQ(unset.provenance_size(), 0);
}

TEST(Edits, UnsetIsAppliedBeforeOtherFlags) {
  const v1::Lubricant old = edited({{"--density", "100=815"}, {"--label", "a=1"}});
  const v1::Lubricant added = edited({{"--density", "60=840"}}, old);
  EXPECT_EQ(added.measurements().densities_size(), 2);
  const v1::Lubricant anew = edited({{"--density", "60=840"},
                                     {"--unset", "measurements"},
                                     {"--label", "a=2"},
                                     {"--remove-label", "a"}},
                                    old);
  ASSERT_EQ(anew.measurements().densities_size(), 1);
  EXPECT_EQ(anew.measurements().densities(0).temperature_celsius(), 60);
  EXPECT_EQ(anew.labels(0).value(), "2");
}

TEST(Edits, ReportEachError) {
  Complaints complaints;
  edited({{"--kv40", "thick"},
          {"--pressure-viscosity", "20 s"},
          {"--pressure-viscosity-coefficient-per-pascal", "2e-8"},
          {"--alpha", "20"},
          {"--brookfield", "150000"},
          {"--viscosity", "20C=7"},
          {"--label", "axle"},
          {"--provenance", "thermal-conductivty=measured"},
          {"--provenance", "thermal-conductivity=guessed"},
          {"--unset", "condiction"}},
         {}, &complaints);
  ASSERT_EQ(complaints.size(), 9U);
  EXPECT_NE(complaints[1].find("'20 s'"), std::string::npos);
  EXPECT_NE(complaints[6].find("thermal-conductivity "), std::string::npos);
  EXPECT_NE(complaints[8].find("condition "), std::string::npos);
}

TEST(Edits, EveryNumberOfEveryKindHasAFlag) {
  for (const ResourceKind& kind : resource_kinds()) {
    ResourceEdits edits;
    FlagList flags;
    add_edit_flags(flags, kind, edits);
    const auto* type = kind.prototype->GetDescriptor();
    for (int i = 0; i < type->field_count(); ++i) {
      const auto& field = *type->field(i);
      if (field.is_repeated() ||
          field.cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) {
        continue;
      }
      const std::string name = flag_of_field(field.name());
      EXPECT_TRUE(std::any_of(flags.flags().begin(), flags.flags().end(), [&](const Flag& flag) {
        return ("," + flag.names + ",").find("," + name + ",") != std::string::npos;
      })) << name;
    }
  }
}

std::string error_of(const std::string& json) {
  try {
    read_resources(json, "x.json", nullptr);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitUsage);
    return failure.what();
  }
  return "";
}

TEST(JsonInput, NamesEveryUnknownFieldAndTheNearestOne) {
  const std::string text = error_of(
      R"({"name": "lubricants/q", "measurments": {}, "labels": [{"ky": "a"}],
          "measurements": {"densities": [{"temperature_celcius": 3}]}})");
  EXPECT_NE(text.find("measurments"), std::string::npos);
  EXPECT_NE(text.find("measurements "), std::string::npos) << "the nearest one";
  EXPECT_NE(text.find("labels[0].ky"), std::string::npos);
  EXPECT_NE(text.find("measurements.densities[0].temperature_celcius"), std::string::npos);
}

TEST(JsonInput, RejectsTextThatIsNotAResource) {
  for (const std::string& text :
       {std::string(), std::string("[1, 2]"), std::string("{"), std::string(5000, '['),
        std::string("{}"), std::string(R"({"name": "lubricants/q", "labels": 7})")}) {
    EXPECT_NE(error_of(text).find("x.json"), std::string::npos) << text.substr(0, 40);
  }
  EXPECT_NE(error_of(R"({"lubricants": [7]})").find("lubricants[0]"), std::string::npos);
}

TEST(JsonInput, ReadsBackWhatExportWrites) {
  std::vector<ResourcePointer> fluids;
  for (const char* name : {"lubricants/a", "lubricants/b"}) {
    auto fluid = std::make_unique<v1::Lubricant>();
    fluid->set_name(name);
    fluid->set_pressure_viscosity_coefficient_per_pascal(1.0 / 3e8);
    fluid->set_havriliak_negami_beta(0);  // set to zero
    fluid->set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_ESTER);
    fluid->add_labels()->set_key("a\"\n\u00e9");
    fluids.push_back(std::move(fluid));
  }
  const auto again = read_resources(export_text(lubricants(), fluids), "x", nullptr);
  ASSERT_EQ(again.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again[i].resource->SerializeAsString(), fluids[i]->SerializeAsString());
  }
  v1::Lubricant kept;
  kept.CopyFrom(*fluids[0]);
  dynamic_cast<v1::Lubricant&>(*fluids[0]).set_etag("server's");
  fluids.pop_back();
  const auto alone = read_resources(export_text(lubricants(), fluids), "x", &lubricants());
  EXPECT_EQ(alone.at(0).resource->SerializeAsString(), kept.SerializeAsString());
}

TEST(TableFiles, ListMeasurements) {
  v1::Lubricant fluid;
  fluid.mutable_measurements()->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      8.86);
  fluid.mutable_measurements()->set_density_15_celsius_kilograms_per_cubic_metre(870);
  EXPECT_EQ(viscosity_table_csv(fluid),
            "temperature_celsius,kinematic_viscosity_square_millimetres_per_second,"
            "dynamic_viscosity_millipascal_seconds,density_kilograms_per_cubic_metre\n"
            "100,8.86,,\n15,,,870\n");
}

TEST(Difference, ListsDifferentValuesFirst) {
  v1::Lubricant a;
  v1::Lubricant b;
  a.set_name("lubricants/a");
  b.set_name("lubricants/b");
  a.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  b.set_pressure_viscosity_coefficient_per_pascal(1.5e-8);
  a.set_vogel_temperature_coefficient_kelvin(900);
  b.set_vogel_temperature_coefficient_kelvin(900);
  b.set_thermal_conductivity_watts_per_metre_kelvin(0.14);
  a.set_pressure_viscosity_temperature_kelvin(313.15);
  b.set_pressure_viscosity_temperature_kelvin(323.15);
  const FluidDifference difference = fluid_difference(a, b, true, OutputFormat::kTable);
  EXPECT_TRUE(difference.differs);
  EXPECT_NE(difference.text.find("-25.00"), std::string::npos);
  EXPECT_LT(difference.text.find("pressure viscosity coefficient"),
            difference.text.find("vogel temperature coefficient"));
  EXPECT_LT(difference.text.find("thermal conductivity"),
            difference.text.find("vogel temperature coefficient"));
  EXPECT_EQ(fluid_difference(a, b, false, OutputFormat::kTable).text.find("vogel temperature"),
            std::string::npos);
  EXPECT_FALSE(fluid_difference(a, a, false, OutputFormat::kCsv).differs);
}

std::vector<std::string> completed(const std::vector<std::string>& words) {
  CommonOptions options;
  options.server = "127.0.0.1:9";  // nothing listens there
  FlagList common_flags;
  CommonOptions unused;
  add_common_flags(common_flags, unused);
  return completions(words, all_commands(), common_flags, options);
}

TEST(Completion, OffersCommandsFlagsAndValues) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(completed({"lub"}), Words({"lubricants"}));
  EXPECT_EQ(completed({"lubricants", "un"}), Words({"undelete"}));
  EXPECT_EQ(completed({"--server", "x", "jobs", "wat"}), Words({"watch"}));
  EXPECT_EQ(completed({"lubricants", "create", "x", "--base-oil-class", "group-ii"}),
            Words({"group-ii", "group-iii"}));
  EXPECT_EQ(completed({"curve", "--model=q"}), Words({"--model=quasi-static"}));
  EXPECT_EQ(completed({"lubricants", "list", "--show"}), Words({"--show-deleted"}));
  EXPECT_EQ(completed({"validate", ""}), Words({"\\file"}));
  EXPECT_EQ(completed({"curve", "--plot", ""}), Words({"\\file"}));
}

TEST(Completion, PrintsNoErrorWithoutAServer) {
  EXPECT_TRUE(completed({"lubricants", "get", ""}).empty());
  EXPECT_TRUE(completed({}).empty());
  EXPECT_TRUE(completed({"nonsense", ""}).empty());
}

}  // namespace
}  // namespace tribodyn::client
