// SIGTERM, SIGINT and SIGHUP as a question that long work asks now and then: a thread of its own waits for them, so
// that no code runs in a signal handler and no state is global.
#pragma once
#include <atomic>
#include <thread>

namespace relook {

/// Thrown by Interrupt::check(): unwinds to main, removing temporary files on the way.
struct Interrupted {
  int signal;
};

class Interrupt {
 public:
  /// Create before any other thread: those inherit the signal mask.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Throws Interrupted once a signal has come. A second signal ends the process at once.
  void check() const;

 private:
  void wait_for_signals();

  std::atomic<int> signal_{0};
  std::thread waiter_;
};

}  // namespace relook
