// The figures of the paper with a real tribodynd: every verdict and number that `tribodyn paper`
// states, within the bounds of tests/data/paper_findings.csv around what was obtained.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/paper/paper_report.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/service/paper_studies.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "tests/service/server_process.h"
#include "tests/support/paths.h"

namespace tribodyn::client {
namespace {

/// One number of one statement.
struct StatedNumber {
  std::string verdict;
  std::string value;  // empty: the statement has no numbers
  std::string bound;  // absolute
};
using StatedNumbers = std::map<std::string, StatedNumber>;

StatedNumbers stated_numbers(const std::string& csv) {
  StatedNumbers out;
  bool is_header = true;
  for (const CsvLine& line : read_csv(csv)) {
    if (!std::exchange(is_header, false)) {
      const auto& cells = line.cells;
      const std::string key = cells[0] + " | " + cells[1] + " | " + cells[3] + " | " + cells[5];
      out[key] = {cells[2], cells[6], cells.size() > 7 ? cells[7] : ""};
    }
  }
  return out;
}

/// Returns the findings with the bounds of the file before, and with new ones where it has none:
/// twice the tolerance of the points.
std::string with_bounds(const std::string& csv, const StatedNumbers& before) {
  std::string out;
  for (const CsvLine& line : read_csv(csv)) {
    std::vector<std::string> cells = line.cells;
    const auto known =
        before.find(cells[0] + " | " + cells[1] + " | " + cells[3] + " | " + cells[5]);
    if (out.empty()) {
      cells.emplace_back("bound");
    } else if (known != before.end() || cells[6].empty()) {
      cells.push_back(known != before.end() ? known->second.bound : "");
    } else {
      cells.push_back(significant(std::max(1e-9, 2e-3 * std::abs(std::stod(cells[6]))), 1));
    }
    out += csv_line(cells);
  }
  return out;
}

class Paper : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::filesystem::temp_directory_path() /
              ("tribodyn_paper_test." + std::to_string(getpid()));
    std::filesystem::create_directory(folder_);
    const std::string port_file = folder_ / "port";
    process_ = std::make_unique<server::ServerProcess>(
        std::vector<std::string>{"--listen", "127.0.0.1:0", "--database", folder_ / "db.sqlite",
                                 "--port-file", port_file},
        folder_ / "log");
    const std::string address = server::wait_for_address(port_file, *process_);
    ASSERT_FALSE(address.empty()) << process_->log();
    Connection connection(address, std::chrono::seconds(120));
    std::vector<const PaperFigure*> figures;
    for (const PaperFigure& figure : paper_figures()) figures.push_back(&figure);
    results_ = compute_paper_studies(figures, connection, ProgressForm::kNone);
    for (const PaperFigure* figure : figures) {
      chapters_.push_back(paper_chapter(*figure, results_));
    }
  }
  static void TearDownTestSuite() {
    process_.reset();
    std::filesystem::remove_all(folder_);
  }

  static inline PaperResults results_;
  static inline std::vector<PaperChapter> chapters_;

 private:
  static inline std::filesystem::path folder_;
  static inline std::unique_ptr<server::ServerProcess> process_;
};

