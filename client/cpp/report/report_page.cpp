#include "client/cpp/report/report_page.h"

#include <cmath>

#include "client/cpp/plot/curve_plot.h"
#include "client/cpp/plot/explanation_plot.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/report/inputs.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kPageStyle[] = R"(
body { font: 15px/1.5 "Helvetica Neue", Arial, sans-serif; color: #222; margin: 2em auto; max-width: 1100px; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #ddd; }
table { border-collapse: collapse; margin: 1em 0; }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #e4e4e4; }
th:first-child, td:first-child { text-align: left; }
td.hash { font-family: monospace; font-size: .85em; word-break: break-all; text-align: left; }
pre { font-size: 12px; line-height: 1.35; overflow-x: auto; background: #f7f7f7; padding: 1em; }
figure { margin: 1em 0; } svg { max-width: 100%; height: auto; }
@media print { pre { white-space: pre-wrap; } h2 { break-after: avoid; } }
)";

std::string paragraph(const std::string& text) { return "<p>" + xml_escaped(text) + "</p>\n"; }

std::string chapter(const std::string& text) { return "<h2>" + xml_escaped(text) + "</h2>\n"; }

/// Returns the lines of a text report in a fixed pitch.
std::string preformatted(const std::string& text) {
  std::string out;
  for (const std::string& line : split(text, '\n')) out += xml_escaped(line) + "\n";
  while (out.ends_with("\n\n")) out.pop_back();
  return "<pre>" + out + "</pre>\n";
}

/// Returns a part of the page that is closed until a reader opens it.
std::string closed_part(const std::string& title, const std::string& html) {
  return "<details><summary>" + xml_escaped(title) + "</summary>\n" + html + "</details>\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Returns the picture as a part of a page. The ids of its elements get a prefix of their own: all
/// pictures of a page share one space of ids.
std::string figure(const std::string& svg, const std::string& prefix, const std::string& label) {
  const std::string own = replaced(svg, " id=\"", " id=\"" + prefix);
  return "<figure role=\"img\" aria-label=\"" + xml_escaped(label) + "\">\n" +
         replaced(own, "url(#", "url(#" + prefix) + "</figure>\n";
}

std::string row(const std::vector<std::string>& cells, const char* tag) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) {
    out += std::string("<") + tag + ">" + xml_escaped(cell) + "</" + tag + ">";
  }
  return out + "</tr>\n";
}

std::string verdict_words(v1::ComparedDifference::Verdict verdict) {
  switch (verdict) {
    case v1::ComparedDifference::LOWER:
      return "loses less";
    case v1::ComparedDifference::HIGHER:
      return "loses more";
    case v1::ComparedDifference::CANNOT_BE_TOLD_APART:
      return "cannot be told apart";
    default:
      return "-";
  }
}

/// The mean of all speeds of each lubricant, and what its difference from the first amounts to.
std::string verdict_table(const v1::ComparePointsResponse& comparison) {
  std::string out =
      "<table>\n" + row({"lubricant", "mean inefficiency, energy mean", "95 % interval",
                         "difference, % points", "95 % interval", "P(lower)",
                         "against " + resource_id(comparison.lubricants(0).lubricant_revision())},
                        "th");
  const auto interval = [](const v1::UncertainFigure& each) {
    return significant(each.interval_minimum(), 3) + " to " +
           significant(each.interval_maximum(), 3);
  };
  for (const v1::ComparedLubricant& lubricant : comparison.lubricants()) {
    std::vector<std::string> cells = {resource_id(lubricant.lubricant_revision())};
    const bool has_mean = lubricant.has_mean_inefficiency_percent();
    const v1::UncertainFigure& mean = lubricant.mean_inefficiency_percent();
    cells.push_back(has_mean ? with_errors(mean, "%") : "-");
    cells.push_back(has_mean ? interval(mean) : "-");
    const v1::ComparedDifference& difference = lubricant.mean_difference();
    if (difference.has_difference_percent()) {
      cells.push_back(significant(difference.difference_percent().value(), 3));
      cells.push_back(interval(difference.difference_percent()));
      cells.push_back(fixed(100 * difference.lower_probability(), 0) + " %");
      cells.push_back(verdict_words(difference.verdict()));
    }
    out += row(cells, "td");
  }
  return out + "</table>\n";
}

