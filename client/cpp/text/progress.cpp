#include "client/cpp/text/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kBarWidth = 20;

/// Returns the estimated time left, or the elapsed time while the job has done too little for an
/// estimate.
std::string time_text(const JobProgress& job, double elapsed_seconds) {
  if (job.ended || job.fraction < 0.05 || elapsed_seconds < 2)
    return duration_text(elapsed_seconds);
  return duration_text(elapsed_seconds * (1 - job.fraction) / job.fraction) + " left";
}

int percent(const JobProgress& job) {
  // Rounded down: 100 % only for a job that has ended.
  const int value = static_cast<int>(std::floor(100 * std::clamp(job.fraction, 0.0, 1.0)));
  return job.ended ? value : std::min(value, 99);
}

}  // namespace

std::string percent_text(double fraction) {
  // 1e-9: rounding of the product must not lose a percent.
  const double percent = 100 * std::clamp(fraction, 0.0, 1.0) + 1e-9;
  // Rounded down: 100 % appears only when the work is complete.
  return fraction > 0 && percent < 10 ? fixed(std::floor(10 * percent) / 10, 1)
                                      : fixed(std::floor(percent), 0);
}

std::string progress_bar_line(const JobProgress& job, int label_width, double elapsed_seconds,
                              int width) {
  const int filled = kBarWidth * percent(job) / 100;
  std::string label = printable(job.label);
  label.resize(label.size() + std::max(0, label_width - display_width(label)), ' ');
  std::string number = percent_text(percent(job) < 99 ? job.fraction : 0.01 * percent(job));
  number.insert(0, 3 - std::min<std::size_t>(3, number.size()), ' ');
  std::string line = label + " [" + std::string(filled, '#') +
                     std::string(kBarWidth - filled, '.') + "] " + number + " %  " +
                     time_text(job, elapsed_seconds) + "  " +
                     printable(job.stage.empty() || job.ended ? job.state : job.stage);
  // Cut at a code point so that a line never wraps: redraw() counts lines.
  std::size_t end = 0;
  for (int columns = 0; end < line.size(); ++end) {
    const bool starts_a_character = (static_cast<unsigned char>(line[end]) & 0xC0U) != 0x80U;
    if (starts_a_character && ++columns > width) break;
  }
  return line.substr(0, end);
}

ProgressDisplay::ProgressDisplay(std::ostream& out, ProgressForm form, int width)
    : out_(out), form_(form), width_(width), start_(std::chrono::steady_clock::now()) {}

void ProgressDisplay::show(const std::vector<JobProgress>& jobs) {
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  switch (form_) {
    case ProgressForm::kBars:
      return redraw(jobs, elapsed);
    case ProgressForm::kLines:
      return log_changes(jobs, elapsed);
    case ProgressForm::kNone:
      break;
  }
}

void ProgressDisplay::redraw(const std::vector<JobProgress>& jobs, double elapsed_seconds) {
  int label_width = 0;
  for (const JobProgress& job : jobs) label_width = std::max(label_width, display_width(job.label));
  std::string frame;
  if (lines_drawn_ > 0) frame += "\x1b[" + std::to_string(lines_drawn_) + "A";
  for (const JobProgress& job : jobs) {
    frame += "\r\x1b[K" + progress_bar_line(job, label_width, elapsed_seconds, width_ - 1) + "\n";
  }
  lines_drawn_ = jobs.size();
  out_ << frame << std::flush;
}

void ProgressDisplay::log_changes(const std::vector<JobProgress>& jobs, double elapsed_seconds) {
  logged_states_.resize(jobs.size());
  logged_tenths_.resize(jobs.size(), 0);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const JobProgress& job = jobs[i];
    const int tenths = percent(job) / 10;
    if (job.state == logged_states_[i] && tenths <= logged_tenths_[i]) continue;
    logged_states_[i] = job.state;
    logged_tenths_[i] = tenths;
    out_ << printable(job.label) << ": " << job.state;
    if (!job.ended && tenths > 0) out_ << ", " << percent(job) << " %";
    if (!job.ended && !job.stage.empty()) out_ << ", " << printable(job.stage);
    out_ << " (" << duration_text(elapsed_seconds) << ")\n" << std::flush;
  }
}

void ProgressDisplay::finish() { lines_drawn_ = 0; }

bool standard_error_is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

int standard_error_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= 40) return size.ws_col;
  return 80;
}

}  // namespace tribodyn::client
