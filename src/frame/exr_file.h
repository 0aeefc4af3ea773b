// A flat OpenEXR file as it is stored: every part, every level of its resolution, every channel, in the file's own
// numbers (half, float or uint). Rows are decoded from top to bottom in bands of bounded size. Deep parts and
// subsampled channels are refused. Headers are checked before memory is allocated, and everything that OpenEXR throws
// becomes one InputError.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/files.h"

namespace relook {

/// Do images of so many pixels get read? 65536 a side, 2^28 in all.
[[nodiscard]] constexpr bool is_read_size(std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kLargestSide = 65536, kMostPixels = std::int64_t{1} << 28;
  return width >= 1 && height >= 1 && width <= kLargestSide && height <= kLargestSide && width * height <= kMostPixels;
}

enum class SampleKind : std::uint8_t { half, float32, uint32 };
[[nodiscard]] constexpr std::size_t sample_bytes(SampleKind kind) { return kind == SampleKind::half ? 2 : 4; }

/// Pixels [x0, x1) x [y0, y1).
struct PixelWindow {
  std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] std::int64_t width() const { return x1 - x0; }
  [[nodiscard]] std::int64_t height() const { return y1 - y0; }
};

struct StoredChannel {
  std::string name;
  SampleKind kind = SampleKind::half;
};

/// A part at one level of its resolution.
struct ExrImage {
  std::string part;  // its name; "" when it has none
  std::size_t part_index = 0;
  int level_x = 0, level_y = 0;         // 0: full size
  PixelWindow window;                   // counted from the upper left corner of the display window
  std::vector<StoredChannel> channels;  // in the order of their names' bytes
  [[nodiscard]] std::size_t pixel_bytes() const;
};

class ExrFile {
 public:
  /// `name` is for messages. Throws InputError.
  ExrFile(Bytes bytes, std::string name);
  ~ExrFile();
  ExrFile(const ExrFile&) = delete;
  ExrFile& operator=(const ExrFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const PixelWindow& display() const { return display_; }
  [[nodiscard]] std::size_t part_count() const;
  /// Part by part; in a part by levels, full size first.
  [[nodiscard]] const std::vector<ExrImage>& images() const { return images_; }
  /// The names of all parts' Cryptomattes, from their headers ("CryptoObject").
  [[nodiscard]] const std::vector<std::string>& cryptomattes() const { return cryptomattes_; }

 private:
  friend class ImageRows;
  struct Input;

  void read_part(int part);

  Bytes bytes_;
  std::string name_;
  PixelWindow display_;
  std::vector<ExrImage> images_;
  std::vector<std::string> cryptomattes_;
  std::unique_ptr<Input> input_;
};

/// The rows of one image. One at a time for a file: they share its place.
class ImageRows {
 public:
  /// Requires: a file that outlives this, and one of its images.
  ImageRows(const ExrFile& file, const ExrImage& image);

  [[nodiscard]] const ExrImage& image() const { return image_; }
  [[nodiscard]] bool holds(std::int64_t y) const { return y >= band_.y0 && y < band_.y1; }
  /// Decodes a band of rows with row `y` in it. Requires: a row of the image's window. Throws InputError.
  void load(std::int64_t y);
  /// A channel's samples of a row, [image().window.width()]. Requires: holds(y).
  [[nodiscard]] const std::byte* row(std::size_t channel, std::int64_t y) const;

 private:
  [[nodiscard]] PixelWindow band_around(std::int64_t y) const;

  const ExrFile& file_;
  const ExrImage& image_;
  std::int64_t band_rows_;
  PixelWindow band_;
  Bytes samples_;                     // channel by channel, [height of band_ * width]
  std::vector<std::size_t> offsets_;  // by channel: bytes of a pixel in the channels before it
};

}  // namespace relook
