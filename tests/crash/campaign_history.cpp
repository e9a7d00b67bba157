#include "tests/crash/campaign_history.h"

#include <algorithm>

namespace tribodyn::crash {
namespace {

using Complaints = std::vector<std::string>;

std::string state_name(CampaignHistory::State state) { return v1::Campaign::State_Name(state); }

int count_of(const std::map<std::string, int>& counts, const std::string& name) {
  const auto found = counts.find(name);
  return found == counts.end() ? 0 : found->second;
}

/// Returns the acknowledged requests to create, each answer once.
std::vector<CampaignHistory::Made> answers_of(const CampaignHistory& history) {
  std::vector<CampaignHistory::Made> out;
  std::set<std::pair<std::string, std::string>> known;
  for (const auto& each : history.made) {
    if (known.emplace(each.request_id, each.name).second) out.push_back(each);
  }
  return out;
}

void check_made(const CampaignHistory& history, Complaints& out) {
  std::map<std::string, std::string> name_of_request;
  for (const auto& each : answers_of(history)) {
    const auto found = history.campaigns.find(each.name);
    const bool may_be_deleted = history.sent_deletions.contains(each.name);
    if (found == history.campaigns.end() && !may_be_deleted) {
      out.push_back(each.name + " was acknowledged and is lost");
    } else if (found != history.campaigns.end() && found->second.request_id() != each.request_id) {
      out.push_back(each.name + " was acknowledged to request " + each.request_id +
                    " and belongs to request " + found->second.request_id());
    }
    const auto [known, is_new] = name_of_request.emplace(each.request_id, each.name);
    if (!is_new && known->second != each.name) {
      out.push_back("one request made " + known->second + " and " + each.name);
    }
  }
  if (static_cast<int>(history.campaigns.size()) > history.requests) {
    out.push_back(std::to_string(history.requests) + " requests made " +
                  std::to_string(history.campaigns.size()) + " campaigns");
  }
  for (const std::string& name : history.deleted) {
    if (history.campaigns.contains(name)) out.push_back(name + " was deleted and is there");
  }
}

void check_states(const CampaignHistory& history, Complaints& out) {
  for (const auto& [name, state] : history.ended) {
    const auto found = history.campaigns.find(name);
    if (found == history.campaigns.end() || found->second.state() == state) continue;
    out.push_back(name + " had ended " + state_name(state) + " and is " +
                  state_name(found->second.state()));
  }
  for (const std::string& name : history.paused) {
    const auto found = history.found.find(name);
    if (found != history.found.end() && found->second.state() == v1::Campaign::RUNNING) {
      out.push_back(name + " was paused and runs");
    }
  }
  for (const auto& [name, campaign] : history.campaigns) {
    if (campaign.state() < v1::Campaign::SUCCEEDED) {
      out.push_back(name + " never ended: it is " + state_name(campaign.state()) + " with " +
                    std::to_string(campaign.points_done()) + " rows");
    }
    if (campaign.state() == v1::Campaign::FAILED) {
      out.push_back(name + " failed with " + campaign.stop().reason());
    }
  }
}

void check_candidates(const CampaignHistory& history, Complaints& out) {
  std::map<std::string, int> scenes;
  for (const auto& each : history.made) scenes[each.name] = each.scene;
  for (const auto& [name, campaign] : history.campaigns) {
    const int appends = (campaign.candidates() - kFirstCandidates) / kAppendedCandidates;
    if (campaign.candidates() != kFirstCandidates + appends * kAppendedCandidates ||
        appends < count_of(history.acknowledged_appends, name) ||
        appends > count_of(history.sent_appends, name)) {
      out.push_back(name + " has " + std::to_string(campaign.candidates()) + " candidates after " +
                    std::to_string(count_of(history.acknowledged_appends, name)) + " to " +
                    std::to_string(count_of(history.sent_appends, name)) + " appends");
    }
    const auto scene = scenes.find(name);
    if (scene == scenes.end() || campaign.candidate_columns().empty()) continue;
    const auto& values = campaign.candidate_columns(0).values();
    bool is_right = values.size() == campaign.candidates();
    for (int i = 0; i < values.size() && is_right; ++i) {
      is_right = values[i] == candidate_value(scene->second, i);
    }
    if (!is_right) out.push_back(name + " has other candidates than it was sent");
  }
}

/// Returns true if the row was refused because processes were lost while they computed it.
bool was_given_up(const v1::Campaign& campaign, const std::string& bits) {
  double number = 0;
  std::copy_n(bits.data(), sizeof number, reinterpret_cast<char*>(&number));
  return number >= 1 && number <= campaign.refusals_size() &&
         campaign.refusals(static_cast<int>(number) - 1).reason() == "WORKER_LOST";
}

void check_rows(const CampaignHistory& history, Complaints& out) {
  static const std::map<std::int64_t, std::string> kNone;
  const auto rows_of = [](const auto& all, const auto& key) -> const auto& {
    const auto found = all.find(key);
    return found == all.end() ? kNone : found->second;
  };
  for (const auto& [name, campaign] : history.campaigns) {
    const auto& rows = rows_of(history.rows, name);
    if (static_cast<int>(rows.size()) != campaign.points_done()) {
      out.push_back(name + " counts " + std::to_string(campaign.points_done()) +
                    " rows as computed and has " + std::to_string(rows.size()));
    }
    if (campaign.state() == v1::Campaign::SUCCEEDED &&
        static_cast<int>(rows.size()) != campaign.points()) {
      out.push_back(name + " has succeeded and lacks rows");
    }
  }
  for (const auto& read : history.reads) {
    if (!history.campaigns.contains(read.name)) continue;
    const auto& rows = rows_of(history.rows, read.name);
    for (const auto& [row, bits] : read.rows) {
      const auto found = rows.find(row);
      if (found != rows.end() && found->second == bits) continue;
      out.push_back(read.name + ": row " + std::to_string(row) + " was read and " +
                    (found == rows.end() ? "is lost" : "has changed"));
      break;
    }
  }
  for (const auto& each : answers_of(history)) {
    const auto campaign = history.campaigns.find(each.name);
    const auto right = history.undisturbed.find(each.scene);
    if (campaign == history.campaigns.end() || right == history.undisturbed.end()) continue;
    for (const auto& [row, bits] : rows_of(history.rows, each.name)) {
      const auto expected = right->second.find(row);
      if (expected != right->second.end() &&
          (expected->second == bits || was_given_up(campaign->second, bits))) {
        continue;
      }
      out.push_back(each.name + ": row " + std::to_string(row) +
                    " has other bits than in an undisturbed run");
      break;
    }
  }
}

}  // namespace

double candidate_value(int scene, int candidate) {
  return 1.2e-8 * (1 + 1e-3 * candidate + 1e-4 * scene);
}

std::vector<std::string> campaign_violations(const CampaignHistory& history) {
  Complaints out;
  check_made(history, out);
  check_states(history, out);
  check_candidates(history, out);
  check_rows(history, out);
  return out;
}

}  // namespace tribodyn::crash
