// Tunnels in a cache (paper 3.4, 4.1, 4.3): they are those that a replay would build, are read when a step needs them
// and not before, and whatever is wrong with them costs time, never a pixel.
#include "cache/stored_tunnels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <tuple>

#include "base/hash.h"
#include "cache/manifest.h"
#include "cache/tunnel_parts.h"
#include "edit/apply.h"
#include "image/cached_tunnels.h"
#include "image/path_classes.h"
#include "region/cell_tunnels.h"
#include "region_checks.h"
#include "run_program.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

Edit edit_of_text(const std::string& text) { return parsed_edit(text); }

const char* const kColor = R"([{"op": "replace", "path": "/materials/Matte/pbrMetallicRoughness/baseColorFactor",
                                "value": [0.2, 0.7, 0.3, 1]}])";
const char* const kOptics = R"([{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior",
                                 "value": 1.8}])";
const char* const kMove = R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.4, 0.9, 0.3]}])";
const char* const kMoveOther =
    R"([{"op": "replace", "path": "/nodes/MirrorBall/translation", "value": [-1.2, 1.1, 0.2]}])";
const char* const kMoveLight = R"([{"op": "replace", "path": "/nodes/Lamp/translation", "value": [1.5, 4.2, 2.5]}])";

std::vector<RegionOptions> shapes() {
  return {{},
          {.tunnels = 2},
          {.tunnels = 3, .atoms = 1},
          {.tunnels = 2, .tunnel_levels = 0},
          {.tunnel_levels = 1},
          {.tunnel_levels = 4},
          {.tunnel_levels = 6},
          {.tunnels = 2, .most_tunnels = 900},
          {.most_tunnels = 300},
          {.most_tunnels = 8}};
}

std::string text_of_shape(const RegionOptions& shape) {
  return std::to_string(shape.tunnels) + " a region, levels " + std::to_string(shape.tunnel_levels) + ", most " +
         std::to_string(shape.most_tunnels.value_or(0)) + ", atoms " + std::to_string(shape.atoms);
}

std::vector<std::filesystem::path> tunnel_files(const std::filesystem::path& cache) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(cache / "tunnels")) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void flip_byte(const std::filesystem::path& file, std::size_t at) {
  Bytes bytes = read_file(file);
  bytes[at] ^= std::byte{1};
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// The frame is a full render of the scene as it is now.
void expect_full_render(const Replayer& replayer, const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).size(), 0U)
      << what;
}

class StoredTunnelsTest : public testing::Test {
 protected:
  void write(const SceneState& state, const ViewOptions& view, const RegionOptions& shape) {
    std::filesystem::remove_all(cache_);
    write_cache(cache_, content_with_tunnels(state, view, shape));
  }
  /// `expects_faults`: the number of files that cannot be used.
  void expect_exact(const RegionOptions& shape, std::size_t expects_faults, const std::string& what) const {
    OpenedCache opened = opened_cache(cache_);
    const std::shared_ptr<StoredTunnels> tunnels = opened.tunnels;
    Replayer replayer(std::move(*opened.state), std::move(opened.image), shape, nullptr, opened.tunnels);
    for (const char* edit : {kColor, kOptics, kMove, kMoveOther, kColor, kMoveLight, kMove}) {
      replayer.step(edit_of_text(edit), "stored", ".");
      expect_full_render(replayer, what + edit);
      EXPECT_EQ(stale_tiles(replayer), 0U) << what << edit;
    }
    EXPECT_EQ(tunnels ? tunnels->take_faults().size() : 0, expects_faults) << what;
  }

  [[nodiscard]] std::shared_ptr<const Manifest> manifest() const {
    return std::make_shared<const Manifest>(load_manifest(cache_));
  }

  ScratchFolder folder_{"stored_tunnels"};
  std::filesystem::path cache_ = folder_ / "c";
};

