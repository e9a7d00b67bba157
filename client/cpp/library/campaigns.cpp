#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <chrono>

#include "client/cpp/library/column_stream.h"
#include "client/cpp/library/services.h"
#include "tribodyn/v1/limits.pb.h"

namespace tribodyn::client {
namespace {

using std::chrono::milliseconds;

// Pauses between two requests for the state of a campaign. The first ones are short, because a
// small campaign ends after some milliseconds; later ones are as long as a person takes to read.
constexpr milliseconds kFirstLook(10);
constexpr milliseconds kLatestLook(500);
constexpr milliseconds kWhileLost(250);
constexpr int kFollowRetries =
    20;  // about 40 s in all: long enough for a server that drains and restarts
constexpr int kLargestRankingPage = 10'000;

/// Throws ServiceError, as the server would, if the request takes more bytes than its method
/// allows: before it is sent. States how many such candidates do not.
template <class Request, class Candidates>
void check_size(const Request& request, const Candidates& candidates, const char* method,
                const std::string& field) {
  const auto* service = request.GetDescriptor()->file()->FindServiceByName("CampaignService");
  const auto limit = static_cast<std::size_t>(
      service->FindMethodByName(method)->options().GetExtension(v1::max_request_bytes));
  const std::size_t bytes = request.ByteSizeLong();
  if (bytes <= limit) return;
  std::size_t count = 0;
  for (const v1::CandidateColumn& each : candidates.candidate_columns()) {
    count = std::max(count, static_cast<std::size_t>(each.values_size()));
  }
  for (const v1::CandidateAttribute& each : candidates.candidate_attributes()) {
    count = std::max(count, static_cast<std::size_t>(each.values_size() + each.texts_size()));
  }
  const std::string text = std::to_string(count) + " candidates take " + std::to_string(bytes) +
                           " bytes with their attributes; allowed: " + std::to_string(limit) +
                           " bytes, which " + std::to_string(count * limit / bytes) +
                           " such candidates take; make several campaigns";
  throw ServiceError("1 invalid value [INVALID_FIELDS]\n  " + field + ": " + text,
                     grpc::StatusCode::INVALID_ARGUMENT, "INVALID_FIELDS", {{field, text}},
                     std::nullopt);
}

/// Puts the candidates of earlier pages of a ranking before those of `page`, and their warnings
/// together.
void add_earlier_pages(v1::RankCandidatesResponse earlier, v1::RankCandidatesResponse& page) {
  earlier.mutable_candidates()->MergeFrom(page.candidates());
  page.mutable_candidates()->Swap(earlier.mutable_candidates());
  for (const v1::CandidateWarning& each : page.warnings()) {
    auto& warnings = *earlier.mutable_warnings();
    const auto known = std::find_if(warnings.begin(), warnings.end(), [&each](const auto& warning) {
      return warning.code() == each.code();
    });
    if (known == warnings.end()) {
      *warnings.Add() = each;
      continue;
    }
    known->mutable_candidates()->MergeFrom(each.candidates());
    const bool is_of_all = known->where().empty() || each.where().empty();
    if (is_of_all) known->clear_where();
    if (!is_of_all && known->where().find(each.where()) == std::string::npos) {
      known->set_where(known->where() + "; " + each.where());
    }
  }
  page.mutable_warnings()->Swap(earlier.mutable_warnings());
}

}  // namespace

bool has_ended(v1::Campaign::State state) {
  return state == v1::Campaign::SUCCEEDED || state == v1::Campaign::FAILED ||
         state == v1::Campaign::CANCELLED;
}

v1::Campaign Connection::create_campaign(const v1::Campaign& campaign,
                                         const CreateCampaignOptions& options) {
  v1::CreateCampaignRequest request;
  *request.mutable_campaign() = campaign;
  request.set_validate_only(options.validate_only);
  request.set_request_id(options.request_id.empty() ? new_request_id() : options.request_id);
  check_size(request, campaign, "CreateCampaign", "campaign.candidate_columns");
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::CreateCampaign,
                         request);
}

v1::Campaign Connection::get_campaign(const std::string& name, v1::CampaignView view) {
  v1::GetCampaignRequest request;
  request.set_name(name);
  request.set_view(view);
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::GetCampaign, request);
}

Listing<v1::Campaign> Connection::list_campaigns(const ListOptions& options) {
  Listing<v1::Campaign> all;
  v1::ListCampaignsRequest request;
  request.set_page_token(options.page_token);
  request.set_filter(options.filter);
  const int limit = options.limit;
  do {
    const int missing = limit - static_cast<int>(all.resources.size());
    request.set_page_size(limit == 0 ? kLargestPage : std::min(missing, kLargestPage));
    const auto page =
        services_->call(*services_->campaigns, &v1::CampaignService::Stub::ListCampaigns, request);
    all.resources.insert(all.resources.end(), page.campaigns().begin(), page.campaigns().end());
    all.total_size = page.total_size();
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() &&
           (limit == 0 || static_cast<int>(all.resources.size()) < limit));
  all.next_page_token = request.page_token();
  all.has_more = !all.next_page_token.empty();
  return all;
}

