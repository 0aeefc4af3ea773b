#include "run_plan.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iterator>
#include <set>

#include "base/error.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/hash.h"
#include "cache/cache.h"
#include "report/own_file.h"
#include "report/progress_file.h"
#include "report/report_file.h"
#include "report/run_source.h"

namespace relook {
namespace {

struct RunPart {
  std::string_view folder, suffix;
  OwnKind kind;
};
constexpr std::array<RunPart, 4> kParts{{{"frames", ".exr", OwnKind::frame},
                                         {"previews", ".png", OwnKind::preview},
                                         {"overlays", ".png", OwnKind::preview},
                                         {"pixels", ".js", OwnKind::page_data}}};
constexpr std::array<std::pair<std::string_view, OwnKind>, 3> kFiles{
    {{kReportName, OwnKind::report}, {"report.html", OwnKind::page}, {kProgressName, OwnKind::progress}}};

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::not_found;
}

/// The entries of a folder that are not the system's, in order.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (!is_system_name(entry.path().filename().string())) entries.push_back(entry.path());
  if (error && is_there(folder)) throw IoError(folder.string(), "cannot be read: " + error.message());
  std::ranges::sort(entries);
  return entries;
}

/// Where a link stands in place of a folder of the run, what lies beyond it is written to and never removed.
std::vector<std::filesystem::path> entries_not_beyond_link(const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_folder = std::filesystem::symlink_status(folder, error).type() == std::filesystem::file_type::directory;
  return is_folder ? entries_of(folder) : std::vector<std::filesystem::path>();
}

std::string unfinished_name(const std::filesystem::path& path) {
  return std::string(name_of_temporary(path.filename().string()));
}

/// "0003_01" of "0003_01.exr", "0003_01_groups.png".
std::string frame_stem(const std::string& name) {
  const std::size_t end = name.find_first_not_of("0123456789_");
  const std::string stem = name.substr(0, end);
  return stem.ends_with('_') ? stem.substr(0, stem.size() - 1) : stem;
}

/// Whether a name is one that frames, previews or overlays have: 0003, 0003_01, with a kind and a suffix.
bool is_frame_stem(const std::string& name) {
  const std::string stem = frame_stem(name);
  const std::size_t step_digits = std::min(stem.find('_'), stem.size());
  const std::string_view rest = std::string_view(name).substr(std::min(stem.size(), name.size()));
  const bool has_kind =
      rest == ".exr" || rest == ".png" || rest == "_dependent.png" || rest == "_touched.png" || rest == "_groups.png";
  return has_kind && step_digits >= 4 && step_digits <= 9 && std::ranges::count(stem, '_') <= 1;
}

std::uint32_t step_of(const std::string& name) {
  std::uint32_t step = 0;
  std::from_chars(name.data(), name.data() + name.size(), step);
  return step;
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw IoError(path.string(), "cannot be removed: " + error.message());
}

/// Whether a file is as it was when it was noted.
bool is_sound(const std::filesystem::path& path, const Json& stamp) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  if (static_cast<std::uint64_t>(status.st_size) != stamp.at("bytes").get<std::uint64_t>()) return false;
  const auto modified = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  return modified == stamp.at("modified").get<std::int64_t>() ||
         hash128(read_file(path)) == stamp.at("hash").get<std::string>();
}

}  // namespace

FileStamp stamp_of(const std::filesystem::path& path, std::string hash) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw IoError(path.string(), std::string("cannot be read: ") + std::strerror(errno));
  return {std::move(hash), static_cast<std::uint64_t>(status.st_size),
          std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec};
}