/// Every scene with one and with several samples.
class StoredTunnelsOfScene : public StoredTunnelsTest,
                             public testing::WithParamInterface<std::tuple<TestScene, std::uint32_t>> {};

TEST_P(StoredTunnelsOfScene, EqualThoseThatAreBuiltValueByValue) {
  const auto [scene, samples] = GetParam();
  for (const RegionOptions& shape : shapes()) {
    SCOPED_TRACE(text_of_shape(shape));
    const SceneState state = test_scene(scene, 150, 70);
    const ViewOptions view{samples, 5, 1};
    write(state, view, shape);
    const Replayer replayer(compiled_again(state), preprocessed(state.scene(), view), shape);
    const auto tunnels = StoredTunnels::of_cache(cache_, manifest(), replayer.image().paths);
    EXPECT_EQ(tunnels != nullptr, replayer.regions().may_have_tunnels(replayer.image()));
    if (!tunnels) continue;
    const ImageRegions built = fresh_regions(replayer);
    StoredTunnels& stored = *tunnels;
    for (std::size_t tile = 0; tile < replayer.image().trees.size(); ++tile) {
      EXPECT_TRUE(stored.around(tile) == built.around(tile)) << tile;
      EXPECT_TRUE(stored.read(tile) == built.tunnels(tile)) << tile;
    }
    EXPECT_TRUE(stored.take_faults().empty());
    EXPECT_TRUE(check_cache(cache_).findings.empty());
  }
}

std::string scene_name(const testing::TestParamInfo<std::tuple<TestScene, std::uint32_t>>& info) {
  return std::string(test_scene_name(std::get<0>(info.param))) + "_" + std::to_string(std::get<1>(info.param)) +
         "_samples";
}

INSTANTIATE_TEST_SUITE_P(Scenes, StoredTunnelsOfScene,
                         testing::Combine(testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                                          testing::Values(1U, 4U)),
                         scene_name);

/// Each of shapes(), by number.
class StoredTunnelsOfShape : public StoredTunnelsTest, public testing::WithParamInterface<std::size_t> {};

