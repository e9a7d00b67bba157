#pragma once

#include <stdexcept>
#include <string>

namespace tribodyn::server {

/// Error of the store: the database cannot be used. what() is a sentence for the operator; it names
/// the file and never contains stored data.
class StoreError : public std::runtime_error {
 public:
  enum class Kind {
    kCannotOpen,
    kInUse,         ///< another server uses it
    kOtherVersion,  ///< written by another version of tribodynd
    kForeign,       ///< a database of another program
    kCorrupt,
    kReadOnly,
    kDataLoss,   ///< stored bytes differ from their checksum
    kMisplaced,  ///< its file was deleted, renamed or replaced while a server uses it
    kDeadline,   ///< the deadline of the caller passed (call_limits.h); nothing has changed
    kCancelled,  ///< the caller cancelled (call_limits.h); nothing has changed
    kFull,       ///< the disk is full
    kFailed,     ///< a statement failed: I/O error
  };
  StoreError(Kind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace tribodyn::server
