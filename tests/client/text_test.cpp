#include "client/cpp/text/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "client/cpp/failure.h"
#include "client/cpp/report/contact_report.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/history_report.h"
#include "client/cpp/report/limits_report.h"
#include "client/cpp/report/point_report.h"
#include "client/cpp/report/precision.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/report/results.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/output.h"
#include "client/cpp/text/progress.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/warnings.h"
#include "tests/client/sample_simulations.h"

namespace tribodyn::client {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return AssertionSuccess();
  return AssertionFailure() << "\"" << part << "\" is not in\n" << text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines = split(text, '\n');
  if (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

/// Returns the text with single blanks in place of runs of blanks.
std::string squeezed(const std::string& text) {
  std::string out;
  std::unique_copy(text.begin(), text.end(), std::back_inserter(out),
                   [](char a, char b) { return a == ' ' && b == ' '; });
  return out;
}

TEST(Text, NumbersAreRoundedAndNeverNegativeZero) {
  EXPECT_EQ(fixed(-0.0004, 2), "0.00");
  EXPECT_EQ(fixed(1.005e3, 1), "1005.0");
  EXPECT_EQ(fixed(std::nan(""), 2), "-");
  EXPECT_EQ(significant(1.23456789e7, 3), "1.23e+07");
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(-std::numeric_limits<double>::infinity()), "-Infinity");
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(0.00042), "0.4 ms");
  EXPECT_EQ(duration_text(0.035), "35 ms");
  EXPECT_EQ(duration_text(0.9996), "1.0 s");
  EXPECT_EQ(duration_text(3.25), "3.2 s");
  EXPECT_EQ(duration_text(125), "2 min 05 s");
  EXPECT_EQ(duration_text(3720), "1 h 02 min");
}

TEST(Text, PrintableReplacesControlCharacters) {
  EXPECT_EQ(printable("a\x1b[2Jb\nc\x7f"), "a?[2Jb c?");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "?31m");
  EXPECT_EQ(printable("\xC2\xB5m"), "\xC2\xB5m");
}

TEST(Text, SplitKeepsEmptyParts) {
  EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string>{"a", "", "b", ""}));
  EXPECT_TRUE(split("", ',').empty());
}

TEST(Text, ResourceNamesMayOmitTheirCollection) {
  EXPECT_EQ(resource_name("lubricants", "1"), "lubricants/1");
  EXPECT_EQ(resource_name("lubricants", "lubricants/1"), "lubricants/1");
  EXPECT_EQ(resource_id("simulations/x"), "x");
}

TEST(Text, ASlashThatBelongsToNoCollectionCutsNothingOffAName) {
  EXPECT_EQ(resource_id("gearSets/axle@2"), "axle@2");
  EXPECT_EQ(resource_id("projects/acme/lubricants/oil"), "oil");
  for (const char* text : {"oil", "75W/90", "Shell 75W/77", "PAO/ester-1", "lubricants/75W/90",
                           "projects/acme/75W/90", "projects/acme", "projects/", "/", ""}) {
    EXPECT_EQ(resource_id(text), text);
  }
}

TEST(Table, AlignsByDisplayWidth) {
  Table table({{"film", "\xC2\xB5m"}, {"lost", "", Table::Align::kLeft}});
  table.add_row({"0.123", "yes"});
  table.add_row({"10.5"});
  EXPECT_EQ(table.text(),
            " film  lost\n"
            "   \xC2\xB5m\n"
            "-----  ----\n"
            "0.123  yes\n"
            " 10.5\n");
}

TEST(Table, AlignsDecimalPoints) {
  Table table({{"loss", "W", Table::Align::kDecimal}, {"x", ""}});
  table.add_row({"1.26", "a"});
  table.add_row({"12", "b"});
  table.add_row({"0.1234", "c"});
  table.add_row({"+/- 0.5", "d"});
  table.add_row({"-", "e"});
  EXPECT_EQ(table.text(),
            "      loss  x\n"
            "         W\n"
            "----------  -\n"
            "    1.26    a\n"
            "   12       b\n"
            "    0.1234  c\n"
            "+/- 0.5     d\n"
            "         -  e\n");
}

TEST(Csv, QuotesCellsThatReadersWouldMisread) {
  EXPECT_EQ(csv_line({"a", "b,c", "say \"x\"", "two\nlines", ""}),
            "a,\"b,c\",\"say \"\"x\"\"\",\"two\nlines\",\n");
}

