// The header of an OpenEXR file, checked before the library sees it (image.cpp): OpenEXR 3.1 takes memory for the size
// that an attribute says, 2 GB for a file of some hundred bytes, and for a whole tile or block of rows as it opens the
// file.
#pragma once
#include <cstdint>
#include <string>

#include "base/files.h"

namespace relook {

struct ExrHeader {
  /// "" when every attribute, and every value in it that has a size of its own, lies within the file and takes the
  /// bytes that it says.
  std::string fault;
  /// What a decoder holds at once: the largest tile, or the rows that are packed together, unpacked.
  std::uint64_t block_bytes = 0;
};

/// Reads the headers of all parts. Requires: the file begins with OpenEXR's magic number.
[[nodiscard]] ExrHeader read_exr_header(BytesView exr);

}  // namespace relook