RunPlan::RunPlan(const Arguments& arguments, const Journal& journal, std::filesystem::path folder, Json source)
    : arguments_(arguments),
      journal_(journal),
      folder_(std::move(folder)),
      source_(std::move(source)),
      hashes_(journal) {
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
  for (const auto& [name, kind] : kFiles)
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

/// What may stay and what not.
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
  if (step == 0) return number == kWholeStep ? std::optional(hashes_.at(0, 0)) : std::nullopt;
  const JournalStep& entry = journal_.steps[step - 1];
  if (number == kWholeStep) return hashes_.after(step);
  const bool is_numbered = !entry.drag.empty() || !entry.wedge.empty();
  return is_numbered && number <= frames_of(entry).size() ? std::optional(hashes_.at(step, number - 1)) : std::nullopt;
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

/// Before a whole run is replaced: every file in its folder is one that relook has written.
void RunPlan::require_known_files() const {
  const auto refuse = [](const std::filesystem::path& path) {
    throw UsageError(path.string(), "is not relook's: a run with other files in its folder is not replaced");
  };
  for (const std::filesystem::path& path : entries_of(folder_)) {
    const std::string name = path.filename().string();
    if (std::ranges::find(kFiles, name, [](const auto& file) { return file.first; }) != kFiles.end()) continue;
    const auto part = std::ranges::find(kParts, name, &RunPart::folder);
    std::error_code error;
    if (part == kParts.end() || !std::filesystem::is_directory(path, error)) {
      if (unfinished_name(path).empty()) refuse(path);
      continue;
    }
    for (const std::filesystem::path& file : entries_of(path))
      if (unfinished_name(file).empty() && !(file.extension() == part->suffix && is_own_file(file, part->kind)))
        refuse(file);
  }
}

bool RunPlan::is_kept(const RunLedger::Note& note, const Json& entry) const {
  if (arguments_.fresh && !note.is_fresh) return false;
  try {
    if (arguments_.overlays && !entry.at("overlays").get<bool>()) return false;
    if (arguments_.verify_percent && entry.at("verify_percent").is_null()) return false;
    if (arguments_.verify_percent && entry.at("verify_percent").get<double>() < *arguments_.verify_percent)
      return false;
    for (const auto& [name, stamp] : entry.at("files").items())
      if (!is_sound(folder_ / name, stamp)) return false;
    return entry.at("files").contains(entry.at("frame").get<std::string>());
  } catch (const Json::exception&) {
    return false;
  } catch (const InputError&) {
    return false;
  }
}

void RunPlan::require_free(const std::string& name) const {
  const std::filesystem::path path = folder_ / name;
  std::error_code error;
  if (!is_there(path) || (std::filesystem::is_regular_file(path, error) && std::filesystem::is_empty(path, error)))
    return;
  const auto part = std::ranges::find(kParts, name.substr(0, name.find('/')), &RunPart::folder);
  if (!is_own_file(path, part->kind))
    throw UsageError(path.string(), "is where a file of the run is to go, and not of relook: not replaced");
}

void RunPlan::find_kept() {
  frames_ = kept_frames_ = 0;
  pixels_different_ = 0;
  kept_.clear();
  bool has_all_in_report = ledger_.has_value();
  for (std::uint32_t step = first_; step <= last_; ++step) {
    const std::size_t count = frames_in(step);
    std::vector<bool>& kept = kept_.emplace_back(count, false);
    frames_ += count;
    for (std::size_t frame = 0; frame < count; ++frame) {
      const FramePlace here = place(step, frame);
      const RunLedger::Note* note = ledger_ && !replaces_all_ ? ledger_->find(key_of(step, frame)) : nullptr;
      if (note != nullptr && note->edits == hashes_.at(step, frame)) {
        const Json entry = ledger_->entry(*note);
        kept[frame] = is_kept(*note, entry) && entry.at("frame") == frame_name(here);
        if (kept[frame] && entry.at("verify").is_object())
          pixels_different_ += entry.at("verify").at("pixels_different").get<std::uint64_t>();
        has_all_in_report = has_all_in_report && note->is_in_report;
      }
      kept_frames_ += kept[frame] ? 1 : 0;
      if (kept[frame] || replaces_all_) continue;
      require_free(frame_name(here));
      require_free(preview_name(here));
      if (!arguments_.overlays) continue;
      for (const char* kind : {"_dependent.png", "_touched.png", "_groups.png"})
        require_free("overlays/" + std::filesystem::path(frame_name(here)).stem().string() + kind);
    }
  }
  const bool wants_page = arguments_.report == ReportKind::html && !has_current_page();
  const bool lacks_baseline = arguments_.baseline && ledger_ && ledger_->head().is_object() &&
                              ledger_->head().value("full_render_seconds", Json()).is_null();
  is_complete_ = kept_frames_ == frames_ && !replaces_some_ && !wants_page && !lacks_baseline &&
                 (arguments_.report == ReportKind::none ||
                  (has_all_in_report && ledger_->head().is_object() && !ledger_->head().value("interrupted", true)));
}

std::size_t RunPlan::frames_in(std::uint32_t step) const {
  return step == 0 ? 1 : frames_of(journal_.steps[step - 1]).size();
}

LedgerKey RunPlan::key_of(std::uint32_t step, std::size_t frame) const {
  return {step, place(step, frame).number.value_or(kWholeStep)};
}

FramePlace RunPlan::place(std::uint32_t step, std::size_t frame) const {
  return step == 0 ? FramePlace() : place_of(journal_.steps[step - 1], step, frame);
}

bool RunPlan::is_of_journal(const LedgerKey& key, const RunLedger::Note& note) const {
  const std::optional<std::string> expected = expected_edits(key);
  return expected && *expected == note.edits;
}

bool RunPlan::is_frame(const LedgerKey& key) const {
  const auto& [step, number] = key;
  return number != kWholeStep || step == 0 || step > journal_.steps.size() ||
         (journal_.steps[step - 1].drag.empty() && journal_.steps[step - 1].wedge.empty());
}

Json RunPlan::kept_entry(std::uint32_t step, std::size_t frame) const {
  return ledger_->entry(*ledger_->find(key_of(step, frame)));
}

bool RunPlan::keeps_whole_step(std::uint32_t step) const {
  const RunLedger::Note* note = ledger_ && !replaces_all_ ? ledger_->find({step, kWholeStep}) : nullptr;
  return note != nullptr && note->edits == hashes_.after(step);
}

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
    const bool may_have = !is_frame({key.first, kWholeStep}) && frames_in(key.first) >= kThreeDigits;
    return may_have && is_of_journal(key, note) && ledger_->entry(note).at("frame") != frame_name_of(key);
  });
}

