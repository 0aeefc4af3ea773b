#include "run/run_plan.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "base/error.h"
#include "base/parallel.h"
#include "cache/cache.h"
#include "edit/journal_walk.h"
#include "report/journal_words.h"
#include "report/run_source.h"
#include "run/run_files.h"

namespace relook {

RunPlan::RunPlan(const Arguments& arguments, const Journal& journal, std::filesystem::path folder, Json source)
    : arguments_(arguments),
      journal_(journal),
      folder_(std::move(folder)),
      source_(std::move(source)),
      hashes_(journal),
      files_(std::make_unique<NotedFiles>(folder_)) {
  unsigned width = 0, height = 0;
  std::sscanf(source_.at("resolution").get_ref<const std::string&>().c_str(), "%ux%u", &width, &height);
  source_hash_ = hash_of_source(source_);
  pixels_ = std::uint64_t{width} * height;
  samples_ = pixels_ * std::stoull(source_.at("samples").get_ref<const std::string&>());
  const auto steps = static_cast<std::uint32_t>(journal.steps.size());
  first_ = arguments.steps ? arguments.steps->first : 0;
  last_ = arguments.steps ? arguments.steps->last.value_or(steps) : steps;
  refresh();
}

void RunPlan::refresh() {
  ledger_.reset();
  replaces_all_ = replaces_some_ = false;
  look_into_folder();
  find_kept();
}

void RunPlan::look_into_folder() {
  if (!is_there(folder_)) return;
  std::error_code error;
  if (!std::filesystem::is_directory(folder_, error)) throw UsageError(folder_.string(), "is there and is no folder");
  const std::vector<std::filesystem::path> entries = entries_of(folder_);
  if (entries.empty()) return;
  for (const auto& [name, kind] : kRunFiles)
    if (is_there(folder_ / name) && !is_own_file(folder_ / name, kind))
      throw UsageError((folder_ / name).string(), "is there and not of relook: not replaced");
  ledger_.emplace(folder_);
  if (ledger_->is_run()) return judge_run();
  Json manifest;
  const bool is_cache = read_manifest(folder_, manifest).fault == CacheFault::none;
  throw UsageError(folder_.string(), is_cache ? "holds a cache: not replaced by a run"
                                              : "is there and is no run: \"" +
                                                    printable(entries.front().filename().string()) +
                                                    "\" is not relook's; nothing is replaced");
}

/// Decides what of the run that is there may stay. Throws UsageError when something may not and --overwrite is not
/// given.
void RunPlan::judge_run() {
  const bool has_nothing = ledger_->source().is_null() && ledger_->notes().empty() && !is_there(folder_ / kReportName);
  if (has_nothing) return;  // killed as it began
  std::optional<std::string> other;
  if (ledger_->has_foreign_report())
    other = "a report.json that this version of relook has not written, or that was changed since";
  else
    other = difference_of_sources(ledger_->source(), source_);
  replaces_all_ = other.has_value();
  if (!other) other = other_journal();
  replaces_some_ = other.has_value() || has_other_names();
  if (!other) return;
  if (!arguments_.overwrite) throw UsageError(folder_.string(), "holds " + *other + "; --overwrite replaces it");
  if (replaces_all_) require_known_files();
}

std::optional<std::string> RunPlan::expected_edits(const LedgerKey& key) const {
  const auto& [step, number] = key;
  if (step > journal_.steps.size()) return std::nullopt;
  if (number == kWholeStep) return hashes_.after(step);
  const bool has_it = is_numbered(journal_, step) && number <= frames_in(journal_, step);
  return has_it ? std::optional(hashes_.at(step, number - 1)) : std::nullopt;
}

std::optional<std::string> RunPlan::other_journal() const {
  for (const RunLedger::Task& task : ledger_->tasks())
    if (task.last_step > journal_.steps.size() || hashes_.after(task.last_step) != task.edits)
      return "frames of another journal (a command is, or was, at its steps " + std::to_string(task.first_step) +
             " to " + std::to_string(task.last_step) + ")";
  for (const auto& [key, note] : ledger_->notes()) {
    if (is_of_journal(key, note)) continue;
    const std::optional<std::string> expected = expected_edits(key);
    const Json entry = ledger_->entry(note);
    const std::string name = printable(entry.value("name", "")), frame = entry.value("frame", "");
    if (expected && key.second == kWholeStep && frame.find('_') != std::string::npos)
      continue;  // a wedge or drag with more frames than before: only its own entry is another
    return "a run of another journal (its step " + std::to_string(key.first) + ", \"" + name + "\", is " +
           (expected ? "not that of " : "not in ") + printable(journal_.file) + ")";
  }
  return std::nullopt;
}

/// Before a whole run is replaced: throws UsageError unless every file in its folder is one that relook has written.
void RunPlan::require_known_files() const {
  const auto refuse = [](const std::filesystem::path& path) {
    throw UsageError(path.string(), "is not relook's: a run with other files in its folder is not replaced");
  };
  for (const std::filesystem::path& path : entries_of(folder_)) {
    const std::string name = path.filename().string();
    if (std::ranges::find(kRunFiles, name, [](const auto& file) { return file.first; }) != kRunFiles.end()) continue;
    const auto part = std::ranges::find(kRunParts, name, &RunPart::folder);
    std::error_code error;
    if (part == kRunParts.end() || !std::filesystem::is_directory(path, error)) {
      const bool is_index = name == "index.html" && is_own_file(path, OwnKind::page);
      if (unfinished_name(path).empty() && !is_index) refuse(path);
      continue;
    }
    for (const std::filesystem::path& file : entries_of(path))
      if (unfinished_name(file).empty() && !(file.extension() == part->suffix && is_own_file(file, part->kind)))
        refuse(file);
  }
}

/// Whether an entry has the overlays, the layers of light, the exposure and the verification that this command asks
/// for.
bool RunPlan::is_enough(const Json& entry) const {
  if (arguments_.overlays && !entry.at("overlays").get<bool>()) return false;
  if (arguments_.relight && !entry.at("relight").get<bool>()) return false;
  if (entry.at("exposure").get<double>() != arguments_.exposure) return false;
  if (!arguments_.verify_percent) return true;
  const Json& verified = entry.at("verify_percent");
  return !verified.is_null() && verified.get<double>() >= *arguments_.verify_percent;
}

KnownFrame RunPlan::known_frame(const LedgerKey& key) const {
  const auto& [step, number] = key;
  KnownFrame known;
  known.edits = expected_edits(key).value_or("");
  known.frame = frame_name_of(key);
  known.preview = preview_name(place_of_key(key));
  known.source = source_hash_;
  known.is_numbered = number != kWholeStep;
  known.is_drag = step > 0 && step <= journal_.steps.size() && journal_.steps[step - 1].form() == StepForm::drag;
  known.is_base = step == 0;
  known.is_whole_step = !is_frame(key);
  known.pixels = pixels_;
  known.samples = samples_;
  return known;
}

/// Whether the header of a frame says what its entry does: so that no frame passes for another's.
bool RunPlan::is_its_frame(const LedgerKey& key, const Json& entry) const {
  const std::optional<FrameMeta> meta = own_frame_meta(folder_ / entry.at("frame").get_ref<const std::string&>());
  return meta && meta->scene_hash == source_.at("scene") && meta->edits_hash == entry.at("edits") &&
         meta->exposure == exposure_text(entry.at("exposure").get<double>()) &&
         meta->step == step_label(place_of_key(key)) && (!is_frame(key) || meta->change_class == entry.at("class"));
}

/// Whether the header of a frame has the name, the note and so on that the journal has now.
bool RunPlan::says_what_the_journal_does(const LedgerKey& key, const Json& entry) const {
  const std::optional<std::size_t> frame = frame_of(key);
  if (!frame) return true;
  const std::optional<FrameMeta> meta = own_frame_meta(folder_ / entry.at("frame").get_ref<const std::string&>());
  return meta && has_journal_words(*meta, journal_, key.first, *frame);
}

bool RunPlan::is_sound(const LedgerKey& key, const Json& entry) {
  if (!agrees(entry, known_frame(key))) return false;
  const bool answers_for_it = key.first >= first_ && key.first <= last_;
  return answers_for_it ? files_->hold(entry) && is_its_frame(key, entry) : files_->seem_to_hold(entry);
}

void RunPlan::require_free(const std::string& name) const {
  const std::filesystem::path path = folder_ / name;
  std::error_code error;
  if (!is_there(path) || (std::filesystem::is_regular_file(path, error) && std::filesystem::is_empty(path, error)))
    return;
  const auto part = std::ranges::find(kRunParts, name.substr(0, name.find('/')), &RunPart::folder);
  if (!is_own_file(path, part->kind))
    throw UsageError(path.string(), "is where a file of the run is to go, and not of relook: not replaced");
}

void RunPlan::find_kept() {
  unsound_frames_ = 0;
  kept_.clear();
  keeps_whole_.clear();
  for (std::uint32_t step = first_; step <= last_; ++step) kept_.emplace_back(frames_in(journal_, step), false);
  keeps_whole_.assign(kept_.size(), false);
  pixels_different_ = 0;
  if (ledger_ && !replaces_all_) judge_notes();
  count_kept();
}

/// Files are read, and entries parsed, by many threads.
void RunPlan::judge_notes() {
  std::vector<const std::pair<const LedgerKey, RunLedger::Note>*> notes;
  for (const auto& entry : ledger_->notes()) {
    const auto& [key, note] = entry;
    // What was done afresh, by a command that was then killed, counts; but it is not what --verify may rely on.
    const bool is_old = arguments_.fresh && (!note.is_fresh || arguments_.verify_percent);
    const bool is_wanted = key.first >= first_ && key.first <= last_ && !is_old;
    if (is_wanted && is_of_journal(key, note)) notes.push_back(&entry);
  }
  struct Judgement {
    bool is_sound = false, is_kept = false;
    std::uint64_t pixels_different = 0;
  };
  std::vector<Judgement> judgements(notes.size());
  parallel_for(notes.size(), [&](std::size_t i) {
    const auto& [key, note] = *notes[i];
    const Json entry = ledger_->entry(note);
    Judgement& judgement = judgements[i];
    judgement.is_sound = is_sound(key, entry);
    judgement.is_kept = judgement.is_sound && is_enough(entry) && says_what_the_journal_does(key, entry);
    if (judgement.is_kept && entry.at("verify").is_object())
      judgement.pixels_different = entry.at("verify").at("pixels_different").get<std::uint64_t>();
  });
  for (std::size_t i = 0; i < notes.size(); ++i) {
    const auto& [key, note] = *notes[i];
    unsound_frames_ += judgements[i].is_sound ? 0 : 1;
    const std::size_t frame = key.second == kWholeStep ? 0 : key.second - 1;
    if (!is_frame(key)) {
      keeps_whole_[key.first - first_] = judgements[i].is_sound && sums_up(key.first, ledger_->entry(note));
      continue;
    }
    kept_[key.first - first_][frame] = judgements[i].is_kept;
    pixels_different_ += judgements[i].pixels_different;
  }
}

/// Whether the entry of a drag or wedge as a whole says of it what those of its frames say, which come before it. When
/// one of these is missing, it is made anew in any case.
bool RunPlan::sums_up(std::uint32_t step, const Json& whole) const {
  ChangeClass change = ChangeClass::color;
  const std::size_t frames = frames_in(journal_, step);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (!keeps(step, frame)) return false;
    const Json entry = kept_entry(step, frame);
    change = combined(change, change_class_of(entry.at("class").get_ref<const std::string&>()));
    const bool is_last = frame + 1 == frames;
    for (const char* key : {"files", "verify", "verify_percent", "overlays", "relight", "exposure"})
      if (is_last && whole.at(key) != entry.at(key)) return false;
  }
  return whole.at("class") == change_class_name(change);
}

