#include "client/cpp/service/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "client/cpp/failure.h"
#include "client/cpp/text/colour.h"

namespace tribodyn::client {
namespace {

volatile std::sig_atomic_t interrupt_noted = 0;

void note_interrupt(int signal) {
  interrupt_noted = 1;
  std::signal(signal, SIG_DFL);  // the next signal ends the process
}

std::atomic<const std::string*> text_of_interrupt;
static_assert(decltype(text_of_interrupt)::is_always_lock_free, "a signal handler reads it");

void end_with_text(int /*signal*/) {
  const std::string& text = *text_of_interrupt.load();
  // The process ends whether the text was written or not.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
  std::_Exit(kExitInterrupted);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupt_noted = 0;
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::interrupted() { return interrupt_noted != 0; }

InterruptText::~InterruptText() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void InterruptText::set(const std::string& text) {
  const bool is_first = texts_.empty();
  texts_.push_back(std::make_unique<const std::string>(alarm("tribodyn:") + " " + text + "\n"));
  text_of_interrupt = texts_.back().get();
  if (!is_first) return;
  std::signal(SIGINT, end_with_text);
  std::signal(SIGTERM, end_with_text);
}

}  // namespace tribodyn::client
