#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <stack>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/failure.h"
#include "client/cpp/plot/map_plot.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/report/curve_plot.h"
#include "client/cpp/report/history_plot.h"
#include "client/cpp/report/rig_rows.h"
#include "client/cpp/report/spectrum_report.h"
#include "client/cpp/report/variant_report.h"
#include "client/cpp/report/viscosity_report.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "tests/client/sample_simulations.h"

namespace tribodyn::client {
namespace {

/// Whether tags nest and text contains no bare markup: the part of XML that Svg writes.
testing::AssertionResult is_well_formed(const std::string& xml) {
  std::stack<std::string> open;
  for (std::size_t at = 0; at < xml.size();) {
    if (xml[at] == '&') {
      const std::string entity = xml.substr(at, xml.find(';', at) - at + 1);
      if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;") {
        return testing::AssertionFailure() << "bare & in " << xml.substr(at, 40);
      }
    }
    if (xml[at] != '<') {
      if (xml[at] == '>') return testing::AssertionFailure() << "bare > at " << at;
      ++at;
      continue;
    }
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return testing::AssertionFailure() << "tag without end";
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return testing::AssertionFailure() << "< in " << tag;
    const std::string name = tag.substr(0, tag.find(' '));
    if (tag[0] == '/') {
      if (open.empty() || open.top() != tag.substr(1)) {
        return testing::AssertionFailure() << "unexpected <" << tag << ">";
      }
      open.pop();
    } else if (tag.back() != '/') {
      open.push(name);
    }
    at = end + 1;
  }
  if (!open.empty()) return testing::AssertionFailure() << "<" << open.top() << "> left open";
  return testing::AssertionSuccess();
}

/// Saves the picture if the environment variable TRIBODYN_TEST_PICTURES names a folder.
void keep(const std::string& name, const std::string& svg) {
  const char* folder = std::getenv("TRIBODYN_TEST_PICTURES");
  if (folder != nullptr) std::ofstream(std::string(folder) + "/" + name) << svg;
}

TEST(Svg, EscapesTextAndDropsControlCharacters) {
  Svg svg(100, 50);
  svg.text({1, 2}, "a<b & \"c\" > \x1b[31md");
  EXPECT_TRUE(is_well_formed(svg.finish()));
  EXPECT_NE(svg.finish().find("a&lt;b &amp; &quot;c&quot; &gt; ?[31md"), std::string::npos);
}

TEST(Ticks, CoverTheRangeWithRoundNumbers) {
  EXPECT_EQ(nice_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(tick_labels(nice_ticks(1.03, 1.72, 6)),
            (std::vector<std::string>{"1.0", "1.2", "1.4", "1.6", "1.8"}));
  EXPECT_EQ(tick_labels({0, 0.25, 0.5}), (std::vector<std::string>{"0.00", "0.25", "0.50"}));
  for (const auto& [low, high] : {std::pair{-3e-9, 4e-9}, {5.0, 5.0}, {0.0, 0.0}, {-7e8, 2e12}}) {
    const auto ticks = nice_ticks(low, high, 6);
    ASSERT_GE(ticks.size(), 2U);
    EXPECT_LT(ticks.size(), 20U);
    EXPECT_LE(ticks.front(), low);
    EXPECT_GE(ticks.back(), high);
  }
}

TEST(Ticks, OfLogarithmicAxesAreOneTwoAndFiveTimesPowersOfTen) {
  EXPECT_EQ(logarithmic_tick_labels(logarithmic_ticks(std::log10(0.03), std::log10(3))),
            (std::vector<std::string>{"0.02", "0.05", "0.1", "0.2", "0.5", "1", "2", "5"}));
  EXPECT_EQ(logarithmic_tick_labels(logarithmic_ticks(-3, 2)),
            (std::vector<std::string>{"0.001", "0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(logarithmic_tick_labels(logarithmic_ticks(0, 0)), (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(logarithmic_tick_labels({5, 6, 7 + std::log10(2)}),
            (std::vector<std::string>{"100000", "1e6", "2e7"}));
}

RigRow rig_row(double speed, double traction, bool is_isothermal) {
  RigRow row;
  row.fluid = "lubricants/x@1";
  row.is_isothermal = is_isothermal;
  row.condition.set_load_newtons(20);
  row.condition.set_entrainment_speed_metres_per_second(speed);
  row.condition.set_supply_temperature_celsius(40);
  for (const std::string& column : rig_columns()) row.figures[column] = traction;
  return row;
}

constexpr RigView kStribeck{"stribeck",
                            "Stribeck",
                            "entrainment_speed_metres_per_second",
                            "traction_coefficient",
                            "Speed",
                            "Friction",
                            1,
                            true};

TEST(RigPlot, DrawsLinesDashedWhereIsothermalAndMeasuredPointsHollow) {
  std::vector<RigRow> rows{rig_row(0.01, 0.1, false), rig_row(1, 0.05, false),
                           rig_row(0.01, 0.12, true), rig_row(1, 0.06, true)};
  rows.push_back(rig_row(0.1, 0.08, false));
  rows.back().measured = 0.07;
  const std::string svg = rig_plot(rows, kStribeck, "model-x");
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("model-x"), std::string::npos);
  EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
  EXPECT_NE(svg.find("<circle"), std::string::npos);
}

TEST(RigPlot, DrawsBandsOfTheFigureThatItShowsAlone) {
  std::vector<RigRow> rows{rig_row(0.01, 0.1, false), rig_row(1, 0.05, false)};
  const std::string without = rig_plot(rows, kStribeck, "model-x");
  for (RigRow& row : rows) row.bands["film_ratio"] = {0.1, 0.01, 0.9};
  EXPECT_EQ(rig_plot(rows, kStribeck, "model-x"), without);
  for (RigRow& row : rows) row.bands["traction_coefficient"] = {0.01, 0.03, 0.12};
  const std::string svg = rig_plot(rows, kStribeck, "model-x");
  keep("rig_bands.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(without.find("fill-opacity"), std::string::npos);
  const std::size_t band = svg.find("fill-opacity");
  EXPECT_NE(band, std::string::npos);
  EXPECT_EQ(svg.find("fill-opacity", band + 1), std::string::npos);
}

TEST(MapPlot, DrawsACellAtEachFigureAndContourLinesThroughExactPlaces) {
  MapPicture picture;
  picture.title = "Map";
  picture.figure_title = "x + y";
  picture.x = {"Speed, m/s", {1, 2, 3}, false};
  picture.y = {"Temperature", {10, 20}, false};
  picture.maps = {{"x@1", {0, 1, 2, 10, 11, std::nan("")}}};
  picture.footer = "model-x";
  const std::string svg = map_plot(picture);
  keep("map.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text : {"x + y", "Speed, m/s", "x@1", "model-x"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  const auto count = [&svg](const char* mark) {
    std::size_t out = 0;
    for (std::size_t at = 0; (at = svg.find(mark, at)) != std::string::npos; ++at) ++out;
    return out;
  };
  EXPECT_EQ(count("<rect") - count("<clipPath"), 1 + 5 + 64U)
      << "background, figures, scale of colours";
}

TEST(SpectrumPlot, DrawsALineForEachOrder) {
  v1::ReadSpectrumResponse spectrum;
  for (int k = 1; k <= 4; ++k) spectrum.add_orders(0.5 * k);
  v1::OrderSpectrum& column = *spectrum.add_columns();
  column.set_name("mesh_force_newtons");
  for (const double amplitude : {1.0, 5.0, 0.5, 2.0}) column.add_amplitudes(amplitude);
  for (int k = 0; k < 4; ++k) column.add_phase_angles_radians(0.1 * k);
  spectrum.set_mesh_cycles(2);
  spectrum.set_samples_per_mesh_cycle(192);
  spectrum.set_is_periodic(true);
  spectrum.set_mesh_frequency_hertz(500);
  const v1::Simulation simulation = sample_curve("1", 1);
  const std::string svg = spectrum_plot(simulation, spectrum);
  keep("spectrum.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  const std::string csv = spectrum_text(simulation, spectrum, OutputFormat::kCsv);
  EXPECT_NE(csv.find("\n1,5,0.1,"), std::string::npos) << csv;
}

TEST(ViscosityPlot, DrawsALineForEachLubricantAndPressure) {
  ViscosityAnswer answer;
  for (const double celsius : {40.0, 100.0}) answer.request.add_temperatures_celsius(celsius);
  for (const double pressure : {0.0, 1e9}) answer.request.add_pressures_pascals(pressure);
  for (const double viscosity : {0.1, 300.0, 0.015, 4.0}) {
    answer.answer.add_dynamic_viscosity_pascal_seconds(viscosity);
  }
  answer.answer.set_lubricant_revision("lubricants/x@2");
  answer.answer.set_model_version("model-x");
  const std::string svg = viscosity_plot({answer});
  keep("viscosity.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text : {">x@2, ", "1 GPa", "model-x", "mPa s"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(RigText, StatesResidualsOfMeasuredPointsAndRefusals) {
  std::vector<RigRow> rows{rig_row(0.01, 0.11, false), rig_row(1, 0.05, false)};
  rows[0].measured = 0.1;
  rows[1].figures.clear();
  rows[1].refusal = "too cold";
  const std::string table = rig_text(rows, kStribeck, OutputFormat::kTable);
  EXPECT_NE(table.find(" 10 % of 1 "), std::string::npos) << table;
  EXPECT_NE(table.find("too cold"), std::string::npos);
}

TEST(RigText, StatesWarningsWithTheirPlacesInEveryForm) {
  std::vector<RigRow> rows{rig_row(0.01, 0.11, false), rig_row(0.1, 0.08, false),
                           rig_row(1, 0.05, false)};
  for (const std::size_t i : {0U, 1U}) {
    rows[i].warnings = {
        {"FILM_RATIO", "thin", v1::WARNING_LEVEL_WITHHOLDS_VERDICT, "lambda is 0.1"}};
  }
  const std::string table = rig_text(rows, kStribeck, OutputFormat::kTable);
  EXPECT_NE(table.find("at 0.01 to 0.1 m/s: lambda is 0.1. [FILM_RATIO]"), std::string::npos)
      << table;
  const std::vector<CsvLine> lines = read_csv(rig_text(rows, kStribeck, OutputFormat::kCsv));
  const auto& header = lines.front().cells;
  const auto column = static_cast<std::size_t>(std::find(header.begin(), header.end(), "warnings") -
                                               header.begin());
  EXPECT_EQ(lines.at(1).cells.at(column), "FILM_RATIO");
  EXPECT_EQ(lines.at(3).cells.at(column), "");
  const std::string json = rig_text(rows, kStribeck, OutputFormat::kJson);
  EXPECT_NE(json.find("\"level\": \"WARNING_LEVEL_WITHHOLDS_VERDICT\""), std::string::npos) << json;
  const std::string svg = rig_plot(rows, kStribeck, "m");
  EXPECT_NE(svg.find("[FILM_RATIO]"), std::string::npos);
  EXPECT_NE(svg.find("url(#hatch"), std::string::npos);
}

TEST(RigText, StatesUncertaintiesAndWhatCountsAsExact) {
  std::vector<RigRow> rows{rig_row(0.01, 0.11, false), rig_row(1, 0.05, false)};
  rows[0].bands["traction_coefficient"] = {0.0123, 0.09, 0.14};
  rows[1].bands["traction_coefficient"] = {std::nan(""), std::nan(""), std::nan("")};
  rows[1].refused_draws = 12;
  const RigDraws draws{199, {{"lubricants/x@1", {"lubricant.relaxation_time_seconds"}}}};
  const std::string table = rig_text(rows, kStribeck, OutputFormat::kTable, draws);
  EXPECT_NE(table.find("+/-"), std::string::npos) << table;
  EXPECT_NE(table.find("0.025"), std::string::npos) << table;
  EXPECT_NE(table.find(" 199 "), std::string::npos) << table;
  EXPECT_NE(table.find("relaxation time"), std::string::npos) << table;
  const std::string csv = rig_text(rows, kStribeck, OutputFormat::kCsv, draws);
  for (const char* header :
       {"traction_coefficient_standard_uncertainty,traction_coefficient_interval_minimum,"
        "traction_coefficient_interval_maximum",
        "refused_draws"}) {
    EXPECT_NE(csv.find(header), std::string::npos) << csv;
  }
  EXPECT_NE(csv.find(",0.0123,0.09,0.14,"), std::string::npos) << csv;
  EXPECT_EQ(rig_text(rows, kStribeck, OutputFormat::kCsv).find("draws"), std::string::npos);
}

TEST(MeasuredPoints, AreReadByTheNamesOfTheirColumns) {
  v1::RigCondition usual;
  usual.set_load_newtons(35);
  const auto points = read_measured(
      "traction_coefficient;entrainment_speed_metres_per_second;note\n0.1;0.02;a\n0.05;1;b\n",
      "m.csv", kStribeck, usual);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].value, 0.1);
  EXPECT_EQ(points[0].condition.load_newtons(), 35);
  EXPECT_EQ(points[1].condition.entrainment_speed_metres_per_second(), 1);
  const auto complaint = [&usual](const char* text) -> std::string {
    try {
      read_measured(text, "m.csv", kStribeck, usual);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_NE(complaint("traction_coefficient\n0.1\n").find("m.csv, line 1: "), std::string::npos);
  EXPECT_NE(complaint("traction_coefficient,entrainment_speed_metres_per_second\n0.1,x\n")
                .find("line 2: entrainment_speed_metres_per_second = \"x\""),
            std::string::npos);
}

TEST(CurvePlot, ShowsEveryFluid) {
  const std::string svg =
      curve_plot({sample_curve("1", 1), sample_curve("2", 1.25), sample_curve("3", 1.02)},
                 {{"lubricants/1", "Lubricant 1: ester-olefin copolymer"},
                  {"lubricants/2", "Lubricant 2: polyisobutylene"}});
  keep("curve.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text : {"Lubricant 1", "Lubricant 2", "lubricant 3", "tribodyn-model-2"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(CurvePlot, LeavesAGapAtASpeedWithoutResult) {
  v1::Simulation curve = sample_curve("1", 1);
  curve.mutable_result()->mutable_points(3)->clear_result();
  const std::string svg = curve_plot({curve}, {});
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(CurvePlot, BreaksTheLineWhereABranchEnds) {
  const auto lines_of = [](const v1::Simulation& curve) {
    const std::string svg = curve_plot({curve}, {});
    int lines = 0;
    for (std::size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
    return lines;
  };
  v1::Simulation curve = sample_curve("1", 1);
  const int whole = lines_of(curve);
  v1::BranchEnd* end = curve.mutable_result()->mutable_points(10)->mutable_branch_end();
  end->set_followed_to_kilometres_per_hour(69.1);
  end->set_gone_at_kilometres_per_hour(69.14);
  const int broken_below = lines_of(curve);
  EXPECT_GT(broken_below, whole);
  curve.mutable_result()->set_direction(v1::SWEEP_DIRECTION_DOWN);
  EXPECT_EQ(lines_of(curve), broken_below);
}

/// Returns the curve with a warning in a range of speeds.
v1::Simulation with_warning(v1::Simulation curve, const std::string& code, v1::WarningLevel level,
                            double from, double to) {
  for (auto& point : *curve.mutable_result()->mutable_points()) {
    const double speed = point.speed_kilometres_per_hour();
    if (speed < from || speed > to) continue;
    auto& warning = *point.mutable_result()->add_warnings();
    warning.set_code(code);
    warning.set_message("told in full by the table");
    warning.set_level(level);
    warning.set_summary("summary of " + code);
  }
  return curve;
}

TEST(CurvePlot, HasAPanelForEachFigureOnRequest) {
  const v1::Simulation curve = sample_curve("1", 1);
  const std::string plain = curve_plot({curve}, {});
  const std::string svg = curve_plot({curve}, {}, {},
                                     {{"transmission-error", "friction-torque", "boundary-ratio",
                                       "film-ratio", "temperature-rise"},
                                      75e-6});
  EXPECT_TRUE(is_well_formed(svg));
  const auto lines = [](const std::string& text) {
    int count = 0;
    for (std::size_t at = 0; (at = text.find("<polyline", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_GE(lines(svg), lines(plain) + 5);
}

TEST(CurvePlot, HatchesWhereALawIsOutsideItsRangeAndNamesItsCode) {
  const std::string plain = curve_plot({sample_curve("1", 1), sample_curve("2", 1.1)}, {});
  EXPECT_EQ(plain.find("hatch"), std::string::npos);
  const std::string svg = curve_plot(
      {with_warning(sample_curve("1", 1), "PRESSURE", v1::WARNING_LEVEL_CAUTION, 100, 120),
       sample_curve("2", 1.1)},
      {});
  keep("hatched.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  // 690 pixels hold 120 km/h; the range reaches half way to 95 and to 125 km/h.
  EXPECT_NE(svg.find("width=\"143.75\" height=\"8\" fill=\"url(#hatch0)\""), std::string::npos);
  EXPECT_NE(svg.find("summary of PRESSURE, 1 at 100 to 120 km/h [PRESSURE]"), std::string::npos);
}

TEST(CurvePlot, HatchesTheWholePanelWhereAVerdictIsWithheld) {
  const std::string svg = curve_plot({with_warning(sample_curve("1", 1), "THICK_FILM",
                                                   v1::WARNING_LEVEL_WITHHOLDS_VERDICT, 20, 140)},
                                     {});
  keep("cold.svg", svg);
  EXPECT_NE(svg.find("[THICK_FILM]"), std::string::npos);
  EXPECT_NE(svg.find("width=\"690\" height=\"350\" fill=\"url(#hatch0)\""), std::string::npos);
}

TEST(CurvePlot, ShowsANoteOnTheMethodWithoutHatching) {
  const std::string svg = curve_plot(
      {with_warning(sample_curve("1", 1), "PERIOD", v1::WARNING_LEVEL_NOTE, 60, 60)}, {});
  EXPECT_NE(svg.find("60 km/h [PERIOD]"), std::string::npos);
  EXPECT_EQ(svg.find("hatch"), std::string::npos);
}

TEST(CurvePlot, NamesModelVersionAndInputHashes) {
  v1::Simulation other = sample_curve("2", 1.1);
  other.mutable_result()->set_input_hash("fedcba9876543210");
  const std::string svg = curve_plot({sample_curve("1", 1), other}, {});
  for (const char* text : {"tribodyn-model-2", "1: abc123", "2: fedcba987654"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(CurvePlot, LabelsCurvesBySumpTemperatureWhereItDiffers) {
  std::vector<v1::Simulation> simulations = {sample_curve("lubricants/paper-fluid-1", 1),
                                             sample_curve("lubricants/paper-fluid-1", 1.2)};
  simulations[0].set_sump_temperature_celsius(40);
  simulations[1].set_sump_temperature_celsius(90);
  for (v1::Simulation& each : simulations) {
    each.mutable_result()->add_input_warnings()->set_code("EXPANSION_ESTIMATED");
  }
  const std::string svg = curve_plot(simulations, {});
  EXPECT_NE(svg.find("[EXPANSION_ESTIMATED]"), std::string::npos);
  EXPECT_NE(svg.find("sump 40 "), std::string::npos);
  EXPECT_NE(svg.find("sump 90 "), std::string::npos);
}

TEST(CurvePlot, VariantsOfAModelAreLabelledAndTheirDifferenceIsDrawnBelow) {
  std::vector<v1::Simulation> simulations = {sample_curve("lubricants/paper-fluid-1", 1),
                                             sample_curve("lubricants/paper-fluid-1", 1.25),
                                             sample_curve("lubricants/paper-fluid-1", 1)};
  simulations[1].mutable_model_options()->set_isothermal(true);
  simulations[2].mutable_inefficiency_curve()->set_direction(v1::SWEEP_DIRECTION_DOWN);
  EXPECT_EQ(variant_notes(simulations),
            (std::vector<std::string>{"recommended", "isothermal", "down-sweep"}));
  const std::string svg = curve_plot(simulations, {});
  EXPECT_NE(svg.find(">isothermal</text>"), std::string::npos);
  const auto variants = variants_of(simulations);
  ASSERT_EQ(variants.size(), 2U);
  const auto differences = relative_differences(variants[0]);
  ASSERT_FALSE(differences.empty());
  const v1::CurvePoint& first = simulations[0].result().points(0);
  const double base = first.result().inefficiency_energy_mean_percent();
  const double other =
      simulations[1].result().points(0).result().inefficiency_energy_mean_percent();
  EXPECT_EQ(differences.front().first, first.speed_kilometres_per_hour());
  EXPECT_NEAR(differences.front().second, 100 * (other / base - 1), 1e-9);
  EXPECT_GT(std::abs(differences.front().second), 1);
  EXPECT_NE(variant_report(simulations).find(signed_fixed(differences.front().second, 2)),
            std::string::npos);
}

TEST(CurvePlot, CutsALongTitleWithAnEllipsis) {
  const std::string svg = curve_plot({sample_curve("1", 1)},
                                     {{"lubricants/1", "An oil with quite a long name 75W-90"}});
  EXPECT_NE(svg.find(">An oil with quite a\xE2\x80\xA6</text>"), std::string::npos);
  EXPECT_EQ(svg.find("lubricant 1"), std::string::npos);
  // Without a title the label is the id, uncut if it fits.
  const std::string untitled = curve_plot(
      {sample_curve("mineral-80w90", 1), sample_curve("a-very-long-name-of-an-oil", 1)}, {});
  EXPECT_NE(untitled.find(">mineral-80w90</text>"), std::string::npos);
  EXPECT_NE(untitled.find(">a-very-long-name-of\xE2\x80\xA6</text>"), std::string::npos);
}

TEST(Looks, DifferInColourOrDashesAndNoMainLineLooksLikeASideLine) {
  std::set<std::pair<std::string, std::string>> looks;
  std::set<std::string> main_dashes;
  std::set<std::string> side_dashes;
  for (std::size_t i = 0; i < kDistinctLooks; ++i) {
    const Look look = look_of(i);
    looks.emplace(look.colour, look.dashes);
    main_dashes.insert(look.dashes);
    side_dashes.insert(look.side_dashes);
  }
  EXPECT_EQ(looks.size(), kDistinctLooks);
  for (const std::string& dashes : main_dashes) EXPECT_EQ(side_dashes.count(dashes), 0U) << dashes;
  EXPECT_THROW(look_of(kDistinctLooks), std::out_of_range);
}

TEST(CurvePlot, DrawsTwelveFluidsWithTwelveLooks) {
  std::vector<v1::Simulation> curves;
  for (int i = 0; i < 12; ++i) {
    curves.push_back(sample_curve("oil-" + std::to_string(i), 1 + 0.05 * i));
  }
  const std::string svg = curve_plot(curves, {});
  keep("twelve.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  // Main lines are 2.4 wide; samples in front of the labels are lines, not polylines.
  std::set<std::string> strokes;
  const std::string width = "stroke-width=\"2.4\"";
  for (std::size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) {
    const std::string tag = svg.substr(at, svg.find("/>", at) - at);
    if (tag.find(width) == std::string::npos) continue;
    strokes.insert(tag.substr(tag.find("stroke=")));
  }
  EXPECT_EQ(strokes.size(), 12U);
}

TEST(Labels, HaveTheContrastOfSmallTextOnWhite) {
  EXPECT_EQ(legible_on_white("#000000"), "#000000");
  EXPECT_EQ(legible_on_white("#0072b2"), "#0072b2");  // contrast 5.2 to 1
  EXPECT_NE(legible_on_white("#e69f00"), "#e69f00");  // contrast 2.3 to 1
  const std::string svg =
      curve_plot({sample_curve("1", 1), sample_curve("2", 1), sample_curve("3", 1),
                  sample_curve("4", 1), sample_curve("5", 1), sample_curve("6", 1)},
                 {});
  EXPECT_EQ(svg.find("fill=\"#e69f00\" font-weight"), std::string::npos);
  EXPECT_EQ(svg.find("fill=\"#56b4e9\" font-weight"), std::string::npos);
  EXPECT_NE(svg.find("fill=\"" + legible_on_white("#e69f00") + "\" font-weight"),
            std::string::npos);
}

TEST(Panels, MarkTheBreakOfAnAxisWithoutZero) {
  const auto points_of_axis = [](double low, double high, bool arbitrary_zero) {
    Panel panel;
    panel.corner = {100, 50};
    panel.width = 300;
    panel.height = 200;
    panel.has_arbitrary_zero = arbitrary_zero;
    panel.series.push_back({});
    panel.series.back().x = {0, 1};
    panel.series.back().y = {low, high};
    Svg svg(500, 300);
    draw_panel(panel, svg);
    const std::string text = svg.finish();
    const std::size_t start = text.find("<polyline points=\"100,250");
    const std::string points = text.substr(start, text.find('"', start + 18) - start);
    return std::count(points.begin(), points.end(), ',');
  };
  EXPECT_EQ(points_of_axis(0, 1, false), 2);
  EXPECT_EQ(points_of_axis(-1, 1, false), 2);
  EXPECT_EQ(points_of_axis(5, 6, false), 6);
  EXPECT_EQ(points_of_axis(-6, -5, false), 6);
  EXPECT_EQ(points_of_axis(5, 6, true), 2);
}

TEST(CurvePlot, AcceptsOnePointAndNoPoint) {
  v1::Simulation curve = sample_curve("1", 1);
  curve.mutable_result()->mutable_points()->DeleteSubrange(1, 24);
  EXPECT_TRUE(is_well_formed(curve_plot({curve}, {})));
  curve.mutable_result()->clear_points();
  EXPECT_TRUE(is_well_formed(curve_plot({curve}, {})));
  EXPECT_TRUE(is_well_formed(curve_plot({}, {})));
}

TEST(ContactLossBands, ReachHalfWayToTheNeighboursAndMerge) {
  using Bands = std::vector<std::pair<double, double>>;
  EXPECT_EQ(contact_loss_bands({sample_curve("1", 1), sample_curve("2", 1)}),
            (Bands{{62.5, 82.5}}));
  v1::Simulation curve = sample_curve("1", 1);
  for (auto& point : *curve.mutable_result()->mutable_points()) {
    point.mutable_result()->set_contact_loss(point.speed_kilometres_per_hour() < 21);
  }
  EXPECT_EQ(contact_loss_bands({curve}), (Bands{{20, 22.5}}));
}

TEST(HistoryPlot, DrawsTheFlanksOfOneQuantityInOnePanel) {
  const std::string svg = history_plot(sample_point(), sample_history(), "Axle oil 75W-90: PAO");
  keep("history.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text : {"Mesh force, N", "Flank load, N", "flank 2", "Time, ms"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(is_well_formed(history_plot(sample_point(), {}, "")));
}

TEST(HistoryPlot, DrawsTemperaturesInDegreesCelsius) {
  v1::History history;
  for (const char* name : {"time_seconds", "flank_contact_temperature_kelvin_flank_0"}) {
    auto& column = *history.add_columns();
    column.set_name(name);
    for (const double value : {373.15, 393.15}) {
      column.add_values(history.columns_size() == 1 ? value - 373.15 : value);
    }
  }
  const std::string svg = history_plot(sample_point(), history, "");
  EXPECT_NE(svg.find(">100</text>"), std::string::npos);
  EXPECT_EQ(svg.find(">380</text>"), std::string::npos);
}

TEST(HistoryPlot, ConnectsALabelWithALineThatEndsBeforeTheFrame) {
  v1::History history = sample_history();
  const auto leaders = [](const std::string& svg) {
    int count = 0;
    for (std::size_t at = 0; (at = svg.find("1.5 2.5", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  history.mutable_columns(4)->set_name("flank_film_ratio_flank_2");
  history.mutable_columns(3)->set_name("flank_film_ratio_flank_1");
  const int before = leaders(history_plot(sample_point(), history, ""));
  auto& values = *history.mutable_columns(4)->mutable_values();
  for (int row = values.size() / 2; row < values.size(); ++row) values[row] = 0;  // no contact
  EXPECT_EQ(leaders(history_plot(sample_point(), history, "")), before + 1);
}

TEST(HistoryPlot, NamesModelVersionInputHashAndWarnings) {
  const std::string svg = history_plot(sample_point(), sample_history(), "");
  for (const char* text : {"tribodyn-model-2", "abc123", "[FILM_RATIO_LOW]"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(ColumnTitle, ScalesUnits) {
  EXPECT_EQ(column_title("dynamic_transmission_error_metres").title,
            "Dynamic transmission error, \xC2\xB5m");
  EXPECT_EQ(column_title("dynamic_transmission_error_metres").factor, 1e6);
  EXPECT_EQ(column_title("flank_film_ratio_flank_1").title, "Flank film ratio");
  EXPECT_EQ(column_title("pinion_speed_radians_per_second").title, "Pinion speed, rad/s");
}

}  // namespace
}  // namespace tribodyn::client
