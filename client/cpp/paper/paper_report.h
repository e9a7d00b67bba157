#pragma once

#include <string>
#include <vector>

#include "client/cpp/paper/figure.h"

namespace tribodyn::client {

/// A figure with its results.
struct PaperChapter {
  const PaperFigure* figure;
  std::vector<Finding> findings;
  std::vector<Evidence> variants;
  std::string picture;  ///< SVG; empty for the conclusions
};
PaperChapter paper_chapter(const PaperFigure& figure, const PaperResults& results);

/// Returns "Figure 10: ..." or the title of the conclusions.
std::string heading_of(const PaperFigure& figure);

/// Returns statements, verdicts and numbers for a terminal.
std::string paper_text(const std::vector<PaperChapter>& chapters);
/// One line for each number: figure, statement, verdict, quantity, unit, at, value.
std::string paper_csv(const std::vector<PaperChapter>& chapters);
/// An object with the chapters, their findings and the numbers of each.
std::string paper_json(const std::vector<PaperChapter>& chapters);
/// Returns one page (HTML) with all pictures that needs no other file.
std::string paper_page(const std::vector<PaperChapter>& chapters, const PaperResults& results);

}  // namespace tribodyn::client