TEST(Csv, AnApostropheStopsSpreadsheetsFromComputingTextsButNotNumbers) {
  EXPECT_EQ(csv_line({"=HYPERLINK(1)", "+x", "-x", "@x", "\tx", "\rx", "-1.5e-9", "-inf", "a=b"}),
            "'=HYPERLINK(1),'+x,'-x,'@x,\"'\tx\",\"'\rx\",-1.5e-9,-inf,a=b\n");
}

TEST(Csv, IsReadBackAsItWasWritten) {
  const std::vector<std::vector<std::string>> rows = {{"# no note"},
                                                      {"sep=", "", ""},
                                                      {""},
                                                      {" blanks ", "\ttab", "semi;colon"},
                                                      {"", "", ""},
                                                      {"ends\r", "\"", "\"\""},
                                                      {"=1+1", "'=2", "'plain", "@x", "-", "+5 C"}};
  std::string text = "name\n";
  for (const auto& row : rows) text += csv_line(row);
  const std::vector<CsvLine> lines = read_csv(text);
  ASSERT_EQ(lines.size(), rows.size() + 1);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(lines[i + 1].cells, rows[i]) << i;
}

TEST(Csv, HeadersHaveUnitsAndDoNotDependOnValues) {
  v1::Simulation curve = sample_curve("1", 1);
  const auto full = lines_of(points_csv({curve}));
  ASSERT_EQ(full.size(), 26U);
  for (auto& point : *curve.mutable_result()->mutable_points()) {
    point.clear_result();
    point.set_refusal_reason("WORK_LIMIT");
  }
  const auto refused = lines_of(points_csv({curve}));
  EXPECT_EQ(full[0], refused[0]);
  const auto headers = split(full[0], ',');
  EXPECT_EQ(std::set<std::string>(headers.begin(), headers.end()).size(), headers.size());
  for (const std::string& line : full) EXPECT_EQ(split(line, ',').size(), headers.size());
  EXPECT_TRUE(holds(full[0], ",speed_kilometres_per_hour,"));
  EXPECT_TRUE(holds(full[0], ",minimum_central_film_thickness_metres,"));
  EXPECT_TRUE(holds(full[0], ",flank_losses_2_boundary_watts,"));
  EXPECT_TRUE(holds(full[0], ",inefficiency_rms_percent,"));
  EXPECT_TRUE(holds(refused[1], ",,,,"));
  EXPECT_TRUE(holds(refused[1], "WORK_LIMIT"));
}

TEST(Csv, UnsetOptionalIsEmptyNotZero) {
  v1::PointResult result;
  CsvRow row;
  append_fields(result, "", row);
  for (const auto& [header, value] : row) {
    if (header == "inefficiency_rms_percent" || header == "estimated_relative_error" ||
        header == "minimum_film_ratio") {
      EXPECT_EQ(value, "") << header;
    }
    if (header == "mesh_loss_power_watts") {
      EXPECT_EQ(value, "0");
    }
  }
}

TEST(PointReport, HasFiguresModelHashAndWarnings) {
  const std::string text = squeezed(point_report(sample_point(), {}));
  for (const char* part : {"72.5 km/h", "0.600 ms", "0.00012 %", "abc123", "tribodyn-model-2",
                           "eq17_atan", "FILM_RATIO_LOW", "--assumptions"}) {
    EXPECT_TRUE(holds(text, part));
  }
  EXPECT_TRUE(holds(point_report(sample_point(), {.assumptions = true}),
                    "asperity_radius_metres = 4e-05 m"));
}

TEST(PointReport, ShowsTheStatisticsOfTheSolverOnRequestAndWhereNoSteadyStateWasFound) {
  v1::Simulation simulation = sample_point();
  v1::PointResult& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  result.set_settled(true);
  result.set_period_in_mesh_cycles(2);
  EXPECT_FALSE(holds(point_report(simulation, {}), "Floquet"));
  EXPECT_TRUE(holds(point_report(simulation, {.solver = true}), "Floquet"));
  result.set_settled(false);
  EXPECT_TRUE(holds(point_report(simulation, {}), "Floquet"));
  result.set_settled(true);
  result.set_period_in_mesh_cycles(0);
  EXPECT_TRUE(holds(point_report(simulation, {}), "Floquet"));
}

