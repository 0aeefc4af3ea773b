// RUN/report.json, written and read an entry at a time: `relook` first, an entry of `steps` a line, `frames` last. A
// `seal` in each entry and one before `steps`, over all bytes before it, tell what was changed since. Written by
// cli/run/run_folder.h; RunLedger reads it back by the lines below.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "report/report_entries.h"

namespace relook {

inline constexpr std::string_view kReportName = "report.json";
inline constexpr std::string_view kStepsLine = "  \"steps\": [";
inline constexpr std::string_view kStepsEnd = "  ],";
inline constexpr std::string_view kSealLine = "  \"seal\": \"";
inline constexpr std::string_view kFramesLine = "  \"frames\": {", kFramesEnd = "  }\n}\n";
/// A line of `frames` without what separates it from the next.
[[nodiscard]] std::string frame_line(const std::string& frame, const std::string& hash);

class ReportFile {
 public:
  /// `head`: report_head_json(). The file appears with publish(). Throws IoError, ResourceError, as all functions do.
  ReportFile(const std::filesystem::path& path, const Json& head);
  /// Adds an entry as step_json() makes it. Entries come in the order of their frames.
  void add(const Json& entry);
  void publish();
  /// After publish(): the entries, read from the file. This and the file, as it is, must outlive what is returned.
  [[nodiscard]] ReportEntries entries() const;

 private:
  std::filesystem::path path_;
  FileWriter file_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> lines_;  // offset, bytes
  std::vector<std::pair<std::string, std::string>> frames_;     // name, hash
};

}  // namespace relook
