#pragma once

#include <string>
#include <vector>

#include "server/application/outcome.h"
#include "server/transport/http/http_message.h"
#include "server/transport/http/media_types.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Returns the points of a simulation as columns, in the form kPointColumns, kCsv or kNumpy: the
/// speed, then every number of PointResult under the name of its field; "minimum_", "mean_" or
/// "maximum_" before the name of a field with three figures. NaN: unset, or the point has no
/// result. `wanted` chooses columns; empty: all. Returns FAILED_PRECONDITION if there is no result,
/// INVALID_ARGUMENT for a column that does not exist.
Outcome<HttpResponse> curve_table(const v1::Simulation& simulation,
                                  const std::vector<std::string>& wanted, Form form);

}  // namespace tribodyn::server
