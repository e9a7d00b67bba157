#pragma once

#include <chrono>
#include <ostream>
#include <string>
#include <vector>

namespace tribodyn::client {

/// How far one job is.
struct JobProgress {
  std::string label;    ///< e.g. "lubricants/1"
  std::string state;    ///< "queued", "running", ...
  std::string stage;    ///< e.g. "settling at 65 km/h"
  double fraction = 0;  ///< [0, 1]
  bool ended = false;
};

/// A fraction in percent: "0.4", "12". Below 10 % there is a decimal, so that a curve of a thousand
/// points is seen to move.
std::string percent_text(double fraction);

/// One terminal line: label, bar, percent, time, stage; at most `width` columns.
std::string progress_bar_line(const JobProgress& job, int label_width, double elapsed_seconds,
                              int width);

/// How progress is shown.
enum class ProgressForm {
  kNone,
  kBars,   ///< redrawn in place: for a terminal
  kLines,  ///< a line when a job changes state or has come another 10 %: for a log
};

/// Shows several jobs. Not thread safe.
class ProgressDisplay {
 public:
  ProgressDisplay(std::ostream& out, ProgressForm form, int width);
  void show(const std::vector<JobProgress>& jobs);
  /// Leaves the last picture standing (bars) and ends the display.
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

/// Whether standard error is a terminal that can move its cursor, and its width.
bool standard_error_is_terminal();
int standard_error_width();

}  // namespace tribodyn::client
