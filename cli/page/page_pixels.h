// Which frames of a run its page has the pixels of, and where: in the page while there is room, else in pixels/*.js
// beside it, several frames to a file. What lies beside the page takes no more than half of the bytes of the frames and
// 6 MB, spread over the run; a frame that does not fit is left out whole, so that each frame that is there is right bit
// by bit. Used by run_page.cpp.
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

/// What lies beside a page may take half of the bytes of the frames and these: pixels seven eighths, details one.
inline constexpr std::uint64_t kFreeBesideBytes = 6'000'000;

/// Files beside the page, each with the records of several entries.
class PixelBundles {
 public:
  /// `call`: kPixelsCall or kRelightCall.
  explicit PixelBundles(PageFiles& files, std::string_view call = kPixelsCall) : files_(&files), call_(call) {}
  using Append = std::function<void(std::string_view)>;
  /// Adds the record of an entry, which `write` appends piece by piece.
  void add(std::size_t entry, const std::function<void(const Append&)>& write);
  void end_file();
  [[nodiscard]] const std::vector<std::size_t>& first_entries() const { return first_entries_; }

 private:
  PageFiles* files_;
  std::string_view call_;
  std::unique_ptr<FileWriter> file_;  // not ended yet
  std::vector<std::size_t> first_entries_;
};

/// Tiles, increasing, as runs: [first, count, ...].
[[nodiscard]] std::vector<std::size_t> runs_of(const std::vector<std::size_t>& tiles);
/// A list of entries, one a tile, as runs: [count, entry, ...].
[[nodiscard]] std::vector<std::size_t> counted(const std::vector<std::size_t>& entries);
/// The base64 of packed tiles, one after the other, in pieces.
void append_base64(const std::vector<std::size_t>& tiles, const std::function<BytesView(std::size_t)>& packed_tile,
                   const PixelBundles::Append& append);

class PagePixels {
 public:
  /// `files` outlives this. `exposure`: stops, of thumbnails. Pixels are at 1/scale of the frames' size.
  PagePixels(const std::filesystem::path& run, double exposure, PageFiles& files, std::uint32_t scale = 1);

  /// Takes the frame of the next entry. `room_bytes`: what all pixels may take in the page.
  void take(std::size_t entry, const std::string& stem, bool is_last, std::size_t room_bytes);
  /// Whether the page has the pixels of the last entry taken.
  [[nodiscard]] bool has_last() const { return has_last_; }
  /// The tiles of the last entry taken that differ from the frame that the page had before it, as runs: [first, count,
  /// ...].
  [[nodiscard]] const std::vector<std::size_t>& last_tiles() const { return last_tiles_; }
  /// The entries that the tiles of the last frame in the page are from, as runs: [count, entry, ...].
  [[nodiscard]] std::vector<std::size_t> sources() const { return counted(sources_); }
  /// A small PNG file of the last entry taken.
  [[nodiscard]] Bytes thumbnail() { return run_.thumbnail(); }

  /// Moves all records, and those to come, from the page to files beside it.
  void move_out();
  [[nodiscard]] std::size_t bytes_in_page() const { return is_beside_ ? bundles_.first_entries().size() * 7 : bytes_; }
  /// After the last entry: width, height, channels, and `bundles`: the first entry of each file beside the page, or
  /// null.
  [[nodiscard]] Json finish();
  /// JSON: a list of the frames, or null when they are beside the page.
  [[nodiscard]] std::string in_page() const;
  [[nodiscard]] bool is_beside() const { return is_beside_; }
  /// Bytes of all files of frames/ together.
  [[nodiscard]] std::uint64_t frames_bytes() const { return frames_bytes_; }

 private:
  [[nodiscard]] bool fits_beside(std::size_t bytes, bool is_last) const;
  void keep(std::size_t entry, bool is_last, std::size_t room_bytes);
  [[nodiscard]] std::string record_start(std::size_t entry) const;

  std::filesystem::path folder_;
  RunPixels run_;
  std::uint32_t scale_;
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
