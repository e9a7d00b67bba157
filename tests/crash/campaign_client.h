#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/crash/history.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::crash {

/// Returns the campaign of a scene, with its first candidates.
v1::Campaign campaign_of(int scene, int candidates);

/// Returns the rows of a campaign that are computed, by number, as the bits of all figures. Throws
/// client::ServiceError.
std::map<std::int64_t, std::string> computed_rows(client::Connection& connection,
                                                  const std::string& name);

/// One client. At random it creates campaigns, creates them again under the same request_id,
/// pauses, resumes, extends, reads, cancels and deletes them, and records the answers.
class CampaignClient {
 public:
  CampaignClient(std::string address, int number, std::uint64_t seed, Recorder& recorder);

  /// Works until `stop`. Creates two campaigns, and one more for each of three `crashes`.
  void run(const std::atomic<bool>& stop, const std::atomic<int>& crashes);

 private:
  struct Own {
    std::string request_id;
    int scene = 0;
    std::string name = {};  ///< empty until the server acknowledges it
    int appends = 0;        ///< acknowledged
    bool is_append_sent = false;
    bool is_cancelled = false;  ///< or may be
    bool is_deleted = false;    ///< or may be
  };

  int draw(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  void act(bool may_create);
  void create(Own& own);
  void append(Own& own);
  void pause(const Own& own);
  void resume(const Own& own);
  void cancel(Own& own);
  void remove(Own& own);
  void read(const Own& own);
  /// Notes that a command is sent that may end the pause of a campaign.
  void note_command(const Own& own);
  void note_state(const v1::Campaign& campaign);

  client::Connection connection_;
  const int number_;
  std::mt19937_64 random_;
  Recorder& recorder_;
  std::vector<Own> own_;
};

}  // namespace tribodyn::crash
