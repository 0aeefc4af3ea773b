// Compression of frames: the bytes follow from the data alone.
#include "frame/deflate.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

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

/// What `deflater` makes of the data with 64 KiB of stack for each unit of `depth` in between.
[[gnu::noinline]] Bytes zlib_below(Deflater& deflater, const std::vector<unsigned char>& data, int depth) {
  std::array<volatile unsigned char, 64 << 10> frame;
  frame[0] = static_cast<unsigned char>(depth);
  Bytes bytes = depth == 0 ? deflater.zlib(data) : zlib_below(deflater, data, depth - 1);
  frame[1] = frame[0];
  return bytes;
}

TEST(Deflate, bytes_do_not_depend_on_where_the_stack_lies) {
  std::mt19937 random(1);
  Deflater deflater;
  for (int i = 0; i < 500; ++i) {
    std::vector<unsigned char> data(100);
    for (std::size_t k = 0; k < data.size(); ++k)
      data[k] = k < 40 ? static_cast<unsigned char>(random()) : data[k - 40];
    const Bytes zlib = zlib_below(deflater, data, 0);
    for (int depth = 1; depth < 100; ++depth) ASSERT_EQ(zlib_below(deflater, data, depth), zlib) << i << ", " << depth;
  }
}

TEST(Deflate, every_size_comes_back) {
  Deflater deflater;
  for (std::size_t size = 0; size < 700; ++size) {
    const std::vector<unsigned char> data = repeating(size);
    std::vector<unsigned char> back(size);
    ASSERT_TRUE(inflate_zlib(deflater.zlib(data), back)) << size;
    ASSERT_EQ(back, data) << size;
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
