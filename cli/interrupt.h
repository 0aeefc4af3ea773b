// Signals that ask the program to end, as a question that long work asks now and then: TERM, INT, HUP, and USR1, USR2
// and XCPU, by which schedulers give notice. A thread of its own waits for them, so that no code runs in a signal
// handler. Once one has come, further ones change nothing.
#pragma once
#include <atomic>
#include <thread>

#include "base/parallel.h"

namespace relook {

class Interrupt {
 public:
  /// Create before any other thread: those inherit the signal mask. Loops of the whole process are interrupted, too.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Throws Interrupted once a signal has come: unwinds to main, removing temporary files on the way.
  void check() const;

 private:
  void wait_for_signals();

  std::atomic<int> signal_{0};
  std::thread waiter_;
};

}  // namespace relook
