// The folder of one run: frames, previews and, last, the report. Files appear whole or not at all. Those of an earlier
// run are removed first, save the frames that a run of the same inputs has finished.
#pragma once
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "edit/journal.h"
#include "engine/frame_file.h"
#include "engine/preview.h"
#include "engine/replay.h"
#include "engine/report.h"
#include "progress_file.h"

namespace relook {

class RunFolder {
 public:
  /// Throws InputError when `path` is there and neither empty nor a run.
  static void refuse_foreign(const std::filesystem::path& path);

  /// Creates the folder, or empties that of an earlier run. `run`: hash of the inputs, see run_hash(); none: nothing is
  /// noted for a later run. `is_fresh`: nothing of an earlier run is kept. Throws IoError when another run is writing
  /// here. `view`: of previews and overlays; null: sRGB.
  RunFolder(std::filesystem::path path, std::uint32_t width, std::uint32_t height, PixelFormat format,
            std::shared_ptr<const DisplayView> view, const std::optional<std::string>& run, bool is_fresh);

  /// Entries of the frames that were kept, whole steps from the first on, each file with the hash that was noted.
  [[nodiscard]] const std::vector<Json>& kept() const { return kept_; }

  /// Writes the frame and preview of a step and sets step.frame, preview and seconds.write. Only tiles of changed
  /// pixels are compressed again, and all of that happens while the next step runs: seconds.write is what this step
  /// waits for, the hash of the frame is known to write_report(), and what goes wrong is thrown by the next call.
  /// `meta.step` and `meta.change_class` are taken from `step`. `layers`: the frame's scene, if it is to have layers;
  /// they are made here, which is part of seconds.write.
  void write_step(StepReport& step, const Image& image, const ChangedPixels& changed_pixels, FrameMeta meta,
                  const Scene* layers);
  /// Writes overlays/<step>_<kind>.png: leaves that depend on the selection, leaves whose tunnels it may touch, groups.
  void write_overlays(const StepReport& step, const Replayer& replayer, const StepResult& result);
  /// After write_step() and write_overlays(), with all that is known of the step: a later run may take it over.
  void note_step(const StepReport& step);
  /// Sets the frame hashes of the steps and writes report.html, then report.json.
  void write_report(RunReport& report, const Journal& journal);

 private:
  void keep_finished_steps(const std::string& run);
  [[nodiscard]] bool has_files_of(const Json& note) const;
  void remove_all_but_kept();
  void finish_writing();
  void append_note(const std::optional<Json>& note);
  void write_frame(const std::filesystem::path& frame, const std::filesystem::path& preview, const FrameMeta& meta,
                   const std::optional<Bytes>& layered);

  std::filesystem::path path_;
  ProgressFile progress_;
  bool notes_steps_ = false;
  std::vector<Json> kept_notes_, kept_;                // as in the progress file; their entries
  std::map<std::string, std::string> overlay_hashes_;  // by file, of those written since the last note
  std::string preview_hash_;                           // of the last frame
  std::optional<Json> finished_;                       // note of the last step, not yet in the progress file
  PixelFormat format_;
  FrameEncoder encoder_;
  std::shared_ptr<const DisplayView> view_;
  PreviewEncoder preview_encoder_;
  bool preview_is_stale_ = true;
  Bytes preview_;                          // of the last frame
  std::vector<std::string> frame_hashes_;  // of the frames written so far, in the order of their steps
  std::future<void> writing_;              // uses the members above: goes first, and waits
};

}  // namespace relook
