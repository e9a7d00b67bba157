#include "client/cpp/paper/paper_report.h"

#include <algorithm>
#include <array>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/report/html.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/output.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kPaper[] =
    "Paouris, Rahmani, Theodossiades, Rahnejat, Hunt, Barton: Inefficiency Predictions in a Hypoid "
    "Gear Pair through Tribodynamics Analysis (2018)";

std::string number_text(double value) { return significant(value, 4); }

std::string quantity_text(const Evidence& evidence) {
  return evidence.quantity + (evidence.unit.empty() ? "" : ", " + evidence.unit);
}

/// Evidence as a matrix: a row for each quantity, a column for each place.
struct Matrix {
  std::vector<std::string> places;  ///< in their first order; without "" for single numbers
  struct Row {
    std::string quantity;
    std::vector<std::string> cells;
  };
  std::vector<Row> rows;
  std::vector<Row> singles;  ///< one cell each
};

Matrix matrix_of(const std::vector<Evidence>& evidence) {
  Matrix out;
  for (const Evidence& each : evidence) {
    if (each.at.empty() || std::count(out.places.begin(), out.places.end(), each.at) > 0) continue;
    out.places.push_back(each.at);
  }
  for (const Evidence& each : evidence) {
    const std::string quantity = quantity_text(each);
    if (each.at.empty()) {
      out.singles.push_back({quantity, {number_text(each.value)}});
      continue;
    }
    auto row = std::find_if(out.rows.begin(), out.rows.end(),
                            [&](const Matrix::Row& known) { return known.quantity == quantity; });
    if (row == out.rows.end()) {
      row = out.rows.insert(row, {quantity, std::vector<std::string>(out.places.size())});
    }
    const auto column = std::find(out.places.begin(), out.places.end(), each.at);
    row->cells[static_cast<std::size_t>(column - out.places.begin())] = number_text(each.value);
  }
  return out;
}

std::string text_table(const std::vector<Evidence>& evidence) {
  if (evidence.empty()) return "";
  const Matrix matrix = matrix_of(evidence);
  std::string out;
  if (!matrix.rows.empty()) {
    std::vector<Table::Column> columns{{"", "", Table::Align::kLeft}};
    for (const std::string& place : matrix.places) {
      columns.push_back({place, "", Table::Align::kDecimal});
    }
    Table table(columns);
    for (const auto& [quantity, cells] : matrix.rows) {
      std::vector<std::string> row{quantity};
      row.insert(row.end(), cells.begin(), cells.end());
      table.add_row(std::move(row));
    }
    out += table.text();
  }
  for (const auto& [quantity, cells] : matrix.singles) out += quantity + ": " + cells[0] + "\n";
  std::string indented;
  for (const std::string& line : split(out, '\n')) {
    if (!line.empty()) indented += "      " + line + "\n";
  }
  return indented;
}

std::string html_table(const std::vector<Evidence>& evidence) {
  if (evidence.empty()) return "";
  const Matrix matrix = matrix_of(evidence);
  std::string out = "<table>\n";
  if (!matrix.rows.empty()) {
    std::vector<std::string> header{""};
    header.insert(header.end(), matrix.places.begin(), matrix.places.end());
    out += html_row(header, "th");
    for (const auto& [quantity, cells] : matrix.rows) {
      std::vector<std::string> row{quantity};
      row.insert(row.end(), cells.begin(), cells.end());
      out += html_row(row, "td");
    }
  }
  for (const auto& [quantity, cells] : matrix.singles) {
    out += html_row({quantity, cells[0]}, "td");
  }
  return out + "</table>\n";
}

std::string badge(Verdict verdict) {
  const VerdictLook& look = verdict_look(verdict);
  return std::string("<span class=\"verdict ") + look.style + "\">" + look.text + "</span>";
}

/// Returns e.g. "figure-10" for file names and anchors.
std::string anchor_of(const PaperFigure& figure) {
  return figure.name == "conclusions" ? figure.name : "figure-" + figure.name;
}

