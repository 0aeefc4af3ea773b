#include "terminal/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <initializer_list>

namespace relook {
namespace {

constexpr int kSignalExitBase = 128;  // the shell's convention for "ended by a signal"

/// The signal that the destructor sends to the waiting thread only.
int stop_waiting() { return SIGRTMIN; }

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, stop_waiting()}) sigaddset(&set, signal);
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);  // a closed stdout is a failed write, reported at the end, and leaves no temporary files
  signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is a failed write, too
  let_loops_be_interrupted(&signal_);
  waiter_ = std::thread([this] { wait_for_signals(); });
}

Interrupt::~Interrupt() {
  let_loops_be_interrupted(nullptr);
  pthread_kill(waiter_.native_handle(), stop_waiting());
  waiter_.join();
}

void Interrupt::check() const {
  if (is_interrupted()) throw Interrupted{signal_.load()};
}

void Interrupt::wait_for_signals() {
  constexpr auto kPatience = std::chrono::milliseconds(1500);
  constexpr timespec kPause{0, 100'000'000};
  const sigset_t set = watched_signals();
  std::chrono::steady_clock::time_point first;
  for (;;) {
    const int signal = signal_.load() == 0 ? sigwaitinfo(&set, nullptr) : sigtimedwait(&set, nullptr, &kPause);
    if (signal == stop_waiting()) return;
    int none = 0;
    if (signal > 0 && signal_.compare_exchange_strong(none, signal)) first = std::chrono::steady_clock::now();
    const bool is_late = signal_.load() != 0 && std::chrono::steady_clock::now() - first > kPatience;
    if (!is_late || expendable_.load() == 0) continue;
    const std::lock_guard lock(mutex_);
    if (last_words_) last_words_(signal_.load());
    _exit(kSignalExitBase + signal_.load());
  }
}

}  // namespace relook
