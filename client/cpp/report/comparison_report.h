#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/table.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// Returns lubricants side by side, condition by condition, with what the difference amounts to and
/// which inputs decide it.
std::string comparison_report(const v1::ComparePointsRequest& request,
                              const v1::ComparePointsResponse& response);

/// Returns a CSV line for every lubricant at every condition.
std::string comparison_csv(const v1::ComparePointsRequest& request,
                           const v1::ComparePointsResponse& response);

/// Returns the words for a verdict on a lubricant, e.g. "loses less"; `withheld`: by which warning.
std::string verdict_text(const v1::ComparedDifference& difference, const std::string& withheld);
/// Whether the difference has an interval: no verdict without one.
bool states_interval(const v1::ComparedDifference& difference);
/// Returns the first refusal of a lubricant, with the condition where there are several; empty if
/// there is none.
std::string refusal_text(const v1::ComparePointsRequest& request,
                         const v1::ComparedLubricant& lubricant);
/// Returns the words for a warning that withholds verdicts on two lubricants; empty if none does.
std::string withheld_by(const v1::ComparedLubricant& one, const v1::ComparedLubricant& other);

/// Returns the warnings of all points with the lubricants and conditions that have them.
std::vector<ShownWarning> comparison_warnings(const v1::ComparePointsRequest& request,
                                              const v1::ComparePointsResponse& response);

/// Adds the friction coefficient of a contact with its uncertainty, what makes it, and the fields
/// that count as exact.
void add_contact_uncertainty(const v1::EvaluateContactResponse& contact, Sheet& sheet);

/// The error that no uncertainty states.
inline constexpr char kModelErrorRemark[] =
    "The error of the model's laws is in no figure: `tribodyn help models` says what each choice "
    "of a law is worth.";

/// Returns the figures of one lubricant at one condition with the uncertainty of its inputs.
std::string uncertainty_report(const v1::ComparePointsResponse& response);

/// Returns what the inputs leave open with a probability of 95 %, e.g. "+/- 0.42", "0.9 to 2.1"
/// where that is asymmetric, "uncertainty not stated", or "uncertainty not known" where the model
/// refuses too many draws.
std::string input_error_text(const v1::UncertainFigure& figure);

/// Returns sentences on what makes the uncertainty of the first lubricant's mean over a curve.
std::string curve_uncertainty_remark(const v1::ComparePointsResponse& response);

/// Returns the name of a source of error: "pressure viscosity coefficient" for
/// "lubricant.pressure_viscosity_coefficient_per_pascal".
std::string input_text(const std::string& input);

/// Returns e.g. "1.18 %, +/- 0.42; solver error 0.0004 %".
std::string with_errors(const v1::UncertainFigure& figure, const std::string& unit);

}  // namespace tribodyn::client