TEST_P(StoredTunnelsOfShape, GiveTheFramesOfAFullRenderAndTheCountersOfBuiltOnes) {
  const RegionOptions shape = shapes().at(GetParam());
  SCOPED_TRACE(text_of_shape(shape));
  const SceneState state = test_scene(TestScene::study, 90, 70);
  write(state, {1, 5, 1}, shape);
  expect_exact(shape, 0, text_of_shape(shape));
  OpenedCache opened = opened_cache(cache_);
  Replayer reads(std::move(*opened.state), std::move(opened.image), shape, nullptr, opened.tunnels);
  Replayer builds(compiled_again(state), preprocessed(state.scene(), {1, 5, 1}), shape);
  for (const char* edit : {kOptics, kMove, kMoveOther}) {
    const StepResult a = reads.step(edit_of_text(edit), "a", "."), b = builds.step(edit_of_text(edit), "b", ".");
    EXPECT_EQ(a.counters.ray_tests, b.counters.ray_tests);
    EXPECT_EQ(a.counters.samples_affected, b.counters.samples_affected);
    EXPECT_EQ(a.counters.by_tunnels.visited, b.counters.by_tunnels.visited);
    EXPECT_EQ(b.counters.tunnels_read, 0U);
    EXPECT_EQ(a.counters.rebuilt.tunnels + b.counters.rebuilt.tunnels, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, StoredTunnelsOfShape, testing::Range(std::size_t{0}, shapes().size()));

TEST_F(StoredTunnelsTest, AreNotReadBeforeAStepNeedsThem) {
  write(test_scene(TestScene::study, 150, 70), {1, 5}, {});
  OpenedCache opened = opened_cache(cache_);
  const std::shared_ptr<StoredTunnels> tunnels = opened.tunnels;
  Replayer replayer(std::move(*opened.state), std::move(opened.image), {}, nullptr, tunnels);
  const std::vector<std::filesystem::path> files = tunnel_files(cache_);
  for (const auto& file : files) std::filesystem::rename(file, file.string() + ".aside");
  replayer.step(edit_of_text(kColor), "color", ".");
  replayer.step(edit_of_text(kOptics), "optics", ".");
  EXPECT_TRUE(tunnels->take_faults().empty());
  for (const auto& file : files) std::filesystem::rename(file.string() + ".aside", file);
  const StepResult step = replayer.step(edit_of_text(kMove), "move", ".");
  EXPECT_TRUE(tunnels->take_faults().empty());
  EXPECT_GT(step.counters.tunnels_read, 0U);
  EXPECT_LE(step.counters.tunnels_read, replayer.image().trees.size());
}

TEST_F(StoredTunnelsTest, OfTilesThatAChangeIsFarFromAreNeverRead) {
  write(test_scene(TestScene::spheres, 300, 200), {1, 5}, {});
  OpenedCache opened = opened_cache(cache_);
  Replayer replayer(std::move(*opened.state), std::move(opened.image), {}, nullptr, opened.tunnels);
  const StepResult step = replayer.step(
      edit_of_text(R"([{"op": "replace", "path": "/nodes/Ball/scale", "value": [0.1, 0.1, 0.1]}])"), "small", ".");
  EXPECT_GT(step.counters.tunnels_read, 0U);
  EXPECT_LT(step.counters.tunnels_read, replayer.image().trees.size());
}

TEST_F(StoredTunnelsTest, ThatAreMissingOrDamagedCostNoPixel) {
  const SceneState state = test_scene(TestScene::study, 90, 70);
  write(state, {1, 5}, {});
  const std::filesystem::path file = tunnel_files(cache_).front();
  const Bytes sound = read_file(file);
  for (const std::size_t at : {std::size_t{3}, std::size_t{90}, sound.size() / 2, sound.size() - 1}) {
    flip_byte(file, at);
    expect_exact({}, 1, "byte " + std::to_string(at));
    EXPECT_FALSE(check_cache(cache_).findings.empty());
    flip_byte(file, at);
  }
  std::filesystem::resize_file(file, sound.size() / 2);
  expect_exact({}, 1, "cut short");
  std::filesystem::remove(file);
  expect_exact({}, 1, "missing");
}

TEST_F(StoredTunnelsTest, OfOtherRayTreesAreRefused) {
  const SceneState state = test_scene(TestScene::study, 90, 70);
  write(state, {1, 5}, {});
  const std::filesystem::path file = tunnel_files(cache_).front();
  const CacheContent content = content_with_tunnels(state, {1, 5}, {});
  const Manifest manifest = load_manifest(cache_);
  Bytes foreign;
  for (int other = 0; other < 1000 && foreign.size() != std::filesystem::file_size(file); ++other)
    foreign = encode_tunnels(content, 0, manifest.identity,
                             hash128(bytes_of("trees" + std::to_string(other))) + hash128(bytes_of("other paths")));
  ASSERT_EQ(foreign.size(), std::filesystem::file_size(file)) << "told apart by nothing but what they are bound to";
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(foreign.data()), static_cast<std::streamsize>(foreign.size()));
  expect_exact({}, 1, "foreign");
}

TEST_F(StoredTunnelsTest, ThatAreWrongAndHaveTheirHashesAreFoundByCheck) {
  const SceneState state = test_scene(TestScene::study, 90, 70);
  CacheContent content = content_with_tunnels(state, {1, 5}, {});
  write_cache(cache_, content);
  const OpenedCache sound = opened_cache(cache_);
  EXPECT_EQ(count_wrong_tunnels(*sound.state, sound.image, *sound.tunnels), 0U);
  const TileGrid grid = content.tunnels[1].grid();
  TileTunnels::Cells cells = content.tunnels[1].cells();
  for (TunnelSection& section : cells.sections)
    if (!section.points.isEmpty()) section.points = Box(section.points.min, section.points.min);
  content.tunnels[1] = TileTunnels::united(grid, cells, 1);
  content.around_tiles[1] = around(content.tunnels[1]);
  write_cache(cache_, content);
  EXPECT_TRUE(check_cache(cache_).findings.empty()) << "every hash and invariant holds";
  const OpenedCache wrong = opened_cache(cache_);
  EXPECT_EQ(count_wrong_tunnels(*wrong.state, wrong.image, *wrong.tunnels), 1U);
  const ProgramResult checked = run_program({RELOOK_PROGRAM, "check", cache_.string()});
  EXPECT_EQ(checked.exit_code, 5) << checked.output;
  EXPECT_NE(checked.output.find("tunnels of 1 tile"), std::string::npos) << checked.output;
}

/// Between the reading of the trees and the first use of tunnels another cache may take the place of the first.
TEST_F(StoredTunnelsTest, OfACacheThatHasTakenThePlaceOfTheOneReadAreNotUsed) {
  const SceneState state = test_scene(TestScene::study, 90, 70);
  write(state, {1, 5}, {});
  CacheContent content;
  ASSERT_EQ(read_cache(cache_, content).fault, CacheFault::none);
  SceneState other = test_scene(TestScene::study, 90, 70);
  apply_edit(other, edit_of_text(kMove), "moved", ".");
  write(other, {1, 5}, {});
  const auto tunnels = StoredTunnels::of_cache(cache_, content.manifest, content.image.paths);
  for (std::size_t tile = 0; tile < content.image.trees.size(); ++tile) {
    EXPECT_FALSE(tunnels->around(tile).has_value());
    EXPECT_FALSE(tunnels->read(tile).has_value());
  }
  EXPECT_EQ(tunnels->take_faults().size(), 1U);
}

TEST_F(StoredTunnelsTest, OfMoreSectionsThanTheTreesCanHaveAreRefusedBeforeTheyAreRead) {
  const SceneState state = test_scene(TestScene::study, 90, 70);
  CacheContent content = content_with_tunnels(state, {1, 5}, {});
  TunnelSection section = content.around_tiles[0].front();
  for (std::uint32_t number = 1U << 20; number < (1U << 20) + 2000000; ++number) {
    section.history = History::of_number(number);
    content.around_tiles[0].push_back(section);
  }
  write_cache(cache_, content);
  OpenedCache opened = opened_cache(cache_);
  EXPECT_FALSE(opened.tunnels->around(0).has_value());
  const std::vector<CacheAnswer> faults = opened.tunnels->take_faults();
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].detail, "more sections than the ray trees can have");
}

