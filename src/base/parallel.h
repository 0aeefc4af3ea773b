// Work split over threads. Results must go to slots of their own index: the order of execution is not defined, the
// outcome must not depend on it.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>

namespace relook {

/// Limits every later parallel_for of the process; 0 means all hardware threads. Call before any other work.
void set_thread_count(std::size_t threads);
[[nodiscard]] std::size_t thread_count();

/// Rounding to nearest, denormal numbers are zero, on this thread: the one mode in which pixels are computed. For the
/// start of a program, and after a call into a library that may have changed it; parallel_for sets it for its bodies.
void set_float_mode();

/// Thrown where work ends because a signal has come.
struct Interrupted {
  int signal;
};
/// From now on every parallel_for of the process throws Interrupted before its next body once `signal` is not 0, so
/// that no long work needs to ask. Null: no longer. `signal` must outlive that.
void let_loops_be_interrupted(const std::atomic<int>* signal);
/// While it lives, loops that this thread begins go on to their end: for what is to be finished all the same.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;

 private:
  bool was_uninterrupted_;
};
/// Whether a loop that this thread begins now would be interrupted.
[[nodiscard]] bool is_interrupted();
/// For long work within one body: throws Interrupted if a loop would.
void stop_if_interrupted();

/// Calls body(i) once for each i in [0, count), `grain` at least at a time on one thread. The first exception thrown by
/// a body is rethrown here.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain = 1);

/// Runs `work`, whose own parallel loops this thread waits for without taking on anything else: what is locked around
/// it stays safe from other bodies of a parallel_for that this one runs in.
void run_isolated(const std::function<void()>& work);

}  // namespace relook
