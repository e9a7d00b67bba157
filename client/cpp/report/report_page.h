#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/report/input_uncertainty.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/points.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Everything that a report of lubricants shows. The first lubricant is the one that others are
/// compared with.
struct ReportContents {
  struct Explanation {
    v1::ExplainPointsRequest request;
    v1::ExplainPointsResponse response;
  };
  std::string command;                        ///< that makes the report again
  std::vector<v1::Simulation> curves;         ///< one for each lubricant; all have succeeded
  std::vector<v1::Lubricant> lubricants;      ///< with the revisions of the curves
  std::map<std::string, std::string> titles;  ///< as for curve_plot()
  CurveUncertainties uncertainties;
  v1::ComparePointsRequest comparison_request;
  v1::ComparePointsResponse comparison;
  std::vector<Explanation> explanations;  ///< of each other lubricant
};

/// Returns a page (HTML) that needs no other file, no script and no network: verdict, curves with
/// bands, comparison, explanations, lubricants with the origin of each parameter, assumptions,
/// warnings, revisions and hashes.
std::string report_page(const ReportContents& contents);

}  // namespace tribodyn::client
