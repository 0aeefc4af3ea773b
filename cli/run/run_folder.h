// The folder of a run as a command writes it: frames and previews, a note of each, and in the end the report of all
// that is there. Files appear whole or not at all. Encoding and writing go on while the next frame is worked out.
#pragma once
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "edit/journal.h"
#include "frame/frame_file.h"
#include "frame/preview.h"
#include "image/layers/half_light.h"
#include "image/layers/relight_file.h"
#include "replay/replay.h"
#include "report/progress_file.h"
#include "report/report.h"
#include "report/report_file.h"
#include "run/run_plan.h"

namespace relook {

class RunFolder {
 public:
  /// What is written.
  struct Style {
    std::uint32_t width = 0, height = 0;
    PixelFormat format = PixelFormat::half;
    PreviewStyle previews;  // and of overlays
    ReportKind report = ReportKind::html;
  };

  struct FrameChange {
    const ChangedPixels& pixels;   // since the last frame
    bool follows_last = false;     // no other edit lies between it and the last frame written
    const ChangedPixels& in_step;  // since where the step starts, or the frame before it in a drag or wedge
  };

  /// What is written beside R, G, B and A.
  struct Layers {
    bool in_frame = false;  // --aovs
    bool relight = false;   // --relight
  };

  /// Creates the folder, locks the steps of `plan`, looks into the folder again and removes what is to be replaced.
  /// Throws BusyError, UsageError, IoError, ResourceError. `plan` and `journal` must outlive it.
  RunFolder(RunPlan& plan, const Journal& journal, Style style);
  ~RunFolder();

  /// Writes the frame and preview of a step and sets its files, seconds.write and command. Only tiles of changed pixels
  /// are compressed again, and all of that happens while the next step runs: seconds.write is what this step waits for,
  /// and what goes wrong is thrown by the next call. `meta.step` and `meta.change_class` are taken from `step`.
  /// `layers`: they are made here, which is part of seconds.write.
  void write_frame(StepReport& step, Replayer& replayer, const FrameChange& change, FrameMeta meta, Layers layers);
  /// The pixels of the frame last given to write_frame() that half cannot hold, layers aside; 0 where frames are
  /// float32.
  [[nodiscard]] std::uint64_t clipped_pixels() const { return clipped_pixels_; }
  /// Writes overlays/<step>_<kind>.png: leaves that depend on the selection, leaves whose tunnels it may touch, groups.
  void write_overlays(StepReport& step, const Replayer& replayer, const StepResult& result);
  /// Once all is known of a frame, or of a drag or wedge as a whole: a later command may take it over.
  void note(StepReport step);
  /// Writes report.json and report.html of all frames that are there. `interrupted`: frames of this command are
  /// missing, and the page is made quickly. `check`: called now and then while the page is made; may throw.
  void write_report(RunReport& report, bool interrupted, const std::function<void()>& check);

 private:
  void finish_writing();
  void append_notes();
  /// Files that are encoded when the next step begins.
  struct Ready {
    std::optional<Bytes> layered, relight;
  };
  void encode_and_write(const StepReport& step, const FrameMeta& meta, const Ready& ready);
  [[nodiscard]] std::vector<std::pair<LedgerKey, RunLedger::Note>> sound_notes(const RunLedger& ledger) const;
  [[nodiscard]] bool write_report_file(RunReport& report, bool interrupted);
  void write_page(const RunReport& report, bool is_quick, const std::function<void()>& check);

  RunPlan& plan_;
  const Journal& journal_;
  Style style_;
  std::filesystem::path path_;
  std::unique_ptr<ProgressFile> progress_;
  std::string command_;  // tells the entries of this command from others
  FrameEncoder encoder_;
  PreviewEncoder preview_encoder_;
  KeptHalves halves_;  // of frames with layers
  std::optional<RelightEncoder> relight_encoder_;
  bool has_written_ = false;  // the encoders have a frame
  bool preview_is_stale_ = true;
  Bytes preview_;  // of the last frame
  std::string preview_hash_;
  std::pair<std::string, std::map<std::string, FileStamp>> last_files_;  // of the last frame written: name, stamps
  std::vector<StepReport> notes_;                                        // not yet in the progress file
  std::size_t own_frames_ = 0;
  std::uint64_t clipped_pixels_ = 0;
  std::uint64_t noted_bytes_ = 0;  // of the progress file, when the report was written
  std::unique_ptr<ReportFile> report_file_;
  std::future<void> writing_;  // uses the members above: goes first, and waits
};

}  // namespace relook
