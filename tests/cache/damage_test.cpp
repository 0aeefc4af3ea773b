// Damage of a cache: whatever follows from the scene is traced again, to the bit; everything else is refused. Never a
// wrong pixel. Every byte and every length with RELOOK_FAULTS=all in the environment, some otherwise.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/json.h"
#include "image/cached_image.h"
#include "image/render.h"
#include "run_program.h"
#include "test_scenes.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

bool same_colors(const std::vector<Rgba>& a, const std::vector<Rgba>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgba)) == 0;
}

bool same_image(const CacheContent& first, const CacheContent& second) {
  const Image &a = first.image, &b = second.image;
  bool same = same_colors(a.frame.pixels, b.frame.pixels) &&
              std::ranges::equal(a.paths.all_words(), b.paths.all_words()) &&
              std::ranges::equal(a.paths.all_offsets(), b.paths.all_offsets()) && a.trees.size() == b.trees.size();
  for (std::size_t tile = 0; same && tile < a.trees.size(); ++tile)
    same = a.trees[tile].paths == b.trees[tile].paths && a.trees[tile].hits == b.trees[tile].hits &&
           a.trees[tile].first_hit == b.trees[tile].first_hit &&
           same_colors(a.sample_colors[tile], b.sample_colors[tile]);
  return same && first.around_tiles == second.around_tiles && first.tunnels == second.tunnels;
}

/// A floor, a mirror box and a glass-like card under a light: every kind of path in few bytes.
SceneState small_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder builder;
  const int grey = builder.material("Grey", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.4, 0.3, 1}}}}});
  const int mirror =
      builder.material("Mirror", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
  const int veil = builder.material(
      "Veil", {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.9, 0.5, 0.5}}}}});
  builder.node("Floor", {{"mesh", builder.mesh("Floor", plane_mesh(4, 1), grey)}});
  builder.node("Box",
               {{"mesh", builder.mesh("Box", box_mesh({0.5F, 0.5F, 0.5F}), mirror)}, {"translation", {0, 0.5, 0}}});
  builder.node("Card", {{"mesh", builder.mesh("Card", card_mesh(0.6F, 0.6F), veil)}, {"translation", {0.9, 0.6, 0.8}}});
  builder.light("Lamp", {{"type", "point"}, {"intensity", 100}}, {{"translation", {2, 3, 2}}});
  builder.look_at({0, 1.5F, 4}, {0, 0.5F, 0}, 40, width, height);
  return builder.state();
}

class Damage : public testing::Test {
 protected:
  void write(std::uint32_t width, std::uint32_t height, ViewOptions view) {
    const SceneState state = small_scene(width, height);
    written_ = content_with_tunnels(state, view, {.tunnels = 2});
    write_cache(cache_, written_);
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache_))
      if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
  }
  static bool is_of_tunnels(const std::filesystem::path& file) { return file.parent_path().filename() == "tunnels"; }
  static bool is_mendable(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    return is_of_tunnels(file) || file.parent_path().filename() == "trees" || name.starts_with("frame-") ||
           name.starts_with("paths-");
  }
  /// A damaged cache is mended, to the bit, or refused.
  void expect_mended_or_refused(const std::filesystem::path& file) {
    CacheContent content;
    CacheLosses losses;
    CacheAnswer answer = read_cache(cache_, content, &losses);
    if (answer.fault == CacheFault::none) answer = make_good(content, losses);
    ASSERT_EQ(answer.fault == CacheFault::none, is_mendable(file)) << file << ": " << answer.detail;
    EXPECT_FALSE(is_mendable(file) && losses.tiles.empty() && losses.tunnels.empty()) << file;
    if (answer.fault == CacheFault::none) {
      ASSERT_TRUE(same_image(content, written_)) << file;
    }
    ++cases_;
  }
  static void overwrite(const std::filesystem::path& file, BytesView bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  /// How far apart the bytes to try are.
  static std::size_t stride(std::size_t size, std::size_t by_default) {
    const char* const wanted = std::getenv("RELOOK_FAULTS");
    return wanted != nullptr && std::string(wanted) == "all" ? 1 : std::max<std::size_t>(1, size / by_default);
  }

  ScratchFolder folder_{"damage"};
  std::filesystem::path cache_ = folder_ / "c";
  CacheContent written_;
  std::size_t cases_ = 0;
};

TEST_F(Damage, a_look_document_of_another_form_with_correct_hashes_is_refused) {
  write(20, 10, {1, 6, 0});
  for (const Json& look : {Json::object(), Json{{"materials", 5}}, Json{{"lights", Json::array({1})}}}) {
    CacheContent content;
    ASSERT_EQ(read_cache(cache_, content).fault, CacheFault::none);
    Json crafted = content.document.look;
    if (look.empty()) crafted = look;
    crafted.update(look);
    content.document.look = crafted;
    CacheLosses all;
    all.faults.emplace_back();
    EXPECT_EQ(make_good(content, all).fault, CacheFault::damaged) << look.dump();
  }
}

TEST_F(Damage, every_flipped_byte_is_mended_or_refused) {
  for (const ViewOptions view : {ViewOptions{1, 4, 0}, ViewOptions{2, 4, 2}}) {
    write(24, 16, view);
    for (const std::filesystem::path& file : files()) {
      const Bytes sound = read_file(file);
      for (std::size_t i = 0; i < sound.size(); i += stride(sound.size(), 60)) {
        SCOPED_TRACE(i);
        Bytes damaged = sound;
        damaged[i] ^= std::byte{static_cast<unsigned char>(1U << i % 8)};
        overwrite(file, damaged);
        expect_mended_or_refused(file);
      }
      overwrite(file, sound);
    }
  }
  std::printf("%zu bytes flipped\n", cases_);
}