TEST_F(StoredTunnelsTest, CountAsRebuiltOnlyWhereTheyHadBeen) {
  const auto counters_of = [&](const std::vector<const char*>& edits, const RegionOptions& shape) {
    OpenedCache opened = opened_cache(cache_);
    Replayer replayer(std::move(*opened.state), std::move(opened.image), shape, nullptr, opened.tunnels);
    Counters sum;
    for (const char* edit : edits) sum += replayer.step(edit_of_text(edit), "counted", ".").counters;
    return sum;
  };
  const SceneState state = test_scene(TestScene::study, 256, 256);  // 16 tiles, 5 regions above
  const RegionOptions outlines{.tunnels = 2, .most_tunnels = 21};   // of each tile just the one around all of it
  write(state, {1, 5}, outlines);
  Counters counters = counters_of({kMove}, outlines);
  EXPECT_GT(counters.tunnels_read, 0U);
  EXPECT_EQ(counters.rebuilt.tunnels, 0U);

  CacheContent content = content_with_tunnels(state, {1, 5}, {});
  for (TileTunnels& tunnels : content.tunnels) tunnels = TileTunnels();  // left out
  write_cache(cache_, content);
  counters = counters_of({kMove, kMoveOther}, {});
  EXPECT_EQ(counters.tunnels_read, 0U);
  EXPECT_EQ(counters.rebuilt.tunnels, 0U);

  write(state, {1, 5}, {});
  const std::filesystem::path file = tunnel_files(cache_).front();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);  // of the last section alone
  const std::uint64_t moved = counters_of({kMove, kMoveOther}, {}).rebuilt.tunnels;
  EXPECT_EQ(counters_of({kOptics, kMove, kMoveOther}, {}).rebuilt.tunnels, moved) << "whatever comes first";
}

