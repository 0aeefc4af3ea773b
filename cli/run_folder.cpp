#include "run_folder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "engine/overlay.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 5> kRunEntries{"frames", "previews", "overlays", "report.json", "report.html"};

void remove_entry(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw IoError(path.string(), "cannot be removed: " + error.message());
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

RunFolder::RunFolder(std::filesystem::path path, std::uint32_t width, std::uint32_t height, PixelFormat format)
    : path_(std::move(path)), encoder_(width, height, format), preview_encoder_(width, height) {
  make_folders(path_);
  remove_entry(path_ / "report.json");
  for (const std::string_view entry : kRunEntries) remove_entry(path_ / entry);
  make_folders(path_ / "frames");
  make_folders(path_ / "previews");
}

void RunFolder::write_step(StepReport& step, const Frame& frame, const ChangedPixels& changed_pixels, FrameMeta meta) {
  const auto start = std::chrono::steady_clock::now();
  finish_writing();
  if (frame_hashes_.empty()) {
    encoder_.update(frame);
    preview_encoder_.update(frame);
  } else if (!changed_pixels.empty()) {
    encoder_.update(frame, changed_pixels);
    preview_encoder_.update(frame, changed_pixels);
    preview_is_stale_ = true;
  }
  meta.step = step_label(step.step, step.frame_in_step());
  meta.change_class = change_class_name(step.change);
  step.frame = frame_name(step.step, step.frame_in_step());
  step.preview = preview_name(step.step, step.frame_in_step());
  writing_ = std::async(std::launch::async, [this, frame_path = path_ / step.frame, preview_path = path_ / step.preview,
                                             meta = std::move(meta)] { write_frame(frame_path, preview_path, meta); });
  step.seconds.write = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void RunFolder::write_frame(const std::filesystem::path& frame, const std::filesystem::path& preview,
                            const FrameMeta& meta) {
  const Bytes bytes = encoder_.exr(meta);
  write_file(frame, bytes);
  frame_hashes_.push_back(hash128(bytes));
  if (std::exchange(preview_is_stale_, false)) preview_ = preview_encoder_.png();
  write_file(preview, preview_);
}

void RunFolder::write_overlays(const StepReport& step, const Replayer& replayer, const StepResult& result) const {
  make_folders(path_ / "overlays");
  const auto write = [&](const char* kind, const auto& draw) {
    Frame frame = replayer.image().frame;
    for (std::size_t tile = 0; tile < tile_count(frame.width, frame.height); ++tile) draw(frame, tile);
    write_file(path_ / "overlays" / (std::filesystem::path(step.preview).stem().string() + "_" + kind + ".png"),
               encode_png(frame));
  };
  if (!result.dependent.empty()) {
    write("dependent", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.dependent[tile]); });
    write("touched", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.touched[tile]); });
  }
  if (replayer.regions().has_groups())
    write("groups", [&](Frame& frame, std::size_t tile) { draw_groups(frame, tile, replayer.regions().groups(tile)); });
}

void RunFolder::finish_writing() {
  if (writing_.valid()) writing_.get();
}

void RunFolder::write_report(RunReport& report) {
  finish_writing();
  require(frame_hashes_.size() == report.steps.size(), "each step of a report has written its frame");
  for (std::size_t i = 0; i < report.steps.size(); ++i) report.steps[i].frame_hash = frame_hashes_[i];
  write_file(path_ / "report.json", report_json(report).dump(2) + "\n");
}

}  // namespace relook
