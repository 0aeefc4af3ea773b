// A folder that is filled under a temporary name beside its final one and appears there whole, or not at all. The
// temporary folder is locked while its writer lives, so that those of killed writers are told apart and removed.
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
  /// Moves the folder to its final name. A folder already there is exchanged with it in one step, then removed, so that
  /// the final name always has the old folder or the new one. Throws IoError.
  void publish();

 private:
  /// For file systems that cannot exchange two names: for a moment there is no folder under the final one.
  bool replace_in_two_steps();
  void remove_abandoned(const std::string& start) const;

  std::filesystem::path given_, final_, staged_;
  int lock_ = -1;  // descriptor of the temporary folder
};

}  // namespace relook
