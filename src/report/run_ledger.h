// What a run's folder holds: the entries of its frames, those of report.json and those noted in progress.jsonl since,
// by whatever command. Of an entry only its place in the file and the hash of its edits are in memory. Entries have
// passed check_entry(); whether they are of the frames at hand, RunPlan (cli/run/run_plan.h) asks of agrees().
#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "report/line_reader.h"

namespace relook {

/// A step, and within it the number of a frame of a drag or wedge or kWholeStep: whole steps come after their frames.
using LedgerKey = std::pair<std::uint32_t, std::uint32_t>;
inline constexpr std::uint32_t kWholeStep = std::numeric_limits<std::uint32_t>::max();

class RunLedger {
 public:
  struct Note {
    std::string edits;  // hash of the edits up to the frame
    bool is_in_report = false;
    bool is_fresh = false;  // made by a command with --fresh that is not complete
    std::uint64_t offset = 0;  // of the entry in its file, in bytes
    std::size_t bytes = 0;
  };
  /// What a command was, or is, to do that has begun since the run was complete last.
  struct Task {
    std::uint32_t first_step = 0, last_step = 0;
    std::string edits;  // hash after the last step
    bool is_fresh = false;
  };
  /// The line of progress.jsonl with which a command begins.
  [[nodiscard]] static Json head_of(const Task& task, const Json& source);

  /// Reads what is there; lines that are cut short, were changed since or make no sense count as none. Throws
  /// InputError when report.json or progress.jsonl cannot be read.
  explicit RunLedger(std::filesystem::path run);

  /// Whether the folder has a report or notes that relook has written.
  [[nodiscard]] bool is_run() const { return is_run_; }
  /// report.json without its steps; null when there is none that can be gone on with, or its head was changed since.
  [[nodiscard]] const Json& head() const { return head_; }
  /// What all its frames have in common (run_source.h); null when that is not known, as of a run of another version.
  [[nodiscard]] const Json& source() const { return source_; }
  [[nodiscard]] const std::map<LedgerKey, Note>& notes() const { return notes_; }
  /// The tasks in progress.jsonl, in the order in which they began.
  [[nodiscard]] const std::vector<Task>& tasks() const { return tasks_; }
  /// Whether report.json is of relook, but not laid out as this version does it.
  [[nodiscard]] bool has_foreign_report() const { return has_foreign_report_; }
  /// Whether report.json, if there is one, is as it was written.
  [[nodiscard]] bool has_whole_report() const { return has_whole_report_; }
  /// How many lines should be entries and are not as they were written.
  [[nodiscard]] std::size_t refused() const { return refused_; }
  [[nodiscard]] const Note* find(const LedgerKey& key) const;
  /// Throws InputError.
  [[nodiscard]] Json entry(const Note& note) const;

 private:
  void read_report();
  void read_progress();
  [[nodiscard]] bool read_entries();
  [[nodiscard]] bool has_sound_end(std::uint64_t expected);
  [[nodiscard]] bool take_head(std::string_view text);
  struct Taken {
    LedgerKey key;
    std::string frame, hash;
  };
  /// Notes an entry; none if the text is no entry. `skipped`: bytes of the line before it.
  std::optional<Taken> take(std::string_view text, const LineReader& file, std::size_t skipped, bool is_in_report);

  std::filesystem::path run_;
  bool is_run_ = false, has_foreign_report_ = false, has_whole_report_ = true;
  std::size_t refused_ = 0;
  Json head_, source_;
  std::vector<Task> tasks_;
  std::map<LedgerKey, Note> notes_;
  std::unique_ptr<LineReader> report_, progress_;
};

}  // namespace relook
