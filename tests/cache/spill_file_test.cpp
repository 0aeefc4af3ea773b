// The file that pieces are written to where memory is short.
#include <gtest/gtest.h>

#include "base/error.h"
#include "cache/residency/residency.h"

namespace relook {
namespace {

TEST(SpillFile, reuses_extents_and_keeps_within_its_limit) {
  SpillFile file(testing::TempDir(), 64 << 10);
  const Bytes piece(20000, std::byte{7});
  const auto first = file.write(piece), second = file.write(piece);
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(file.write(piece)) << "32 KiB each";
  EXPECT_EQ(file.read(*second), piece);
  file.free(*first);
  const auto third = file.write(Bytes(30000, std::byte{9}));
  ASSERT_TRUE(third);
  EXPECT_EQ(third->offset, first->offset);
  EXPECT_EQ(file.read(*second), piece);
  EXPECT_EQ(file.read(*third), Bytes(30000, std::byte{9}));
}

TEST(SpillFile, needs_a_folder_that_holds_files) {
  EXPECT_THROW(SpillFile(std::filesystem::path("/proc/no such folder"), 1 << 20), IoError);
}

}  // namespace
}  // namespace relook
