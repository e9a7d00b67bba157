#include "client/cpp/service/campaign_run.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <stop_token>

#include "client/cpp/failure.h"
#include "client/cpp/report/campaign_report.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using Clock = std::chrono::steady_clock;

/// The progress of a campaign, with the rate since the first look.
class CampaignProgress {
 public:
  JobProgress of(const v1::Campaign& campaign) {
    if (!first_points_) first_points_ = campaign.points_done();
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const int computed = campaign.points_done() - *first_points_;
    JobProgress out;
    out.label = campaign.name();
    out.state = state_text(campaign);
    out.stage = points_text(campaign);
    if (computed > 0 && seconds > 0) out.stage += ", " + fixed(computed / seconds, 0) + "/s";
    out.fraction = static_cast<double>(campaign.points_done()) / std::max(campaign.points(), 1);
    out.ended = campaign.state() != v1::Campaign::RUNNING;
    if (out.ended) out.state += ", " + out.stage;
    if (campaign.has_stalled()) out.stage = "stalled: " + printable(campaign.stalled().message());
    return out;
  }

 private:
  const Clock::time_point start_ = Clock::now();
  std::optional<int> first_points_;
};

std::string commands_that_go_on(const Connection& connection, const std::string& name) {
  const std::string program = program_of(connection), id = resource_id(name);
  return "\n  The campaign goes on. Follow it:  " + program + " screen --campaign " + id +
         "\n                        Pause it:   " + program + " campaigns pause " + id +
         "\n                        Cancel it:  " + program + " campaigns cancel " + id;
}

}  // namespace

std::string interrupted_campaign(const Connection& connection, const std::string& name) {
  return "interrupted." + commands_that_go_on(connection, name);
}

v1::Campaign follow_to_end(Connection& connection, const std::string& name, ProgressForm form) {
  const InterruptGuard interrupts;
  ProgressDisplay display(std::cerr, form, standard_error_width());
  CampaignProgress progress;
  std::stop_source stop;
  try {
    v1::Campaign campaign = connection.follow_campaign(
        name,
        [&](const v1::Campaign& present) {
          display.show({progress.of(present)});
          if (InterruptGuard::interrupted()) stop.request_stop();
        },
        stop.get_token());
    display.finish();
    if (campaign.state() != v1::Campaign::RUNNING) return campaign;
    throw Failure(kExitInterrupted, "interrupted after " + points_text(campaign) + "." +
                                        commands_that_go_on(connection, name));
  } catch (const ServiceError& error) {
    display.finish();
    if (error.kind() == ServiceError::Kind::kRefused) throw;
    const Failure failure(error);
    throw Failure(failure.exit_code(), failure.what() + commands_that_go_on(connection, name));
  }
}

}  // namespace tribodyn::client
