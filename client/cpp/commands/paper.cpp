#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>

#include "client/cpp/commands/command.h"
#include "client/cpp/paper/paper_report.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/service/paper_studies.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct PaperFlags {
  std::vector<const PaperFigure*> figures;  ///< empty: all
  std::string folder;                       ///< empty: none
  std::optional<OutputFormat> format;       ///< as in --output of other commands
};

std::string names_of_figures() {
  std::vector<std::string> names;
  for (const PaperFigure& figure : paper_figures()) names.push_back(figure.name);
  return joined(names, "|");
}

bool add_figure(const std::string& name, PaperFlags& flags) {
  const auto& figures = paper_figures();
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const PaperFigure& each) { return each.name == name; });
  if (found == figures.end()) return false;
  flags.figures.push_back(&*found);
  return true;
}

/// Makes the folder unless it exists.
void make_folder(const std::string& path) {
  if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) {
    throw Failure(kExitFailed, "cannot make the folder " + path + ": " + std::strerror(errno));
  }
}

/// Returns e.g. "paper/figure-05.svg".
std::string file_of(const std::string& folder, const PaperFigure& figure, const char* extension) {
  std::string number = figure.name;
  if (number.size() == 1) number.insert(0, "0");
  return folder + "/figure-" + number + extension;
}

void write_folder(const std::string& folder, const std::vector<PaperChapter>& chapters,
                  const PaperResults& results) {
  for (const PaperChapter& chapter : chapters) {
    if (chapter.picture.empty()) continue;
    write_file(file_of(folder, *chapter.figure, ".svg"), chapter.picture);
    std::vector<v1::Simulation> curves;
    for (const PaperCurve& curve : chapter.figure->curves) curves.push_back(results.of(curve));
    if (!curves.empty()) {
      write_file(file_of(folder, *chapter.figure, ".csv"), points_csv(curves));
    }
  }
  write_file(folder + "/findings.csv", paper_csv(chapters));
  write_file(folder + "/index.html", paper_page(chapters, results));
}

int run_paper(const PaperFlags& flags, const CommonOptions& options) {
  std::vector<const PaperFigure*> figures = flags.figures;
  if (figures.empty()) {
    for (const PaperFigure& figure : paper_figures()) figures.push_back(&figure);
  }
  if (!flags.folder.empty()) make_folder(flags.folder);
  Connection connection = options.connect();
  const PaperResults results = compute_paper_studies(figures, connection, options.progress_form());
  std::vector<PaperChapter> chapters;
  for (const PaperFigure* figure : figures) chapters.push_back(paper_chapter(*figure, results));
  switch (flags.format.value_or(options.output_format)) {
    case OutputFormat::kTable:
      std::cout << paper_text(chapters);
      break;
    case OutputFormat::kCsv:
      std::cout << paper_csv(chapters);
      break;
    case OutputFormat::kJson:
      std::cout << paper_json(chapters);
  }
  if (!flags.folder.empty()) {
    write_folder(flags.folder, chapters, results);
    std::cout.flush();
    std::cerr << "pictures and page: " << flags.folder << "/index.html\n";
  }
  return kExitOk;
}

}  // namespace

Command paper_command() {
  const auto flags = std::make_shared<PaperFlags>();
  Command command{
      "paper",
      "figures 5 to 16 of the paper, beside what the paper states about them",
      "Computes the studies of the figures of Paouris et al. 2018 and says of each statement "
      "whether the corrected model confirms it, with the numbers. Where it contradicts the paper, "
      "the variants tried stand there: other laws, and the misprints of the paper. The model "
      "has the preset `paper` (--model-preset of other commands).",
      {"tribodyn paper --output paper", "tribodyn paper 10 --output paper",
       "tribodyn paper 6 7 --output csv"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags.choices("figure", names_of_figures(),
                        "Figures of the paper: " + names_of_figures() + ". Default: all.",
                        [flags](const std::string& name) { return add_figure(name, *flags); });
  command.flags.group("Files");
  command.flags.text(
      "--output,-o", "DIR",
      "Also write a page with all pictures (index.html), each picture (SVG), its points (CSV) and "
      "the numbers of all statements (findings.csv) into this folder, which is made if need be. "
      "table, csv or json set the form of standard output instead, as in every command; "
      "./csv is a folder.",
      [flags](const std::string& text) {
        constexpr const char* kForms[] = {"table", "csv", "json"};
        const auto* form = std::find(std::begin(kForms), std::end(kForms), text);
        if (form == std::end(kForms)) {
          flags->folder = text;
        } else {
          flags->format = static_cast<OutputFormat>(form - std::begin(kForms));
        }
      });
  command.check = [](Complaints&) {};
  command.run = [flags](const CommonOptions& options) { return run_paper(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
