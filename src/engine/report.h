// report.json, version 1: what each step of a run cost and what it could skip. Its names are stable: report.schema.json
// beside this file has all of them; additions are welcome, renames are not.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "edit/apply.h"
#include "engine/counters.h"
#include "engine/image.h"
#include "scene/camera.h"

namespace relook {

inline constexpr std::int64_t kReportVersion = 1;

/// The program's own version, "0.1.0".
[[nodiscard]] std::string_view program_version();

/// Bit-by-bit comparison of a step's frame with a full render of the edited scene.
struct VerifyResult {
  std::uint64_t pixels_compared = 0, pixels_different = 0;
};

struct StepReport {
  std::uint32_t step = 0;  // 0: before any edit
  std::string name;
  ChangeClass change = ChangeClass::base;
  std::vector<std::string> reasons;
  std::optional<std::uint32_t> drag_frame;   // 1.. for the intermediate frames of a drag
  std::optional<std::uint32_t> wedge_frame;  // 1.. for the values of a wedge
  [[nodiscard]] std::optional<std::uint32_t> frame_in_step() const { return drag_frame ? drag_frame : wedge_frame; }
  std::string frame, frame_hash, preview;  // files relative to the run directory; XXH3-128 of the frame's bytes
  Counters counters;
  Seconds seconds;
  Resident resident;
  std::uint64_t peak_rss_bytes = 0;
  std::optional<VerifyResult> verify;
};

/// Steps of a journal, from 1; 0 is the frame before any of them.
struct StepRange {
  std::uint32_t first = 0;
  std::optional<std::uint32_t> last;  // none: to the end
};

/// Structure options as given; frames never depend on them.
struct StructureOptions {
  std::optional<std::uint64_t> memory_bytes;
  std::string policy = "weight";            // of eviction
  std::optional<std::uint64_t> disk_bytes;  // of the spill file
  double ray_trees_percent = 100, color_trees_percent = 100;
  std::uint32_t tunnels = 1, groups = 4, atoms = 0;
  std::vector<std::string> params;  // pointers to parameters that are subject to change; empty: any may be
};

struct CacheSizes {
  std::map<std::string, std::uint64_t> bytes_by_part;  // "look", "geometry", ...
  std::uint64_t total_bytes = 0;
  std::uint64_t samples = 1;
  /// Bytes a sample by part, and of all together as "total".
  [[nodiscard]] std::map<std::string, double> per_sample() const;
};

struct RunReport {
  std::string scene, scene_hash;      // file as named when the cache was made
  std::string cache_folder;           // as named by the user
  std::string journal, journal_hash;  // file as named by the user
  Camera camera;
  ViewOptions view;
  StructureOptions structures;
  bool float_frames = false;
  bool layers = false;  // --aovs
  std::optional<double> verify_percent;
  std::optional<StepRange> step_range;  // none: all
  std::size_t threads = 0;
  std::optional<double> full_render_seconds;
  CacheSizes cache;
  std::vector<std::string> cache_damage;  // sentences: what was damaged or missing and traced again
  bool interrupted = false;               // ended by a signal or for want of memory: later steps are missing
  std::vector<Json>
      resumed;  // step_json() of frames that an earlier run of the same inputs has finished; before `steps`
  double resume_seconds = 0;  // to get to where that run was
  std::vector<StepReport> steps;
};

[[nodiscard]] Json report_json(const RunReport& report);
/// Its entry of `steps`, and its `options`.
[[nodiscard]] Json step_json(const StepReport& step);
[[nodiscard]] Json options_json(const RunReport& report);

/// The class of several edits together, by the rule of classify(): that of a drag's release.
[[nodiscard]] ChangeClass combined(ChangeClass a, ChangeClass b);

/// "frames/0003.exr", "frames/0003_01.exr".
[[nodiscard]] std::string frame_name(std::uint32_t step, std::optional<std::uint32_t> frame_in_step);
[[nodiscard]] std::string preview_name(std::uint32_t step, std::optional<std::uint32_t> frame_in_step);
/// "3", "3_01".
[[nodiscard]] std::string step_label(std::uint32_t step, std::optional<std::uint32_t> frame_in_step);

/// Largest resident set of this process so far.
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace relook
