#pragma once

#include <stdexcept>
#include <string>

namespace tribodyn::server {

/// The database cannot be used, or not any more. what() is a sentence for the person who runs the
/// server; it names the file and never holds what is stored in it.
class StoreError : public std::runtime_error {
 public:
  enum class Kind {
    kCannotOpen,
    kInUse,        ///< another server has it
    kNewerSchema,  ///< written by a newer tribodynd
    kForeign,      ///< a database of another program
    kCorrupt,
    kReadOnly,
    kDataLoss,   ///< stored bytes are not what was written
    kMisplaced,  ///< its file was deleted, renamed or replaced while the server has it open
    kDeadline,   ///< the caller's deadline passed (call_limits.h); nothing has changed
    kCancelled,  ///< the caller gave up (call_limits.h); nothing has changed
    kFailed,     ///< a statement failed: disk full, I/O error
  };
  StoreError(Kind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace tribodyn::server