TEST(ResourceSheet, OfALubricantSummedUpCountsItsParametersByOrigin) {
  v1::Lubricant oil;
  oil.set_name("lubricants/my-oil");
  oil.set_thermal_conductivity_watts_per_metre_kelvin(0.14);
  oil.set_relaxation_time_seconds(1e-6);
  auto& provenance = *oil.add_provenance();
  provenance.set_field("thermal_conductivity_watts_per_metre_kelvin");
  provenance.set_provenance(v1::PROVENANCE_ASSUMED);
  const std::string brief = squeezed(resource_sheet(oil, ResourceDetail::kSummary));
  EXPECT_TRUE(holds(brief, " 1 assumed"));
  EXPECT_TRUE(holds(brief, "tribodyn lubricants get my-oil"));
  EXPECT_FALSE(holds(brief, "0.14"));
  EXPECT_TRUE(holds(resource_sheet(oil), "0.14"));
}

TEST(PointReport, HasFrictionSlidingAndFlashTemperature) {
  v1::Simulation simulation = sample_point();
  v1::PointResult& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  result.mutable_friction_coefficient()->set_mean(0.0412);
  result.mutable_flank_losses(1)->set_friction_coefficient(0.0387);
  result.mutable_pinion_specific_sliding()->set_maximum(1.375);
  result.mutable_flash_temperature_rise_kelvin()->set_maximum(61.25);
  const std::string text = squeezed(point_report(simulation, {}));
  for (const char* figure : {" 0.0412", " 0.0387", " 1.3", " 61"}) EXPECT_TRUE(holds(text, figure));
}

v1::FigureLimit limit_of(const std::string& figure, double minimum, double maximum,
                         const std::string& source) {
  v1::FigureLimit out;
  out.set_figure(figure);
  if (minimum != 0) out.set_minimum(minimum);
  if (maximum != 0) out.set_maximum(maximum);
  out.set_source(source);
  return out;
}

TEST(LimitsReport, SetsEachFigureBesideItsLimitAndSaysWhetherItIsKept) {
  v1::Simulation simulation = sample_point();
  v1::SimulationResult& result = *simulation.mutable_result();
  EXPECT_EQ(limits_report(result), "") << "no limits";
  v1::PointResult& point = *result.mutable_points(0)->mutable_result();
  point.mutable_film_ratio()->set_minimum(0.7);
  point.mutable_maximum_pressure_pascals()->set_maximum(1.2e9);
  point.mutable_flash_temperature_rise_kelvin()->set_maximum(61);
  *result.add_limits() = limit_of("film_ratio.minimum", 0.5, 0, "sparse asperities");
  *result.add_limits() = limit_of("film_ratio.minimum", 1, 0, "boundary lubrication below");
  *result.add_limits() =
      limit_of("maximum_pressure_pascals.maximum", 0.85e9, 1.35e9, "friction model compared");
  *result.add_limits() = limit_of("figure.of_a_newer_server", 1, 2, "unknown");
  const std::string text = squeezed(limits_report(result));
  EXPECT_TRUE(holds(text, " 0.7 >= 0.5 yes sparse asperities"));
  EXPECT_TRUE(holds(text, " 0.7 >= 1 no boundary lubrication below"));
  EXPECT_TRUE(holds(text, " GPa 1.2 0.85 to 1.35 yes friction model compared"));
  EXPECT_TRUE(holds(text, " K 61 "));
  EXPECT_FALSE(holds(text, "unknown"));
  *result.add_limits() = limit_of("flash_temperature_rise_kelvin.maximum", 0, 60, "stated: FZG");
  EXPECT_TRUE(holds(squeezed(limits_report(result)), " K 61 <= 60 no stated: FZG"));
}

TEST(LimitsReport, OfACurveCountsTheSpeedsAtWhichALimitIsNotKept) {
  v1::Simulation curve = sample_curve("1", 1);
  v1::SimulationResult& result = *curve.mutable_result();
  for (int i = 0; i < result.points_size(); ++i) {
    result.mutable_points(i)->mutable_result()->mutable_film_ratio()->set_minimum(i < 3 ? 0.4 : 2);
  }
  *result.add_limits() = limit_of("film_ratio.minimum", 1, 0, "stated");
  EXPECT_TRUE(holds(squeezed(limits_report(result)), " 0.4 >= 1 not at 3 of 25 speeds stated"));
}

