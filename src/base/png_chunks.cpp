#include "base/png_chunks.h"

#include <zlib.h>

namespace relook {

void append_png_number(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}

void append_png_chunk(Bytes& out, std::string_view type, BytesView data) {
  append_png_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  const BytesView letters = bytes_of(type);
  out.insert(out.end(), letters.begin(), letters.end());
  out.insert(out.end(), data.begin(), data.end());
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(out.data() + start), static_cast<uInt>(out.size() - start));
  append_png_number(out, static_cast<std::uint32_t>(sum));
}

}  // namespace relook
