// journal/1: steps of RFC 6902 edits on the look document, read strictly. Nothing here knows pixels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/system/standard_input.h"

namespace relook {

enum class PatchOp : std::uint8_t { add, remove, replace, move, copy, test };

struct PatchOperation {
  PatchOp op = PatchOp::replace;
  std::string path;         // as written
  std::string from;         // move, copy
  Json value;               // add, replace, test
  std::string where;        // pointer into the journal: "/steps/3/edit/0"; its path is below it
  std::string value_where;  // pointer to the value: "/steps/3/edit/0/value"
};
using Edit = std::vector<PatchOperation>;

/// One parameter, one value a frame; the last stays. A frame's edit is made when it is asked for: a wedge takes the
/// memory of its text, whatever its count.
struct Wedge {
  std::string path;
  std::vector<Json> values;  // empty for a range
  Json from, to;             // a range: numbers or arrays of as many numbers
  std::size_t count = 0;     // of frames
  std::string where;         // "/steps/3/wedge"
  [[nodiscard]] bool empty() const { return count == 0; }
  [[nodiscard]] std::size_t size() const { return count; }
  /// A "replace" of the value; of a range, `i` of `count` evenly spaced ones from `from` to `to`.
  [[nodiscard]] Edit operator[](std::size_t i) const;
};

/// The most frames a journal may have, of all its steps together.
inline constexpr std::size_t kMostFrames = 1'000'000;

struct JournalStep {
  std::string name;
  Edit edit;                        // empty for a drag and a wedge
  std::vector<std::string> select;  // drag: "/nodes/<name>" pointers
  std::vector<Edit> drag;           // one intermediate frame each; the last is committed
  Wedge wedge;
  std::string where;  // "/steps/3"
};

/// The frames of a step, each an edit: those of a drag or a wedge, or the one of a plain edit. Refers to the step.
class StepFrames {
 public:
  class Iterator {
   public:
    Iterator(const StepFrames& frames, std::size_t at) : frames_(frames), at_(at) {}
    [[nodiscard]] Edit operator*() const { return frames_[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    [[nodiscard]] bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const StepFrames& frames_;
    std::size_t at_;
  };
  explicit StepFrames(const JournalStep& step) : step_(&step) {}
  [[nodiscard]] std::size_t size() const {
    return !step_->drag.empty() ? step_->drag.size() : !step_->wedge.empty() ? step_->wedge.size() : 1;
  }
  [[nodiscard]] Edit operator[](std::size_t i) const {
    return !step_->drag.empty() ? step_->drag[i] : !step_->wedge.empty() ? step_->wedge[i] : step_->edit;
  }
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator end() const { return {*this, size()}; }

 private:
  const JournalStep* step_;
};
[[nodiscard]] inline StepFrames frames_of(const JournalStep& step) { return StepFrames(step); }

struct Journal {
  std::filesystem::path path;  // where it was read; assets and images it names lie below its folder
  std::string file;            // as named by the user, for messages
  std::string name;            // file name without extension: safe as one component of a path, at most 200 bytes
  std::string text;            // its bytes
  std::string hash;            // XXH3-128 of the bytes
  std::vector<JournalStep> steps;
};

/// A file or, as "-", standard input. Throws InputError{file, pointer, ...} for the file as a whole, InputErrors that
/// name the wrong steps; a journal of more than kMostFrames frames is not read beyond the step that is too much.
[[nodiscard]] Journal read_journal(const std::filesystem::path& path, const WhileWaiting& while_waiting = {});
/// A journal that is not in a file yet: `path` is where it will be.
[[nodiscard]] Journal parse_journal(std::string_view text, const std::filesystem::path& path);
/// The text of a bare RFC 6902 array (--look).
[[nodiscard]] Edit parse_patch(std::string_view text, std::string_view file);

}  // namespace relook