TEST_F(StoredTunnelsTest, OfAnotherShapeAreNotUsed) {
  write(test_scene(TestScene::study, 90, 70), {1, 5}, {.tunnels = 2});
  OpenedCache opened = opened_cache(cache_);
  Replayer replayer(std::move(*opened.state), std::move(opened.image), {}, nullptr, opened.tunnels);
  const StepResult step = replayer.step(edit_of_text(kMove), "move", ".");
  EXPECT_EQ(step.counters.tunnels_read, 0U);
  expect_full_render(replayer, "another shape");
  EXPECT_EQ(stale_tiles(replayer), 0U);
}

TEST_F(StoredTunnelsTest, AreLeftOutWhereADiskIsSmallAndThenBuilt) {
  const SceneState state = test_scene(TestScene::study, 400, 300);
  CacheContent whole = content_with_tunnels(state, {4, 5}, {});
  write_cache(cache_, whole);
  std::uint64_t bytes = 0;
  for (const CacheFile& file : load_manifest(cache_).files) bytes += file.bytes;
  for (const double share : {0.95, 0.8, 0.6}) {
    SCOPED_TRACE(share);
    CacheContent content = whole;
    content.storage.disk_bytes = static_cast<std::uint64_t>(share * static_cast<double>(bytes));
    fit_to_disk(content, *content.storage.disk_bytes, tunnel_areas(state, content));
    write_cache(cache_, content);
    EXPECT_LT(load_manifest(cache_).pieces.tunnels + load_manifest(cache_).pieces.ray_trees,
              count_pieces(whole).tunnels + count_pieces(whole).ray_trees);
    EXPECT_TRUE(check_cache(cache_).findings.empty());
    OpenedCache opened = opened_cache(cache_);
    Replayer replayer(std::move(*opened.state), std::move(opened.image), {}, nullptr, opened.tunnels);
    replayer.step(edit_of_text(kMove), "move", ".");
    expect_full_render(replayer, "small disk");
  }
}

TEST_F(StoredTunnelsTest, LeaveMemoryAndComeBackFromTheCacheWithoutADisk) {
  const SceneState state = test_scene(TestScene::study, 300, 200);
  ResidencyOptions options;
  options.process_bytes = nullptr;
  options.memory_bytes = 3 << 19;
  Replayer replayer = replayer_of_cache(state, {1, 5}, {}, cache_, options);
  std::uint64_t evicted = 0, reloaded = 0;
  for (int round = 0; round < 3; ++round)
    for (const char* edit : {kMove, kMoveOther}) {
      const std::string back =
          std::string(edit).find("MirrorBall") != std::string::npos
              ? R"([{"op": "replace", "path": "/nodes/MirrorBall/translation", "value": [-1, 1, 0.1]}])"
              : R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.3, 0.8, 0.3]}])";
      for (const std::string& text : {std::string(edit), back}) {
        const StepResult step = replayer.step(edit_of_text(text), "budget", ".");
        evicted += step.counters.evicted.tunnels;
        reloaded += step.counters.reloaded.tunnels;
        expect_full_render(replayer, text);
      }
    }
  EXPECT_GT(evicted, 0U);
  EXPECT_GT(reloaded, 0U);
}

}  // namespace
}  // namespace relook