TEST(PointReport, TakesTheInputPowerFromTheShaftThatDrives) {
  v1::Simulation simulation = sample_point();
  v1::PointResult& coast = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  coast.set_pinion_torque_newton_metres(-30);
  coast.set_input_power_watts(6086);
  coast.mutable_power_balance()->set_input_joules(-8);
  coast.mutable_power_balance()->set_output_joules(-9);
  coast.mutable_power_balance()->set_friction_joules(1);
  const std::string text = squeezed(point_report(simulation, {.solver = true}));
  EXPECT_TRUE(holds(text, " 6.0860 kW"));
  EXPECT_TRUE(holds(text, "9.0000 J in = 8.0000 out + 1.0000 friction"));
}

TEST(PointReport, GivesThreeDigitsWithoutErrorEstimate) {
  v1::Simulation simulation = sample_point();
  auto& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  result.clear_estimated_relative_error();
  EXPECT_TRUE(holds(squeezed(point_report(simulation, {})), " 1.33 %"));
}

TEST(PointReport, HasNoMoreDigitsThanTheErrorJustifies) {
  v1::Simulation simulation = sample_point();
  auto& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  result.set_inefficiency_energy_mean_percent(1.325178);
  result.set_pinion_torque_newton_metres(33.15439);
  result.mutable_dynamic_transmission_error_metres()->set_minimum(1.23456e-6);
  result.mutable_maximum_pressure_pascals()->set_maximum(6.0164e8);
  const auto report = [&](double error) {
    result.set_estimated_relative_error(error);
    return squeezed(point_report(simulation, {}));
  };
  const std::map<double, std::vector<const char*>> expected = {
      {5e-3, {" 0.5 %", " 1.3 %", " 33 N m", "1 80 90"}},
      {2e-4, {" 0.02 %", " 1.325 %", " 33.2 N m", "1.2 80.0 90.0"}},
      {1e-6, {" 1.3252 %", " 33.154 N m", "1.235 80.000 90.000"}}};
  for (const auto& [error, parts] : expected) {
    const std::string text = report(error);
    for (const char* part : parts) EXPECT_TRUE(holds(text, part)) << error;
  }
  EXPECT_TRUE(holds(report(1e-6), "0.500 0.602"));
  simulation.mutable_solver_options()->set_tolerance(1e-5);
  EXPECT_TRUE(holds(report(1e-6), "0.5000 0.6016"));
}

TEST(CurveReport, HasOneLinePerSpeedAndTheReasonOfAMissingOne) {
  v1::Simulation curve = sample_curve("2", 1);
  for (const int index : {2, 3}) {
    auto& point = *curve.mutable_result()->mutable_points(index);
    point.clear_result();
    point.set_refusal_reason("WORK_LIMIT");
    point.set_refusal_message("no steady state within 4000 mesh cycles");
  }
  const std::string text = curve_report(curve, {});
  for (const char* part :
       {"lubricants/2: ", "30, 35 km/h: no steady state within 4000 mesh cycles [WORK_LIMIT]"}) {
    EXPECT_TRUE(holds(text, part));
  }
  for (int speed = 20; speed <= 140; speed += 5) {
    EXPECT_TRUE(holds(squeezed(text), " " + std::to_string(speed) + " "));
  }
}

TEST(CurveReport, OfIndependentPointsAndOfAJumpDiffersFromThatOfASweep) {
  v1::Simulation curve = sample_curve("2", 1);
  const std::string sweep = curve_report(curve, {});
  v1::BranchEnd* end = curve.mutable_result()->mutable_points(10)->mutable_branch_end();
  end->set_gone_at_kilometres_per_hour(69.25);
  EXPECT_GT(curve_report(curve, {}).size(), sweep.size());
  curve = sample_curve("2", 1);
  curve.mutable_inefficiency_curve()->clear_direction();
  curve.mutable_inefficiency_curve()->set_independent_points(true);
  curve.mutable_result()->set_independent_points(true);
  EXPECT_NE(curve_report(curve, {}), sweep);
  EXPECT_TRUE(holds(points_csv({curve}), ",INDEPENDENT_POINTS,"));
}