std::string accuracy_text(const PaperFigure& figure, const PaperResults& results) {
  double largest = 0;
  for (const PaperCurve& curve : figure.curves) {
    largest = std::max(largest, results.largest_error(curve));
  }
  std::string out = "Model version " + results.model_version() + ".";
  if (!figure.curves.empty()) {
    out += " Largest estimated relative error of a point: " + significant(largest, 2) + ".";
  }
  return out;
}

std::string picture_of(const PaperFigure& figure, const std::vector<Finding>& findings,
                       const PaperResults& results) {
  std::vector<Panel> panels = figure.panels(results);
  if (panels.empty()) return "";
  constexpr double kWidth = 960, kLeft = 70, kPanelWidth = 690, kPanelHeight = 300, kPitch = 390,
                   kHeadingTop = 36, kHeadingSize = 17, kHeadingPitch = 22, kStatementSize = 12.5,
                   kStatementPitch = 20, kStatementLeft = kLeft + 165;
  const std::vector<std::string> heading =
      text_lines(heading_of(figure), kHeadingSize, kWidth - 2 * kLeft);
  std::vector<std::vector<std::string>> statements;
  double statements_height = 0;
  for (const Finding& finding : findings) {
    statements.push_back(
        text_lines(finding.statement, kStatementSize, kWidth - kLeft - kStatementLeft));
    statements_height += kStatementPitch * static_cast<double>(statements.back().size());
  }
  const std::vector<std::string> below =
      footer_lines({figure.studied, accuracy_text(figure, results)}, kWidth - 2 * kLeft);
  double top = kHeadingTop + kHeadingPitch * static_cast<double>(heading.size()) + 26;
  const double statements_top =
      top + kPitch * static_cast<double>(panels.size() - 1) + kPanelHeight + 70;
  const double footer_top = statements_top + statements_height + 8;
  Svg svg(kWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  double y = kHeadingTop;
  for (const std::string& line : heading) {
    svg.text({kLeft, y}, line, {kHeadingSize, "start", "#111", true, 0});
    y += kHeadingPitch;
  }
  for (Panel& panel : panels) {
    panel.corner = {kLeft, top};
    panel.width = kPanelWidth;
    panel.height = kPanelHeight;
    draw_panel(panel, svg);
    top += kPitch;
  }
  y = statements_top;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const VerdictLook& look = verdict_look(findings[i].verdict);
    svg.text({kLeft, y}, look.text, {kStatementSize, "start", look.colour, true, 0});
    for (const std::string& line : statements[i]) {
      svg.text({kStatementLeft, y}, line, {kStatementSize, "start", "#222", false, 0});
      y += kStatementPitch;
    }
  }
  draw_footer(below, {kLeft, footer_top}, svg);
  return svg.finish();
}

std::string summary_table(const std::vector<PaperChapter>& chapters) {
  std::string out =
      "<table>\n<tr><th></th><th style=\"text-align: left\">statement of the "
      "paper</th><th>verdict</th></tr>\n";
  for (const PaperChapter& chapter : chapters) {
    const std::string name =
        chapter.figure->name == "conclusions" ? "conclusions" : "figure " + chapter.figure->name;
    for (const Finding& finding : chapter.findings) {
      out += "<tr><td><a href=\"#" + anchor_of(*chapter.figure) + "\">" + name +
             "</a></td><td style=\"text-align: left\">" + xml_escaped(finding.statement) +
             "</td><td>" + badge(finding.verdict) + "</td></tr>\n";
    }
  }
  return out + "</table>\n";
}

std::string tally(const std::vector<PaperChapter>& chapters) {
  std::array<int, kVerdictLooks.size()> counts{};
  for (const PaperChapter& chapter : chapters) {
    for (const Finding& finding : chapter.findings)
      ++counts.at(static_cast<std::size_t>(finding.verdict));
  }
  std::string out;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int count = counts.at(i);
    if (count == 0) continue;
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + kVerdictLooks.at(i).text;
  }
  return out;
}

