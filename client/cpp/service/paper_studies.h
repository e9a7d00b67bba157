#pragma once

#include <vector>

#include "client/cpp/paper/figure.h"
#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Computes the studies of figures of the paper, each once, on the server. Throws Failure if a
/// curve fails, and as follow() does.
PaperResults compute_paper_studies(const std::vector<const PaperFigure*>& figures,
                                   Connection& connection, ProgressForm form);

}  // namespace tribodyn::client