std::string hash_table(const ReportContents& contents) {
  std::string out = "<table>\n" + row({"lubricant", "hash of the inputs (SHA-256)"}, "th");
  for (const v1::Simulation& curve : contents.curves) {
    out += "<tr><td>" + xml_escaped(curve.lubricant_revision()) + "</td><td class=\"hash\">" +
           xml_escaped(curve.result().input_hash()) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string page_title(const ReportContents& contents) {
  std::vector<std::string> names;
  for (const v1::Simulation& curve : contents.curves) {
    names.push_back(resource_id(curve.lubricant_revision()));
  }
  return (names.size() == 1 ? "Mesh inefficiency of " : "Mesh inefficiency: ") +
         joined(names, ", ");
}

}  // namespace

std::string report_page(const ReportContents& contents) {
  const v1::Simulation& first = contents.curves.front();
  const int speeds = contents.comparison_request.conditions_size();
  const std::string title = page_title(contents);
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      xml_escaped(title) + "</title>\n<style>" + kPageStyle + "</style>\n</head>\n<body>\n<h1>" +
      xml_escaped(title) + "</h1>\n";
  out += paragraph(
      "Losses of the gear mesh of a hypoid axle; bearings, churning and seals are not in "
      "them. " +
      study_text(first) + "; " + inputs_text(first) + ".");
  out += chapter("Which loses less, and how sure that is");
  out +=
      paragraph("Mean of " + std::to_string(speeds) +
                " speeds. +/- (inputs): standard uncertainty that the stated uncertainties of the "
                "parameters make, from " +
                std::to_string(contents.comparison.draws()) +
                " draws; +/- (solver): estimated error of the solution.");
  out += verdict_table(contents.comparison);
  out += figure(curve_plot(contents.curves, contents.titles, contents.uncertainties), "curves-",
                "Inefficiency against speed");
  for (std::size_t i = 0; i < contents.explanations.size(); ++i) {
    const auto& [request, response] = contents.explanations[i];
    out += chapter("Why " + resource_id(response.other_lubricant_revision()) + " differs from " +
                   resource_id(response.lubricant_revision()));
    if (response.mean().refusal_reason().empty()) {
      out += figure(explanation_plot(request, response), "why" + std::to_string(i) + "-",
                    "Shares of groups of parameters in the difference");
    }
    out += preformatted(explanation_report(request, response));
  }
  out += chapter("Speed by speed, and what to measure to know better");
  out += preformatted(comparison_report(contents.comparison_request, contents.comparison));
  out += chapter("Lubricants: parameters, their uncertainties and where they come from");
  for (const v1::Lubricant& lubricant : contents.lubricants) {
    out += closed_part(resource_id(lubricant.name()), preformatted(resource_sheet(lubricant)));
  }
  out += chapter("Curves with warnings and assumptions");
  for (const v1::Simulation& curve : contents.curves) {
    const auto found = contents.uncertainties.find(curve.name());
    out += closed_part(
        resource_id(curve.lubricant_revision()),
        preformatted(curve_report(
            curve, true, found == contents.uncertainties.end() ? nullptr : &found->second)));
  }
  out += chapter("To compute it again");
  out += paragraph("Model version " + first.result().model_version() + " on " +
                   first.result().platform() + "; " + first.gear_set_revision() + ", " +
                   first.surface_revision() + ", " + first.vehicle_revision() + ".");
  out += preformatted(contents.command);
  out += hash_table(contents);
  return out + "</body>\n</html>\n";
}

}  // namespace tribodyn::client