/// Counts the frames that are kept, and finds whether the run is complete. Throws UsageError for what is in the way of
/// frames that are to be made.
void RunPlan::count_kept() {
  frames_ = kept_frames_ = 0;
  bool has_all_in_report = ledger_ && ledger_->has_whole_report();
  const auto is_reported = [&](const LedgerKey& key) {
    const RunLedger::Note* note = ledger_->find(key);
    return note != nullptr && note->is_in_report;
  };
  for (std::uint32_t step = first_; step <= last_; ++step) {
    const std::size_t count = frames_in(journal_, step);
    frames_ += count;
    const LedgerKey whole{step, kWholeStep};
    if (is_numbered(journal_, step))
      has_all_in_report = has_all_in_report && keeps_whole_[step - first_] && is_reported(whole);
    for (std::size_t frame = 0; frame < count; ++frame) {
      if (keeps(step, frame)) {
        ++kept_frames_;
        has_all_in_report = has_all_in_report && is_reported(key_of(step, frame));
      } else if (!replaces_all_) {
        require_free_names(place_of(journal_, step, frame));
      }
    }
  }
  const Json head = ledger_ ? ledger_->head() : Json();
  const auto is_in_head = [&](const char* key, const auto& wanted) {
    return head.is_object() && head.contains(key) && wanted(head.at(key));
  };
  const bool wants_page = arguments_.report == ReportKind::html && !has_current_page();
  const bool lacks_baseline =
      arguments_.baseline && is_in_head("full_render_seconds", [](const Json& value) { return value.is_null(); });
  const bool has_whole_report = has_all_in_report && has_true_head(head) &&
                                is_in_head("interrupted", [](const Json& value) { return value == false; });
  is_complete_ = kept_frames_ == frames_ && !replaces_some_ && !wants_page && !lacks_baseline &&
                 (arguments_.report == ReportKind::none || has_whole_report);
}

