#include "client/cpp/text/nearest.h"

#include <algorithm>
#include <numeric>

namespace tribodyn::client {
namespace {

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  int least = static_cast<int>(std::max<std::size_t>(2, word.size() / 3)) + 1;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  // Of a name in several words its beginning is near too: film-ratio for film-ratio-minimum.
  const bool is_beginning = best.empty() && word.find_first_of("-_") != std::string::npos;
  for (const std::string& candidate : known) {
    const bool begins = candidate.size() > word.size() && candidate.starts_with(word) &&
                        (candidate[word.size()] == '-' || candidate[word.size()] == '_');
    const bool is_shorter = best.empty() || candidate.size() < best.size();
    if (is_beginning && begins && is_shorter) best = candidate;
  }
  return best;
}

}  // namespace tribodyn::client
