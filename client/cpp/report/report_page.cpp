#include "client/cpp/report/report_page.h"

#include <cmath>

#include "client/cpp/plot/svg.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/report/curve_plot.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/explanation_plot.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/report/html.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// The mean of all speeds of each lubricant, and what its difference from the first amounts to.
std::string verdict_table(const v1::ComparePointsResponse& comparison) {
  std::string out =
      "<table>\n" +
      html_row({"lubricant", "mean inefficiency, energy mean, +/- 95 %", "difference, % points",
                "95 % interval", "P(lower)",
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
    const v1::ComparedDifference& difference = lubricant.mean_difference();
    if (difference.has_difference_percent()) {
      cells.push_back(significant(difference.difference_percent().value(), 3));
      cells.push_back(states_interval(difference) ? interval(difference.difference_percent())
                                                  : "-");
      const double probability = difference.lower_probability();
      cells.push_back(std::isnan(probability) ? "-" : fixed(100 * probability, 0) + " %");
      cells.push_back(verdict_text(difference, withheld_by(comparison.lubricants(0), lubricant)));
    }
    out += html_row(cells, "td");
  }
  return out + "</table>\n";
}

std::string hash_table(const ReportContents& contents) {
  std::string out = "<table>\n" + html_row({"lubricant", "hash of the inputs (SHA-256)"}, "th");
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
  std::string out;
  out += html_paragraph(contents.comparison.not_included());
  out += html_paragraph(study_text(first) + "; " + inputs_text(first) + "; model " +
                        model_options_text(first.model_options()) + ".");
  out += html_chapter("Which loses less, and how sure that is");
  out += html_paragraph(
      "Mean of " + std::to_string(speeds) +
      " speeds. +/-, or two ends where that is asymmetric: 95 % interval by the stated "
      "uncertainties of the parameters, from " +
      std::to_string(contents.comparison.draws()) + " draws.");
  out += verdict_table(contents.comparison);
  out += html_preformatted(
      warnings_text(comparison_warnings(contents.comparison_request, contents.comparison)));
  out += html_figure(curve_plot(contents.curves, contents.titles, contents.uncertainties),
                     "curves-", "Inefficiency against speed");
  for (std::size_t i = 0; i < contents.explanations.size(); ++i) {
    const auto& [request, response] = contents.explanations[i];
    out += html_chapter("Why " + resource_id(response.other_lubricant_revision()) +
                        " differs from " + resource_id(response.lubricant_revision()));
    if (response.mean().refusal_reason().empty()) {
      out += html_figure(explanation_plot(request, response), "why" + std::to_string(i) + "-",
                         "Shares of groups of parameters in the difference");
    }
    out += html_preformatted(explanation_report(request, response));
  }
  out += html_chapter("Speed by speed, and what to measure to know better");
  out += html_preformatted(comparison_report(contents.comparison_request, contents.comparison));
  out += html_chapter("Lubricants: parameters, their uncertainties and where they come from");
  for (const v1::Lubricant& lubricant : contents.lubricants) {
    out += html_closed_part(resource_id(lubricant.name()),
                            html_preformatted(resource_sheet(lubricant)));
  }
  out += html_chapter("Curves with warnings and assumptions");
  for (const v1::Simulation& curve : contents.curves) {
    const auto found = contents.uncertainties.find(curve.name());
    out += html_closed_part(resource_id(curve.lubricant_revision()),
                            html_preformatted(curve_report(
                                curve, {.assumptions = true},
                                found == contents.uncertainties.end() ? nullptr : &found->second)));
  }
  out += html_chapter("To compute it again");
  out += html_paragraph("Model version " + first.result().model_version() + " on " +
                        first.result().platform() + "; " + first.gear_set_revision() + ", " +
                        first.surface_revision() + ", " + first.vehicle_revision() + ".");
  out += html_preformatted(contents.command);
  out += hash_table(contents);
  return html_page(title, out);
}

}  // namespace tribodyn::client