/// Whether the head of a report says of resolution, samples, scene and depth what the source says.
bool RunPlan::has_true_head(const Json& head) const {
  try {
    const JsonView view(head, kReportName), resolution = view.at("resolution");
    const std::string pixels = std::to_string(resolution.at(0).integer(1, INT32_MAX)) + "x" +
                               std::to_string(resolution.at(1).integer(1, INT32_MAX));
    return pixels == source_.at("resolution") && view.at("samples").value().dump() == source_.at("samples") &&
           view.at("scene").at("hash").value() == source_.at("scene") &&
           view.at("options").at("integrator").value() == source_.at("integrator") &&
           view.at("options").at("max_depth").value().dump() == source_.at("max_depth");
  } catch (const InputError&) {
    return false;
  }
}

void RunPlan::require_free_names(const FramePlace& here) const {
  require_free(frame_name(here));
  require_free(preview_name(here));
  if (arguments_.relight) require_free(relight_name(here));
  if (!arguments_.overlays) return;
  for (const char* kind : {"_dependent.png", "_touched.png", "_groups.png"})
    require_free("overlays/" + std::filesystem::path(frame_name(here)).stem().string() + kind);
}

std::vector<std::string> RunPlan::warnings() const {
  const std::size_t lines = ledger_ && !replaces_all_ ? ledger_->refused() : 0;
  if (lines + unsound_frames_ == 0) return {};
  return {folder_.string() + ": " + std::to_string(lines + unsound_frames_) +
          " notes of finished frames are not as they were written, or the files are not as noted; such frames are made"
          " again"};
}

