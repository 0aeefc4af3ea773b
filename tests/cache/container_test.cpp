// Files of a cache whose hashes are right and whose tables lie: sizes are not believed before they are checked.
#include "cache/container.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"

namespace relook {
namespace {

const CacheIdentity kIdentity{std::string(32, 'a'), std::string(32, 'b')};
constexpr std::size_t kTable = 80, kEntry = 64, kRawBytes = 32;

template <class T>
void put(Bytes& file, std::size_t offset, T value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
}
/// The hash of header and table, made right.
void sign(Bytes& file, std::size_t sections) {
  const std::size_t end = kTable + sections * kEntry;
  put(file, end, hash64(BytesView(file).first(end)));
}

Bytes file_of(const std::vector<float>& values) {
  ContainerWriter writer;
  writer.add_column("values", values, sizeof(float));
  return writer.finish(kIdentity);
}

TEST(Container, sizes_that_a_sections_bytes_cannot_have_are_damage) {
  const std::vector<float> values(10'000, 1.0F);
  for (const std::uint64_t claimed :
       {std::uint64_t{1} << 63, std::uint64_t{1} << 50, std::uint64_t{1} << 32, std::uint64_t{40'004},
        std::uint64_t{39'996}, std::uint64_t{0}, ~std::uint64_t{3}}) {
    Bytes file = file_of(values);
    put(file, kTable + kRawBytes, claimed);
    sign(file, 1);
    EXPECT_THROW(ContainerReader(file, kIdentity), CacheDamage) << claimed;
  }
  Bytes file = file_of(values);
  sign(file, 1);
  EXPECT_EQ(ContainerReader(file, kIdentity).column<float>("values", values.size()), values);
}

TEST(Container, sizes_that_a_frame_repeats_are_no_better) {
  // A zstd frame without blocks but for one, that claims 2^50 bytes: magic, 8 bytes of content size, a last raw block.
  constexpr std::uint64_t kClaimed = std::uint64_t{1} << 50;
  Bytes frame(4 + 1 + 8 + 3, std::byte{0});
  put(frame, 0, std::uint32_t{0xFD2FB528});
  frame[4] = std::byte{0xE0};  // content size of 8 bytes, one segment
  put(frame, 5, kClaimed);
  frame[13] = std::byte{1};  // last block
  Bytes file = file_of({1, 2, 3});
  const std::size_t start = kTable + kEntry + 8;
  file.resize(start);
  file.insert(file.end(), frame.begin(), frame.end());
  put(file, kTable + 24, std::uint32_t{1});  // zstd
  put(file, kTable + kRawBytes, kClaimed);
  put(file, kTable + 40, std::uint64_t{frame.size()});
  put(file, kTable + 56, hash64(frame));
  sign(file, 1);
  EXPECT_THROW(ContainerReader(file, kIdentity), CacheDamage);
}

TEST(Container, long_runs_of_one_value_are_read_back) {
  const std::vector<float> zeros(5'000'000, 0.0F);
  const Bytes file = file_of(zeros);
  EXPECT_LT(file.size(), 10'000U);
  EXPECT_EQ(ContainerReader(file, kIdentity).column<float>("values", zeros.size()), zeros);
}

TEST(Container, as_many_sections_as_a_scene_has_images) {
  ContainerWriter writer;
  constexpr std::size_t kImages = 5000;
  for (std::size_t i = 0; i < kImages; ++i) writer.add("image" + std::to_string(i), bytes_of(std::to_string(i)));
  const Bytes file = writer.finish(kIdentity);
  const ContainerReader reader(file, kIdentity);
  EXPECT_EQ(reader.text("image0"), "0");
  EXPECT_EQ(reader.text("image4999"), "4999");
}

TEST(Container, more_sections_than_the_file_has_room_for_are_a_cut_file) {
  Bytes file = file_of({1, 2, 3});
  put(file, 12, std::uint32_t{0xFFFFFFFF});
  EXPECT_THROW(ContainerReader(file, kIdentity), CacheDamage);
}

}  // namespace
}  // namespace relook
