#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/storage/stored_resource.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// States of a campaign as stored; the numbers are those of v1::Campaign::State.
enum class CampaignState {
  kRunning = 1,
  kPaused = 2,
  kSucceeded = 3,
  kFailed = 4,
  kCancelled = 5,
};

/// Returns true if the state is final.
inline bool has_ended(CampaignState state) { return state >= CampaignState::kSucceeded; }

/// What a campaign may spend before it pauses; 0: no limit.
struct CampaignBudget {
  double processor_seconds = 0;
  std::int64_t points = 0;
};

using CampaignLabels = std::vector<std::pair<std::string, std::string>>;  ///< by key

/// A campaign before it is stored.
struct NewCampaign {
  std::string project = kDefaultProject;
  std::string request;          ///< serialised Campaign without its columns of candidates
  std::string candidate_table;  ///< serialised Campaign, its columns of candidates only
  std::string request_id;       ///< empty: none
  std::string request_hash;     ///< of everything that the client set
  std::string input_hash;       ///< SHA-256, 64 hex digits
  std::string model_version;
  std::string platform;
  std::string client;
  std::string principal;
  int candidates = 1;
  int conditions = 1;
  double cost_seconds = 0;  ///< estimate, in seconds of one processor
  CampaignBudget budget;
  CampaignLabels labels;
  ResourceRevisions revisions;  ///< each exists in the project or, but the first, is empty
  std::vector<std::string> candidate_lubricants;  ///< candidates that are lubricants, likewise
};

/// Candidates that are added to a campaign.
struct NewCandidates {
  std::int64_t campaign = 0;                      ///< row
  std::string request_id;                         ///< empty: none
  std::string request_hash;                       ///< of everything that the client set
  int candidates_before = 0;                      ///< number of its candidates when it was read
  int candidates = 0;                             ///< number of its candidates with these
  std::string candidate_table;                    ///< of all candidates, as in NewCampaign
  std::string input_hash;                         ///< of all candidates
  double cost_seconds = 0;                        ///< of these candidates alone
  std::vector<std::string> candidate_lubricants;  ///< these candidates, as in NewCampaign
};

struct StoredCampaign {
  std::int64_t id = 0;  ///< row, over all projects
  std::string project;
  std::int64_t number = 0;  ///< in its name; counts within the project
  CampaignState state = CampaignState::kRunning;
  std::string stop_reason;  ///< why it is paused or failed; else empty
  std::string stop_message;
  Microseconds create_time = 0;
  std::optional<Microseconds> end_time;
  std::string request;     ///< as in NewCampaign
  std::string request_id;  ///< empty: none
  std::string request_hash;
  std::string input_hash;
  std::string model_version;
  std::string platform;
  std::string principal;
  int candidates = 1;
  int conditions = 1;
  std::int64_t points_done = 0;
  std::int64_t points_refused = 0;
  /// Processes that began to compute it, this one included, and have not proved that they can.
  int lost_attempts = 0;
  CampaignBudget budget;
  double processor_seconds = 0;
  double cost_seconds = 0;  ///< estimate of all its points, in seconds of one processor
  std::int64_t stored_bytes = 0;
  ResourceRevisions revisions;

  std::int64_t points() const { return std::int64_t{candidates} * conditions; }
  /// Returns the estimate of the points that are not done.
  double remaining_seconds() const {
    return cost_seconds * (1 - static_cast<double>(points_done) / static_cast<double>(points()));
  }
};

/// Returns the full name of a stored campaign.
inline std::string name_of(const StoredCampaign& campaign) {
  return campaign_name(campaign.project, campaign.number);
}

/// Outcome of Store::add_campaign().
struct CampaignAdded {
  enum class Kind {
    kAdded,
    kRepeated,        ///< an earlier request with the same id and hash added it
    kRequestIdTaken,  ///< an earlier request with the same id and another hash added it
  };
  Kind kind = Kind::kAdded;
  StoredCampaign stored;
};

/// Outcome of Store::add_candidates().
struct CandidatesAdded {
  enum class Kind {
    kAdded,
    kRepeated,        ///< an earlier request with the same id and hash added them
    kRequestIdTaken,  ///< an earlier request with the same id and another hash added candidates
    kChanged,         ///< the campaign has other candidates than those that were read, has FAILED,
                      ///< is CANCELLED or was removed; nothing has changed
  };
  Kind kind = Kind::kAdded;
  std::optional<StoredCampaign> stored;  ///< the campaign as it is now; empty if it was removed
};

/// A run of rows.
struct RowRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// Rows of whole candidates that are computed with care, because an earlier process was lost.
struct CampaignSuspect {
  RowRange rows;
  int lost_attempts = 0;  ///< of processes that computed it as a single candidate
};

/// How far a campaign is.
struct CampaignProgress {
  CampaignState state = CampaignState::kRunning;
  std::string stop_reason;  ///< why it is paused or failed; else empty
  std::string stop_message;
  std::int64_t points = 0;
  std::int64_t points_done = 0;
  std::int64_t points_refused = 0;
  std::int64_t first_missing_row = 0;  ///< all rows before it are in tiles
  double processor_seconds = 0;
};

/// A sentence of the refusals of a campaign, and its number, from 1.
struct CampaignRefusal {
  int number = 0;
  std::string reason;
  std::string message;
};

/// Largest number of rows of a tile. Tiles of 4,096 rows cost 0.7 % beside their points, tiles of
/// 390 rows 3.5 % (measured).
inline constexpr std::int64_t kMaximumTileRows = 4096;

/// Rows of a campaign that were computed together.
struct NewTile {
  RowRange rows;
  std::vector<std::vector<double>> columns;  ///< by number; the caller says what each one means
  std::vector<CampaignRefusal> refusals;     ///< whose numbers no earlier tile had
  std::int64_t refused_points = 0;
  double processor_seconds = 0;
  bool proves_health = false;  ///< the attempts of earlier processes that were lost are forgiven
};

}  // namespace tribodyn::server
