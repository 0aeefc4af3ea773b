// What a replay has to do in one run folder, found before anything is written: which frames are there already, made by
// whatever command from the same cache and the same edits, and whether anything else is in the way. A frame is there if
// its note is sound (report/run_entry_check.h), its files are those of the note byte for byte, and its header says that
// it is this frame; any other note counts as none.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/frame_place.h"
#include "edit/journal.h"
#include "options/arguments.h"
#include "report/edit_hashes.h"
#include "report/progress_file.h"
#include "report/run_entry_check.h"
#include "report/run_ledger.h"
#include "run/noted_files.h"

namespace relook {

class RunPlan {
 public:
  /// `source`: run_source() of what is to be done. Throws UsageError when something else is at `folder`, or at the name
  /// of a file to be written: a run of another source or journal (unless --overwrite is given), or anything that relook
  /// has not written.
  RunPlan(const Arguments& arguments, const Journal& journal, std::filesystem::path folder, Json source);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const Json& source() const { return source_; }
  [[nodiscard]] const std::string& source_hash() const { return source_hash_; }
  [[nodiscard]] const EditHashes& hashes() const { return hashes_; }
  /// The steps whose frames are asked for; 0 is the frame before any.
  [[nodiscard]] std::uint32_t first_step() const { return first_; }
  [[nodiscard]] std::uint32_t last_step() const { return last_; }
  /// The samples of one frame.
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] std::size_t kept_frames() const { return kept_frames_; }
  /// Whether frame `frame` (from 0) of a step is there; then its entry is.
  [[nodiscard]] bool keeps(std::uint32_t step, std::size_t frame) const { return kept_[step - first_][frame]; }
  [[nodiscard]] Json kept_entry(std::uint32_t step, std::size_t frame) const;
  /// Whether there is a sound entry for a drag or wedge as a whole, and all its frames. Requires: one of the steps
  /// asked for.
  [[nodiscard]] bool keeps_whole_step(std::uint32_t step) const;
  /// The number of pixels that --verify found different in all frames that are kept.
  [[nodiscard]] std::uint64_t pixels_different() const { return pixels_different_; }
  /// Whether there is nothing to do: all frames, and the report that is asked for, are there.
  [[nodiscard]] bool is_complete() const { return is_complete_; }

  /// One line if there are notes that count as none.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Whether an entry is believed: of a frame that was asked for, its files are read. From many threads. Requires: an
  /// entry of this journal.
  [[nodiscard]] bool is_sound(const LedgerKey& key, const Json& entry);

  /// Notes in `progress`, which has locked the steps, that they are being done; looks into the folder again, as others
  /// may have gone on; removes what --overwrite replaces and what killed commands have left, by name. Throws as the
  /// constructor, and BusyError when something is to be replaced and another command is at any step.
  void begin(ProgressFile& progress);

  /// What a killed command has left of report.html; in turn for the page.
  void remove_unfinished_page() const;

  /// The name of an entry's frame; a drag or wedge as a whole has that of its last frame. Requires: an entry of this
  /// journal.
  [[nodiscard]] std::string frame_name_of(const LedgerKey& key) const;
  [[nodiscard]] LedgerKey key_of(std::uint32_t step, std::size_t frame) const;
  /// Whether an entry is of this journal, and whether it has a frame of its own: not one of a drag or wedge as a whole.
  [[nodiscard]] bool is_of_journal(const LedgerKey& key, const RunLedger::Note& note) const;
  /// Within its step, from 0; none: a drag or wedge as a whole.
  [[nodiscard]] std::optional<std::size_t> frame_of(const LedgerKey& key) const;
  [[nodiscard]] bool is_frame(const LedgerKey& key) const;

 private:
  void refresh();
  void look_into_folder();
  void judge_run();
  void require_known_files() const;
  void find_kept();
  void judge_notes();
  void count_kept();
  [[nodiscard]] bool sums_up(std::uint32_t step, const Json& whole) const;
  [[nodiscard]] KnownFrame known_frame(const LedgerKey& key) const;
  [[nodiscard]] bool is_its_frame(const LedgerKey& key, const Json& entry) const;
  [[nodiscard]] FramePlace place_of_key(const LedgerKey& key) const;
  [[nodiscard]] bool has_true_head(const Json& head) const;
  void require_free_names(const FramePlace& here) const;
  [[nodiscard]] std::optional<std::string> other_journal() const;
  [[nodiscard]] std::optional<std::string> expected_edits(const LedgerKey& key) const;
  [[nodiscard]] bool is_enough(const Json& entry) const;
  [[nodiscard]] bool says_what_the_journal_does(const LedgerKey& key, const Json& entry) const;
  [[nodiscard]] bool has_current_page() const;
  void require_free(const std::string& name) const;
  [[nodiscard]] std::vector<Json> entries_to_stay() const;
  [[nodiscard]] bool has_other_names() const;
  void remove_replaced() const;
  void remove_leftovers() const;

  const Arguments& arguments_;
  const Journal& journal_;
  std::filesystem::path folder_;
  Json source_;
  EditHashes hashes_;
  std::unique_ptr<NotedFiles> files_;
  std::uint64_t pixels_ = 0, samples_ = 0;  // of a frame
  std::string source_hash_;
  std::uint32_t first_ = 0, last_ = 0;
  std::optional<RunLedger> ledger_;  // of a run that can be gone on with, or in which things are replaced
  bool replaces_some_ = false;       // --overwrite of anything there
  bool replaces_all_ = false;        // of a run of another source
  std::size_t frames_ = 0, kept_frames_ = 0, unsound_frames_ = 0;
  std::vector<std::vector<bool>> kept_;  // [step - first][frame]
  std::vector<bool> keeps_whole_;        // [step - first]
  std::uint64_t pixels_different_ = 0;
  bool is_complete_ = false;
};

}  // namespace relook
