// What a frame of a journal is called: in messages, and as a file of a run. Which frames there are, edit/journal_walk.h
// says.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace relook {

/// A frame of a journal: 0 is the one before any edit; a drag or a wedge has frames numbered from 1.
struct FramePlace {
  std::uint32_t step = 0;
  std::optional<std::uint32_t> number;
  std::uint32_t count = 0;  // frames of the step, if they are numbered
};
/// "3", "3_01", "3_001": as many digits as the count has, at least two.
[[nodiscard]] std::string step_label(const FramePlace& place);
/// "frames/0003.exr", "frames/0003_01.exr".
[[nodiscard]] std::string frame_name(const FramePlace& place);
[[nodiscard]] std::string preview_name(const FramePlace& place);
[[nodiscard]] std::string relight_name(const FramePlace& place);

}  // namespace relook
