#pragma once

#include <google/protobuf/empty.pb.h>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "server/application/streams.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// Checks and stores a campaign. When it returns, the campaign is on disk.
Outcome<v1::Campaign> create_campaign(Application& application,
                                      const v1::CreateCampaignRequest& request,
                                      const CallContext& call = {});
Outcome<v1::Campaign> get_campaign(Application& application, const v1::GetCampaignRequest& request,
                                   const CallContext& call = {});
/// Changes display name and labels.
Outcome<v1::Campaign> update_campaign(Application& application,
                                      const v1::UpdateCampaignRequest& request,
                                      const CallContext& call = {});
/// Adds candidates. When it returns, they are on disk.
Outcome<v1::Campaign> append_candidates(Application& application,
                                        const v1::AppendCandidatesRequest& request,
                                        const CallContext& call = {});
/// Returns a page of campaigns, the latest first.
Outcome<v1::ListCampaignsResponse> list_campaigns(Application& application,
                                                  const v1::ListCampaignsRequest& request,
                                                  const CallContext& call = {});

// When these functions return, the campaign is PAUSED, RUNNING or CANCELLED on disk, unless it had
// ended before.
Outcome<v1::Campaign> pause_campaign(Application& application,
                                     const v1::PauseCampaignRequest& request,
                                     const CallContext& call = {});
Outcome<v1::Campaign> resume_campaign(Application& application,
                                      const v1::ResumeCampaignRequest& request,
                                      const CallContext& call = {});
Outcome<v1::Campaign> cancel_campaign(Application& application,
                                      const v1::CancelCampaignRequest& request,
                                      const CallContext& call = {});

/// Removes a campaign for good, with its rows.
Outcome<google::protobuf::Empty> delete_campaign(Application& application,
                                                 const v1::DeleteCampaignRequest& request,
                                                 const CallContext& call = {});

/// How far a campaign is, at once and after each change until its end.
StreamOutcome<v1::CampaignEvent> watch_campaign(Application& application,
                                                const v1::WatchCampaignRequest& request,
                                                const CallContext& call = {});

/// The schema of columns of a campaign, then their rows.
StreamOutcome<v1::ReadCampaignResponse> read_campaign(Application& application,
                                                      const v1::ReadCampaignRequest& request,
                                                      const CallContext& call = {});

/// Returns the stored campaign. Returns INVALID_ARGUMENT if `name` does not have the form of a
/// name, and NOT_FOUND if there is no such campaign.
Outcome<StoredCampaign> find_campaign(Application& application, const std::string& name,
                                      const CallContext& call);

}  // namespace tribodyn::server
