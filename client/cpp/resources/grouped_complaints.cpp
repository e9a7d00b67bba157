#include "client/cpp/resources/grouped_complaints.h"

#include <numeric>

namespace tribodyn::client {
namespace {

constexpr std::size_t kMostLines = 100;

}  // namespace

void GroupedComplaints::add(const std::string& place, const std::string& about,
                            const std::string& sentence) {
  const auto [at, is_new] = index_.emplace(std::pair(about, sentence), groups_.size());
  if (is_new) groups_.push_back({place, about, sentence, place, 0});
  Group& group = groups_[at->second];
  group.last_place = place;
  ++group.count;
}

std::vector<std::string> GroupedComplaints::lines() const {
  std::vector<std::string> out;
  std::size_t all = 0;
  for (const Group& group : groups_) all += group.count;
  if (all > 1) {
    out.push_back(std::to_string(all) + " errors" +
                  (groups_.size() < all
                       ? " of " + std::to_string(groups_.size()) +
                             (groups_.size() == 1 ? " kind" : " kinds, each listed once")
                       : "") +
                  ":");
  }
  for (const Group& group : groups_) {
    if (out.size() > kMostLines) {
      out.push_back(std::to_string(groups_.size() - kMostLines) + " more kinds of errors");
      break;
    }
    std::string line = group.place;
    if (!group.about.empty()) line += (line.empty() ? "" : " ") + group.about;
    line += (line.empty() ? "" : ": ") + group.sentence;
    if (group.count > 1) {
      line += " (and in " + std::to_string(group.count - 1) + " more, the last " +
              group.last_place + ")";
    }
    out.push_back(line);
  }
  return out;
}

}  // namespace tribodyn::client
