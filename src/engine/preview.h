// Previews: 8-bit sRGB PNG files of a frame over black, for looking at, never for comparing. Deflated in bands of rows
// that are kept from step to step, so that a step pays for the bands that it changed.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/files.h"
#include "engine/changed_pixels.h"
#include "engine/image.h"

namespace relook {

/// NaN becomes black. The bytes depend on the frame alone.
class PreviewEncoder {
 public:
  PreviewEncoder(std::uint32_t width, std::uint32_t height);

  /// Deflates all bands.
  void update(const Frame& frame);
  /// Deflates the bands of the pixels that changed since the last update.
  void update(const Frame& frame, const ChangedPixels& changed_pixels);
  /// The bytes of the file.
  [[nodiscard]] Bytes png() const;

 private:
  struct Band {
    Bytes deflated;              // whole bytes, no reference to other bands
    std::uint32_t checksum = 1;  // Adler-32 of the filtered rows
  };
  void compress(const Frame& frame, std::span<const std::uint32_t> bands);
  [[nodiscard]] std::size_t band_bytes(std::size_t band) const;  // of its filtered rows

  std::uint32_t width_, height_;
  std::vector<Band> bands_;
};

[[nodiscard]] Bytes encode_png(const Frame& frame);

}  // namespace relook
