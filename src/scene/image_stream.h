// The framing of encoded images, checked before a decoder sees them, and reduced to what makes pixels: decoders unpack
// colour profiles, Exif, IPTC and texts that nobody reads (a bad IPTC block crashes OpenImageIO 2.4), print to stderr
// about damaged PNG files, and fill the missing end of a JPEG with grey.
#pragma once
#include <string>

#include "base/files.h"

namespace relook {

/// The reduced image, or what is wrong with it.
struct ImageStream {
  Bytes bytes;
  std::string fault;
};

/// Keeps IHDR, PLTE, tRNS, IDAT and IEND. Every chunk must be whole and have the right CRC.
[[nodiscard]] ImageStream png_pixels(BytesView png);

/// Drops application segments (but JFIF's and Adobe's, which say how colours are coded) and comments. Every segment
/// must be whole, and an EOI marker must end the image.
[[nodiscard]] ImageStream jpeg_pixels(BytesView jpeg);

}  // namespace relook
