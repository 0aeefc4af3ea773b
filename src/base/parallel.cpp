#include "base/parallel.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <memory>
#include <utility>

#include "base/system/sanitizers.h"

namespace relook {
namespace {

// TBB's limit on threads lives as long as this object, which belongs to the process.
std::unique_ptr<tbb::global_control>& limit() {
  static std::unique_ptr<tbb::global_control> control;
  return control;
}

// The signal that interrupts loops belongs to the process, too; that nothing may interrupt them belongs to a thread.
std::atomic<const std::atomic<int>*> interruption = nullptr;
thread_local bool is_uninterrupted = false;

const std::atomic<int>* interruption_here() { return is_uninterrupted ? nullptr : interruption.load(); }

}  // namespace

void let_loops_be_interrupted(const std::atomic<int>* signal) { interruption.store(signal); }

Uninterrupted::Uninterrupted() : was_uninterrupted_(std::exchange(is_uninterrupted, true)) {}
Uninterrupted::~Uninterrupted() { is_uninterrupted = was_uninterrupted_; }

bool is_interrupted() {
  const std::atomic<int>* const signal = interruption_here();
  return signal != nullptr && signal->load(std::memory_order_relaxed) != 0;
}

void stop_if_interrupted() {
  if (is_interrupted()) throw Interrupted{interruption_here()->load()};
}

void set_thread_count(std::size_t threads) {
  limit().reset();
  if (threads > 0)
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

void set_float_mode() {
#if defined(__x86_64__)
  constexpr unsigned kFlushToZero = 1U << 15, kDenormalsAreZero = 1U << 6, kAllMasked = 0x1F80;
  _mm_setcsr(kAllMasked | kFlushToZero | kDenormalsAreZero);
#endif
}

std::size_t thread_count() { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); }

namespace {

/// The meeting of threads before and after a loop. It is TBB's business; but the thread sanitizer does not see into
/// Debian's TBB, so in its builds an atomic says the same once more.
class Meeting {
 public:
  void pass_on() {
    if constexpr (kHasThreadSanitizer) passed_.fetch_add(1, std::memory_order_release);
  }
  void take_over() {
    if constexpr (kHasThreadSanitizer) static_cast<void>(passed_.load(std::memory_order_acquire));
  }

 private:
  std::atomic<int> passed_ = 0;
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain) {
  // Embree changes the treatment of denormal numbers, and TBB hands the mode of whoever came first on to its threads:
  // every body gets ours, whatever ran before.
  set_float_mode();
  tbb::task_group_context context(tbb::task_group_context::isolated,
                                  tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
  Meeting before, after;
  const std::atomic<int>* const signal = interruption_here();
  const bool was_uninterrupted = is_uninterrupted;
  const auto run = [&](const auto& range) {
    before.take_over();
    const bool other = std::exchange(is_uninterrupted, was_uninterrupted);  // for loops within bodies
    const auto put_back = [&](bool* value) { *value = other; };
    const std::unique_ptr<bool, decltype(put_back)> at_end(&is_uninterrupted, put_back);
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const int stop = signal == nullptr ? 0 : signal->load(std::memory_order_relaxed);
      if (stop != 0) throw Interrupted{stop};
      body(i);
    }
    after.pass_on();
  };
  before.pass_on();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), run, context);
  after.take_over();
}

void run_isolated(const std::function<void()>& work) { tbb::this_task_arena::isolate(work); }

}  // namespace relook
