#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::crash {

// Candidates of every campaign, and those of each request that adds some.
inline constexpr int kFirstCandidates = 300;
inline constexpr int kAppendedCandidates = 100;
inline constexpr int kMostAppends = 3;

/// The value of a candidate in the only column of a campaign. It depends on the scene, a number.
double candidate_value(int scene, int candidate);

/// What clients read of campaigns while the server was killed repeatedly, and what the server has
/// of them at the end. Failed calls are not included: they may or may not have had an effect.
struct CampaignHistory {
  using State = v1::Campaign::State;

  /// A request to create a campaign that the server acknowledged.
  struct Made {
    std::string request_id;
    std::string name;
    int scene = 0;
  };
  /// Rows that a client read: by number, the bits of all figures.
  struct SeenRows {
    std::string name;
    std::map<std::int64_t, std::string> rows;
  };

  std::vector<Made> made;
  int requests = 0;  ///< distinct request_ids of requests to create, acknowledged or not
  // Requests that add candidates, by campaign.
  std::map<std::string, int> sent_appends;
  std::map<std::string, int> acknowledged_appends;
  std::vector<std::pair<std::string, State>> ended;  ///< seen as CANCELLED or FAILED
  std::set<std::string> sent_deletions;
  std::set<std::string> deleted;  ///< acknowledged
  std::set<std::string> paused;   ///< the last command was to pause them, and was acknowledged
  std::vector<SeenRows> reads;

  std::map<std::string, v1::Campaign> found;  ///< when the last server had started
  /// After those that were PAUSED had been resumed and all had ended, with their candidates.
  std::map<std::string, v1::Campaign> campaigns;
  std::map<std::string, std::map<std::int64_t, std::string>> rows;  ///< of these, as SeenRows
  /// Rows of each scene from a server that was not killed.
  std::map<int, std::map<std::int64_t, std::string>> undisturbed;
};

/// Returns one sentence for each promise about campaigns that the history breaks:
/// - an acknowledged campaign exists, belongs to the acknowledged request, and is the only one of
///   that request; an acknowledged deletion is for good;
/// - every campaign ends; one that was paused stays so until it is resumed, and one that was
///   cancelled is cancelled; none fails;
/// - acknowledged candidates are there, in their order, and no request adds them twice;
/// - as many rows are there as the campaign counts, all of one that has succeeded;
/// - a row that a client has read never changes, and all rows have the same bits as on a server
///   that was not killed.
std::vector<std::string> campaign_violations(const CampaignHistory& history);

}  // namespace tribodyn::crash
