#include "frame/deflate.h"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <memory>

#include "base/error.h"

namespace relook {

Deflater::Deflater() : memory_(ISAL_DEF_LVL1_DEFAULT) {}

Bytes Deflater::zlib(std::span<const unsigned char> data) { return run(data, true); }
Bytes Deflater::blocks(std::span<const unsigned char> data) { return run(data, false); }

Bytes Deflater::run(std::span<const unsigned char> data, bool is_zlib) {
  constexpr std::size_t kMostOverhead = 1024;  // beyond stored blocks
  packed_.resize(data.size() + data.size() / 64 + kMostOverhead);
  isal_zstream stream{};  // the size of the window, too: init leaves it as it is
  isal_deflate_init(&stream);
  stream.level = 1;
  stream.level_buf = memory_.data();
  stream.level_buf_size = static_cast<std::uint32_t>(memory_.size());
  stream.gzip_flag = is_zlib ? IGZIP_ZLIB : IGZIP_DEFLATE;
  stream.next_in = const_cast<std::uint8_t*>(data.data());  // only read
  stream.next_out = packed_.data();
  stream.avail_out = static_cast<std::uint32_t>(packed_.size());
  bool is_whole = true;
  const auto feed = [&](std::size_t size, bool is_last) {
    stream.avail_in = static_cast<std::uint32_t>(size);
    stream.flush = !is_last ? SYNC_FLUSH : is_zlib ? NO_FLUSH : FULL_FLUSH;
    stream.end_of_stream = is_last && is_zlib ? 1 : 0;
    is_whole = isal_deflate(&stream) == COMP_OK && stream.avail_in == 0 && is_whole;
  };
  // ISA-L 2.30 enters the third byte of its first long run into its table under a hash of the stream's address
  // (igzip_icf_body_h1_gr_bt.asm, .write_first_byte), so that bytes would follow from where the stack lies. Short runs
  // take another way; the first of four bytes makes it pass that place by.
  const std::size_t first = std::min<std::size_t>(data.size(), 4);
  feed(first, false);
  feed(data.size() - first, true);
  require(is_whole, "deflate into a buffer of its own bound succeeds");
  const BytesView packed = std::as_bytes(std::span(packed_)).first(packed_.size() - stream.avail_out);
  return {packed.begin(), packed.end()};
}

bool inflate_zlib(BytesView zlib, std::span<unsigned char> data) {
  const auto state = std::make_unique_for_overwrite<inflate_state>();
  isal_inflate_init(state.get());
  state->crc_flag = ISAL_ZLIB;
  state->next_in = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(zlib.data()));  // only read
  state->avail_in = static_cast<std::uint32_t>(zlib.size());
  state->next_out = data.data();
  state->avail_out = static_cast<std::uint32_t>(data.size());
  return isal_inflate_stateless(state.get()) == ISAL_DECOMP_OK && state->avail_out == 0;
}

}  // namespace relook