TEST_F(Damage, every_truncation_is_mended_or_refused) {
  write(24, 16, {1, 4, 0});
  for (const std::filesystem::path& file : files()) {
    const Bytes sound = read_file(file);
    for (std::size_t size = 0; size < sound.size(); size += stride(sound.size(), 40)) {
      SCOPED_TRACE(size);
      overwrite(file, BytesView(sound).first(size));
      expect_mended_or_refused(file);
    }
    overwrite(file, sound);
  }
  std::printf("%zu truncations\n", cases_);
}

TEST_F(Damage, missing_groups_of_tiles_are_traced_again_and_no_others) {
  write(64 * 8, 64 * 5, {1, 3, 0});  // 40 tiles: two groups
  const std::vector<std::filesystem::path> all = files();
  const auto group = std::ranges::find_if(
      all, [](const std::filesystem::path& file) { return file.filename().string().starts_with("00001-"); });
  ASSERT_NE(group, all.end());
  std::filesystem::remove(*group);
  CacheContent content;
  CacheLosses losses;
  ASSERT_EQ(read_cache(cache_, content, &losses).fault, CacheFault::none);
  EXPECT_EQ(losses.tiles, (std::vector<std::size_t>{32, 33, 34, 35, 36, 37, 38, 39}));
  ASSERT_EQ(losses.faults.size(), 1U);
  ASSERT_EQ(make_good(content, losses).fault, CacheFault::none);
  EXPECT_TRUE(same_image(content, written_));
  EXPECT_EQ(read_cache(cache_, content).fault, CacheFault::damaged) << "strict";
}

TEST_F(Damage, tiles_that_leave_memory_as_they_are_read_come_back_the_same) {
  write(64 * 8, 64 * 5, {4, 3, 0});  // 40 tiles: five groups
  for (const bool is_damaged : {false, true}) {
    if (is_damaged) {
      const std::vector<std::filesystem::path> all = files();
      std::filesystem::remove(*std::ranges::find_if(
          all, [](const std::filesystem::path& file) { return file.filename().string().starts_with("00002-"); }));
    }
    ResidencyOptions options;
    options.memory_bytes = 1 << 20;  // a fifth
    options.process_bytes = nullptr;
    options.spill_folder = testing::TempDir();
    Residency residency(options);
    OpenedCache opened;
    ASSERT_EQ(open_cache(cache_, true, opened, &residency).fault, CacheFault::none);
    EXPECT_EQ(opened.losses.tiles.size(), is_damaged ? 8U : 0U);
    const Image& image = opened.image;
    EXPECT_GT(std::ranges::count_if(image.sample_colors, &std::vector<Rgba>::empty), 20);
    for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
      const auto trees = residency.use(PieceKind::ray_trees, tile);
      const auto colors = residency.use(PieceKind::sample_colors, tile);
      EXPECT_EQ(image.trees[tile].hits, written_.image.trees[tile].hits) << tile;
      EXPECT_EQ(image.trees[tile].first_hit, written_.image.trees[tile].first_hit) << tile;
      EXPECT_TRUE(same_colors(image.sample_colors[tile], written_.image.sample_colors[tile])) << tile;
    }
  }
}

TEST_F(Damage, a_replay_says_what_it_traced_again_and_strict_refuses) {
  const std::string scene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
  const std::string cache = cache_.string(), journal = (folder_ / "j.json").string();
  std::ofstream(journal) << R"({"relook": "journal/1", "steps": [{"name": "up", "edit": [
      {"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.2, 0]}]}]})";
  const auto run = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    return run_program(arguments);
  };
  ASSERT_EQ(run({"preprocess", scene, "--integrator", "whitted", "-o", cache, "--resolution", "64x36", "--quiet",
                 "--overwrite"})
                .exit_code,
            0);
  const auto replayed = [&](const std::string& name) {
    const ProgramResult result = run({"replay", cache, journal, "-o", (folder_ / name).string(), "--progress", "none"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return parse_json(text_of(read_file(folder_ / name / "report.json")), "report.json");
  };
  const Json sound = replayed("sound");
  EXPECT_EQ(sound["steps"][0]["rebuilt"]["ray_trees"], 0);
  for (const std::filesystem::path& file : files()) {
    if (!is_mendable(file)) continue;
    std::filesystem::rename(file, folder_ / "aside");
    const Json report = replayed("run_" + file.stem().string());
    EXPECT_EQ(report["frames"], sound["frames"]) << file;
    EXPECT_EQ(report["steps"][0]["rebuilt"]["ray_trees"], is_of_tunnels(file) ? 0 : 64 * 36) << file;
    EXPECT_EQ(report["steps"][1]["rebuilt"]["tunnels"], is_of_tunnels(file) ? 1 : 0) << file;
    EXPECT_EQ(report["cache_damage"].size(), 1U);
    const ProgramResult strict = run({"replay", cache, journal, "-o", (folder_ / "strict").string(), "--strict"});
    EXPECT_EQ(strict.exit_code, 5) << strict.output;
    EXPECT_EQ(std::ranges::count(strict.output, '\n'), 1) << strict.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "strict"));
    EXPECT_EQ(run({"check", cache, "--quiet"}).exit_code, 5);
    std::filesystem::rename(folder_ / "aside", file);
  }
}

}  // namespace
}  // namespace relook
