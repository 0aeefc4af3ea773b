// report.json, version 1: what each step of a run cost and what it could skip, from the plain values below to JSON. Its
// names are stable: report.schema.json beside this file has all of them; names may be added, none is renamed. Filled
// and written by cli/run/; report_file.h has the layout of the file.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "edit/apply.h"
#include "edit/frame_place.h"
#include "image/counters.h"
#include "frame/image.h"
#include "scene/camera.h"

namespace relook {

/// The program's own version, "0.1.0".
[[nodiscard]] std::string_view program_version();

/// Bit-by-bit comparison of a step's frame with a full render of the edited scene.
struct VerifyResult {
  std::uint64_t pixels_compared = 0, pixels_different = 0;
};

/// A full render of the scene that a frame shows, without writing: what the frame would cost without a cache.
struct FullRender {
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t rays = 0;    // and shadow segments: those of the frame's ray trees
  bool is_measured = false;  // otherwise the one of --baseline, scaled by its rays
};

/// A file of a run as it was written.
struct FileStamp {
  std::string hash;  // XXH3-128
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  // nanoseconds since the epoch: with `bytes`, tells most changes without reading the file
};

/// One entry of `steps`: of a frame, or of a drag or wedge as a whole, which has no frame of its own and names its last
/// one.
struct StepReport {
  FramePlace place;
  bool is_whole_step = false;  // of a drag or wedge
  std::string name;
  Json words = Json::object();  // what the journal says of it, the name too: entry_words() (report/journal_words.h)
  ChangeClass change = ChangeClass::base;
  std::vector<std::string> reasons;
  bool is_drag = false;        // of numbered frames: they are a drag's, otherwise a wedge's
  std::string frame, preview;  // files relative to the run folder
  std::string edits_hash;      // see report/edit_hashes.h
  std::string source_hash;     // of RunReport::source
  double exposure = 0;         // stops, of the preview and the overlays
  bool has_overlays = false;   // --overlays
  bool has_relight = false;    // --relight
  std::optional<double> verify_percent;
  std::string command;  // which command has done it: 16 hexadecimal digits, of its own
  std::map<std::string, FileStamp>
      files;  // of the frame, its preview, overlays and layers of light, by name; known once they are written
  Counters counters;
  Seconds seconds;
  Resident resident;
  std::uint64_t peak_rss_bytes = 0;
  std::optional<VerifyResult> verify;
  std::optional<FullRender> full_render;  // none: neither --verify nor --baseline
};

/// Steps of a journal, from 1; 0 is the frame before any of them.
struct StepRange {
  std::uint32_t first = 0;
  std::optional<std::uint32_t> last;  // none: to the end
};

/// The options of structures and memory as given; frames never depend on them.
struct StructureOptions {
  std::optional<std::uint64_t> memory_bytes;
  std::string policy = "weight";            // of eviction
  std::optional<std::uint64_t> disk_bytes;  // of the spill file
  double ray_trees_percent = 100, color_trees_percent = 100;
  std::uint32_t tunnels = 1, groups = 4, atoms = 0;
  std::uint32_t tunnel_levels = 2;            // the lowest levels without tunnels
  std::optional<std::uint64_t> most_tunnels;  // of the image; none: no limit
  std::vector<std::string> params;            // pointers to parameters that are subject to change; empty: any may be
};

struct CacheSizes {
  std::map<std::string, std::uint64_t> bytes_by_part;  // "look", "geometry", ...
  std::uint64_t total_bytes = 0;
  std::uint64_t samples = 1;
  /// Bytes a sample by part, and of all together as "total".
  [[nodiscard]] std::map<std::string, double> per_sample() const;
};

/// What report.json says of a run as a whole.
struct RunReport {
  std::string scene, scene_hash;      // file as named when the cache was made
  std::string cache_folder;           // as named by the user
  std::string journal, journal_hash;  // file as named by the user
  Annotations said;                   // of the journal as a whole
  Json source;                        // what all frames of the run have in common (report/run_source.h)
  Json places;                        // where cache and journal are (report/places.h)
  Camera camera;
  ViewOptions view;
  StructureOptions structures;
  bool float_frames = false;
  bool layers = false;  // --aovs
  bool relight = false;  // --relight
  double exposure = 0;  // stops, of previews
  std::optional<double> verify_percent;
  std::optional<StepRange> step_range;  // none: all
  std::size_t threads = 0;
  std::optional<double> noise;  // of the frame before any step (image/layers/half_light.h)
  std::optional<double> full_render_seconds;
  CacheSizes cache;
  std::vector<std::string> cache_damage;  // sentences: what was damaged or missing and traced again
  bool interrupted = false;               // frames that were asked for are missing
  std::vector<std::string> parts;         // the ranges of steps asked for so far: "1-5"
  std::size_t frames = 0;                 // that are there
  std::size_t resumed_frames = 0;         // of these, done by other commands
  double resume_seconds = 0;              // to get to where frames were missing
};

/// All of report.json but `steps` and `frames`.
[[nodiscard]] Json report_head_json(const RunReport& report);
/// An entry of `steps`.
[[nodiscard]] Json step_json(const StepReport& step);

/// The class of this name, other than base; colour for any other name.
[[nodiscard]] ChangeClass change_class_of(std::string_view name);

/// The largest resident set of this process so far.
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace relook
