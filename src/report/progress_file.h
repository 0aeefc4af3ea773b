// RUN/progress.jsonl: what the commands that write a run have finished, appended frame by frame and synced, so that a
// run that was killed can be taken up again; gone once report.json has all of it and no command is writing any more. A
// line is the XXH3-128 of its text, a space, and the text: a head where a command begins ({"relook":"progress/2", what
// it is to do}), and entries as in report.json. A line that was cut short counts as none.
//
// It is also the lock of the run: a command holds the bytes of its steps (byte k for step k, open file description
// locks), so that commands with other steps of the same run work side by side, on other hosts, too, and two with the
// same steps never do. Where a file system has no locks, that is the user's to avoid.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/json.h"

namespace relook {

inline constexpr std::string_view kProgressName = "progress.jsonl";
inline constexpr std::string_view kProgressHead = "{\"relook\":\"progress/";

/// The text of a line; "" when it is not as it was written.
[[nodiscard]] std::string_view progress_text(std::string_view line);

class ProgressFile {
 public:
  /// Opens or creates it in the folder `run` and locks the steps first..last. Throws BusyError when another command is
  /// at one of them, IoError, ResourceError.
  ProgressFile(const std::filesystem::path& run, std::uint32_t first_step, std::uint32_t last_step);
  ~ProgressFile();
  ProgressFile(const ProgressFile&) = delete;
  ProgressFile& operator=(const ProgressFile&) = delete;

  /// Adds a line and syncs it to disk, within exclusively().
  void append(const Json& entry) {
    exclusively([&] { append_in_turn({&entry, 1}); });
  }
  /// Within exclusively(): adds lines.
  void append_in_turn(std::span<const Json> entries);
  /// Within exclusively(), with all steps locked: forgets all that is there.
  void clear();
  /// Runs `work` while no other command is in exclusively(). A command that does not end its turn, since it was
  /// stopped, is waited for kShortWait seconds; then `work` runs all the same.
  template <class Work>
  void exclusively(const Work& work) {
    const Turn turn(*this, kAppendByte);
    work();
  }
  /// The same for writing the page, with a lock of its own, so that others append meanwhile. `waits`: for another
  /// command's page, up to kLongWait seconds; otherwise `work` is left out while one is being written.
  template <class Work>
  void exclusively_for_page(bool waits, const Work& work) {
    const Turn turn(*this, kPageByte, waits ? kLongWait : 0);
    if (turn.is_ours() || waits) work();
  }
  /// Whether another command holds one of these steps.
  [[nodiscard]] bool is_being_done(std::uint32_t first_step, std::uint32_t last_step) const;
  /// Locks all steps of the run; false if another command holds one. Commands that begin meanwhile wait for
  /// unlock_other_steps(), for a second at most, and then give up.
  [[nodiscard]] bool lock_all_steps();
  /// Holds the steps first..last alone again.
  void unlock_other_steps();
  [[nodiscard]] std::uint64_t size_bytes() const;
  /// Removes the file of a run that is complete. Requires: lock_all_steps() has returned true.
  void remove();

 private:
  static constexpr std::uint64_t kStepBytes = std::uint64_t{1} << 40, kAppendByte = kStepBytes,
                                 kPageByte = kStepBytes + 1;
  static constexpr int kShortWait = 5, kLongWait = 600;  // seconds
  class Turn {
   public:
    Turn(const ProgressFile& file, std::uint64_t byte, int most_seconds = kShortWait);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    [[nodiscard]] bool is_ours() const { return is_ours_; }

   private:
    const ProgressFile& file_;
    std::uint64_t byte_;
    bool is_ours_ = false;
  };

  std::filesystem::path path_;
  std::uint32_t first_step_, last_step_;
  int descriptor_ = -1;
};

}  // namespace relook
