#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tribodyn::client {

/// Handles Ctrl-C and SIGTERM during its lifetime: the first sets interrupted(), a second ends the
/// process. At most one may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  static bool interrupted();
};

/// The text of a signal that comes before anything was submitted.
inline constexpr char kNothingSubmitted[] = "interrupted; nothing was submitted.";

/// During its lifetime Ctrl-C and SIGTERM print a text on standard error and end the process with
/// kExitInterrupted at once, whatever call is under way; so it is for the time before a result is
/// followed. An InterruptGuard that begins meanwhile replaces it. At most one may exist at a time.
class InterruptText {
 public:
  explicit InterruptText(const std::string& text) { set(text); }
  ~InterruptText();
  InterruptText(const InterruptText&) = delete;
  InterruptText& operator=(const InterruptText&) = delete;
  /// Replaces the text.
  void set(const std::string& text);

 private:
  // A signal may still print an earlier text: all are kept.
  std::vector<std::unique_ptr<const std::string>> texts_;
};

}  // namespace tribodyn::client