/// Of this journal, under the names that its frames have now: a hundredth frame gives those of its step another digit.
std::vector<Json> RunPlan::entries_to_stay() const {
  std::vector<Json> entries;
  for (const auto& [key, note] : ledger_->notes()) {
    if (!is_of_journal(key, note)) continue;
    Json entry = ledger_->entry(note);
    if (entry.at("frame") == frame_name_of(key)) entries.push_back(std::move(entry));
  }
  return entries;
}

std::string RunPlan::frame_name_of(const LedgerKey& key) const {
  const auto& [step, number] = key;
  if (number != kWholeStep) return frame_name(place(step, number - 1));
  return frame_name(step == 0 ? FramePlace() : last_place_of(journal_.steps[step - 1], step));
}

/// With all steps locked. Files that relook has written, as frames of no step of this journal, or all of another run.
void RunPlan::remove_replaced() const {
  std::set<std::string> stems;  // of frames that stay
  if (!replaces_all_)
    for (const auto& [key, note] : ledger_->notes())
      if (is_of_journal(key, note)) stems.insert(std::filesystem::path(frame_name_of(key)).stem().string());
  for (const RunPart& part : kParts) {
    if (part.folder == "pixels" && !replaces_all_) continue;  // the page sees to its own
    const std::filesystem::path folder = folder_ / part.folder;
    for (const std::filesystem::path& file : entries_not_beyond_link(folder)) {
      const std::string unfinished = unfinished_name(file),
                        name = unfinished.empty() ? file.filename().string() : unfinished;
      if (!replaces_all_ && (!is_frame_stem(name) || stems.contains(frame_stem(name)))) continue;
      if (!unfinished.empty() || is_own_file(file, part.kind)) remove_file(file);
    }
    std::error_code not_empty;
    const bool is_folder =
        std::filesystem::symlink_status(folder, not_empty).type() == std::filesystem::file_type::directory;
    if (is_folder) std::filesystem::remove(folder, not_empty);
  }
  for (const std::string_view name : {kReportName, std::string_view("report.html")})
    if (is_there(folder_ / name)) remove_file(folder_ / name);
}

void RunPlan::remove_unfinished_page() const {
  for (const std::filesystem::path& file : entries_of(folder_))
    if (unfinished_name(file) == "report.html") remove_file(file);
}

/// Temporary files of commands that were killed at the steps that are locked now, or while they wrote report.json.
void RunPlan::remove_leftovers() const {
  for (const RunPart& part : kParts)
    for (const std::filesystem::path& file : entries_not_beyond_link(folder_ / part.folder)) {
      const std::string name = unfinished_name(file);
      const bool is_ours =
          part.folder != "pixels" && is_frame_stem(name) && step_of(name) >= first_ && step_of(name) <= last_;
      if (is_ours) remove_file(file);
    }
  for (const std::filesystem::path& file : entries_of(folder_))
    if (unfinished_name(file) == kReportName) remove_file(file);
}

}  // namespace relook
