#include "tests/crash/campaign_client.h"

#include <chrono>
#include <iterator>
#include <thread>
#include <utility>

#include "tests/crash/clients.h"

namespace tribodyn::crash {
namespace {

using std::chrono::milliseconds;

constexpr auto kCampaignCallLimit = std::chrono::seconds(3);
constexpr int kCampaignScenes = 12;
constexpr int kFirstCampaigns = 2;  // for each client until the third crash
constexpr char kVaried[] = "lubricant.pressure_viscosity_coefficient_per_pascal";

}  // namespace

v1::Campaign campaign_of(int scene, int candidates) {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-" + std::to_string(1 + scene % 3));
  v1::CandidateColumn& column = *out.add_candidate_columns();
  column.set_path(kVaried);
  for (int i = 0; i < candidates; ++i) column.add_values(candidate_value(scene, i));
  for (const double speed : {35.0 + scene, 95.0}) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  return out;
}

std::map<std::int64_t, std::string> computed_rows(client::Connection& connection,
                                                  const std::string& name) {
  constexpr double kMissing = -1;  // refusal_number, the first column
  std::map<std::int64_t, std::string> out;
  connection.stream_campaign(
      name, {}, [](const v1::HistorySchema&) {},
      [&out](const client::HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          if (rows.columns.front()[i] == kMissing) continue;
          std::string& bits = out[rows.first_row + static_cast<std::int64_t>(i)];
          for (const auto& column : rows.columns) {
            bits.append(reinterpret_cast<const char*>(&column[i]), sizeof(double));
          }
        }
      });
  return out;
}

CampaignClient::CampaignClient(std::string address, int number, std::uint64_t seed,
                               Recorder& recorder)
    : connection_(std::move(address), kCampaignCallLimit),
      number_(number),
      random_(seed),
      recorder_(recorder) {}

void CampaignClient::run(const std::atomic<bool>& stop, const std::atomic<int>& crashes) {
  while (!stop) {
    try {
      act(std::ssize(own_) < kFirstCampaigns + crashes / 3);
    } catch (const client::ServiceError& error) {
      if (is_refusal(error)) {
        recorder_.write([&](History& history) { history.refusals.emplace_back(error.what()); });
      }
    }
    std::this_thread::sleep_for(milliseconds(draw(60)));
  }
}

void CampaignClient::act(bool may_create) {
  if (own_.empty() || (may_create && draw(4) == 0)) {
    own_.push_back({"campaign-" + std::to_string(number_) + "-" + std::to_string(own_.size()),
                    draw(kCampaignScenes)});
    recorder_.write([](History& history) { ++history.campaigns.requests; });
    return create(own_.back());
  }
  Own& own = own_[static_cast<std::size_t>(draw(static_cast<int>(own_.size())))];
  const int kind = draw(20);
  if (own.is_deleted) return remove(own);
  if (own.name.empty() || kind == 0) return create(own);
  if (own.is_cancelled) {
    if (kind < 4) return remove(own);
    return kind < 8 ? cancel(own) : read(own);
  }
  if (own.is_append_sent || (kind < 5 && own.appends < kMostAppends)) return append(own);
  if (kind < 8) return pause(own);
  if (kind < 13) return resume(own);
  if (kind == 13) return cancel(own);
  if (kind == 14 && draw(2) == 0) return remove(own);
  read(own);
}

void CampaignClient::create(Own& own) {
  client::CreateCampaignOptions options;
  options.request_id = own.request_id;
  const v1::Campaign made =
      connection_.create_campaign(campaign_of(own.scene, kFirstCandidates), options);
  own.name = made.name();
  recorder_.write([&](History& history) {
    history.campaigns.made.push_back({own.request_id, own.name, own.scene});
  });
  note_state(made);
}

void CampaignClient::append(Own& own) {
  note_command(own);
  if (!own.is_append_sent) {
    recorder_.write([&](History& history) { ++history.campaigns.sent_appends[own.name]; });
  }
  own.is_append_sent = true;
  v1::AppendCandidatesRequest request;
  request.set_name(own.name);
  request.set_request_id(own.request_id + "-" + std::to_string(own.appends));
  v1::CandidateColumn& column = *request.add_candidate_columns();
  column.set_path(kVaried);
  const int first = kFirstCandidates + own.appends * kAppendedCandidates;
  for (int i = first; i < first + kAppendedCandidates; ++i) {
    column.add_values(candidate_value(own.scene, i));
  }
  note_state(connection_.append_candidates(request));
  own.is_append_sent = false;
  ++own.appends;
  recorder_.write([&](History& history) { ++history.campaigns.acknowledged_appends[own.name]; });
}

void CampaignClient::pause(const Own& own) {
  note_command(own);
  const v1::Campaign paused = connection_.pause_campaign(own.name);
  note_state(paused);
  if (paused.state() != v1::Campaign::PAUSED) return;
  recorder_.write([&](History& history) { history.campaigns.paused.insert(own.name); });
}

void CampaignClient::resume(const Own& own) {
  note_command(own);
  try {
    note_state(connection_.resume_campaign(own.name));
  } catch (const client::ServiceError& error) {
    if (error.reason() != "ENDED") throw;  // it may have succeeded
  }
}

void CampaignClient::cancel(Own& own) {
  note_command(own);
  own.is_cancelled = true;
  note_state(connection_.cancel_campaign(own.name));
}

void CampaignClient::remove(Own& own) {
  note_command(own);
  own.is_deleted = true;
  recorder_.write([&](History& history) { history.campaigns.sent_deletions.insert(own.name); });
  client::DeleteOptions options;
  options.cancel = options.allow_missing = true;
  connection_.delete_campaign(own.name, options);
  recorder_.write([&](History& history) { history.campaigns.deleted.insert(own.name); });
}

void CampaignClient::read(const Own& own) {
  CampaignHistory::SeenRows seen{own.name, computed_rows(connection_, own.name)};
  recorder_.write([&](History& history) { history.campaigns.reads.push_back(std::move(seen)); });
  note_state(connection_.get_campaign(own.name));
}

void CampaignClient::note_command(const Own& own) {
  recorder_.write([&](History& history) { history.campaigns.paused.erase(own.name); });
}

void CampaignClient::note_state(const v1::Campaign& campaign) {
  if (campaign.state() != v1::Campaign::CANCELLED && campaign.state() != v1::Campaign::FAILED) {
    return;
  }
  recorder_.write([&](History& history) {
    history.campaigns.ended.emplace_back(campaign.name(), campaign.state());
  });
}

}  // namespace tribodyn::crash