TEST(CurveReport, PrintsErrorEstimatesBesideTheFigures) {
  v1::Simulation curve = sample_curve("2", 1);
  auto& points = *curve.mutable_result()->mutable_points();
  points[0].mutable_result()->set_estimated_relative_error(3e-4);
  const std::string text = squeezed(curve_report(curve, {}));
  EXPECT_TRUE(holds(text, " 20 1.350 0.0004 1.391 5.8 ")) << "in the unit of the figure";
  EXPECT_TRUE(holds(text, " 25 1.34 - 1.38 7.5 "));
  EXPECT_TRUE(holds(points_csv({curve}), ",estimated_relative_error,"));
  EXPECT_TRUE(holds(points_csv({curve}), ",3e-04,"));
}

/// Returns the text with one blank in place of every run of blanks and line feeds.
std::string one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

TEST(CurveReport, GivesLargeLossesInKilowatts) {
  v1::Simulation curve = sample_curve("2", 1);
  curve.mutable_result()->mutable_points(3)->mutable_result()->set_mesh_loss_power_watts(1553);
  const std::string text = squeezed(curve_report(curve, {}));
  EXPECT_TRUE(holds(text, " kW "));
  EXPECT_TRUE(holds(text, " 1.55 "));
  EXPECT_EQ(text.find("e+"), std::string::npos);
}

TEST(PointReport, GivesLargeLossesInKilowatts) {
  v1::Simulation simulation = sample_point();
  auto& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  result.set_estimated_relative_error(3e-3);
  result.set_mesh_loss_power_watts(1553.2);
  result.set_boundary_loss_power_watts(53);
  const std::string text = squeezed(point_report(simulation, {}));
  EXPECT_TRUE(holds(text, " 1.55 kW"));
  EXPECT_TRUE(holds(text, " 0.05 kW"));
  EXPECT_EQ(text.find("e+"), std::string::npos);
  result.set_inefficiency_energy_mean_percent(1.1783);
  EXPECT_TRUE(holds(squeezed(point_report(simulation, {})), "solver error 0.004"));
}

TEST(Reports, BeginWithATorqueFarBeyondTheDataOfTheGearSet) {
  v1::GearSet gear_set;
  gear_set.add_series_by_torque()->set_pinion_torque_newton_metres(80);
  gear_set.add_load_share_by_torque()->set_pinion_torque_newton_metres(100);
  v1::Simulation simulation = sample_point();
  simulation.set_gear_set_revision("gearSets/A@1");
  auto& result = *simulation.mutable_result()->mutable_points(0)->mutable_result();
  const auto report = [&](double torque) {
    result.set_pinion_torque_newton_metres(torque);
    return one_line(results_text({simulation}, OutputFormat::kTable, true, {},
                                 {{"gearSets/A@1", largest_torque(gear_set)}}));
  };
  for (const double torque : {765, -765}) {
    EXPECT_EQ(report(torque).find("! "), 0U) << report(torque);
    for (const char* part : {"765 N m", " 7.7 ", "A@1", "100 N m"}) {
      EXPECT_TRUE(holds(report(torque), part));
    }
  }
  EXPECT_EQ(report(120).find("! "), std::string::npos);
  EXPECT_EQ(largest_torque({}), 0);
}

TEST(Warnings, NameWhatHasThemWhere) {
  WarningCollector collector({"20", "40", "60"}, "km/h", "all speeds", {"a", "b"});
  const ShownWarning thick{"THICK", "thick", v1::WARNING_LEVEL_WITHHOLDS_VERDICT, "20 um"};
  const ShownWarning note{"PERIOD", "period", v1::WARNING_LEVEL_NOTE, "2 cycles"};
  for (const std::size_t place : {0U, 1U, 2U}) collector.add(note, 0, place);
  collector.add(thick, 0, 0);
  collector.add(thick, 0, 2);
  collector.add(thick, 1, 1);
  const std::vector<ShownWarning> warnings = collector.warnings();
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].where, "a at 20 and 60 km/h; b at 40 km/h");
  EXPECT_EQ(warnings[1].where, "a at all speeds");
  EXPECT_EQ(codes_of(warnings), "THICK PERIOD");
  EXPECT_EQ(withheld_by(warnings), "thick");
  EXPECT_EQ(json_with("{\n}\n", "warnings", "[]"), "{\n \"warnings\": []\n}\n");
}

