// Chunks of PNG files (ISO/IEC 15948 section 5.3), appended to the bytes of a file that is being written.
#pragma once
#include <cstdint>
#include <string_view>

#include "base/files.h"

namespace relook {

inline constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

/// Appends four bytes, the highest first.
void append_png_number(Bytes& out, std::uint32_t value);
/// Appends length, type, data and checksum. `type`: four letters.
void append_png_chunk(Bytes& out, std::string_view type, BytesView data);

}  // namespace relook
