#pragma once

#include <google/protobuf/repeated_field.h>

#include <string>
#include <vector>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "server/contract/violations.h"
#include "server/storage/history_rows.h"

namespace tribodyn::server {

/// Returns a simulation that has succeeded, its result and the columns of its history, at least
/// one. Returns an error as find_simulation() does, and if the simulation has no result or was run
/// without history.
Outcome<StoredHistory> find_history(Application& application, const std::string& name,
                                    const CallContext& call);

/// Returns NOT_FOUND: the history of the simulation was removed while it was read.
google::rpc::Status history_evicted(const std::string& name);

/// Returns the places in the shape that the names of a request mean, each once:
/// "flank_load_newtons" stands for its three flanks. Adds a violation at `columns` for each name
/// that does not exist, and for too many names.
std::vector<std::size_t> history_places(
    const google::protobuf::RepeatedPtrField<std::string>& columns, const HistoryShape& shape,
    Violations& violations);

}  // namespace tribodyn::server
