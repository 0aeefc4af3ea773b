// The cache of a picture that is a sum of lights: its sums come back bit for bit, a byte of them that is not as it was
// written is noticed, and what no writer makes is refused although every hash fits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include "base/hash.h"
#include "cache/cache.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "image/image_pieces.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr std::uint32_t kWidth = 70, kHeight = 3, kSamples = 4;  // two tiles, the second one clipped
constexpr std::size_t kSums = 1 + kSumsBesideLights;             // of a scene with one light

/// A light with every kind of term, one with few bytes, others with none; the coverage of all pixels but the first.
PackedSums some_sums(std::size_t pixels, float first) {
  TileSums sums(kSums, pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    sums.add(0, pixel, Color(first + static_cast<float>(pixel), -0.001F, 1e-20F));
    if (pixel > 0) sums.add_coverage(pixel, kSamples);
  }
  sums.add(2, 1, Color(0, 64, 0));
  sums.add(3, 1, Color(1e10F, 0, 0));  // counted
  return PackedSums::pack(sums);
}

CacheContent path_content() {
  CacheContent content;
  content.document.look = Json::parse(R"({"nodes":{"A":{}},"scene":{"name":"s"}})");
  content.document.order[6] = {"A"};
  content.document.cameras = {{"Eye", {{"node", "A"}, {"camera", {{"type", "perspective"}}}, {"index", 0}}}};
  content.document.assets = std::make_shared<Assets>();
  content.document.file = "scene.gltf";
  content.pyramids = std::make_shared<PyramidStore>();
  content.camera.name = "Eye";
  content.camera.width = kWidth;
  content.camera.height = kHeight;
  content.camera.half_width = 0.1F;
  content.scene_hash = hash128(bytes_of("scene"));
  content.objects = 1;
  content.lights = 1;
  Image& image = content.image;
  image.view.samples = kSamples;
  image.view.integrator = Integrator::path;
  image.view.glossy_depth = 3;
  image.frame = {kWidth, kHeight, std::vector<Rgba>(kWidth * kHeight, Rgba(1, 2, 3, 1))};
  image.paths.intern(std::vector<std::uint32_t>{PathTable::kMissWord});
  for (const std::uint32_t columns : {64U, kWidth - 64U}) {
    TileTrees trees;
    trees.paths.assign(std::size_t{columns} * kHeight * kSamples, PathId(0));
    trees.first_hit.assign(trees.paths.size() + 1, 0);
    image.trees.push_back(std::move(trees));
    image.light_sums.push_back(some_sums(std::size_t{columns} * kHeight, static_cast<float>(columns)));
  }
  return content;
}

CacheFault fault_of(const std::filesystem::path& cache) {
  CacheContent content;
  return read_cache(cache, content).fault;
}

std::filesystem::path trees_of(const std::filesystem::path& cache) {
  return std::filesystem::directory_iterator(cache / "trees")->path();
}

void overwrite(const std::filesystem::path& path, BytesView bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(SumsCache, round_trip_restores_every_sum) {
  const ScratchFolder folder("cache");
  const CacheContent written = path_content();
  write_cache(folder / "c", written);
  CacheContent read;
  const CacheAnswer answer = read_cache(folder / "c", read);
  ASSERT_EQ(answer.fault, CacheFault::none) << answer.file << ": " << answer.detail;
  EXPECT_EQ(read.image.light_sums, written.image.light_sums);
  EXPECT_EQ(read.image.light_sums[0].clamped(), 1U);
  EXPECT_TRUE(read.image.sample_colors.empty());
  EXPECT_EQ(read.image.view, written.image.view);
  EXPECT_EQ(read.image.trees[1].paths, written.image.trees[1].paths);
  EXPECT_TRUE(check_cache(folder / "c").findings.empty());
  write_cache(folder / "again", read);
  EXPECT_EQ(read_file(trees_of(folder / "again")), read_file(trees_of(folder / "c")));
}

TEST(SumsCache, lights_that_share_a_sum_have_one) {
  const ScratchFolder folder("cache");
  CacheContent written = path_content(), read;
  written.lights = 3;
  written.shared = 2;
  write_cache(folder / "c", written);
  const CacheAnswer answer = read_cache(folder / "c", read);
  ASSERT_EQ(answer.fault, CacheFault::none) << answer.file << ": " << answer.detail;
  EXPECT_EQ(read.lights, 3U);
  EXPECT_EQ(read.shared, 2U);
  EXPECT_EQ(read.image.light_sums, written.image.light_sums);
  written.shared = 1;
  write_cache(folder / "c", written);
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::damaged);
}

TEST(SumsCache, the_integrator_and_its_depths_are_options) {
  const ScratchFolder folder("cache");
  CacheContent content = path_content();
  write_cache(folder / "c", content);
  EXPECT_EQ(match_cache(folder / "c", content).fault, CacheFault::none);
  content.image.view.diffuse_depth = 2;
  content.image.view.glossy_depth = 5;
  EXPECT_EQ(match_cache(folder / "c", content).detail, "--diffuse-depth (0) and --glossy-depth (3)");
  content.image.view.integrator = Integrator::whitted;
  EXPECT_EQ(match_cache(folder / "c", content).detail, "--integrator (path)");
  const std::string whitted = options_hash(content);
  content.image.view.glossy_depth = 6;
  EXPECT_EQ(options_hash(content), whitted);
  content.image.view.integrator = Integrator::path;
  EXPECT_NE(options_hash(content), whitted);
}

