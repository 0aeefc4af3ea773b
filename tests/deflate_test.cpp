// Compressed bytes follow from the data alone.
#include "engine/deflate.h"

#include <gtest/gtest.h>

#include <array>

namespace relook {
namespace {

/// Leaves `value` all over the stack below the caller.
[[gnu::noinline]] void dirty_stack(std::uint16_t value) {
  std::array<volatile std::uint16_t, 256 << 10> garbage;
  for (volatile std::uint16_t& word : garbage) word = value;
}

std::vector<unsigned char> repeating(std::size_t size) {
  std::vector<unsigned char> data(size);
  for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<unsigned char>(i % 4099 * 7 >> (i % 5));
  return data;
}

TEST(Deflate, bytes_do_not_depend_on_what_was_in_memory) {
  const std::vector<unsigned char> data = repeating(32768), other(data.rbegin(), data.rend());
  const Bytes zlib = Deflater().zlib(data), blocks = Deflater().blocks(data);
  EXPECT_LT(zlib.size(), data.size() * 3 / 4);
  Deflater deflater;
  for (std::uint16_t value = 0; value < 20; ++value) {
    static_cast<void>(deflater.zlib(other));
    dirty_stack(value);
    EXPECT_EQ(deflater.zlib(data), zlib) << value;
    dirty_stack(value);
    EXPECT_EQ(deflater.blocks(data), blocks) << value;
  }
}

TEST(Deflate, comes_back_whole_or_not_at_all) {
  const std::vector<unsigned char> data = repeating(5000);
  Bytes zlib = Deflater().zlib(data);
  std::vector<unsigned char> back(data.size());
  ASSERT_TRUE(inflate_zlib(zlib, back));
  EXPECT_EQ(back, data);
  back.resize(data.size() - 1);
  EXPECT_FALSE(inflate_zlib(zlib, back));
  back.resize(data.size() + 1);
  EXPECT_FALSE(inflate_zlib(zlib, back));
  back.resize(data.size());
  zlib.pop_back();
  EXPECT_FALSE(inflate_zlib(zlib, back));
}

}  // namespace
}  // namespace relook
