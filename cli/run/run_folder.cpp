#include "run/run_folder.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <random>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "edit/journal_walk.h"
#include "image/layers/layered_frame.h"
#include "image/overlay.h"
#include "page/run_page.h"
#include "report/journal_words.h"
#include "report/report_file.h"

namespace relook {
namespace {

std::string new_command_number() {
  std::random_device random;
  const Json seed{random(), random(), ::getpid(), std::chrono::steady_clock::now().time_since_epoch().count()};
  return hash128(bytes_of(seed.dump())).substr(0, 16);
}

using StepRanges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// The ranges of a report of a journal with so many steps.
StepRanges ranges_of(const Json& parts, std::uint32_t steps) {
  StepRanges ranges;
  for (const Json& part : parts.is_array() ? parts : Json::array()) {
    unsigned from = 0, to = 0;
    if (part.is_string() && std::sscanf(part.get_ref<const std::string&>().c_str(), "%u-%u", &from, &to) == 2 &&
        from <= to && to <= steps)
      ranges.emplace_back(from, to);
  }
  return ranges;
}

/// The ranges in order; those that overlap or touch are one.
StepRanges joined(StepRanges ranges) {
  std::ranges::sort(ranges);
  StepRanges result;
  for (const auto& range : ranges) {
    if (!result.empty() && range.first <= result.back().second + 1)
      result.back().second = std::max(result.back().second, range.second);
    else
      result.push_back(range);
  }
  return result;
}

}  // namespace

RunFolder::RunFolder(RunPlan& plan, const Journal& journal, Style style)
    : plan_(plan),
      journal_(journal),
      style_(std::move(style)),
      path_(plan.folder()),
      command_(new_command_number()),
      encoder_(style_.width, style_.height, style_.format),
      preview_encoder_(style_.width, style_.height, style_.previews) {
  make_folders(path_);
  progress_ = std::make_unique<ProgressFile>(path_, plan.first_step(), plan.last_step());
  plan.begin(*progress_);
  make_folders(path_ / "frames");
  make_folders(path_ / "previews");
}

RunFolder::~RunFolder() = default;

void RunFolder::write_frame(StepReport& step, Replayer& replayer, const FrameChange& change, FrameMeta meta,
                            Layers layers) {
  const auto start = std::chrono::steady_clock::now();
  finish_writing();
  const Image& image = replayer.image();
  const Frame& frame = image.frame;
  const bool takes_all = !std::exchange(has_written_, true) || !change.follows_last;
  const auto take = [&](auto& encoder) {
    if (takes_all)
      encoder.update(frame);
    else
      encoder.update(frame, change.pixels);
  };
  if (!layers.in_frame) take(encoder_);
  if (style_.format == PixelFormat::half)
    clipped_pixels_ = layers.in_frame ? relook::clipped_pixels(frame) : encoder_.clipped_pixels();
  take(preview_encoder_);
  preview_is_stale_ = preview_is_stale_ || takes_all || !change.pixels.empty();
  meta.step = step_label(step.place);
  meta.change_class = change_class_name(step.change);
  meta.exposure = exposure_text(step.exposure);
  step.frame = frame_name(step.place);
  step.preview = preview_name(step.place);
  Ready files;
  const bool keeps_layers = !replayer.residency().is_limited();
  if (layers.in_frame)
    files.layered = encode_layered_exr(
        {replayer.state().scene(), image.view, frame, change.in_step, style_.format, &image.light_sums,
         &replayer.residency(), &replayer.sum_versions(), keeps_layers ? &halves_ : nullptr},
        meta);
  if (layers.relight) {
    if (!relight_encoder_) relight_encoder_.emplace(keeps_layers);
    step.has_relight = true;
    files.relight = relight_encoder_->exr(replayer.state(), image, replayer.sum_versions(), replayer.residency(), meta);
  }
  // Not before: what has thrown until here is no reason to forget finished frames.
  std::vector<StepReport> ready = std::exchange(notes_, {});
  ++own_frames_;
  writing_ = std::async(std::launch::async,
                        [this, step, meta = std::move(meta), ready = std::move(ready), files = std::move(files)] {
                          const Uninterrupted until_written;  // a finished frame stays
                          for (const StepReport& entry : ready) progress_->append(step_json(entry));
                          encode_and_write(step, meta, files);
                        });
  step.seconds.write = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void RunFolder::encode_and_write(const StepReport& step, const FrameMeta& meta, const Ready& ready) {
  const Bytes bytes = ready.layered ? *ready.layered : encoder_.exr(meta);
  write_file(path_ / step.frame, bytes);
  if (std::exchange(preview_is_stale_, false)) {
    preview_ = preview_encoder_.png();
    preview_hash_ = hash128(preview_);
  }
  write_file(path_ / step.preview, preview_);
  last_files_ = {step.frame,
                 {{step.frame, stamp_of(path_ / step.frame, hash128(bytes))},
                  {step.preview, stamp_of(path_ / step.preview, preview_hash_)}}};
  if (!ready.relight) return;
  const std::string name = relight_name(step.place);
  make_folders(path_ / std::filesystem::path(name).parent_path());
  write_file(path_ / name, *ready.relight);
  last_files_.second[name] = stamp_of(path_ / name, hash128(*ready.relight));
}

namespace {

/// By tile: the leaves with pixels that have changed. Steps of paths search no regions.
std::vector<Leaves> changed_leaves(const ChangedPixels& changed, std::size_t tiles) {
  std::vector<Leaves> leaves(tiles);
  for (const ChangedPixels::Tile& tile : changed.tiles())
    for (std::uint32_t y = 0; y < kTileSize; ++y)
      for (std::uint32_t x = 0; x < kTileSize; ++x)
        if ((tile.mask[y] >> x & 1U) != 0) leaves[tile.tile].set(y / kLeafSize * kLeafSide + x / kLeafSize);
  return leaves;
}

}  // namespace

void RunFolder::write_overlays(StepReport& step, const Replayer& replayer, const StepResult& result) {
  make_folders(path_ / "overlays");
  const auto write = [&](const char* kind, const auto& draw) {
    Frame frame = replayer.image().frame;
    expose(frame, style_.previews.exposure);  // the outlines are white whatever it is
    for (std::size_t tile = 0; tile < tile_count(frame.width, frame.height); ++tile) draw(frame, tile);
    const std::string name = "overlays/" + std::filesystem::path(step.preview).stem().string() + "_" + kind + ".png";
    const Bytes bytes = encode_png(frame, {style_.previews.view, 0});
    write_file(path_ / name, bytes);
    step.files[name] = stamp_of(path_ / name, hash128(bytes));
  };
  step.has_overlays = true;
  if (!result.dependent.empty()) {
    write("dependent", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.dependent[tile]); });
    write("touched", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, result.touched[tile]); });
  } else if (replayer.image().view.integrator == Integrator::path && !result.changed_pixels.empty()) {
    const std::vector<Leaves> changed = changed_leaves(result.changed_pixels, replayer.image().trees.size());
    write("dependent", [&](Frame& frame, std::size_t tile) { draw_regions(frame, tile, changed[tile]); });
  }
  if (replayer.regions().has_groups())
    write("groups", [&](Frame& frame, std::size_t tile) { draw_groups(frame, tile, replayer.regions().groups(tile)); });
}

