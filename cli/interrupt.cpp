#include "interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <initializer_list>

namespace relook {
namespace {

constexpr int kStopWaiting = SIGUSR1;  // sent by the destructor, to the waiting thread only
constexpr int kSignalExitBase = 128;   // the shell's convention for "ended by a signal"

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, kStopWaiting}) sigaddset(&set, signal);
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);  // a closed stdout is a failed write, reported at the end, and leaves no temporary files
  waiter_ = std::thread([this] { wait_for_signals(); });
}

Interrupt::~Interrupt() {
  pthread_kill(waiter_.native_handle(), kStopWaiting);
  waiter_.join();
}

void Interrupt::check() const {
  if (const int signal = signal_.load()) throw Interrupted{signal};
}

void Interrupt::wait_for_signals() {
  const sigset_t set = watched_signals();
  for (;;) {
    int signal = 0;
    if (sigwait(&set, &signal) != 0) continue;
    if (signal == kStopWaiting) return;
    if (signal_.load() != 0) _exit(kSignalExitBase + signal);
    signal_.store(signal);
  }
}

}  // namespace relook
