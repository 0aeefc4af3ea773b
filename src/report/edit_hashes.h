// What identifies a frame of a journal among all journals: the hash of the edits that lead to it. A journal that goes
// on where another ends has the same hashes up to there, so that frames which are there already are known again.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "edit/journal.h"

namespace relook {

/// Of all frames of a journal.
class EditHashes {
 public:
  /// Files that the journal names count with their bytes, as do those that a .gltf among them names. Files that cannot
  /// be read count as nothing: whoever applies the edit says so.
  explicit EditHashes(const Journal& journal);

  /// XXH3-128 over the kinds, operations and files of all edits up to this frame; "" for the one before any.
  [[nodiscard]] std::string at(std::uint32_t step, std::size_t frame) const;
  /// Of the last frame of a step.
  [[nodiscard]] std::string after(std::uint32_t step) const;

 private:
  static constexpr std::size_t kDigits = 32;
  std::vector<std::string> by_step_;  // [step], kDigits a frame; "" for step 0
};

/// The files that an edit brings in, as it names them.
[[nodiscard]] std::vector<std::string> files_of(const Edit& edit);
/// The files that a journal's edits bring in and those that these name; what cannot be found is left out.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const Journal& journal);

}  // namespace relook
