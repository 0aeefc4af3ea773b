// What is wrong with the steps of a journal, gathered, so that one look at the messages is enough to mend it.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>

#include "base/input_errors.h"
#include "edit/growth.h"

namespace relook {

/// How many wrong steps, or steps to be warned of, are named; then their number follows.
inline constexpr std::size_t kMostNamedSteps = 20;

class StepErrors {
 public:
  explicit StepErrors(std::string file) : file_(std::move(file)) {}

  /// Whether `work` on a step throws no InputError; one that it throws is noted. Other errors pass; a
  /// JournalLimitError ends the search at once, as require_none() does.
  template <class Work>
  bool is_sound(const Work& work) {
    try {
      work();
      return true;
    } catch (const JournalLimitError& error) {
      note(error.what());
      require_none();
      return false;
    } catch (const InputError& error) {
      note(error.what());
      return false;
    }
  }
  /// Throws InputErrors with the first of what was noted, if anything was.
  void require_none() const {
    if (steps_ == 0) return;
    const std::size_t more = steps_ - std::min(steps_, kMostNamedSteps);
    if (more == 0) throw InputErrors(lines_);
    throw InputErrors(lines_ + "\n" + printable(file_) + ": " + std::to_string(more) +
                      (more == 1 ? " more step is wrong" : " more steps are wrong"));
  }

 private:
  void note(const char* line) {
    if (++steps_ <= kMostNamedSteps) lines_ += (lines_.empty() ? "" : "\n") + std::string(line);
  }

  std::string file_, lines_;
  std::size_t steps_ = 0;
};

}  // namespace relook
