// journal/1: steps of RFC 6902 edits on the look document, read strictly. Nothing here knows pixels.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/standard_input.h"

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

struct JournalStep {
  std::string name;
  Edit edit;                        // empty for a drag and a wedge
  std::vector<std::string> select;  // drag: "/nodes/<name>" pointers
  std::vector<Edit> drag;           // one intermediate frame each; the last is committed
  std::vector<Edit> wedge;          // one parameter, one value and one frame each; the last stays
  std::string where;                // "/steps/3"
};

/// The frames of a step, each an edit: those of a drag or a wedge, or the one of a plain edit.
[[nodiscard]] inline std::span<const Edit> frames_of(const JournalStep& step) {
  if (!step.drag.empty()) return step.drag;
  if (!step.wedge.empty()) return step.wedge;
  return {&step.edit, 1};
}

struct Journal {
  std::filesystem::path path;  // where it was read; assets and images it names lie below its folder
  std::string file;            // as named by the user, for messages
  std::string name;            // file name without extension: safe as one component of a path, at most 200 bytes
  std::string text;            // its bytes
  std::string hash;            // XXH3-128 of the bytes
  std::vector<JournalStep> steps;
};

/// A file or, as "-", standard input. Throws InputError{file, pointer, ...} for the file as a whole, InputErrors that
/// name the wrong steps.
[[nodiscard]] Journal read_journal(const std::filesystem::path& path, const WhileWaiting& while_waiting = {});
/// A journal that is not in a file yet: `path` is where it will be.
[[nodiscard]] Journal parse_journal(std::string_view text, const std::filesystem::path& path);
/// The text of a bare RFC 6902 array (--look).
[[nodiscard]] Edit parse_patch(std::string_view text, std::string_view file);

}  // namespace relook
