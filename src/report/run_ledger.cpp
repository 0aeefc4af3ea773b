#include "report/run_ledger.h"

#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "base/hash.h"
#include "report/own_file.h"
#include "report/progress_file.h"
#include "report/report_file.h"

namespace relook {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// Throws InputError unless an entry has what its readers rely on.
void check_entry(const Json& entry) {
  const JsonView view(entry, kReportName);
  for (const char* key : {"name", "class", "frame", "frame_hash", "preview", "edits", "command"})
    (void)view.at(key).text();
  if (const JsonView verify = view.at("verify"); !verify.value().is_null())
    (void)(verify.at("pixels_compared").integer(0, INT64_MAX) + verify.at("pixels_different").integer(0, INT64_MAX));
  if (const JsonView percent = view.at("verify_percent"); !percent.value().is_null()) (void)percent.number(0, 100);
  (void)view.at("overlays").boolean();
  const JsonView files = view.at("files");
  files.require_object();
  for (const auto& file : files.value().items()) {
    const JsonView stamp = files.at(file.key());
    (void)stamp.at("hash").text();
    (void)stamp.at("bytes").integer(0, INT64_MAX);
    (void)stamp.at("modified").integer(INT64_MIN, INT64_MAX);
  }
  const std::string stem = std::filesystem::path(view.at("frame").text()).stem().string();
  if (view.at("frame").text() != "frames/" + stem + ".exr" || view.at("preview").text() != "previews/" + stem + ".png")
    view.at("frame").fail("not a frame of a run");
}

}  // namespace

LedgerKey ledger_key(const Json& entry) {
  const JsonView view(entry, kReportName);
  const auto step = static_cast<std::uint32_t>(view.at("step").integer(0, kWholeStep));
  for (const char* kind : {"drag_frame", "wedge_frame"})
    if (const JsonView number = view.at(kind); !number.value().is_null())
      return {step, static_cast<std::uint32_t>(number.integer(1, kWholeStep - 1))};
  return {step, kWholeStep};
}

RunLedger::RunLedger(std::filesystem::path run) : run_(std::move(run)) {
  read_report();
  read_progress();
}

/// Only a report that is laid out as report_file.h does it has its entries noted.
void RunLedger::read_report() {
  const std::filesystem::path path = run_ / kReportName;
  if (!is_own_file(path, OwnKind::report)) return;
  is_run_ = has_foreign_report_ = true;
  report_ = std::make_unique<LineReader>(path);
  std::string head, line;
  bool has_steps = false;
  while (!has_steps && report_->next(line)) {
    has_steps = line == kStepsLine;
    head += line + "\n";
  }
  if (!has_steps) return;
  try {
    head_ = parse_json(head + "]}", path.string());
    source_ = head_.value("source", Json());
    head_.erase("steps");
  } catch (const InputError&) {
    return;
  }
  has_foreign_report_ = source_.is_null();
  while (report_->next(line) && line != kStepsEnd) take(line, *report_, 0, true);
}

void RunLedger::read_progress() {
  const std::filesystem::path path = run_ / kProgressName;
  if (!is_file(path) || !is_own_file(path, OwnKind::progress)) return;
  is_run_ = true;
  progress_ = std::make_unique<LineReader>(path);
  for (std::string line; progress_->next(line);) {
    const std::string_view text = progress_text(line);
    if (text.empty()) continue;
    if (text.starts_with(kProgressHead))
      take_head(parse_json(text, path.string()));
    else
      take(text, *progress_, line.size() - text.size(), false);
  }
}

Json RunLedger::head_of(const Task& task, const Json& source) {
  // As text in the order of the names: what tells the file comes first.
  return {{"relook", "progress/2"},       {"source", source},
          {"steps_edits", task.edits},    {"steps_first", task.first_step},
          {"steps_fresh", task.is_fresh}, {"steps_last", task.last_step}};
}

void RunLedger::take_head(const Json& head) {
  try {
    const JsonView view(head, kProgressName);
    Task task;
    task.first_step = static_cast<std::uint32_t>(view.at("steps_first").integer(0, kWholeStep - 1));
    task.last_step = static_cast<std::uint32_t>(view.at("steps_last").integer(task.first_step, kWholeStep - 1));
    task.edits = view.at("steps_edits").text();
    task.is_fresh = view.at("steps_fresh").boolean();
    source_ = view.at("source").value();
    tasks_.push_back(std::move(task));
  } catch (const InputError&) {  // no head
  }
}

void RunLedger::take(std::string_view text, const LineReader& file, std::size_t skipped, bool is_in_report) {
  if (text.ends_with(',')) text.remove_suffix(1);
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
  } catch (const InputError&) {  // no entry
  }
}

const RunLedger::Note* RunLedger::find(const LedgerKey& key) const {
  const auto found = notes_.find(key);
  return found == notes_.end() ? nullptr : &found->second;
}

Json RunLedger::entry(const Note& note) const {
  return parse_json((note.is_in_report ? report_ : progress_)->read_at(note.offset, note.bytes), kReportName);
}

}  // namespace relook
