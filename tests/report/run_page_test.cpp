// The page of runs of any length: its size, its memory, what lies beside it, whose files it replaces, and that a long
// one opens quickly and shows the right pixels. Page.* (page_test.cpp) try pages of real replays.
#include "page/run_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "base/error.h"
#include "base/files.h"
#include "base/system/sanitizers.h"
#include "page/page_files.h"
#include "page/page_pixels.h"
#include "page_browser.h"
#include "synthetic_run.h"

namespace relook {
namespace {

/// A number in [0, 1) that follows from the three.
float noise(std::size_t a, std::uint32_t x, std::uint32_t y) {
  std::uint64_t bits = (a * 0x9E3779B97F4A7C15U) ^ (std::uint64_t{x} << 32) ^ y;
  bits = (bits ^ (bits >> 29)) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ (bits >> 32)) * 0x94D049BB133111EBU;
  return static_cast<float>(bits >> 41) / static_cast<float>(1 << 23);
}

Rgba all_changes(std::size_t i, std::uint32_t x, std::uint32_t y) {
  return {noise(3 * i, x, y), noise(3 * i + 1, x, y), noise(3 * i + 2, x, y), 1};
}

/// Of each frame one tile is another than before.
Rgba one_tile_changes(std::size_t i, std::uint32_t x, std::uint32_t y) {
  const std::size_t tile = x / 64, last = i < tile ? 0 : (i - tile) / 4 + 1;
  const float value = static_cast<float>(static_cast<int>(noise(last * 4 + tile, x / 2, y / 2) * 16)) / 16;
  return {value, value / 2, 1 - value, 1};
}

std::uint64_t page_bytes(const ScratchFolder& folder) { return std::filesystem::file_size(folder / "run/report.html"); }

std::string page_of(const ScratchFolder& folder) {
  const Bytes bytes = read_file(folder / "run/report.html");
  return std::string(text_of(bytes));
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

TEST(RunPage, a_page_of_8000_steps_is_small_and_opens_with_few_cards) {
  const ScratchFolder folder("page_8000");
  SyntheticRun run(folder / "run", 256, 16, one_tile_changes);
  for (std::size_t i = 0; i <= 8000; ++i) {
    run.add(i)["reasons"] = {"a reason " + std::string(300, 'r')};
    PatchOperation operation;
    operation.path = "/materials/Paint/pbrMetallicRoughness/metallicFactor";
    operation.value = static_cast<double>(i + 1) / 10000;
    run.journal.steps.emplace_back().edit = {operation};
  }
  run.write_report();
  run.write_page();
  EXPECT_LT(page_bytes(folder), 3'000'000U);
  EXPECT_LE(folder_bytes(folder / "run/pixels"), folder_bytes(folder / "run/frames") / 2);
  EXPECT_TRUE(std::filesystem::exists(folder / "run/pixels/steps_00031_1.js")) << "details are beside the page, too";
  Json expected = page_expectations(folder / "run", false);
  expected.update({{"rows", 8001}, {"mixes", false}, {"words", "material Paint: metallic becomes 0.8"}});
  expected["pixels"] = Json::array();
  for (const std::size_t entry : std::vector<std::size_t>{8000, 0, 1, 255, 256, 4099, 7999})
    expected["pixels"].push_back(run.expected_pixel(entry, 97 + entry % 64, 5));
  use_in_browser("long_page.py", folder / "run", expected, folder);
}

TEST(RunPage, pixels_beside_the_page_stay_below_half_of_the_frames_and_6_mb_and_those_there_are_right) {
  const ScratchFolder folder("page_half");
  SyntheticRun run(folder / "run", 200, 200, all_changes);
  for (std::size_t i = 0; i < 120; ++i) run.add(i);
  run.write_report();
  run.write_page();
  const std::uint64_t frames = folder_bytes(folder / "run/frames"), pixels = folder_bytes(folder / "run/pixels");
  EXPECT_GT(frames, 20'000'000U);
  EXPECT_LE(pixels, frames / 2 + kFreeBesideBytes);
  EXPECT_GT(pixels, frames / 4) << "most of what may be there is";
  Json expected = page_expectations(folder / "run", false);
  expected.update({{"rows", 120}, {"mixes", true}});
  expected["pixels"] = Json::array();
  for (std::size_t entry = 0; entry < 120; entry += 7) {
    expected["pixels"].push_back(run.expected_pixel(entry, 95, 103));
    expected["pixels"].back()["must_be_there"] = entry == 0 || entry == 119;
  }
  use_in_browser("long_page.py", folder / "run", expected, folder);
}

TEST(RunPage, a_short_run_is_one_file) {
  const ScratchFolder folder("page_short");
  SyntheticRun run(folder / "run", 200, 100, all_changes);
  for (std::size_t i = 0; i < 12; ++i) run.add(i);
  run.write_page();
  EXPECT_FALSE(std::filesystem::exists(folder / "run/pixels"));
  const std::string page = page_of(folder);
  EXPECT_EQ(page.find("strict-dynamic"), std::string::npos) << "loads nothing";
  EXPECT_NE(page.find("<meta charset=\"utf-8\">\n<meta name=\"generator\" content=\"relook\">"), std::string::npos);
}

TEST(RunPage, the_step_of_a_drag_shares_the_last_frame_and_labels_are_as_wide_as_file_names) {
  const ScratchFolder folder("page_drag");
  SyntheticRun run(folder / "run", 256, 64, one_tile_changes);
  run.add(0);
  run.add(1);
  run.journal.steps.resize(2);
  for (const char* within : {"_001", "_002", "_003"}) run.add(2, within);
  run.add_sharing(2);
  run.add(3)["resumed"] = true;
  run.entries[1]["pixels_changed"] = 5000;
  run.write_report();
  run.write_page();
  const Json expected = page_expectations(folder / "run", false);
  EXPECT_EQ(expected["labels"], Json({"0", "1", "2_001", "2_002", "2_003", "2", "3"}));
  use_in_browser("report_page.py", folder / "run", expected, folder);
}

TEST(RunPage, memory_does_not_follow_the_number_of_steps) {
  if (kIsInstrumented) GTEST_SKIP() << "sanitizers keep what is freed";
  const ScratchFolder folder("page_memory");
  SyntheticRun run(folder / "run", 64, 40, all_changes);
  for (std::size_t i = 0; i < 20; ++i) run.add(i);
  for (std::size_t i = 20; i < 8000; ++i) run.add_linked(i, i % 20);
  const auto peak_of_page = [&](std::size_t count) {
    std::ofstream("/proc/self/clear_refs") << "5";  // the peak is the present size
    run.write_page(count);
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6)) * 1024;
    return 0UL;
  };
  (void)peak_of_page(100);
  const std::size_t of_100 = peak_of_page(100), of_8000 = peak_of_page(8000);
  ASSERT_GT(of_100, 0U);
  EXPECT_LT(of_8000, of_100 + 12'000'000) << "not " << of_100;
}

