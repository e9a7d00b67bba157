#pragma once

#include <string>

#include "client/cpp/text/table.h"
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

/// Adds the friction coefficient of a contact with its uncertainty, what makes it, and the fields
/// that count as exact.
void add_contact_uncertainty(const v1::EvaluateContactResponse& contact, Sheet& sheet);

/// The error that no uncertainty states.
inline constexpr char kModelErrorRemark[] =
    "The error of the model's laws is in no figure: `tribodyn help models` says what each choice "
    "of a law is worth.";

/// Returns the figures of one lubricant at one condition with the uncertainty of its inputs.
std::string uncertainty_report(const v1::ComparePointsResponse& response);

/// Returns the standard uncertainty by the inputs, e.g. "+/- 0.42".
std::string input_error_text(const v1::UncertainFigure& figure);

/// Returns sentences on what makes the uncertainty of the first lubricant's mean over a curve.
std::string curve_uncertainty_remark(const v1::ComparePointsResponse& response);

/// Returns the name of a source of error: "pressure viscosity coefficient" for
/// "lubricant.pressure_viscosity_coefficient_per_pascal".
std::string input_text(const std::string& input);

/// Returns e.g. "1.18 % +/- 0.42 (inputs) +/- 0.0004 (solver)".
std::string with_errors(const v1::UncertainFigure& figure, const std::string& unit);

}  // namespace tribodyn::client
