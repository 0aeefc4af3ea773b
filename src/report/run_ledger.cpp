#include "report/run_ledger.h"

#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "base/hash.h"
#include "report/own_file.h"
#include "report/progress_file.h"
#include "report/report_file.h"
#include "report/run_entry_check.h"

namespace relook {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// The key of an entry. Throws InputError when it is none that step_json() makes.
LedgerKey ledger_key(const Json& entry) {
  const JsonView view(entry, kReportName);
  const auto step = static_cast<std::uint32_t>(view.at("step").integer(0, kWholeStep));
  for (const char* kind : {"drag_frame", "wedge_frame"})
    if (const JsonView number = view.at(kind); !number.value().is_null())
      return {step, static_cast<std::uint32_t>(number.integer(1, kWholeStep - 1))};
  return {step, kWholeStep};
}

}  // namespace

RunLedger::RunLedger(std::filesystem::path run) : run_(std::move(run)) {
  read_report();
  read_progress();
}

/// Notes the entries of report.json, if it is laid out as report_file.h does it.
void RunLedger::read_report() {
  const std::filesystem::path path = run_ / kReportName;
  if (!is_own_file(path, OwnKind::report)) return;
  is_run_ = has_foreign_report_ = true;
  report_ = std::make_unique<LineReader>(path);
  std::string head, line;
  bool has_steps = false, has_seal = false;
  while (!has_steps && report_->next(line)) {
    has_steps = line == kStepsLine;
    has_seal = has_seal || line == std::string(kSealLine) + hash128(bytes_of(head)) + "\",";
    head += line + "\n";
  }
  if (!has_steps) return;
  try {
    head_ = parse_json(head + "]}", path.string());
    source_ = head_.value("source", Json());
    head_.erase("steps");
    head_.erase("seal");
  } catch (const InputError&) {
    return;
  }
  has_foreign_report_ = source_.is_null();
  if (!has_seal) head_ = nullptr;
  has_whole_report_ = read_entries() && has_seal;
}

/// Notes the entries. Whether all are as they were written, each once and in order, and what follows names their
/// frames.
bool RunLedger::read_entries() {
  const std::size_t refused = refused_;
  std::optional<Taken> last;
  std::uint64_t frames = 0;  // hash of the lines that name them
  bool is_in_order = true;
  std::string line;
  while (report_->next(line) && line != kStepsEnd) {
    const std::string_view text = std::string_view(line).substr(0, line.size() - (line.ends_with(',') ? 1 : 0));
    std::optional<Taken> taken = has_sound_seal(text) ? take(text, *report_, 0, true) : std::nullopt;
    if (!taken) {
      ++refused_;
      continue;
    }
    is_in_order = is_in_order && (!last || last->key < taken->key);
    if (!last || last->frame != taken->frame) frames = hash64(bytes_of(frame_line(taken->frame, taken->hash)), frames);
    last = std::move(taken);
  }
  return is_in_order && last && refused_ == refused && has_sound_end(frames);
}

/// Whether the lines that name the frames have this hash, and nothing comes after them.
bool RunLedger::has_sound_end(std::uint64_t expected) {
  std::uint64_t frames = 0;
  std::string line, end;
  if (!report_->next(line) || line != kFramesLine) return false;
  while (report_->next(line) && line.starts_with("    ")) {
    if (line.ends_with(',')) line.pop_back();
    frames = hash64(bytes_of(line), frames);
  }
  for (end = line + "\n"; report_->next(line) && end.size() <= kFramesEnd.size();) end += line + "\n";
  return frames == expected && end == kFramesEnd;
}

/// Notes the entries and tasks of progress.jsonl. A line that was cut short, by a command that was killed as it wrote,
/// is left out; any other line that makes no sense counts as refused.
void RunLedger::read_progress() {
  const std::filesystem::path path = run_ / kProgressName;
  if (!is_file(path) || !is_own_file(path, OwnKind::progress)) return;
  is_run_ = true;
  progress_ = std::make_unique<LineReader>(path);
  for (std::string line; progress_->next(line);) {
    const std::string_view text = progress_text(line);
    const bool is_taken = text.starts_with(kProgressHead)
                              ? take_head(text)
                              : !text.empty() && take(text, *progress_, line.size() - text.size(), false);
    if (!is_taken && line.ends_with('}')) ++refused_;
  }
}

Json RunLedger::head_of(const Task& task, const Json& source) {
  // Json sorts by name, so that `relook`, which tells what the file is, comes first.
  return {{"relook", "progress/2"},       {"source", source},
          {"steps_edits", task.edits},    {"steps_first", task.first_step},
          {"steps_fresh", task.is_fresh}, {"steps_last", task.last_step}};
}

bool RunLedger::take_head(std::string_view text) {
  try {
    const Json head = parse_json(text, kProgressName);
    const JsonView view(head, kProgressName);
    Task task;
    task.first_step = static_cast<std::uint32_t>(view.at("steps_first").integer(0, kWholeStep - 1));
    task.last_step = static_cast<std::uint32_t>(view.at("steps_last").integer(task.first_step, kWholeStep - 1));
    task.edits = view.at("steps_edits").text();
    task.is_fresh = view.at("steps_fresh").boolean();
    source_ = view.at("source").value();
    tasks_.push_back(std::move(task));
    return true;
  } catch (const InputError&) {  // no head
    return false;
  }
}

std::optional<RunLedger::Taken> RunLedger::take(std::string_view text, const LineReader& file, std::size_t skipped,
                                                bool is_in_report) {
  try {
    const Json entry = parse_json(text, kReportName);
    check_entry(entry);
    const LedgerKey key = ledger_key(entry);
    const bool is_fresh = std::ranges::any_of(tasks_, [&](const Task& task) {
      return task.is_fresh && task.first_step <= key.first && key.first <= task.last_step;
    });
    Note note{entry["edits"].get<std::string>(), is_in_report, is_fresh && !is_in_report, file.offset() + skipped,
              text.size()};
    notes_.insert_or_assign(key, std::move(note));
    return Taken{key, entry["frame"].get<std::string>(), entry["frame_hash"].get<std::string>()};
  } catch (const InputError&) {  // no entry
    return std::nullopt;
  }
}

const RunLedger::Note* RunLedger::find(const LedgerKey& key) const {
  const auto found = notes_.find(key);
  return found == notes_.end() ? nullptr : &found->second;
}

Json RunLedger::entry(const Note& note) const {
  Json entry = parse_json((note.is_in_report ? report_ : progress_)->read_at(note.offset, note.bytes), kReportName);
  entry.erase("seal");
  return entry;
}

}  // namespace relook