TEST_F(Paper, EveryStatementHasTheVerdictAndTheNumbersObtained) {
  const std::string path = test_data_file("paper_findings.csv");
  std::ifstream file(path);
  const StatedNumbers expected =
      stated_numbers({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
  const std::string csv = paper_csv(chapters_);
  if (std::getenv("TRIBODYN_RENEW_PAPER") != nullptr) {
    std::ofstream(path) << with_bounds(csv, expected);
    GTEST_SKIP() << "wrote " << path;
  }
  const StatedNumbers obtained = stated_numbers(csv);
  EXPECT_EQ(obtained.size(), expected.size());
  for (const auto& [key, number] : obtained) {
    const auto found = expected.find(key);
    if (found == expected.end()) {
      ADD_FAILURE() << key << " is not in " << path << "; TRIBODYN_RENEW_PAPER=1 writes it";
      continue;
    }
    EXPECT_EQ(number.verdict, found->second.verdict) << key;
    if (found->second.value.empty()) continue;
    EXPECT_NEAR(std::stod(number.value), std::stod(found->second.value),
                std::stod(found->second.bound))
        << key;
  }
}

TEST_F(Paper, AllFiguresAreCheapAtAnErrorOfAThousandth) {
  std::map<std::string, std::int64_t> right_hand_sides;  // by simulation: figures share some
  for (const PaperFigure& figure : paper_figures()) {
    for (const PaperCurve& curve : figure.curves) {
      EXPECT_LE(results_.largest_error(curve), 1e-3) << figure.name;
      const v1::Simulation& simulation = results_.of(curve);
      std::int64_t& count = right_hand_sides[simulation.name()];
      count = 0;
      for (const v1::CurvePoint& point : simulation.result().points()) {
        count += point.result().statistics().right_hand_sides();
      }
    }
  }
  std::int64_t sum = 0;
  for (const auto& [name, count] : right_hand_sides) sum += count;
  EXPECT_LT(sum, 4'000'000) << "as many as one rattling point takes; 2.3 million when written";
}

TEST_F(Paper, FiguresHaveTheNumbersOfThePaperAndEachHasAPictureAndStatements) {
  std::vector<std::string> names;
  for (const PaperChapter& chapter : chapters_) {
    names.push_back(chapter.figure->name);
    EXPECT_FALSE(chapter.findings.empty()) << names.back();
    EXPECT_EQ(chapter.picture.empty(), names.back() == "conclusions") << names.back();
    EXPECT_EQ(chapter.picture.find("nan,"), std::string::npos) << names.back();
    // Where the model contradicts the paper, other laws stand beside it.
    for (const Finding& finding : chapter.findings) {
      if (!contradicts(finding.verdict) || names.back() == "conclusions") continue;
      EXPECT_FALSE(chapter.variants.empty()) << names.back() << ": " << finding.statement;
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"5", "6", "7", "8", "9", "10", "11", "12", "13", "14",
                                             "15", "16", "conclusions"}));
}

TEST_F(Paper, EveryTextEndsWithinItsPicture) {
  const std::regex text_element(
      R"re(<text x="([0-9.]+)"[^>]* font-size="([0-9.]+)"([^>]*)>([^<]*)<)re");
  const std::regex picture_width(R"re(^<svg [^>]*width="([0-9.]+)")re");
  for (const PaperChapter& chapter : chapters_) {
    const std::string& picture = chapter.picture;
    if (picture.empty()) continue;
    std::smatch width;
    ASSERT_TRUE(std::regex_search(picture, width, picture_width));
    int texts = 0;
    for (std::sregex_iterator at(picture.begin(), picture.end(), text_element), end; at != end;
         ++at, ++texts) {
      if ((*at)[3].str().find("text-anchor") != std::string::npos) continue;
      EXPECT_LE(std::stod((*at)[1]) + text_width((*at)[4].str(), std::stod((*at)[2])),
                std::stod(width[1]))
          << heading_of(*chapter.figure) << ": " << (*at)[4];
    }
    EXPECT_GT(texts, 10);
  }
}

TEST_F(Paper, ThePageHoldsEveryPictureAndNeedsNothingElse) {
  const std::string page = paper_page(chapters_, results_);
  for (const PaperChapter& chapter : chapters_) {
    EXPECT_NE(page.find(xml_escaped(heading_of(*chapter.figure))), std::string::npos);
    for (const Finding& finding : chapter.findings) {
      EXPECT_NE(page.find(xml_escaped(finding.statement)), std::string::npos);
    }
  }
  for (const char* outside : {" src=", "<script", "href=\"http", "url(http", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
}

}  // namespace
}  // namespace tribodyn::client
