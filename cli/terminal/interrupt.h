// Signals that ask the program to end, as a question that long work asks now and then: TERM, INT, HUP, and USR1, USR2
// and XCPU, by which schedulers give notice. A thread of its own waits for them, so that no code runs in a signal
// handler. Once one has come, further ones change nothing.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

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

  /// Whether a signal has come, also for work that goes on to its end all the same.
  [[nodiscard]] bool has_come() const { return signal_.load() != 0; }

  /// While it lives nothing is being made that would be lost or left half done: when work does not come to a check()
  /// for a second and a half after a signal (an image that is being decoded, say), the process ends at once.
  class Expendable {
   public:
    explicit Expendable(const Interrupt& interrupt) : count_(interrupt.expendable_) { ++count_; }
    ~Expendable() { --count_; }
    Expendable(const Expendable&) = delete;
    Expendable& operator=(const Expendable&) = delete;

   private:
    std::atomic<int>& count_;
  };
  /// Sets what is called before the process ends so.
  void set_last_words(std::function<void(int signal)> last_words) {
    const std::lock_guard lock(mutex_);
    last_words_ = std::move(last_words);
  }

 private:
  void wait_for_signals();

  std::atomic<int> signal_{0};
  mutable std::atomic<int> expendable_{0};
  std::mutex mutex_;
  std::function<void(int)> last_words_;
  std::thread waiter_;
};

}  // namespace relook
