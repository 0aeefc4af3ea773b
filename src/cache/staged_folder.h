// A cache's folder, filled under a temporary name beside its final one: it appears there whole, or not at all. The
// temporary folder is locked while its writer lives, so that those of killed writers are told apart and removed. Only
// files of caches are ever removed (cache/cache_folder.h); a folder in which anything else is found stays. Used by
// write_cache(), and by require_writable() to find out early.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace relook {

class StagedFolder {
 public:
  /// Creates the temporary folder beside `final_path`, whose parents are created as needed; removes what killed writers
  /// of the same folder have left there. Throws IoError, ResourceError.
  explicit StagedFolder(const std::filesystem::path& final_path);
  /// Removes whatever was not published.
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return staged_; }
  /// Runs `fill`, which writes below path(). Its errors name the final folder as given, not the temporary one.
  void fill(const std::function<void()>& fill) const;
  /// Moves the folder to its final name. A folder already there that is not empty is exchanged with it in one step, if
  /// `may_replace` says so, so that the final name always has the old folder or the new one; then the old cache's files
  /// are removed and all else moves into the new folder. If `may_replace` says no, what is there stays and the new
  /// folder goes. Throws IoError, and what `may_replace` throws.
  void publish(const std::function<bool()>& may_replace);

  /// Removes what killed writers of a folder have left beside it, where that is permitted.
  static void remove_abandoned(const std::filesystem::path& final_path);

 private:
  /// For file systems that cannot exchange two names: for a moment there is no folder under the final one.
  bool replace_in_two_steps();

  std::filesystem::path given_, final_, staged_;
  int lock_ = -1;  // descriptor of the temporary folder
};

}  // namespace relook
