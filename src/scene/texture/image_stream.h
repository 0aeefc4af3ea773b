// The framing of encoded images, checked before a decoder sees them, and reduced to what makes pixels: decoders unpack
// colour profiles, Exif, IPTC and texts that nobody reads (a bad IPTC block crashes OpenImageIO 2.4), print to stderr
// about damaged PNG files, and fill the missing end of a JPEG with grey. Bytes in, bytes out. Called by image.cpp; the
// importer and the compiler ask for formats that are refused.
#pragma once
#include <cstdint>
#include <string>

#include "base/files.h"

namespace relook {

/// The reduced image, or what is wrong with it.
struct ImageStream {
  Bytes bytes;
  std::string fault;
  /// What a decoder holds of the image at once: all values of an interlaced PNG, all coefficients of a JPEG in more
  /// than one scan, else 0.
  std::uint64_t held_bytes = 0;
};

/// The PNG with its chunks IHDR, PLTE, tRNS, IDAT and IEND alone. Every chunk must be whole and have the right CRC.
[[nodiscard]] ImageStream png_pixels(BytesView png);

/// The JPEG without application segments (but JFIF's and Adobe's, which say how colours are coded) and comments. Every
/// segment must be whole, and an EOI marker must end the image; more than 100 scans are too many.
[[nodiscard]] ImageStream jpeg_pixels(BytesView jpeg);

[[nodiscard]] bool is_webp(BytesView bytes);
[[nodiscard]] bool is_animated_webp(BytesView bytes);
[[nodiscard]] bool is_ktx2(BytesView bytes);

}  // namespace relook
