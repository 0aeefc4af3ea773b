#include "run_folder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "engine/layered_frame.h"
#include "engine/overlay.h"
#include "page/run_page.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 4> kFrameFolders{"frames", "previews", "overlays", "pixels"};
constexpr std::array<std::string_view, 7> kRunEntries{"report.json", "report.html", "frames",     "previews",
                                                      "overlays",    "pixels",      kProgressName};

void remove_entry(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw IoError(path.string(), "cannot be removed: " + error.message());
}

std::filesystem::path made(std::filesystem::path folder) {
  make_folders(folder);
  return folder;
}

/// A temporary file of write_file() that a killed run has left.
bool is_unfinished(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(".report.") && name.ends_with(".tmp");
}

/// The last frame of its step: not one of a drag or a wedge.
bool ends_step(const Json& note) {
  const Json& entry = note.at("entry");
  return entry.at("drag_frame").is_null() && entry.at("wedge_frame").is_null();
}

}  // namespace

void RunFolder::refuse_foreign(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  if (!std::filesystem::is_directory(path, error)) throw InputError(path.string(), "", "exists and is not a folder");
  if (std::filesystem::is_empty(path, error)) return;
  for (const std::string_view entry : kRunEntries)
    if (std::filesystem::exists(path / entry, error)) return;
  throw InputError(path.string(), "", "exists and is not a run: not overwritten");
}

RunFolder::RunFolder(std::filesystem::path path, std::uint32_t width, std::uint32_t height, PixelFormat format,
                     std::shared_ptr<const DisplayView> view, const std::optional<std::string>& run, bool is_fresh)
    : path_(made(std::move(path))),
      progress_(path_),
      notes_steps_(run.has_value()),
      format_(format),
      encoder_(width, height, format),
      view_(std::move(view)),
      preview_encoder_(width, height, view_) {
  if (run && !is_fresh) keep_finished_steps(*run);
  remove_all_but_kept();
  progress_.restart(run.value_or(""), kept_notes_);
  make_folders(path_ / "frames");
  make_folders(path_ / "previews");
}

void RunFolder::keep_finished_steps(const std::string& run) {
  std::size_t whole_steps = 0;  // notes of them
  try {
    for (Json& note : progress_.entries(run)) {
      if (!has_files_of(note)) break;
      kept_notes_.push_back(std::move(note));
      if (ends_step(kept_notes_.back())) whole_steps = kept_notes_.size();
    }
  } catch (const Json::exception&) {  // not a note after all
  }
  kept_notes_.resize(whole_steps);
  for (const Json& note : kept_notes_) kept_.push_back(note.at("entry"));
}

/// Whether all files of a note are there with their hashes.
bool RunFolder::has_files_of(const Json& note) const {
  const auto is_sound = [&](const std::string& name, const std::string& hash) {
    std::error_code error;
    return std::filesystem::is_regular_file(path_ / name, error) && hash128(read_file(path_ / name)) == hash;
  };
  const Json& entry = note.at("entry");
  if (!is_sound(entry.at("frame").get<std::string>(), entry.at("frame_hash").get<std::string>())) return false;
  for (const auto& [name, hash] : note.at("files").items())
    if (!is_sound(name, hash.get<std::string>())) return false;
  return true;
}

void RunFolder::remove_all_but_kept() {
  std::set<std::filesystem::path> kept;
  for (const Json& note : kept_notes_) {
    kept.insert(path_ / note.at("entry").at("frame").get<std::string>());
    for (const auto& file : note.at("files").items()) kept.insert(path_ / file.key());
  }
  remove_entry(path_ / "report.json");
  remove_entry(path_ / "report.html");
  std::error_code ignored;
  for (const auto& file : std::filesystem::directory_iterator(path_, ignored))
    if (is_unfinished(file.path())) remove_entry(file.path());
  for (const std::string_view folder : kFrameFolders) {
    std::error_code error;
    if (kept.empty()) {
      remove_entry(path_ / folder);
      continue;
    }
    for (const auto& file : std::filesystem::directory_iterator(path_ / folder, error))
      if (!kept.contains(file.path())) remove_entry(file.path());
  }
}

