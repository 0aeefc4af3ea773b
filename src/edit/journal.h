// journal/1: steps of RFC 6902 edits on the look document, read strictly. Nothing here knows pixels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/system/standard_input.h"
#include "edit/patch_operation.h"
#include "edit/wedge/wedge.h"

namespace relook {

/// The most frames a journal may have, of all its steps together.
inline constexpr std::size_t kMostFrames = 1'000'000;

/// What the frames of a step are made by: its one edit, the entries of a drag or the values of a wedge.
enum class StepForm : std::uint8_t { edit, drag, wedge };

/// What people write beside what is to be done: of a journal, and of a step.
struct Annotations {
  std::string note, author;  // "": none
  Json extras;               // anything; null: none
};

/// A text, or null where there is none.
[[nodiscard]] Json text_or_null(const std::string& text);

struct JournalStep {
  std::string name;
  Annotations said;
  std::optional<std::uint32_t> from;  // starts from the state after this earlier step, 0: base; none: the one before
  bool keep = true;                   // false: after a drag or wedge the scene is as it was before
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
  Annotations said;
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
