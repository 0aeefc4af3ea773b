// Which frames of a run its page has the pixels of, and where: in the page while there is room, else in pixels/*.js
// beside it, several frames to a file. Beside the page they take no more than half of the bytes of the frames and 6 MB,
// spread over the run; what does not fit is left out whole, so that each frame that is there is right bit by bit.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json.h"
#include "page/page_files.h"
#include "page/run_pixels.h"

namespace relook {

/// What lies beside a page, pixels and details together, may take half of the bytes of the frames and these.
inline constexpr std::uint64_t kFreeBesideBytes = 6'000'000;

/// Files of records, several in each.
class PixelBundles {
 public:
  explicit PixelBundles(PageFiles& files) : files_(&files) {}
  using Append = std::function<void(std::string_view)>;
  /// `write` appends the record of an entry, piece by piece.
  void add(std::size_t entry, const std::function<void(const Append&)>& write);
  void end_file();
  [[nodiscard]] const std::vector<std::size_t>& first_entries() const { return first_entries_; }

 private:
  PageFiles* files_;
  std::unique_ptr<FileWriter> file_;  // not ended yet
  std::vector<std::size_t> first_entries_;
};

class PagePixels {
 public:
  /// `files` outlives this. `exposure`: stops, of thumbnails.
  PagePixels(const std::filesystem::path& run, double exposure, PageFiles& files);

  /// The frame of an entry. `room_bytes`: what all pixels may take in the page.
  void take(std::size_t entry, const std::string& stem, bool is_last, std::size_t room_bytes);
  /// Whether the page has the pixels of the last entry taken, and the tiles that changed since the last one that it
  /// has, as runs: [first, count, ...].
  [[nodiscard]] bool has_last() const { return has_last_; }
  [[nodiscard]] const std::vector<std::size_t>& last_tiles() const { return last_tiles_; }
  /// The entry that each tile of the last frame that the page has is from, as runs: [count, entry, ...].
  [[nodiscard]] std::vector<std::size_t> sources() const;
  /// A small PNG file of the last entry taken.
  [[nodiscard]] Bytes thumbnail() { return run_.thumbnail(); }

  /// From the page to files beside it.
  void move_out();
  [[nodiscard]] std::size_t bytes_in_page() const { return is_beside_ ? bundles_.first_entries().size() * 7 : bytes_; }
  /// After the last entry: width, height, channels, and the first entry of each file beside the page, or null.
  [[nodiscard]] Json finish();
  /// JSON: a list of the frames, or null when they are beside the page.
  [[nodiscard]] std::string in_page() const;
  [[nodiscard]] bool is_beside() const { return is_beside_; }
  /// What all files of frames/ have together.
  [[nodiscard]] std::uint64_t frames_bytes() const { return frames_bytes_; }

 private:
  [[nodiscard]] bool fits_beside(std::size_t bytes, bool is_last) const;
  void keep(std::size_t entry, bool is_last, std::size_t room_bytes);
  [[nodiscard]] std::string record_start(std::size_t entry) const;

  std::filesystem::path folder_;
  RunPixels run_;
  std::string stem_;                                          // of the frame that run_ has
  std::uint64_t frames_bytes_ = 0;                            // of the whole run
  std::uint64_t read_bytes_ = 0;                              // of the frames read so far
  std::uint64_t bytes_ = 0;                                   // of the pixels kept so far, as text
  std::vector<std::pair<std::size_t, std::string>> records_;  // in the page, with their entries
  bool is_beside_ = false;
  PixelBundles bundles_;
  std::vector<std::size_t> sources_;  // by tile
  bool has_last_ = false;
  std::vector<std::size_t> last_tiles_;
};

}  // namespace relook
