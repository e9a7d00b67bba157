#pragma once

#include <string>

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::client {

/// Returns the elasticities of the inefficiency by every parameter as a table with bars, largest
/// first, beside those of loss power, film ratio and contact temperature; or why there are none.
std::string sensitivity_report(const v1::PointResult& result);

/// Returns a CSV line for every parameter, with the derivatives and elasticities of every figure.
std::string sensitivity_csv(const v1::PointResult& result);

}  // namespace tribodyn::client
