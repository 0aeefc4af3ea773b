// The kept corpus of the fuzz targets (tests/fuzz, tests/fuzz.sh), in the ordinary build: every file of it, its
// first half and no bytes at all have an answer. A target that finds none ends the process.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/import_memory.h"
#include "base/parallel.h"
#include "fuzz_targets.h"

namespace relook {

void PrintTo(const FuzzTarget& target, std::ostream* out) { *out << target.name; }

namespace {

namespace fs = std::filesystem;

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {
 protected:
  ~FuzzCorpus() override {
    set_import_memory(kImportMemory);
    set_thread_count(0);
  }
  static void run(BytesView bytes) {
    EXPECT_EQ(GetParam().run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
  }
};

TEST_P(FuzzCorpus, has_an_answer_each) {
  const fs::path folder = fs::path(RELOOK_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_GE(files.size(), 10U) << folder << " has lost its files";
  run({});
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    const Bytes bytes = read_file(file);
    run(bytes);
    run(BytesView(bytes).first(bytes.size() / 2));
  }
}

std::string target_name(const testing::TestParamInfo<FuzzTarget>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(kFuzzTargets), target_name);

}  // namespace
}  // namespace relook