TEST(SumsCache, every_flipped_byte_and_truncation_is_a_loss_of_its_tiles) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", path_content());
  const std::filesystem::path file = trees_of(folder / "c");
  const Bytes sound = read_file(file);
  const auto expect_loss = [&](const char* what, std::size_t place) {
    EXPECT_NE(fault_of(folder / "c"), CacheFault::none) << what << place;
    CacheContent content;
    CacheLosses losses;
    ASSERT_EQ(read_cache(folder / "c", content, &losses).fault, CacheFault::none) << what << place;
    EXPECT_EQ(losses.tiles, (std::vector<std::size_t>{0, 1}));
    ASSERT_EQ(content.image.light_sums.size(), 2U);
    EXPECT_TRUE(content.image.light_sums[1].empty());
    EXPECT_TRUE(content.image.sample_colors.empty());
  };
  for (std::size_t i = 80; i < sound.size(); i += 1 + sound.size() / 200) {
    Bytes damaged = sound;
    damaged[i] ^= std::byte{4};
    overwrite(file, damaged);
    expect_loss("byte ", i);
    overwrite(file, BytesView(sound).first(i));
    expect_loss("length ", i);
  }
}

TEST(SumsCache, sums_that_no_writer_makes_are_refused_although_every_hash_fits) {
  const ScratchFolder folder("cache");
  const auto detail_after = [&](const std::function<void(CacheContent&)>& change) {
    CacheContent content = path_content(), read;
    change(content);
    write_cache(folder / "c", content);
    const CacheAnswer answer = read_cache(folder / "c", read);
    EXPECT_EQ(answer.fault, CacheFault::damaged);
    return answer.detail;
  };
  EXPECT_NE(detail_after([](CacheContent& c) { c.image.light_sums[1] = some_sums(5, 1); }), "");  // of other pixels
  EXPECT_NE(detail_after([](CacheContent& c) { c.lights = 2; }), "");
  EXPECT_NE(detail_after([](CacheContent& c) {
              for (PackedSums& sums : c.image.light_sums) sums = sums.remapped(std::vector<std::uint32_t>{0, 1, 2});
            }),
            "");
}

TEST(SumsCache, sections_are_checked) {
  const CacheIdentity identity{hash128(bytes_of("scene")), hash128(bytes_of("options"))};
  const Frame frame{2, 1, std::vector<Rgba>(2)};
  const auto fault_of_section = [&](std::vector<std::uint8_t> widths, Bytes values) {
    ContainerWriter writer;
    writer.add_column("sum_widths", widths, 2);
    writer.add_column("sum_clamped", std::vector<std::uint64_t>(widths.size() / 2), 8);
    writer.add_column("sums", values, 1);
    const Bytes file = writer.finish(identity);
    std::vector<PackedSums> tiles(1);
    try {
      read_sums(ContainerReader(file, identity), 1, frame, 0, tiles);
    } catch (const CacheDamage& damage) {
      return std::string(damage.what());
    }
    return std::string();
  };
  const Bytes one(2, std::byte{1});  // the coverage of two pixels
  EXPECT_EQ(fault_of_section({0, 0, 0, 1}, one), "");
  EXPECT_NE(fault_of_section({0, 0, 0, 1, 0, 0}, one), "");
  EXPECT_NE(fault_of_section({0, 0, 0, 17}, Bytes(34, std::byte{1})), "");
  EXPECT_NE(fault_of_section({0, 0, 16, 1}, one), "");
  EXPECT_NE(fault_of_section({3, 0, 0, 1}, one), "");
  EXPECT_NE(fault_of_section({0, 0, 0, 1}, Bytes(3, std::byte{1})), "");
  EXPECT_NE(fault_of_section({0, 0, 0, 2}, Bytes(4)), "");  // zeros that take room
}

TEST(SumsCache, sums_leave_memory_and_come_back) {
  const ScratchFolder folder("spill");
  Image image = path_content().image;
  const std::vector<PackedSums> all = image.light_sums;
  ResidencyOptions options;
  options.memory_bytes = all[0].bytes() + all[1].bytes() / 2;
  options.spill_folder = folder / "";
  options.process_bytes = {};
  Residency residency(options);
  add_image_pieces(residency, image);
  EXPECT_FALSE(residency.has_kind(PieceKind::sample_colors));
  for (std::size_t tile = 0; tile < 2; ++tile) note_sums(residency, tile, image.light_sums[tile]);
  EXPECT_EQ(std::ranges::count_if(image.light_sums, &PackedSums::empty), 1);
  for (std::size_t tile = 0; tile < 2; ++tile) {
    const auto lease = residency.use(PieceKind::light_sums, tile);
    EXPECT_EQ(image.light_sums[tile], all[tile]);
  }
  EXPECT_GT(residency.take_counts().reloaded[index_of(PieceKind::light_sums)], 0U);
  EXPECT_EQ(kind_name(PieceKind::light_sums), "light_sums");
}

}  // namespace
}  // namespace relook
