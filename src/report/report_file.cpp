#include "report/report_file.h"

#include <memory>

#include "base/hash.h"
#include "report/line_reader.h"
#include "report/run_entry_check.h"

namespace relook {

std::string frame_line(const std::string& frame, const std::string& hash) {
  return "    " + json_text(frame) + ": " + json_text(hash);
}

ReportFile::ReportFile(const std::filesystem::path& path, const Json& head) : path_(path), file_(path) {
  Json rest = head;
  rest.erase("relook");
  const std::string text = json_text(rest, 2);  // "{\n  ...\n}"
  std::string start = "{\n  \"relook\": " + json_text(head.at("relook")) + ",\n";
  start.append(text, 2, text.size() - 4).append(",\n");
  file_.append(start + std::string(kSealLine) + hash128(bytes_of(start)) + "\",\n");
  file_.append(kStepsLine);
}

void ReportFile::add(const Json& entry) {
  const std::string text = sealed(json_text(entry));
  file_.append(lines_.empty() ? "\n" : ",\n");
  lines_.emplace_back(file_.size(), static_cast<std::uint32_t>(text.size()));
  file_.append(text);
  const auto& frame = entry.at("frame").get_ref<const std::string&>();
  if (frames_.empty() || frames_.back().first != frame)
    frames_.emplace_back(frame, entry.at("frame_hash").get<std::string>());
}

void ReportFile::publish() {
  file_.append(std::string("\n").append(kStepsEnd).append("\n").append(kFramesLine));
  for (std::size_t i = 0; i < frames_.size(); ++i)
    file_.append((i == 0 ? "\n" : ",\n") + frame_line(frames_[i].first, frames_[i].second));
  file_.append(std::string("\n").append(kFramesEnd));
  file_.publish();
}

ReportEntries ReportFile::entries() const {
  const auto reader = std::make_shared<LineReader>(path_);
  const auto at = [reader, this](std::size_t i) {
    return parse_json(reader->read_at(lines_[i].first, lines_[i].second), kReportName);
  };
  return {lines_.size(), at};
}

}  // namespace relook