v1::Campaign Connection::update_campaign(const v1::Campaign& campaign,
                                         const std::vector<std::string>& update_mask) {
  v1::UpdateCampaignRequest request;
  *request.mutable_campaign() = campaign;
  for (const std::string& each : update_mask) request.mutable_update_mask()->add_paths(each);
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::UpdateCampaign,
                         request);
}

v1::Campaign Connection::append_candidates(v1::AppendCandidatesRequest request) {
  if (request.request_id().empty()) request.set_request_id(new_request_id());
  check_size(request, request, "AppendCandidates", "candidate_columns");
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::AppendCandidates,
                         request);
}

v1::Campaign Connection::pause_campaign(const std::string& name) {
  v1::PauseCampaignRequest request;
  request.set_name(name);
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::PauseCampaign, request);
}

v1::Campaign Connection::resume_campaign(const std::string& name,
                                         const std::optional<v1::CampaignBudget>& budget) {
  v1::ResumeCampaignRequest request;
  request.set_name(name);
  if (budget) *request.mutable_budget() = *budget;
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::ResumeCampaign,
                         request);
}

v1::Campaign Connection::cancel_campaign(const std::string& name) {
  v1::CancelCampaignRequest request;
  request.set_name(name);
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::CancelCampaign,
                         request);
}

void Connection::delete_campaign(const std::string& name, const DeleteOptions& options) {
  v1::DeleteCampaignRequest request;
  request.set_name(name);
  request.set_cancel(options.cancel);
  request.set_allow_missing(options.allow_missing);
  services_->call(*services_->campaigns, &v1::CampaignService::Stub::DeleteCampaign, request);
}

v1::Campaign Connection::follow_campaign(
    const std::string& name, const std::function<void(const v1::Campaign&)>& on_progress,
    const std::stop_token& stop) {
  milliseconds between = kFirstLook;
  Backoff backoff;
  bool was_found = false;
  for (int tries_left = kFollowRetries;;) {
    try {
      v1::Campaign campaign = get_campaign(name);
      was_found = true;
      tries_left = kFollowRetries;
      backoff.reset();
      if (on_progress) on_progress(campaign);
      if (campaign.state() != v1::Campaign::RUNNING || !pause_unless_stopped(between, stop))
        return campaign;
      between = std::min(between * 5 / 4, kLatestLook);
    } catch (const ServiceError& error) {
      const bool is_lost = error.kind() == ServiceError::Kind::kCannotConnect;
      if (!is_lost || !was_found || tries_left-- == 0) throw;
      if (!pause_unless_stopped(backoff.next(kWhileLost), stop)) throw;
    }
  }
}

void Connection::stream_campaign(const std::string& name, const CampaignRowsOptions& options,
                                 const std::function<void(const v1::HistorySchema&)>& on_schema,
                                 const std::function<void(const HistoryRows&)>& on_rows) {
  v1::ReadCampaignRequest request;
  request.set_name(name);
  add_project(services_->project, request);
  *request.mutable_columns() = {options.columns.begin(), options.columns.end()};
  request.set_start_row(options.start_row);
  request.set_row_count(options.row_count);
  request.set_filter(options.filter);
  stream_columns<v1::ReadCampaignResponse>(*services_, *services_->campaigns,
                                           &v1::CampaignService::Stub::ReadCampaign, request,
                                           on_schema, on_rows, options.filter.empty());
}

v1::RankCandidatesResponse Connection::rank_candidates(const v1::RankCandidatesRequest& request) {
  const int wanted = request.count();
  v1::RankCandidatesRequest next = request;
  v1::RankCandidatesResponse out;
  do {
    next.set_page_token(out.next_page_token());
    next.set_count(std::min(wanted - out.candidates_size(), kLargestRankingPage));
    auto page =
        services_->call(*services_->campaigns, &v1::CampaignService::Stub::RankCandidates, next);
    add_earlier_pages(std::move(out), page);
    out = std::move(page);
  } while (!out.next_page_token().empty() && out.candidates_size() < wanted);
  return out;
}

v1::FindParetoCandidatesResponse Connection::find_pareto_candidates(
    const v1::FindParetoCandidatesRequest& request) {
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::FindParetoCandidates,
                         request);
}

v1::EstimateCandidateEffectsResponse Connection::estimate_candidate_effects(
    const v1::EstimateCandidateEffectsRequest& request) {
  return services_->call(*services_->campaigns,
                         &v1::CampaignService::Stub::EstimateCandidateEffects, request);
}

v1::PromoteCandidateResponse Connection::promote_candidate(
    const v1::PromoteCandidateRequest& request) {
  return services_->call(*services_->campaigns, &v1::CampaignService::Stub::PromoteCandidate,
                         request);
}

}  // namespace tribodyn::client
