// RUN/progress.jsonl: what a run in progress has finished, appended step by step and synced, so that a run that was
// killed can be taken up again. Held locked, so that two runs never share a folder; gone once the report is written.
// A line is the XXH3-128 of its text, a space, and the text: first {"relook": "progress/1", "run": HASH}, then one
// entry a frame. A line that was cut short ends the file.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

inline constexpr std::string_view kProgressName = "progress.jsonl";

class ProgressFile {
 public:
  /// Opens or creates it in the folder `run`. Throws IoError (in use by another run, say), ResourceError.
  explicit ProgressFile(const std::filesystem::path& run);
  ~ProgressFile();
  ProgressFile(const ProgressFile&) = delete;
  ProgressFile& operator=(const ProgressFile&) = delete;

  /// The entries of a run with this hash, in order; none if the file is of another run or of none.
  [[nodiscard]] std::vector<Json> entries(const std::string& run_hash) const;
  /// Makes the file that of a run with these entries.
  void restart(const std::string& run_hash, const std::vector<Json>& entries);
  /// Adds an entry and syncs it to disk.
  void append(const Json& entry);
  /// The run is complete.
  void remove();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace relook
