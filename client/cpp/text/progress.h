#pragma once

#include <chrono>
#include <ostream>
#include <string>
#include <vector>

namespace tribodyn::client {

/// The progress of one job.
struct JobProgress {
  std::string label;    ///< e.g. "lubricants/paper-fluid-1"
  std::string state;    ///< "queued", "running", ...
  std::string stage;    ///< e.g. "settling at 65 km/h"
  double fraction = 0;  ///< [0, 1]
  bool ended = false;
};

/// Returns a fraction in percent, e.g. "0.4" or "12". Below 10 % it has one decimal, so that the
/// progress of a curve of a thousand points is visible.
std::string percent_text(double fraction);

/// Returns one terminal line of at most `width` columns: label, bar, percent, time, stage.
std::string progress_bar_line(const JobProgress& job, int label_width, double elapsed_seconds,
                              int width);

/// How progress is shown.
enum class ProgressForm {
  kNone,
  kBars,   ///< redrawn in place: for a terminal
  kLines,  ///< a line whenever a job changes state or progresses by another 10 %: for a log
};

/// Shows the progress of several jobs. Not thread safe.
class ProgressDisplay {
 public:
  ProgressDisplay(std::ostream& out, ProgressForm form, int width);
  void show(const std::vector<JobProgress>& jobs);
  /// Ends the display; the last bars stay on the terminal.
  void finish();

 private:
  void redraw(const std::vector<JobProgress>& jobs, double elapsed_seconds);
  void log_changes(const std::vector<JobProgress>& jobs, double elapsed_seconds);

  std::ostream& out_;
  ProgressForm form_;
  int width_;
  std::chrono::steady_clock::time_point start_;
  std::size_t lines_drawn_ = 0;
  std::vector<std::string> logged_states_;
  std::vector<int> logged_tenths_;
};

/// Whether standard error is a terminal that can move its cursor, and how many columns it has.
bool standard_error_is_terminal();
int standard_error_width();

}  // namespace tribodyn::client
