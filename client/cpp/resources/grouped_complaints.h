#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn::client {

/// The errors in a table. Errors that differ in the cell's text and in numbers alone are of one
/// kind, of which a few are listed.
class GroupedComplaints {
 public:
  /// `place` is a row, e.g. "row 3"; `about` is the column or empty.
  void add(const std::string& place, const std::string& about, const std::string& sentence);
  /// Adds an error of the whole table.
  void add(const std::string& sentence) { add("", "", sentence); }

  /// Adds errors of which no more is known.
  void add_unlisted(std::size_t count) { unlisted_ += count; }

  bool empty() const { return kinds_.empty() && unlisted_ == 0; }
  /// Returns lines such as "row 3 column density15: '0.895' ... (and in 29 more, the last row 32)".
  /// Several errors are preceded by their number. Of each kind at most three different sentences
  /// are listed, then the number of the others.
  std::vector<std::string> lines() const;

 private:
  /// One sentence, and how many rows share it.
  struct Sentence {
    std::string place, text, last_place;
    std::size_t count = 0;
  };
  struct Kind {
    std::string about;
    std::vector<Sentence> sentences;        ///< the first ones
    std::map<std::string, std::size_t> at;  ///< their positions, by text
    std::size_t others = 0;                 ///< errors with other sentences
    std::string last_other;                 ///< place of the last of these
    std::size_t count() const;
  };
  std::size_t unlisted_ = 0;
  std::vector<Kind> kinds_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;  ///< key: about and kind
};

}  // namespace tribodyn::client
