#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/storage/stored_campaign.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// A column of a campaign as clients read it.
struct TableColumn {
  enum class Kind {
    kStored,        ///< by number (campaign_columns.h)
    kCandidate,     ///< the number of the candidate
    kCondition,     ///< the number of the condition
    kRow,           ///< the number of the row
    kPerCandidate,  ///< one value for each candidate
    kPerCondition,  ///< one value for each condition
  };
  std::string name;
  Kind kind = Kind::kStored;
  int number = 0;
  std::vector<double> values = {};
};

/// Finds the columns of a campaign. It reads the columns of candidates from the store when it first
/// uses them.
class TableColumns {
 public:
  /// All arguments must outlive the object.
  TableColumns(Application& application, const StoredCampaign& stored, const CallContext& call);

  /// Returns the columns that the store keeps.
  std::vector<TableColumn> figures() const;
  /// Returns a column of each field of the conditions, defaults written out.
  std::vector<TableColumn> conditions() const;
  std::optional<TableColumn> find(const std::string& name);
  std::vector<std::string> names();

  /// What the client set, without the columns of candidates.
  const v1::Campaign& request() const { return request_; }
  /// The columns of candidates and nothing else.
  const v1::Campaign& table();

 private:
  Application& application_;
  const StoredCampaign& stored_;
  const CallContext& call_;
  v1::Campaign request_;
  std::optional<v1::Campaign> table_;
};

}  // namespace tribodyn::server
