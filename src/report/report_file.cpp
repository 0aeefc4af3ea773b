#include "report/report_file.h"

#include <memory>

#include "report/line_reader.h"

namespace relook {
ReportFile::ReportFile(const std::filesystem::path& path, const Json& head) : path_(path), file_(path) {
  Json rest = head;
  rest.erase("relook");
  const std::string text = json_text(rest, 2);  // "{\n  ...\n}"
  file_.append("{\n  \"relook\": " + json_text(head.at("relook")) + ",\n");
  file_.append(std::string_view(text).substr(2, text.size() - 4));
  file_.append(std::string(",\n").append(kStepsLine));
}

void ReportFile::add(const Json& entry) {
  const std::string text = json_text(entry);
  file_.append(lines_.empty() ? "\n" : ",\n");
  lines_.emplace_back(file_.size(), static_cast<std::uint32_t>(text.size()));
  file_.append(text);
  const auto& frame = entry.at("frame").get_ref<const std::string&>();
  if (frames_.empty() || frames_.back().first != frame)
    frames_.emplace_back(frame, entry.at("frame_hash").get<std::string>());
}

void ReportFile::publish() {
  file_.append(std::string("\n").append(kStepsEnd).append("\n  \"frames\": {"));
  for (std::size_t i = 0; i < frames_.size(); ++i)
    file_.append((i == 0 ? "\n    " : ",\n    ") + json_text(frames_[i].first) + ": " + json_text(frames_[i].second));
  file_.append("\n  }\n}\n");
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