void RunFolder::write_step(StepReport& step, const Image& image, const ChangedPixels& changed_pixels, FrameMeta meta,
                           const Scene* layers) {
  const auto start = std::chrono::steady_clock::now();
  finish_writing();
  std::optional<Json> last = std::exchange(finished_, std::nullopt);
  const Frame& frame = image.frame;
  const auto take = [&](auto& encoder) {
    if (frame_hashes_.empty())
      encoder.update(frame);
    else
      encoder.update(frame, changed_pixels);
  };
  if (layers == nullptr) take(encoder_);
  take(preview_encoder_);
  preview_is_stale_ = preview_is_stale_ || !changed_pixels.empty();
  meta.step = step_label(step.step, step.frame_in_step());
  meta.change_class = change_class_name(step.change);
  step.frame = frame_name(step.step, step.frame_in_step());
  step.preview = preview_name(step.step, step.frame_in_step());
  std::optional<Bytes> layered;
  if (layers != nullptr) layered = encode_layered_exr({*layers, image.view, frame, changed_pixels, format_}, meta);
  writing_ =
      std::async(std::launch::async, [this, frame_path = path_ / step.frame, preview_path = path_ / step.preview,
                                      meta = std::move(meta), last = std::move(last), layered = std::move(layered)] {
        append_note(last);
        write_frame(frame_path, preview_path, meta, layered);
      });
  step.seconds.write = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void RunFolder::write_frame(const std::filesystem::path& frame, const std::filesystem::path& preview,
                            const FrameMeta& meta, const std::optional<Bytes>& layered) {
  const Bytes bytes = layered ? *layered : encoder_.exr(meta);
  write_file(frame, bytes);
  frame_hashes_.push_back(hash128(bytes));
  if (std::exchange(preview_is_stale_, false)) preview_ = preview_encoder_.png();
  write_file(preview, preview_);
  preview_hash_ = hash128(preview_);
}

void RunFolder::write_overlays(const StepReport& step, const Replayer& replayer, const StepResult& result) {
  make_folders(path_ / "overlays");
  const auto write = [&](const char* kind, const auto& draw) {
    Frame frame = replayer.image().frame;
    for (std::size_t tile = 0; tile < tile_count(frame.width, frame.height); ++tile) draw(frame, tile);
    const std::string name = "overlays/" + std::filesystem::path(step.preview).stem().string() + "_" + kind + ".png";
    const Bytes bytes = encode_png(frame, view_);
    write_file(path_ / name, bytes);
    overlay_hashes_[name] = hash128(bytes);
  };
  if (!result.dependent.empty()) {
    write("dependent", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.dependent[tile]); });
    write("touched", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.touched[tile]); });
  }
  if (replayer.regions().has_groups())
    write("groups", [&](Frame& frame, std::size_t tile) { draw_groups(frame, tile, replayer.regions().groups(tile)); });
}

void RunFolder::note_step(const StepReport& step) {
  if (notes_steps_) finished_ = Json{{"entry", step_json(step)}, {"files", std::exchange(overlay_hashes_, {})}};
}

/// Waits; then all is known that a note says.
void RunFolder::finish_writing() {
  if (writing_.valid()) writing_.get();
  if (!finished_) return;
  Json& entry = finished_->at("entry");
  entry["frame_hash"] = frame_hashes_.back();
  (*finished_)["files"][entry.at("preview").get<std::string>()] = preview_hash_;
}

void RunFolder::append_note(const std::optional<Json>& note) {
  if (note) progress_.append(*note);
}

void RunFolder::write_report(RunReport& report, const Journal& journal) {
  finish_writing();
  require(frame_hashes_.size() == report.steps.size(), "each step of a report has written its frame");
  for (std::size_t i = 0; i < report.steps.size(); ++i) report.steps[i].frame_hash = frame_hashes_[i];
  append_note(std::exchange(finished_, std::nullopt));
  const Json json = report_json(report);
  Json head = json;
  head.erase("steps");
  head.erase("frames");
  const Json& steps = json.at("steps");
  write_run_page({.folder = path_,
                  .head = head,
                  .entries = {steps.size(), [&](std::size_t i) { return steps.at(i); }},
                  .journal = journal,
                  .reads_pixels = true,
                  .check = {}});
  write_file(path_ / "report.json", json.dump(2) + "\n");
  if (!report.interrupted) progress_.remove();
}

}  // namespace relook
