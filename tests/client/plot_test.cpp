#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <stack>
#include <string>

#include "client/cpp/plot/curve_plot.h"
#include "client/cpp/plot/history_plot.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/plot/svg.h"
#include "tests/client/sample_simulations.h"

namespace tribodyn::client {
namespace {

/// Whether tags nest and text holds no bare markup: enough of XML for what Svg writes.
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

/// Keeps the picture for a look when TRIBODYN_TEST_PICTURES names a folder.
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

TEST(CurvePlot, ShowsEveryFluidTheBandsAndTheCaption) {
  const std::string svg =
      curve_plot({sample_curve("1", 1), sample_curve("2", 1.25), sample_curve("3", 1.02)},
                 {{"lubricants/1", "Lubricant 1: ester-olefin copolymer"},
                  {"lubricants/2", "Lubricant 2: polyisobutylene"}});
  keep("curve.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text :
       {"Lubricant 1", "ester-olefin copolymer", "Lubricant 2", "lubricant 3", "tribodyn-model-2",
        "sump 40 \xC2\xB0\x43", "up-sweep", "Mesh loss, W"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(CurvePlot, LeavesAGapWhereASpeedWasRefused) {
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
  end->set_followed_to_kilometers_per_hour(69.1);
  end->set_gone_at_kilometers_per_hour(69.14);
  const int broken_below = lines_of(curve);
  EXPECT_GT(broken_below, whole);
  EXPECT_NE(curve_plot({curve}, {}).find("the response jumps"), std::string::npos);
  curve.mutable_result()->set_direction(v1::DOWN);
  EXPECT_EQ(lines_of(curve), broken_below);
}

TEST(CurvePlot, SurvivesOnePointAndNone) {
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
    point.mutable_result()->set_contact_loss(point.speed_kilometers_per_hour() < 21);
  }
  EXPECT_EQ(contact_loss_bands({curve}), (Bands{{20, 22.5}}));
}

TEST(HistoryPlot, PutsTheFlanksOfOneQuantityTogether) {
  const std::string svg = history_plot(sample_point(), sample_history());
  keep("history.svg", svg);
  EXPECT_TRUE(is_well_formed(svg));
  for (const char* text : {"Mesh force, N", "Flank load, N", "flank 2", "Time, ms"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(is_well_formed(history_plot(sample_point(), {})));
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