TEST(Reports, NameEachWarningOnceWithItsSpeeds) {
  v1::Simulation curve = sample_curve("2", 1);
  for (auto& point : *curve.mutable_result()->mutable_points()) {
    if (point.speed_kilometres_per_hour() > 30) continue;
    auto& warning = *point.mutable_result()->add_warnings();
    warning.set_code("THICK_FILM");
    warning.set_summary("thick film");
    warning.set_level(v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
    warning.set_message("film at " + std::to_string(point.speed_kilometres_per_hour()));
  }
  auto& period = *curve.mutable_result()->mutable_points(9)->mutable_result()->add_warnings();
  period.set_code("PERIOD");
  period.set_message("repeats after 2");
  const std::string text = one_line(curve_report(curve, {}));
  EXPECT_TRUE(
      holds(text, "Thick film, at 20 to 30 km/h: film at 20.000000 (at 20 km/h). [THICK_FILM]"));
  EXPECT_TRUE(holds(text, "65 km/h: repeats after 2. [PERIOD]"));
  EXPECT_EQ(text.find("[THICK_FILM]"), text.rfind("[THICK_FILM]"));
}

/// Returns half a unit of the last digit of a number. Zeros at the end of a whole number count as
/// digits if `least`, else as padding.
double half_unit(const std::string& text, bool least) {
  const std::size_t point = text.find('.');
  if (point != std::string::npos) {
    return 0.5 * std::pow(10, -static_cast<int>(text.size() - point - 1));
  }
  const auto zeros = static_cast<int>(text.size() - text.find_last_not_of('0') - 1);
  return least ? 0.5 : 0.5 * std::pow(10, zeros);
}

TEST(Precision, HalfAUnitOfTheLastDigitIsNotBelowTheError) {
  v1::PointResult result;
  for (const double error : {3e-9, 1e-6, 9.9e-5, 2e-4, 1e-3, 5e-3, 0.03}) {
    result.set_estimated_relative_error(error);
    const Precision precision({}, result);
    for (double value = 1.234567e-2; value < 1e7; value *= 1.71) {
      for (const double signed_value : {value, -value}) {
        const std::string text = precision.estimated(signed_value, 4);
        const double shown = std::stod(text);
        const double unit = half_unit(text, false);
        const double least_unit = half_unit(text, true);
        EXPECT_LE(std::abs(shown - signed_value), unit * (1 + 1e-9)) << text;
        const bool has_two_digits = unit > 0.5 * 0.0099 * value;
        EXPECT_TRUE(unit * (1 + 1e-6) >= error * value || has_two_digits)
            << text << " of " << value;
        // One more digit would not be justified.
        EXPECT_TRUE(least_unit <= 0.50001e-4 || least_unit / 10 < error * value)
            << text << " of " << value;
      }
    }
  }
}

TEST(Precision, FiguresWithoutEstimateHaveThreeDigits) {
  const v1::PointResult result;
  const Precision precision({}, result);
  EXPECT_EQ(precision.error_percent(), "-");
  EXPECT_EQ(precision.estimated(1.38456, 4), "1.38");
  EXPECT_EQ(precision.estimated(9.9996, 4), "10.0");
  EXPECT_EQ(precision.estimated(0, 2), "0.00");
  EXPECT_EQ(precision.estimated(5321, 1), "5320") << "no exponent";
  EXPECT_EQ(precision.error_of(1.4), "-");
  EXPECT_EQ(precision.other(0.00456, 3), "0.005");
  EXPECT_EQ(precision.other(std::nan(""), 3), "-");
  EXPECT_EQ(precision.part(0.0123, 91.4, 2), "0.0");
}

TEST(HistoryReport, HasASummaryAndCsv) {
  EXPECT_TRUE(holds(history_summary(sample_history()), "flank_load_newtons_flank_2"));
  const auto lines = lines_of(history_csv(sample_history(), "FILM_RATIO PERIOD"));
  ASSERT_EQ(lines.size(), 385U);
  EXPECT_EQ(lines[0],
            "time_seconds,mesh_force_newtons,flank_load_newtons_flank_0,"
            "flank_load_newtons_flank_1,flank_load_newtons_flank_2,warnings");
  EXPECT_TRUE(lines[1].ends_with(",FILM_RATIO PERIOD"));
}

TEST(HistoryReport, OmitsTheTemperatureOfAFlankWithoutLoad) {
  EXPECT_EQ(column_quantity("flank_film_ratio_flank_1"), "flank_film_ratio");
  EXPECT_EQ(column_quantity("flank_load_newtons"), "flank_load_newtons");
  EXPECT_TRUE(zero_means_no_contact("flank_contact_temperature_kelvin_flank_0"));
  EXPECT_FALSE(zero_means_no_contact("flank_load_newtons_flank_0"));
  EXPECT_FALSE(zero_means_no_contact("mesh_force_newtons"));
  v1::History history;
  auto& column = *history.add_columns();
  column.set_name("flank_contact_temperature_kelvin_flank_0");
  for (const double value : {0.0, 350.0, 370.0}) column.add_values(value);
  const auto lines = lines_of(history_summary(history));
  EXPECT_TRUE(holds(lines.at(2), "2      350   360      370"));
}

TEST(ContactReport, ShowsEveryNumberOfTheResponse) {
  v1::EvaluateContactResponse contact;
  const auto* descriptor = contact.GetDescriptor();
  int numbers = 0;
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const auto* field = descriptor->field(i);
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) ++numbers;
  }
  contact.set_central_film_thickness_metres(3.21e-7);
  const std::string text = contact_report(contact);
  EXPECT_TRUE(holds(text, "h_cen"));
  EXPECT_TRUE(holds(text, "0.321"));
  const auto lines = lines_of(text);
  const auto blank = std::find(lines.begin(), lines.end(), "");
  EXPECT_EQ(blank - lines.begin() - 2, numbers);  // header and rule
}