TEST(RunPage, texts_of_any_length_do_not_make_it_large) {
  const ScratchFolder folder("page_texts");
  SyntheticRun run(folder / "run", 8, 8, all_changes);
  std::string text = "\xC3\xA4<&\x01";
  while (text.size() < 100'000) text += text;
  JournalStep step;
  PatchOperation operation;
  operation.path = "/materials/" + text;
  operation.value = Json{{"a", text}};
  step.edit.assign(200, operation);
  step.select.assign(300, text);
  run.journal.steps.assign(2, step);
  for (std::size_t i = 0; i < 3; ++i) {
    run.add(i)["name"] = text;
    run.entries.back()["reasons"] = Json(std::vector<std::string>(100, text));
  }
  run.head["cache_damage"] = Json(std::vector<std::string>(1000, text));
  run.head["camera"] = text;
  run.write_page();
  EXPECT_LT(page_bytes(folder), 1'000'000U);
}

TEST(RunPage, rows_that_do_not_fit_are_counted_in_the_page_and_stay_in_the_report) {
  const ScratchFolder folder("page_rows");
  SyntheticRun run(folder / "run", 8, 8, all_changes);
  const Json entry = run.add(0);
  run.entries.assign(60'000, entry);
  for (std::size_t i = 0; i < run.entries.size(); ++i) run.entries[i]["name"] = std::string(5000, '<');
  run.write_page(SIZE_MAX, false);
  EXPECT_LT(page_bytes(folder), kMostPageBytes);
  std::smatch rows;
  const std::string page = page_of(folder);
  ASSERT_TRUE(std::regex_search(page, rows, std::regex("\"entries\":60000.*\"rows\":([0-9]+)")));
  EXPECT_GT(std::stoul(rows[1]), 1000U);
  EXPECT_LT(std::stoul(rows[1]), 60'000U);
}

TEST(RunPage, a_quick_page_reads_no_frame) {
  const ScratchFolder folder("page_quick");
  SyntheticRun run(folder / "run", 200, 100, all_changes);
  for (std::size_t i = 0; i < 12; ++i) run.add(i);
  std::filesystem::remove_all(folder / "run/frames");
  run.write_page(SIZE_MAX, false);
  EXPECT_LT(page_bytes(folder), 500'000U);
  EXPECT_THROW(run.write_page(), InputError);
}

class LongRunPage : public testing::Test {
 protected:
  /// Of 40 steps, whose pixels do not fit into the page.
  void SetUp() override {
    for (std::size_t i = 0; i < 40; ++i) run_.add(i);
  }
  ScratchFolder folder_{"page_long"};
  SyntheticRun run_{folder_ / "run", 200, 200, all_changes};
};

TEST_F(LongRunPage, a_foreign_file_of_the_name_of_one_of_its_own_is_refused_before_anything_is_written) {
  for (const char* name : {"pixels/00012.js", "pixels/00012_1.js", "pixels/steps_00000_3.js", "pixels"}) {
    const std::filesystem::path foreign = folder_ / (std::string("run/") + name);
    write_text(foreign, "alert('mine')");
    const auto before = folder_hashes(folder_ / "run");
    try {
      run_.write_page();
      ADD_FAILURE() << name << " was not refused";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(foreign.string()), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder_hashes(folder_ / "run"), before);
    std::filesystem::remove_all(folder_ / "run/pixels");
  }
  std::filesystem::create_directories(folder_ / "run/pixels/00001_1.js");
  EXPECT_THROW(run_.write_page(), UsageError) << "a folder";
  std::filesystem::remove_all(folder_ / "run/pixels");
  write_text(folder_ / "precious.js", "relook_pixels(");
  std::filesystem::create_directories(folder_ / "run/pixels");
  std::filesystem::create_symlink(folder_ / "precious.js", folder_ / "run/pixels/00001_1.js");
  EXPECT_THROW(run_.write_page(), UsageError) << "a link";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "precious.js"));
}

TEST_F(LongRunPage, files_of_earlier_pages_go_and_nothing_else_does) {
  const std::filesystem::path pixels = folder_ / "run/pixels";
  const std::vector<std::string> ours{"00012.js", "00003_7.js", "steps_00000_7.js"};
  const std::vector<std::string> foreign{"notes.txt",      "1.js",     "00012.json",
                                         "steps_00000.js", "steps.js", "x00012_1.js"};
  for (const std::string& name : ours) write_text(pixels / name, "relook_pixels(1,[]);");
  for (const std::string& name : foreign) write_text(pixels / name, "relook_pixels(");
  for (int time = 0; time < 2; ++time) {
    run_.write_page();
    for (const std::string& name : ours) EXPECT_FALSE(std::filesystem::exists(pixels / name)) << name;
    for (const std::string& name : foreign) EXPECT_TRUE(std::filesystem::exists(pixels / name)) << name;
  }
  run_.write_page(2);
  for (const auto& file : std::filesystem::directory_iterator(pixels))
    EXPECT_FALSE(is_page_file_name(file.path().filename().string())) << file.path() << " of a page of 40 steps";
  for (const std::string& name : foreign) std::filesystem::remove(pixels / name);
  run_.write_page();
  run_.write_page(2);
  EXPECT_FALSE(std::filesystem::exists(pixels)) << "empty";
}

TEST_F(LongRunPage, is_as_before_when_it_is_not_finished) {
  run_.write_page();
  const auto before = folder_hashes(folder_ / "run");
  run_.entries[3]["name"] = "another";
  for (const int calls : {0, 5, 39, 40}) {
    int left = calls;
    EXPECT_THROW(run_.write_page(SIZE_MAX, true,
                                 [&] {
                                   if (left-- == 0) throw IoError("x", "stopped");
                                 }),
                 IoError);
    EXPECT_EQ(folder_hashes(folder_ / "run"), before) << "stopped after " << calls;
  }
  run_.write_page();
  EXPECT_NE(folder_hashes(folder_ / "run"), before);
}

TEST_F(LongRunPage, reads_no_file_that_a_report_names_outside_of_its_folders) {
  for (const char* name : {"../precious.exr", "/etc/passwd", "frames/../frames/0001.exr", "frames/0001.png", ""}) {
    run_.entries[1]["frame"] = name;
    EXPECT_THROW(run_.write_page(), InputError) << name;
  }
}

}  // namespace
}  // namespace relook
