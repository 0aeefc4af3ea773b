#include "input/run_input.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "frame/display_view.h"
#include "frame/frame_file.h"
#include "report/own_file.h"
#include "report/report_file.h"

namespace relook {
namespace {

bool has_report(const std::filesystem::path& folder) { return is_own_file(folder / kReportName, OwnKind::report); }

/// The patch of a header, as far as it is there: one that was too long ends in a text.
Edit edit_of_header(const std::string& text, const std::string& file) {
  try {
    Json patch = parse_json(text, file);
    if (patch.is_array() && !patch.empty() && patch.back().is_string()) patch.erase(patch.size() - 1);
    return parse_patch(json_text(patch), file);
  } catch (const InputError&) {
    return {};
  }
}

std::uint64_t number_at(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace

std::vector<std::filesystem::path> runs_at(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error))
    throw InputError(path.string(), "", "is no run: not a folder, or not there");
  if (has_report(path)) return {path};
  std::vector<std::filesystem::path> runs;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (entry.is_directory(error) && has_report(entry.path())) runs.push_back(entry.path());
  if (runs.empty())
    throw InputError(path.string(), "", "is no run: neither it nor a folder in it has a report.json of relook");
  std::ranges::sort(runs);
  return runs;
}

RunInput::RunInput(std::filesystem::path folder)
    : folder_(std::move(folder)), ledger_(std::make_unique<RunLedger>(folder_)) {
  const Json& head = ledger_->head();
  if (ledger_->has_foreign_report() || !head.is_object())
    throw InputError((folder_ / kReportName).string(), "",
                     "is not as this version of relook writes it; the replay that made the run makes it anew");
  const JsonView file = JsonView(head, (folder_ / kReportName).string()).at("journal").at("file");
  name_ = std::filesystem::path(file.text()).stem().string();
  if (name_ == "-" || name_.empty()) name_ = folder_.filename().string();
  for (const auto& [key, note] : ledger_->notes())
    if (note.is_in_report) notes_.push_back(note);
  if (notes_.empty())
    throw InputError((folder_ / kReportName).string(), "steps", "has no entry as this version of relook writes it");
}

ReportEntries RunInput::entries() const {
  return {notes_.size(), [this](std::size_t i) { return ledger_->entry(notes_[i]); }};
}

Journal RunInput::journal() const {
  Journal journal;
  journal.path = folder_ / kReportName;
  journal.file = journal.path.string();
  journal.name = name_;
  constexpr std::uint64_t kMostSteps = 1'000'000;
  for (const RunLedger::Note& note : notes_) {
    const Json entry = ledger_->entry(note);
    const std::uint64_t number = number_at(entry, "step");
    if (number == 0 || number > kMostSteps) continue;
    if (journal.steps.size() < number) journal.steps.resize(number);
    JournalStep& step = journal.steps[number - 1];
    const std::uint64_t place = std::max(number_at(entry, "drag_frame"), number_at(entry, "wedge_frame"));
    if (place > kMostFrames) continue;
    if (place == 0 && !step.drag.empty()) continue;  // the step as a whole
    const std::string frame = (folder_ / entry.value("frame", "")).string();
    const std::optional<FrameMeta> meta = own_frame_meta(frame);
    Edit edit = meta && !meta->edit.empty() ? edit_of_header(meta->edit, frame) : Edit();
    if (place == 0) {
      step.edit = std::move(edit);
    } else {
      if (step.drag.size() < place) step.drag.resize(place);
      step.drag[place - 1] = std::move(edit);
    }
  }
  return journal;
}

double RunInput::exposure() const {
  const Json::json_pointer place("/options/exposure");
  const Json& head = ledger_->head();
  if (!head.contains(place) || !head.at(place).is_number()) return 0;
  return std::clamp(head.at(place).get<double>(), -kMostExposure, kMostExposure);
}

std::string RunInput::view() const {
  const Json::json_pointer place("/source/view");
  const Json& head = ledger_->head();
  return head.contains(place) && head.at(place).is_string() ? head.at(place).get<std::string>() : "";
}

}  // namespace relook