LedgerKey RunPlan::key_of(std::uint32_t step, std::size_t frame) const {
  return {step, place_of(journal_, step, frame).number.value_or(kWholeStep)};
}

bool RunPlan::is_of_journal(const LedgerKey& key, const RunLedger::Note& note) const {
  const std::optional<std::string> expected = expected_edits(key);
  return expected && *expected == note.edits;
}

bool RunPlan::is_frame(const LedgerKey& key) const {
  const auto& [step, number] = key;
  return number != kWholeStep || step > journal_.steps.size() || !is_numbered(journal_, step);
}

std::optional<std::size_t> RunPlan::frame_of(const LedgerKey& key) const {
  if (!is_frame(key)) return std::nullopt;
  return key.second == kWholeStep ? 0 : key.second - 1;
}

Json RunPlan::kept_entry(std::uint32_t step, std::size_t frame) const {
  return ledger_->entry(*ledger_->find(key_of(step, frame)));
}

bool RunPlan::keeps_whole_step(std::uint32_t step) const { return keeps_whole_[step - first_]; }

/// Whether report.html was written after report.json.
bool RunPlan::has_current_page() const {
  std::error_code error;
  const auto page = std::filesystem::last_write_time(folder_ / "report.html", error);
  return !error && page >= std::filesystem::last_write_time(folder_ / kReportName, error) && !error;
}

void RunPlan::begin(ProgressFile& progress) {
  const RunLedger::Task task{first_, last_, hashes_.after(last_), arguments_.fresh};
  progress.exclusively([&] {
    refresh();
    std::vector<Json> lines{RunLedger::head_of(task, source_)};
    if (replaces_some_) {
      if (!progress.lock_all_steps())
        throw BusyError(folder_.string(), "another replay is writing the run that is to be replaced");
      if (!replaces_all_) std::ranges::move(entries_to_stay(), std::back_inserter(lines));
      remove_replaced();
      progress.clear();
    }
    progress.append_in_turn(lines);
    remove_leftovers();
  });
  progress.unlock_other_steps();
  refresh();
}

/// Whether a wedge or drag has come to another number of digits.
bool RunPlan::has_other_names() const {
  constexpr std::size_t kThreeDigits = 100;
  return std::ranges::any_of(ledger_->notes(), [&](const auto& entry) {
    const auto& [key, note] = entry;
    const bool may_have = !is_frame({key.first, kWholeStep}) && frames_in(journal_, key.first) >= kThreeDigits;
    return may_have && is_of_journal(key, note) && ledger_->entry(note).at("frame") != frame_name_of(key);
  });
}

/// The entries of this journal whose frames have the names of now: a hundredth frame gives those of its step another
/// digit.
std::vector<Json> RunPlan::entries_to_stay() const {
  std::vector<Json> entries;
  for (const auto& [key, note] : ledger_->notes()) {
    if (!is_of_journal(key, note)) continue;
    Json entry = ledger_->entry(note);
    if (entry.at("frame") == frame_name_of(key)) entries.push_back(std::move(entry));
  }
  return entries;
}

FramePlace RunPlan::place_of_key(const LedgerKey& key) const {
  const auto& [step, number] = key;
  return number == kWholeStep ? last_place_of(journal_, step) : place_of(journal_, step, number - 1);
}

std::string RunPlan::frame_name_of(const LedgerKey& key) const { return frame_name(place_of_key(key)); }

}  // namespace relook
