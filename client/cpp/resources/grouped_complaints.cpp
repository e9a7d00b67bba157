#include "client/cpp/resources/grouped_complaints.h"

#include <algorithm>

namespace tribodyn::client {
namespace {

constexpr std::size_t kMostKinds = 30;
constexpr std::size_t kMostOfAKind = 3;  // different sentences

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the sentence without quoted texts and without digits.
std::string kind_of_sentence(const std::string& sentence) {
  std::string out;
  bool is_quoted = false;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    const char c = sentence[i];
    const bool opens = c == '\'' && (i == 0 || sentence[i - 1] == ' ' || sentence[i - 1] == '(');
    if (c == '\'' && (is_quoted || opens)) is_quoted = !is_quoted;
    if (!is_quoted && !is_digit(c) && c != '.') out += c;
  }
  return out;
}

}  // namespace

std::size_t GroupedComplaints::Kind::count() const {
  std::size_t out = others;
  for (const Sentence& each : sentences) out += each.count;
  return out;
}

void GroupedComplaints::add(const std::string& place, const std::string& about,
                            const std::string& sentence) {
  const auto [found, is_new] =
      index_.emplace(std::pair(about, kind_of_sentence(sentence)), kinds_.size());
  if (is_new) kinds_.push_back({about, {}, {}, 0, ""});
  Kind& kind = kinds_[found->second];
  const auto at = kind.at.find(sentence);
  if (at == kind.at.end() && kind.sentences.size() == kMostOfAKind) {
    ++kind.others;
    kind.last_other = place;
    return;
  }
  if (at == kind.at.end()) {
    kind.at.emplace(sentence, kind.sentences.size());
    kind.sentences.push_back({place, sentence, place, 1});
    return;
  }
  Sentence& same = kind.sentences[at->second];
  same.last_place = place;
  ++same.count;
}

std::vector<std::string> GroupedComplaints::lines() const {
  std::vector<std::string> out;
  std::size_t all = unlisted_;
  for (const Kind& kind : kinds_) all += kind.count();
  if (all > 1) {
    out.push_back(
        std::to_string(all) + " errors" +
        (kinds_.size() < all && unlisted_ == 0
             ? " of " + std::to_string(kinds_.size()) + (kinds_.size() == 1 ? " kind" : " kinds")
             : "") +
        ":");
  }
  for (std::size_t k = 0; k < std::min(kinds_.size(), kMostKinds); ++k) {
    const Kind& kind = kinds_[k];
    for (const Sentence& each : kind.sentences) {
      std::string line = each.place;
      if (!kind.about.empty()) line += (line.empty() ? "" : " ") + kind.about;
      line += (line.empty() ? "" : ": ") + each.text;
      if (each.count > 1) {
        line += " (and in " + std::to_string(each.count - 1) + " more, the last " +
                each.last_place + ")";
      }
      out.push_back(line);
    }
    if (kind.others > 0) {
      out.push_back("... " + std::to_string(kind.others) + " more like these" +
                    (kind.last_other.empty() ? "" : ", the last in " + kind.last_other));
    }
  }
  if (kinds_.size() > kMostKinds) {
    out.push_back("... " + std::to_string(kinds_.size() - kMostKinds) + " more kinds of errors");
  }
  if (unlisted_ > 0) out.push_back("... " + std::to_string(unlisted_) + " more errors");
  return out;
}

}  // namespace tribodyn::client
