// The folder of one run: frames, previews and, last, the report. Files appear whole or not at all; those of an earlier
// run are removed first.
#pragma once
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "base/json.h"
#include "engine/frame_file.h"
#include "engine/preview.h"
#include "engine/replay.h"
#include "engine/report.h"

namespace relook {

class RunFolder {
 public:
  /// Throws InputError when `path` is there and neither empty nor a run.
  static void refuse_foreign(const std::filesystem::path& path);

  /// Creates the folder, or empties that of an earlier run.
  RunFolder(std::filesystem::path path, std::uint32_t width, std::uint32_t height, PixelFormat format);

  /// Writes the frame and preview of a step and sets step.frame, preview and seconds.write. Only tiles of changed
  /// pixels are compressed again, and all of that happens while the next step runs: seconds.write is what this step
  /// waits for, the hash of the frame is known to write_report(), and what goes wrong is thrown by the next call.
  /// `meta.step` and `meta.change_class` are taken from `step`.
  void write_step(StepReport& step, const Frame& frame, const ChangedPixels& changed_pixels, FrameMeta meta);
  /// Writes overlays/<step>_<kind>.png: leaves that depend on the selection, leaves whose tunnels it may touch, groups.
  void write_overlays(const StepReport& step, const Replayer& replayer, const StepResult& result) const;
  /// Sets the frame hashes of the steps and writes report.json.
  void write_report(RunReport& report);

 private:
  void finish_writing();
  void write_frame(const std::filesystem::path& frame, const std::filesystem::path& preview, const FrameMeta& meta);

  std::filesystem::path path_;
  FrameEncoder encoder_;
  PreviewEncoder preview_encoder_;
  bool preview_is_stale_ = true;
  Bytes preview_;                          // of the last frame
  std::vector<std::string> frame_hashes_;  // of the frames written so far, in the order of their steps
  std::future<void> writing_;              // uses the members above: goes first, and waits
};

}  // namespace relook