void RunFolder::note(StepReport step) {
  step.command = command_;
  notes_.push_back(std::move(step));
}

/// Waits until the last frame is written; then entries of it that wait as notes get the stamps of its files.
void RunFolder::finish_writing() {
  if (writing_.valid()) writing_.get();
  for (StepReport& step : notes_)
    if (step.frame == last_files_.first) step.files.insert(last_files_.second.begin(), last_files_.second.end());
}

void RunFolder::append_notes() {
  finish_writing();
  for (const StepReport& step : std::exchange(notes_, {})) progress_->append(step_json(step));
}

/// Notes of this command, and notes of others that are believed.
std::vector<std::pair<LedgerKey, RunLedger::Note>> RunFolder::sound_notes(const RunLedger& ledger) const {
  std::vector<std::pair<LedgerKey, RunLedger::Note>> notes;
  for (const auto& [key, note] : ledger.notes())
    if (plan_.is_of_journal(key, note)) notes.emplace_back(key, note);
  std::vector<char> is_sound(notes.size());
  const Uninterrupted to_the_end;
  parallel_for(notes.size(), [&](std::size_t i) {
    const auto& [key, note] = notes[i];
    const Json entry = ledger.entry(note);
    std::error_code error;
    const bool is_ours = entry.at("command") == command_;
    is_sound[i] = is_ours ? std::filesystem::is_regular_file(path_ / plan_.frame_name_of(key), error)
                          : plan_.is_sound(key, entry);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < notes.size(); ++i)
    if (is_sound[i] != 0) notes[kept++] = std::move(notes[i]);
  notes.resize(kept);
  return notes;
}

/// Writes report.json. Returns whether all frames of the journal are in it.
bool RunFolder::write_report_file(RunReport& report, bool interrupted) {
  const RunLedger ledger(path_);
  noted_bytes_ = progress_->size_bytes();
  const Json& before = ledger.head();
  const std::vector<std::pair<LedgerKey, RunLedger::Note>> notes = sound_notes(ledger);
  std::vector<std::size_t> frames_there(journal_.steps.size() + 1);
  for (const auto& [key, note] : notes)
    if (plan_.is_frame(key)) ++frames_there[key.first];
  const auto missing_in = [&](std::uint32_t first, std::uint32_t last) {
    std::size_t missing = 0;
    for (std::uint32_t step = first; step <= std::min<std::size_t>(last, journal_.steps.size()); ++step)
      missing += frames_in(journal_, step) - frames_there[step];
    return missing;
  };
  // Asked for by others, too: what is missing there is missing, unless somebody is at it.
  const auto steps = static_cast<std::uint32_t>(journal_.steps.size());
  StepRanges ranges = ranges_of(before.is_object() ? before.value("parts", Json()) : Json(), steps);
  ranges.emplace_back(plan_.first_step(), plan_.last_step());
  for (const RunLedger::Task& task : ledger.tasks()) ranges.emplace_back(task.first_step, task.last_step);
  report.parts.clear();
  std::size_t missing = 0;
  for (const auto& [first, last] : ranges)
    missing += progress_->is_being_done(first, last) ? 0 : missing_in(first, last);
  for (const auto& [first, last] : joined(ranges))
    report.parts.push_back(std::to_string(first) + "-" + std::to_string(last));
  report.interrupted = interrupted || missing > 0;
  report.frames = std::accumulate(frames_there.begin(), frames_there.end(), std::size_t{0});
  report.resumed_frames = report.frames - std::min(report.frames, own_frames_);
  if (!report.full_render_seconds && before.is_object() && before.value("full_render_seconds", Json()).is_number())
    report.full_render_seconds = before["full_render_seconds"].get<double>();

  report_file_ = std::make_unique<ReportFile>(path_ / kReportName, report_head_json(report));
  for (const auto& [key, note] : notes) {
    Json entry = ledger.entry(note);
    entry["resumed"] = entry.at("command") != command_;
    entry.update(entry_words(journal_, key.first, plan_.frame_of(key)));
    report_file_->add(entry);
  }
  report_file_->publish();
  return missing_in(0, steps) == 0;
}

void RunFolder::write_page(const RunReport& report, bool is_quick, const std::function<void()>& check) {
  plan_.remove_unfinished_page();
  const ReportEntries entries = report_file_->entries();
  write_run_page({path_, report_head_json(report), entries, journal_, !is_quick, check, style_.previews.view});
}

void RunFolder::write_report(RunReport& report, bool interrupted, const std::function<void()>& check) {
  append_notes();
  if (style_.report == ReportKind::none) return;
  const bool is_alone = progress_->lock_all_steps();
  bool is_whole = false;
  progress_->exclusively([&] { is_whole = write_report_file(report, interrupted); });
  progress_->unlock_other_steps();
  if (style_.report == ReportKind::html) {
    // Of many commands that write one run, not each makes the whole page anew.
    const bool is_quick = interrupted || !is_alone || !(is_whole || 2 * own_frames_ >= report.frames);
    progress_->exclusively_for_page(!interrupted, [&] { write_page(report, is_quick, check); });
  }
  if (!report.interrupted && progress_->lock_all_steps() && progress_->size_bytes() == noted_bytes_)
    progress_->remove();
}

}  // namespace relook
