#pragma once

#include <memory>

#include "server/transport/http/media_types.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {

/// Returns the format of a history or of rows of a campaign (ReadHistoryResponse,
/// ReadCampaignResponse) in the form kColumns, kCsv, kNumpy or
/// kBinary. A stream that fails is broken off: no form of columns can express a failure.
std::unique_ptr<StreamFormat> history_format(Form form);

}  // namespace tribodyn::server
