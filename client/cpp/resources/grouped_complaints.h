#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tribodyn::client {

/// What is wrong with a table, each mistake told once however many rows make it.
class GroupedComplaints {
 public:
  /// `place` is a row, "row 3"; `about` the column or nothing.
  void add(const std::string& place, const std::string& about, const std::string& sentence);
  /// A mistake of the whole table.
  void add(const std::string& sentence) { add("", "", sentence); }

  bool empty() const { return groups_.empty(); }
  /// A line each: "row 3 column density15: '0.895' ... (and in 29 more rows, the last row 32)". Of
  /// several, first how many there are; of very many, the first hundred.
  std::vector<std::string> lines() const;

 private:
  struct Group {
    std::string place, about, sentence, last_place;
    std::size_t count = 0;
  };
  std::vector<Group> groups_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;  ///< by about and sentence
};

}  // namespace tribodyn::client
