#include "report/run_ledger.h"

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
  is_run_ = true;
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
      source_ = parse_json(text, path.string()).value("source", Json());
    else
      take(text, *progress_, line.size() - text.size(), false);
  }
}

void RunLedger::take(std::string_view text, const LineReader& file, std::size_t skipped, bool is_in_report) {
  if (text.ends_with(',')) text.remove_suffix(1);
  try {
    const Json entry = parse_json(text, kReportName);
    Note note{JsonView(entry, kReportName).at("edits").text(), is_in_report, file.offset() + skipped, text.size()};
    notes_.insert_or_assign(ledger_key(entry), std::move(note));
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
