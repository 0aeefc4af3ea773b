// The pixels of a run's frames for its page: R, G, B and A of the tiles that a frame does not share with the one
// before, compressed as in the files, and thumbnails made of them.
#pragma once
#include <string_view>
#include <vector>

#include "engine/frame_tiles.h"

namespace relook {

/// The packed tiles of one frame that differ from those of the frame before.
struct FramePixels {
  std::vector<std::size_t> tiles, sizes;  // index, bytes
  Bytes bytes;                            // of all of them, one after the other
  Bytes thumbnail;                        // a PNG file
};

/// Takes the frames of a run in their order.
class RunPixels {
 public:
  /// Throws InputError when the file is no frame, or not of the size and channels of those before.
  [[nodiscard]] FramePixels take(Bytes file, std::string_view name);
  [[nodiscard]] const FrameTiles& last() const { return last_; }
  /// R, G, B and A, as far as the frames have them. In the order of the packed tiles.
  [[nodiscard]] const std::vector<FrameTiles::Channel>& channels() const { return channels_; }

 private:
  [[nodiscard]] std::vector<Bytes> packed_colors(const FrameTiles& frame) const;
  void shrink(const std::vector<std::size_t>& tiles);

  FrameTiles last_;
  std::vector<FrameTiles::Channel> channels_;
  std::vector<Bytes> packed_;  // of last_, by tile
  Frame thumbnail_;
  std::uint32_t shrink_ = 1;  // pixels a side that make one of the thumbnail; a power of two, no larger than a tile
};

}  // namespace relook
