// The pixels of a run's frames for its page: R, G, B and A of the tiles in which a frame differs from the last one that
// the page holds, compressed as in the files, and thumbnails made of them. Two frames are in memory at a time. Used by
// page_pixels.h.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "frame/frame_tiles.h"
#include "frame/preview.h"

namespace relook {

/// A frame's file with pixels at 1/scale (scaled_down() of frame/sheet/contact_sheet.h), its format kept, without
/// layers. Throws InputError.
[[nodiscard]] Bytes scaled_frame(Bytes file, std::string_view name, std::uint32_t scale);

/// Takes the frames of a run in their order.
class RunPixels {
 public:
  /// `exposure`: stops, of thumbnails.
  explicit RunPixels(double exposure) : gain_(gain_of(exposure)) {}

  /// Makes a file the current frame. Throws InputError when it is no frame, or not of the size and channels of those
  /// before.
  void load(Bytes file, std::string_view name);
  [[nodiscard]] const FrameTiles& current() const { return current_; }
  /// R, G, B and A, as far as the frames have them, in the order in which packed tiles have them.
  [[nodiscard]] const std::vector<FrameTiles::Channel>& channels() const { return channels_; }

  /// Tiles in which the current frame differs from the one that was kept last; all of them before any was.
  [[nodiscard]] const std::vector<std::size_t>& changed() const { return changed_; }
  [[nodiscard]] BytesView packed(std::size_t tile) const { return packed_[tile]; }
  /// Bytes of all packed tiles of the current frame.
  [[nodiscard]] std::size_t packed_bytes() const;
  /// From here on changed() compares with the current frame.
  void keep();

  /// The current frame, small, as a PNG file. Only tiles that differ from the last thumbnail are shrunk again.
  [[nodiscard]] Bytes thumbnail();

 private:
  [[nodiscard]] std::vector<Bytes> packed_colors() const;
  void shrink(std::size_t tile);

  float gain_;
  FrameTiles current_;
  std::vector<FrameTiles::Channel> channels_;
  std::vector<Bytes> packed_, kept_;  // by tile; kept_ is empty before the first keep()
  std::vector<std::size_t> changed_;
  Frame thumbnail_;
  std::vector<Bytes> shown_;  // packed tiles that the thumbnail shows
  std::uint32_t shrink_ = 1;  // pixels a side that make one of the thumbnail; a power of two, no larger than a tile
};

}  // namespace relook
