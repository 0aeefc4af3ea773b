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

/// One parameter, one value a frame; the last value stays in the scene. A frame's edit is made when it is asked for: a
/// wedge takes the memory of its text, whatever its count.
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

/// What the frames of a step are made by: its one edit, the entries of a drag or the values of a wedge.
enum class StepForm : std::uint8_t { edit, drag, wedge };

struct JournalStep {
  std::string name;
  Edit edit;                        // empty for a drag and a wedge
  std::vector<std::string> select;  // drag: "/nodes/<name>" pointers
  std::vector<Edit> drag;           // one frame each; where the last one puts the selection it stays
  Wedge wedge;
  std::string where;  // "/steps/3"

  [[nodiscard]] StepForm form() const;
  /// The number of frames; 1 for an edit.
  [[nodiscard]] std::size_t frames() const;
  /// The edit that leads to a frame, from 0, from the one before; made when it is asked for.
  [[nodiscard]] Edit edit_of(std::size_t frame) const;
};

struct Journal {
  std::filesystem::path path;  // where it was read; assets and images it names lie below its folder or a --root
  std::string file;            // as named by the user, for messages
  std::string name;            // file name without extension: safe as one component of a path, at most 200 bytes
  std::string text;            // its bytes
  std::string hash;            // XXH3-128 of the bytes
  std::vector<JournalStep> steps;
};

/// The frames of all steps together, without the frame before any edit.
[[nodiscard]] std::size_t frame_count(const Journal& journal);

/// A file or, as "-", standard input. Throws InputError{file, pointer, ...} for the file as a whole, InputErrors that
/// name the wrong steps; a journal of more than kMostFrames frames is not read beyond the step that is too much.
[[nodiscard]] Journal read_journal(const std::filesystem::path& path, const WhileWaiting& while_waiting = {});
/// A journal that is not in a file yet: `path` is where it will be.
[[nodiscard]] Journal parse_journal(std::string_view text, const std::filesystem::path& path);
/// The text of a bare RFC 6902 array (--look).
[[nodiscard]] Edit parse_patch(std::string_view text, std::string_view file);

}  // namespace relook
