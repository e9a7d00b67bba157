#include "client/cpp/service/interrupt.h"

#include <csignal>

namespace tribodyn::client {
namespace {

volatile std::sig_atomic_t interrupt_noted = 0;

void note_interrupt(int signal) {
  interrupt_noted = 1;
  std::signal(signal, SIG_DFL);  // the next signal ends the process
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

}  // namespace tribodyn::client
