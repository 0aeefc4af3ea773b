// The tiles of a frame file as they are stored: for looking at a run's frames without decoding what did not change.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "frame/frame_file.h"

namespace relook {

/// A tiled, ZIP-compressed OpenEXR file of one part and one level in memory, its tiles still compressed.
class FrameTiles {
 public:
  struct Channel {
    std::string name;
    std::uint32_t bytes = 0;  // of a value; 2: half, 4: float32
  };

  FrameTiles() = default;
  /// Throws InputError{file, ...} when it is anything else, or damaged.
  FrameTiles(Bytes bytes, std::string_view file);

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }
  /// The header's attributes that are texts.
  [[nodiscard]] const ExrAttributes& texts() const { return texts_; }
  /// In the order of the file, which is alphabetical.
  [[nodiscard]] const std::vector<Channel>& channels() const { return channels_; }
  [[nodiscard]] std::size_t count() const { return chunks_.size(); }
  /// A tile's chunk: OpenEXR's ZIP (bytes split by significance, differences, zlib), or raw when it has the raw size.
  [[nodiscard]] BytesView packed(std::size_t tile) const;
  /// Row by row, channel by channel. Throws InputError when the chunk is damaged.
  [[nodiscard]] std::vector<unsigned char> unpacked(std::size_t tile) const;
  /// The linear pixels of a tile, [rows * columns]; missing channels are 0, A is 1.
  [[nodiscard]] std::vector<Rgba> pixels(std::size_t tile) const;

 private:
  struct Chunk {
    std::size_t offset = 0, size = 0;
  };
  std::string file_;
  Bytes bytes_;
  std::uint32_t width_ = 0, height_ = 0;
  std::size_t pixel_bytes_ = 0;
  std::vector<Channel> channels_;
  ExrAttributes texts_;
  std::vector<Chunk> chunks_;  // [tile_count]
};

}  // namespace relook
