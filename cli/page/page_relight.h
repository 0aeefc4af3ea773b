// The layers of light of a run's frames (image/layers/relight_file.h) for its page, in pixels/relight_*.js beside it: a
// tile stands with the first frame that has it, whichever frames lie between. With all of them, base64 and texts, the
// page takes about four thirds of the bytes of relight/, at most. Used by run_page.cpp.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"
#include "edit/journal.h"
#include "frame/frame_tiles.h"
#include "page/page_pixels.h"

namespace relook {

class PageRelight {
 public:
  /// `files` and `journal` outlive this.
  PageRelight(const std::filesystem::path& run, const Journal& journal, PageFiles& files)
      : folder_(run), journal_(&journal), bundles_(files, kRelightCall) {}

  /// Takes the layers of an entry's frame, if it has some. Throws InputError when they are damaged.
  void take(std::size_t number, const Json& entry, const std::string& stem);
  /// After the last entry: {"bundles": the first entry of each file, "entries": those that have layers, as runs}; null:
  /// none has.
  [[nodiscard]] Json finish();

 private:
  [[nodiscard]] std::vector<std::size_t> place_tiles(std::size_t number, const FrameTiles& frame);

  std::filesystem::path folder_;
  const Journal* journal_;
  PixelBundles bundles_;
  std::vector<std::size_t> entries_;
  using TileKey = std::array<std::uint64_t, 3>;  // tile, hash of its bytes and channels
  std::map<TileKey, std::size_t> stored_;        // the entry that it stands with
  std::string stem_;                             // of the file taken last
  std::vector<std::size_t> sources_;             // by tile of it: the entry
  std::vector<std::string> channels_;            // of it, in the order of the file
  std::string text_;                             // relook:relight of it
};

}  // namespace relook
