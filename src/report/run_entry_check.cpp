#include "report/run_entry_check.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "base/hash.h"
#include "frame/display_view.h"

namespace relook {
namespace {

constexpr std::string_view kFile = "report.json";
constexpr std::size_t kEntryHashDigits = 32, kCommandDigits = 16;
constexpr std::string_view kSealStart = ",\"seal\":\"", kSealEnd = "\"}";
constexpr double kMostSeconds = 1e9;
constexpr std::int64_t kMostFrameNumber = 1'000'000;

constexpr std::array<std::string_view, 38> kMembers{
    "step",           "name",       "class",         "reasons",        "drag_frame",       "wedge_frame",
    "frame",          "frame_hash", "preview",       "edits",          "source",           "files",
    "command",        "seal",       "samples_total", "pixels_changed", "samples_affected", "regions_visited",
    "regions_culled", "regions",    "ray_tests",     "object_rays",    "ray_tests_culled", "ray_tests_culled_by",
    "ray_updates",    "seconds",    "resident",      "shadow_updates", "evicted",          "rebuilt",
    "reloaded",       "peak_rss",   "resumed",       "exposure",       "overlays",         "verify_percent",
    "verify",         "relight"};
constexpr std::array<std::string_view, 11> kFurtherMembers{"color_trees_evaluated",
                                                           "color_trees_reused",
                                                           "tunnels_read",
                                                           "from",
                                                           "keep",
                                                           "values",
                                                           "axes",
                                                           "note",
                                                           "author",
                                                           "extras",
                                                           "full_render"};
constexpr std::array<std::string_view, 4> kFullRender{"seconds", "cpu_seconds", "rays", "measured"};
constexpr std::array<std::string_view, 15> kCounts{"samples_total",
                                                   "samples_affected",
                                                   "pixels_changed",
                                                   "regions_visited",
                                                   "regions_culled",
                                                   "ray_tests",
                                                   "ray_tests_culled",
                                                   "ray_updates",
                                                   "shadow_updates",
                                                   "object_rays",
                                                   "color_trees_evaluated",
                                                   "color_trees_reused",
                                                   "tunnels_read",
                                                   "peak_rss",
                                                   "step"};
constexpr std::array<std::string_view, 5> kClasses{"base", "color", "optical", "geometric", "mixed"};
constexpr std::array<std::string_view, 8> kPhases{"classify", "select", "test",  "update",
                                                  "evaluate", "write",  "total", "cpu"};
constexpr std::array<std::string_view, 12> kParts{"ray_paths",   "ray_trees",     "sample_colors", "light_sums",
                                                  "kept_rays",   "kept_segments", "kept_terms",    "kept_vertices",
                                                  "color_trees", "groups",        "tunnels",       "total"};
constexpr std::array<std::string_view, 6> kMoved{"ray_trees",   "sample_colors", "light_sums",
                                                 "color_trees", "tunnels",       "total"};
constexpr std::array<std::string_view, 4> kCulledBy{"tunnels", "boxes", "dropped", "class"};
constexpr std::array<std::string_view, 2> kRegionKinds{"groups", "tunnels"}, kRegionCounts{"visited", "culled"},
    kVerify{"pixels_compared", "pixels_different"};
constexpr std::array<std::string_view, 3> kStamp{"hash", "bytes", "modified"},
    kOverlays{"dependent", "touched", "groups"};

void check_count(const JsonView& view) { (void)view.integer(0, INT64_MAX); }

void check_counts(const JsonView& view, std::span<const std::string_view> names) {
  view.only_keys(names);
  for (const std::string_view name : names) check_count(view.at(name));
}

void check_digits(const JsonView& view, std::size_t count) {
  const std::string text = view.text();
  if (text.size() != count || text.find_first_not_of("0123456789abcdef") != text.npos) view.fail("not a hash");
}

void check_members(const JsonView& view) {
  std::vector<std::string_view> members(kMembers.begin(), kMembers.end());
  members.insert(members.end(), kFurtherMembers.begin(), kFurtherMembers.end());
  view.only_keys(members);
  for (const std::string_view member : members)
    if (member != "seal") (void)view.at(member);
}

void check_numbers(const JsonView& view) {
  for (const std::string_view count : kCounts) check_count(view.at(count));
  (void)view.at("step").integer(0, kMostFrameNumber);
  (void)view.at("exposure").number(-kMostExposure, kMostExposure);
  for (const char* kind : {"drag_frame", "wedge_frame"})
    if (const JsonView number = view.at(kind); !number.value().is_null()) (void)number.integer(1, kMostFrameNumber);
  if (!view.at("drag_frame").value().is_null() && !view.at("wedge_frame").value().is_null())
    view.at("wedge_frame").fail("a frame of a drag is none of a wedge");
  view.at("seconds").only_keys(kPhases);
  for (const std::string_view phase : kPhases) (void)view.at("seconds").at(phase).number(0, kMostSeconds);
  check_counts(view.at("resident"), kParts);
  for (const char* moves : {"evicted", "rebuilt", "reloaded"}) check_counts(view.at(moves), kMoved);
  check_counts(view.at("ray_tests_culled_by"), kCulledBy);
  view.at("regions").only_keys(kRegionKinds);
  for (const std::string_view kind : kRegionKinds) check_counts(view.at("regions").at(kind), kRegionCounts);
}

void check_verify(const JsonView& view) {
  const JsonView percent = view.at("verify_percent"), verify = view.at("verify");
  if (percent.value().is_null() != verify.value().is_null()) verify.fail("goes with a percentage");
  if (verify.value().is_null()) return;
  (void)percent.number(0, 100);
  check_counts(verify, kVerify);
  if (verify.at("pixels_different").integer(0, INT64_MAX) > verify.at("pixels_compared").integer(0, INT64_MAX))
    verify.fail("more pixels differ than were compared");
}

/// What the journal says is taken from it; here only what has a form of its own.
void check_words(const JsonView& view) {
  if (const JsonView from = view.at("from"); !from.value().is_null()) (void)from.integer(0, kMostFrameNumber);
  (void)view.at("keep").boolean();
  for (const char* list : {"values", "axes"})
    if (!view.at(list).value().is_null()) view.at(list).require_array();
  for (const char* text : {"note", "author"})
    if (!view.at(text).value().is_null()) (void)view.at(text).text();
}

void check_full_render(const JsonView& full) {
  if (full.value().is_null()) return;
  full.only_keys(kFullRender);
  (void)full.at("seconds").number(0, kMostSeconds);
  (void)full.at("cpu_seconds").number(0, kMostSeconds);
  check_count(full.at("rays"));
  (void)full.at("measured").boolean();
}

/// Only the frame, its preview and, if it has some, its overlays and its layers of light, which are there then.
void check_files(const JsonView& view) {
  const std::string frame = view.at("frame").text(), stem = std::filesystem::path(frame).stem().string();
  if (stem.find_first_not_of("0123456789_") != stem.npos || frame != "frames/" + stem + ".exr" ||
      view.at("preview").text() != "previews/" + stem + ".png")
    view.at("frame").fail("not a frame of a run");
  std::vector<std::string> names{frame, "previews/" + stem + ".png"};
  if (view.at("overlays").boolean())
    for (const std::string_view kind : kOverlays)
      names.push_back("overlays/" + stem + "_" + std::string(kind) + ".png");
  std::size_t always = 2;  // frame and preview
  if (view.at("relight").boolean()) {
    names.insert(names.begin(), "relight/" + stem + ".exr");
    ++always;
  }
  const JsonView files = view.at("files");
  files.require_object();
  for (const auto& file : files.value().items()) {
    if (std::ranges::find(names, file.key()) == names.end()) files.fail("has a file that is not the frame's");
    const JsonView stamp = files.at(file.key());
    stamp.only_keys(kStamp);
    check_digits(stamp.at("hash"), kEntryHashDigits);
    check_count(stamp.at("bytes"));
    (void)stamp.at("modified").integer(INT64_MIN, INT64_MAX);
  }
  for (std::size_t i = 0; i < always; ++i) (void)files.at(names[i]);
  if (view.at("frame_hash").text() != files.at(frame).at("hash").text()) view.at("frame_hash").fail("not the file's");
}

}  // namespace

void check_entry(const Json& entry) {
  const JsonView view(entry, kFile);
  view.require_object();
  check_members(view);
  (void)view.at("name").text();
  (void)view.at("class").one_of(kClasses);
  const JsonView reasons = view.at("reasons");
  reasons.require_array();
  for (std::size_t i = 0; i < reasons.size(); ++i) (void)reasons.at(i).text();
  if (!view.at("edits").text().empty()) check_digits(view.at("edits"), kEntryHashDigits);
  check_digits(view.at("source"), kEntryHashDigits);
  check_digits(view.at("command"), kCommandDigits);
  (void)view.at("resumed").boolean();
  check_words(view);
  check_full_render(view.at("full_render"));
  check_numbers(view);
  check_verify(view);
  check_files(view);
}

bool agrees(const Json& entry, const KnownFrame& known) {
  const auto count = [&](const char* key) { return entry.at(key).get<std::uint64_t>(); };
  const bool has_its_names = entry.at("edits") == known.edits && entry.at("source") == known.source &&
                             entry.at("frame") == known.frame && entry.at("preview") == known.preview &&
                             entry.at("drag_frame").is_number() == (known.is_numbered && known.is_drag) &&
                             entry.at("wedge_frame").is_number() == (known.is_numbered && !known.is_drag);
  const bool may_have_counts = (known.is_whole_step || count("samples_total") == known.samples) &&
                               count("samples_total") <= known.samples && count("samples_affected") <= known.samples &&
                               count("pixels_changed") <= known.pixels;
  if (!has_its_names || !may_have_counts || (entry.at("class") == "base") != known.is_base) return false;
  if (entry.at("verify").is_null()) return true;
  const auto compared = entry.at("verify").at("pixels_compared").get<std::uint64_t>();
  const bool is_all = entry.at("verify_percent").get<double>() == 100;
  return is_all ? compared == known.pixels : compared <= known.pixels;
}

std::string sealed(std::string text) {
  const std::string hash = hash128(bytes_of(text));
  text.pop_back();  // the brace
  return text.append(kSealStart).append(hash).append(kSealEnd);
}

bool has_sound_seal(std::string_view text) {
  constexpr std::size_t kSealBytes = kSealStart.size() + kEntryHashDigits + kSealEnd.size();
  if (text.size() < kSealBytes) return false;
  const std::string_view seal = text.substr(text.size() - kSealBytes);
  const std::string plain = std::string(text.substr(0, text.size() - kSealBytes)) + "}";
  return seal.starts_with(kSealStart) && seal.ends_with(kSealEnd) &&
         seal.substr(kSealStart.size(), kEntryHashDigits) == hash128(bytes_of(plain));
}

}  // namespace relook
