#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tribodyn::client {

/// The errors in a table; an error that many rows share is listed once.
class GroupedComplaints {
 public:
  /// `place` is a row, e.g. "row 3"; `about` is the column or empty.
  void add(const std::string& place, const std::string& about, const std::string& sentence);
  /// Adds an error of the whole table.
  void add(const std::string& sentence) { add("", "", sentence); }

  bool empty() const { return groups_.empty(); }
  /// Returns one line per error: "row 3 column density15: '0.895' ... (and in 29 more rows, the
  /// last row 32)". Several errors are preceded by their number; at most the first hundred are
  /// listed.
  std::vector<std::string> lines() const;

 private:
  struct Group {
    std::string place, about, sentence, last_place;
    std::size_t count = 0;
  };
  std::vector<Group> groups_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;  ///< key: about and sentence
};

}  // namespace tribodyn::client
