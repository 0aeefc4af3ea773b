// Bytes of an image: its header is read and its pyramid made within the budget (--import-memory), or it is refused.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "libfuzzer_mutate.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

constexpr std::size_t kSignatureBytes = 8, kChunkBytes = 12;  // of a PNG: of a chunk without its data

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

/// Sets the check sums of all whole chunks.
void mend_png(std::uint8_t* data, std::size_t size) {
  for (std::size_t at = kSignatureBytes; at + kChunkBytes <= size;) {
    const std::size_t length = big_endian(data + at);
    if (length > size - at - kChunkBytes) return;
    const auto sum = static_cast<std::uint32_t>(crc32(0, data + at + 4, static_cast<unsigned>(length + 4)));
    for (std::size_t i = 0; i < 4; ++i) data[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += kChunkBytes + length;
  }
}

}  // namespace

int fuzz_image(const std::uint8_t* data, std::size_t size) {
  const BytesView bytes = fuzz_bytes(data, size);
  for (const bool is_color : {true, false}) {
    begin_fuzz_case();
    ImageHeader header;
    const bool has_header = is_answered({ExitCode::bad_input, ExitCode::out_of_resources},
                                        [&] { header = read_image_header(bytes, "image", "/images/0"); });
    is_answered({ExitCode::bad_input, ExitCode::out_of_resources}, [&] {
      const auto pyramid = decode_pyramid(bytes, is_color, "image", "/images/0");
      expect(has_header && pyramid->levels.front().width == header.width &&
                 pyramid->levels.front().height == header.height,
             "the image is not as its header says");
    });
  }
  return 0;
}

std::size_t mutate_image(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  size = libfuzzer_mutate(data, size, most);
  if (seed % 8 != 0 && size > kSignatureBytes && std::memcmp(data + 1, "PNG", 3) == 0) mend_png(data, size);
  return size;
}

}  // namespace relook