/// Returns name, inputs and hash of each simulation of a figure.
std::string simulations_table(const PaperFigure& figure, const PaperResults& results) {
  std::string out = "<table>\n" + html_row({"simulation", "lubricant",
                                            "what differs from cruise "
                                            "on gear set A at 40 C, up-sweep",
                                            "hash of the inputs (SHA-256)"},
                                           "th");
  for (const PaperCurve& curve : figure.curves) {
    const v1::Simulation& simulation = results.of(curve);
    std::vector<std::string> differences;
    if (curve.gear_set != PaperCurve().gear_set) differences.push_back(curve.gear_set);
    if (curve.sump_temperature_celsius != PaperCurve().sump_temperature_celsius) {
      differences.push_back("sump " + significant(curve.sump_temperature_celsius) + " C");
    }
    if (!curve.switches.empty()) {
      differences.push_back(model_options_text(simulation.model_options()));
    }
    if (curve.is_down_sweep) differences.emplace_back("down-sweep");
    if (!curve.speeds.empty()) {
      differences.push_back(std::to_string(curve.speeds.size()) + " speeds from " +
                            significant(curve.speeds.front()) + " to " +
                            significant(curve.speeds.back()) + " km/h");
    }
    out += "<tr><td>" + xml_escaped(simulation.name()) + "</td><td>" +
           xml_escaped(simulation.lubricant_revision()) + "</td><td>" +
           xml_escaped(joined(differences, ", ")) + "</td><td class=\"hash\">" +
           xml_escaped(simulation.result().input_hash()) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string chapter_html(const PaperChapter& chapter, const PaperResults& results) {
  const PaperFigure& figure = *chapter.figure;
  std::string out = "<h2 id=\"" + anchor_of(figure) + "\">" + xml_escaped(heading_of(figure)) +
                    "</h2>\n" + html_paragraph(figure.studied);
  if (!chapter.picture.empty()) {
    out += html_figure(chapter.picture, anchor_of(figure) + "-", heading_of(figure));
  }
  for (const Finding& finding : chapter.findings) {
    out += "<div class=\"finding\"><p>" + badge(finding.verdict) + " <b>" +
           xml_escaped(finding.statement) + "</b></p>\n<p class=\"rule\">" +
           xml_escaped(finding.rule) + "</p>\n" + html_table(finding.evidence) + "</div>\n";
  }
  if (!chapter.variants.empty()) {
    out += html_paragraph("Variants tried. " + figure.variants_title + ".") +
           html_table(chapter.variants);
  }
  if (!figure.curves.empty()) {
    out += html_closed_part("Simulations of this figure", simulations_table(figure, results));
  }
  return out;
}

/// One number of a finding or of a variant as a row of CSV.
CsvRow number_row(const PaperFigure& figure, const std::string& statement,
                  const std::string& verdict, const Evidence& evidence) {
  return {{"figure", figure.name},
          {"statement", statement},
          {"verdict", verdict},
          {"quantity", evidence.quantity},
          {"unit", evidence.unit},
          {"at", evidence.at},
          {"value", shortest(evidence.value)}};
}

std::string numbers_json(const std::vector<Evidence>& evidence) {
  std::string out = "[";
  for (const Evidence& each : evidence) {
    out += (out.size() == 1 ? "" : ", ") + ("{\"quantity\": " + json_quoted(each.quantity)) +
           ", \"unit\": " + json_quoted(each.unit) + ", \"at\": " + json_quoted(each.at) +
           ", \"value\": " + shortest(each.value) + "}";
  }
  return out + "]";
}

}  // namespace

PaperChapter paper_chapter(const PaperFigure& figure, const PaperResults& results) {
  PaperChapter out{&figure, figure.findings(results), {}, ""};
  if (figure.variants != nullptr) out.variants = figure.variants(results);
  out.picture = picture_of(figure, out.findings, results);
  return out;
}

std::string heading_of(const PaperFigure& figure) {
  return figure.name == "conclusions" ? figure.title
                                      : "Figure " + figure.name + ": " + figure.title;
}

std::string paper_text(const std::vector<PaperChapter>& chapters) {
  std::string out;
  for (const PaperChapter& chapter : chapters) {
    out += (out.empty() ? "" : "\n") + heading_of(*chapter.figure) + "\n" +
           wrapped(chapter.figure->studied, 0) + "\n";
    for (const Finding& finding : chapter.findings) {
      out += std::string("  ") + verdict_look(finding.verdict).text + ": " + finding.statement +
             "\n" + wrapped(finding.rule, 6) + text_table(finding.evidence);
    }
    if (chapter.variants.empty()) continue;
    out += "\n" + wrapped("Variants tried. " + chapter.figure->variants_title + ":", 2) +
           text_table(chapter.variants);
  }
  return out + "\n" + tally(chapters) + "\n";
}

std::string paper_csv(const std::vector<PaperChapter>& chapters) {
  std::vector<CsvRow> rows;
  for (const PaperChapter& chapter : chapters) {
    for (const Finding& finding : chapter.findings) {
      std::vector<Evidence> numbers = finding.evidence;
      if (numbers.empty()) numbers.push_back({"", "", "", 0});
      for (const Evidence& evidence : numbers) {
        rows.push_back(number_row(*chapter.figure, finding.statement,
                                  verdict_look(finding.verdict).text, evidence));
        if (evidence.quantity.empty()) rows.back().back().second = "";
      }
    }
    for (const Evidence& evidence : chapter.variants) {
      rows.push_back(number_row(*chapter.figure, "", "variant", evidence));
    }
  }
  return csv_text(rows);
}

std::string paper_json(const std::vector<PaperChapter>& chapters) {
  std::string out = "{\"figures\": [";
  for (const PaperChapter& chapter : chapters) {
    out += (&chapter == &chapters.front() ? "\n" : ",\n") +
           (" {\"figure\": " + json_quoted(chapter.figure->name)) +
           ", \"title\": " + json_quoted(chapter.figure->title) + ", \"findings\": [";
    for (const Finding& finding : chapter.findings) {
      out += (&finding == &chapter.findings.front() ? "\n" : ",\n") +
             ("  {\"statement\": " + json_quoted(finding.statement)) +
             ", \"verdict\": " + json_quoted(verdict_look(finding.verdict).text) +
             ", \"rule\": " + json_quoted(finding.rule) +
             ", \"numbers\": " + numbers_json(finding.evidence) + "}";
    }
    out += "], \"variants\": " + numbers_json(chapter.variants) + "}";
  }
  return out + "\n]}\n";
}

std::string paper_page(const std::vector<PaperChapter>& chapters, const PaperResults& results) {
  std::string body =
      html_paragraph(
          std::string("What the model says of the figures and statements of ") + kPaper +
          ", computed with the equations of the paper, misprints corrected, with model "
          "version " +
          results.model_version() +
          " and the preset `paper` in every figure and variant: without shear heating of "
          "the inlet, and with load sharing as in eq 41, unless a variant states them. "
          "Measured points of the paper are not printed as numbers: statements are "
          "compared by their words, each by the rule below it. Losses are those of the "
          "gear mesh.") +
      html_paragraph(
          "The paper does not print the car, the roughness of the flanks, the shear "
          "thinning of the lubricants, the mesh data, inertias and damping of the gear "
          "set, or the range of speeds: they are assumed, or calibrated to statements "
          "of the paper. The line below a figure names what else was chosen. Curves are "
          "up-sweeps unless stated otherwise; at some speeds a second response with "
          "impacts exists (figure 6).") +
      html_paragraph(std::to_string(chapters.size()) +
                     (chapters.size() == 1 ? " chapter: " : " chapters: ") + tally(chapters) +
                     ".") +
      summary_table(chapters);
  for (const PaperChapter& chapter : chapters) body += chapter_html(chapter, results);
  return html_page("The paper, reproduced", body);
}

}  // namespace tribodyn::client