TEST(Json, WritesZerosAndRoundTrips) {
  const std::string text = json_text(sample_point());
  EXPECT_TRUE(holds(text, "\"coast_side_contact\": false"));
  v1::Simulation blank;
  EXPECT_EQ(json_text(blank).find("sump_temperature_celsius"), std::string::npos);
}

TEST(WriteFile, ReplacesTheFileOrReportsTheError) {
  const std::string path = testing::TempDir() + "/tribodyn_write_file_test.txt";
  write_file(path, "one");
  write_file(path, "two");
  EXPECT_THROW(write_file("/nonexistent/folder/file", "x"), Failure);
}

TEST(ProgressBar, FitsTheTerminal) {
  const JobProgress job{"lubricants/1", "running", "settling at 65 km/h", 0.5, false};
  const std::string line = progress_bar_line(job, 12, 10, 200);
  EXPECT_EQ(line, "lubricants/1 [##########..........]  50 %  10.0 s left  settling at 65 km/h");
  EXPECT_EQ(progress_bar_line(job, 12, 10, 30).size(), 30U);
  EXPECT_TRUE(holds(progress_bar_line({"a", "running", "", 1, false}, 1, 0, 99), " 99 %"));
}

TEST(ProgressBar, ShowsTheFirstPointsOfALongCurve) {
  EXPECT_TRUE(holds(progress_bar_line({"a", "running", "", 4.0 / 961, false}, 1, 0, 99), "0.4 %"));
  EXPECT_EQ(percent_text(0), "0");
  EXPECT_EQ(percent_text(0.0199), "1.9") << "rounded down";
  EXPECT_EQ(percent_text(0.57), "57");
  EXPECT_EQ(percent_text(0.999), "99");
  EXPECT_EQ(percent_text(1), "100");
}

TEST(ProgressDisplay, PrintsFewLinesOffTerminals) {
  std::ostringstream out;
  ProgressDisplay display(out, ProgressForm::kLines, 80);
  JobProgress job{"lubricants/1", "running", "settling", 0, false};
  for (int i = 0; i <= 100; ++i) {
    job.fraction = 0.01 * i;
    display.show({job});
  }
  job.state = "succeeded";
  job.ended = true;
  display.show({job});
  const auto lines = lines_of(out.str());
  EXPECT_GE(lines.size(), 8U);
  EXPECT_LE(lines.size(), 12U);
  EXPECT_EQ(out.str().find('\x1b'), std::string::npos);
  EXPECT_TRUE(holds(lines.back(), "lubricants/1: succeeded"));
}

TEST(ProgressDisplay, RedrawsOnTerminals) {
  std::ostringstream out;
  ProgressDisplay display(out, ProgressForm::kBars, 80);
  const JobProgress job{"a", "running", "", 0.1, false};
  display.show({job, job});
  display.show({job, job});
  EXPECT_TRUE(holds(out.str(), "\x1b[2A"));
}

}  // namespace
}  // namespace tribodyn::client
