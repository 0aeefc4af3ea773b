// The cache: what was written comes back bit for bit, and nothing that was not written is ever read as if it had been:
// every truncation and every flipped byte is refused, each kind of misfit with its own sentence.
#include "cache/cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/manifest.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr std::uint32_t kWidth = 70, kHeight = 3;  // two tiles, the second one clipped
constexpr std::uint32_t kMiss = PathTable::kMissWord;

Mesh triangle_mesh() {
  Mesh mesh;
  mesh.name = "Triangle";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uv[0] = {{0, 0}, {1, 0}, {0, 1}};
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 0.5F}, {0, 0, 1, 1}};
  mesh.min_alpha = 0.5F;
  for (const Point& p : mesh.positions) mesh.bounds.extendBy(p);
  return mesh;
}

LookDocument small_document() {
  LookDocument document;
  document.look = Json::parse(R"({"materials":{"Red":{"pbrMetallicRoughness":{"metallicFactor":0.1}}},
                                  "nodes":{"A":{"mesh":"Triangle"},"B":{}},"scene":{"name":"s"}})");
  document.order[0] = {"Red"};
  document.order[6] = {"A", "B"};
  document.instances["B"] = {Transform(), Transform(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1)};
  document.cameras = {{"Eye", {{"node", "A"}, {"camera", {{"type", "perspective"}}}, {"index", 0}}}};
  document.assets = std::make_shared<Assets>();
  document.assets->meshes.push_back(triangle_mesh());
  document.assets->mesh_primitives["Triangle"] = {MeshId(0)};
  document.assets->mesh_primitives["LinesOnly"] = {};
  document.assets->images["Wood"] = {"Wood", std::make_shared<Bytes>(Bytes(100, std::byte{7}))};
  document.file = "scene.gltf";
  return document;
}

std::shared_ptr<PyramidStore> small_pyramids() {
  auto store = std::make_shared<PyramidStore>();
  store->put("Wood", true,
             std::make_shared<TexturePyramid>(
                 build_pyramid(TexelFormat::srgb8, 4, 2, std::vector<std::uint8_t>(4 * 2 * 4, 200))));
  store->put("Sky", false, std::make_shared<TexturePyramid>(build_pyramid(2, 2, std::vector<float>(2 * 2 * 4, 1.25F))));
  return store;
}

/// One light, one object: a miss, an unshadowed hit, and a hit whose light is filtered by the object itself.
std::vector<std::vector<std::uint32_t>> three_paths() { return {{kMiss}, {0, 0, 1}, {0, 0, 2, 1, 0}}; }

CacheContent small_content(std::uint32_t samples = 1) {
  CacheContent content;
  content.document = small_document();
  content.pyramids = small_pyramids();
  content.camera.name = "Eye";
  content.camera.width = kWidth;
  content.camera.height = kHeight;
  content.camera.half_width = 0.1F;
  content.image.view.samples = samples;
  content.scene_hash = hash128(bytes_of("scene"));
  content.objects = 1;
  content.lights = 1;
  content.image.frame = {kWidth, kHeight, std::vector<Rgba>(kWidth * kHeight)};
  std::vector<Rgba>& pixels = content.image.frame.pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = Rgba(static_cast<float>(i), 0.1F, -0.0F, 1);
  for (const auto& words : three_paths()) content.image.paths.intern(words);
  for (std::uint32_t tile = 0; tile < 2; ++tile) {
    const std::uint32_t x0 = tile * 64, columns = tile == 0 ? 64 : kWidth - 64;
    TileTrees trees;
    std::vector<Rgba> colors;
    trees.first_hit.push_back(0);
    for (std::uint32_t i = 0; i < columns * kHeight * samples; ++i) {
      trees.paths.emplace_back(i % 3);
      for (std::uint32_t hit = 0; hit < i % 3; ++hit)
        trees.hits.push_back({0, 0.25F + 0.001F * static_cast<float>(i), 0.5F});
      trees.first_hit.push_back(static_cast<std::uint32_t>(trees.hits.size()));
      const std::uint32_t pixel = i / samples;
      const Rgba color = pixels[pixel / columns * kWidth + x0 + pixel % columns];
      colors.push_back(samples == 1 ? color : color * static_cast<float>(1 + i % samples));
    }
    content.image.trees.push_back(std::move(trees));
    content.image.sample_colors.push_back(std::move(colors));
  }
  return content;
}

bool same_bits(const std::vector<Rgba>& a, const std::vector<Rgba>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgba)) == 0;
}

void expect_equal(const CacheContent& a, const CacheContent& b) {
  EXPECT_EQ(a.document.look, b.document.look);
  EXPECT_EQ(a.document.order, b.document.order);
  EXPECT_EQ(a.document.instances, b.document.instances);
  EXPECT_EQ(a.document.cameras, b.document.cameras);
  EXPECT_EQ(a.document.file, b.document.file);
  ASSERT_EQ(a.document.assets->meshes.size(), b.document.assets->meshes.size());
  const Mesh &first = a.document.assets->meshes[0], &second = b.document.assets->meshes[0];
  EXPECT_EQ(first.name, second.name);
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.normals, second.normals);
  EXPECT_EQ(first.uv, second.uv);
  EXPECT_EQ(first.colors, second.colors);
  EXPECT_EQ(first.min_alpha, second.min_alpha);
  EXPECT_EQ(first.bounds, second.bounds);
  EXPECT_EQ(a.document.assets->mesh_primitives, b.document.assets->mesh_primitives);
  EXPECT_EQ(*a.document.assets->images.at("Wood").bytes, *b.document.assets->images.at("Wood").bytes);
  const auto left = a.pyramids->all(), right = b.pyramids->all();
  ASSERT_EQ(left.size(), right.size());
  for (const auto& [key, pyramid] : left) {
    ASSERT_TRUE(right.contains(key));
    EXPECT_EQ(pyramid->texels8, right.at(key)->texels8);
    EXPECT_EQ(pyramid->texels32, right.at(key)->texels32);
    EXPECT_EQ(pyramid->levels.size(), right.at(key)->levels.size());
    EXPECT_EQ(pyramid->largest, right.at(key)->largest);
  }
  EXPECT_EQ(a.scene_hash, b.scene_hash);
  EXPECT_EQ(options_hash(a), options_hash(b));
  EXPECT_TRUE(same_bits(a.image.frame.pixels, b.image.frame.pixels));
  EXPECT_TRUE(std::ranges::equal(a.image.paths.all_words(), b.image.paths.all_words()));
  ASSERT_EQ(a.image.trees.size(), b.image.trees.size());
  for (std::size_t tile = 0; tile < a.image.trees.size(); ++tile) {
    EXPECT_EQ(a.image.trees[tile].paths, b.image.trees[tile].paths);
    EXPECT_EQ(a.image.trees[tile].first_hit, b.image.trees[tile].first_hit);
    EXPECT_EQ(a.image.trees[tile].hits, b.image.trees[tile].hits);
    EXPECT_TRUE(same_bits(a.image.sample_colors[tile], b.image.sample_colors[tile]));
  }
}

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void overwrite(const std::filesystem::path& path, BytesView bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

CacheFault fault_of(const std::filesystem::path& path) {
  CacheContent content;
  return read_cache(path, content).fault;
}

/// Rewrites the manifest so that it is sound for its changed content.
void change_manifest(const std::filesystem::path& cache, const std::function<void(Manifest&)>& change) {
  Manifest manifest = load_manifest(cache);
  change(manifest);
  overwrite(cache / kManifestName, bytes_of(manifest_text(manifest)));
}

TEST(Cache, round_trip_restores_every_bit) {
  for (const std::uint32_t samples : {1U, 4U}) {
    const ScratchFolder folder("cache");
    const CacheContent written = small_content(samples);
    write_cache(folder / "c", written);
    CacheContent read;
    const CacheAnswer answer = read_cache(folder / "c", read);
    ASSERT_EQ(answer.fault, CacheFault::none) << answer.file << ": " << answer.detail;
    expect_equal(written, read);
    EXPECT_TRUE(check_cache(folder / "c").findings.empty());
  }
}

TEST(Cache, one_sample_colors_that_differ_from_pixels_survive) {
  const ScratchFolder folder("cache");
  CacheContent written = small_content();
  written.image.sample_colors[1][2].g = -7;
  write_cache(folder / "c", written);
  CacheContent read;
  ASSERT_EQ(read_cache(folder / "c", read).fault, CacheFault::none);
  expect_equal(written, read);
}

TEST(Cache, thread_count_does_not_change_a_byte) {
  const ScratchFolder folder("cache");
  const CacheContent content = small_content(2);
  set_thread_count(1);
  write_cache(folder / "one", content);
  set_thread_count(0);
  write_cache(folder / "all", content);
  const auto one = files_below(folder / "one"), all = files_below(folder / "all");
  ASSERT_EQ(one.size(), all.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].filename(), all[i].filename());
    EXPECT_EQ(read_file(one[i]), read_file(all[i]));
  }
}

TEST(Cache, every_flipped_byte_is_refused) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  for (const std::filesystem::path& file : files_below(folder / "c")) {
    const Bytes sound = read_file(file);
    const std::size_t stride = std::max<std::size_t>(1, sound.size() / 150);
    for (std::size_t i = 0; i < sound.size(); i += i < 200 ? 1 : stride) {
      Bytes damaged = sound;
      damaged[i] ^= std::byte{1};
      overwrite(file, damaged);
      ASSERT_NE(fault_of(folder / "c"), CacheFault::none) << file << ", byte " << i;
    }
    overwrite(file, sound);
  }
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::none);
}

TEST(Cache, every_truncation_is_refused) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  for (const std::filesystem::path& file : files_below(folder / "c")) {
    const Bytes sound = read_file(file);
    const std::size_t stride = std::max<std::size_t>(1, sound.size() / 60);
    for (std::size_t size = 0; size < sound.size(); size += stride) {
      overwrite(file, BytesView(sound).first(size));
      ASSERT_EQ(fault_of(folder / "c"), CacheFault::truncated) << file << ", " << size << " bytes";
    }
    Bytes longer = sound;
    longer.push_back(std::byte{0});
    overwrite(file, longer);
    EXPECT_NE(fault_of(folder / "c"), CacheFault::none) << file << ", one byte more";
    overwrite(file, sound);
  }
}

TEST(Cache, each_missing_file_is_refused) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  for (const std::filesystem::path& file : files_below(folder / "c")) {
    const Bytes sound = read_file(file);
    std::filesystem::remove(file);
    const bool is_manifest = file.filename() == kManifestName;
    EXPECT_EQ(fault_of(folder / "c"), is_manifest ? CacheFault::not_a_cache : CacheFault::damaged) << file;
    overwrite(file, sound);
  }
}

TEST(Cache, other_folders_are_told_apart) {
  const ScratchFolder folder("cache");
  EXPECT_EQ(fault_of(folder / "nothing"), CacheFault::missing);
  std::filesystem::create_directory(folder / "empty");
  EXPECT_EQ(fault_of(folder / "empty"), CacheFault::not_a_cache);
  overwrite(folder / "file", bytes_of("x"));
  EXPECT_EQ(fault_of(folder / "file"), CacheFault::not_a_cache);
  std::filesystem::create_directory(folder / "foreign");
  overwrite(folder / "foreign" / "MANIFEST.json", bytes_of("{\"name\": \"an extension\"}\n"));
  EXPECT_EQ(fault_of(folder / "foreign"), CacheFault::not_a_cache);
  overwrite(folder / "foreign" / "MANIFEST.json", bytes_of("{\"relook\": \"cache/1\", \"content\": {}}\n"));
  EXPECT_EQ(fault_of(folder / "foreign"), CacheFault::other_version);
}

TEST(Cache, files_of_another_scene_or_view_are_refused) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  change_manifest(folder / "c", [](Manifest& manifest) { manifest.identity.scene_hash = hash128(bytes_of("other")); });
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::other_scene);
  write_cache(folder / "c", small_content());
  change_manifest(folder / "c", [](Manifest& manifest) {
    manifest.view.max_depth = 3;
    CacheContent content;
    content.camera = manifest.camera;
    content.image.view.max_depth = 3;
    manifest.identity.options_hash = options_hash(content);
  });
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::other_options);
}

TEST(Cache, shadow_counters_are_kept_and_checked) {
  const ScratchFolder folder("cache");
  const auto counted_content = [](std::uint32_t counter) {
    CacheContent content = small_content();
    content.image.view.shadow_bits = 2;
    const PathId blocked = content.image.paths.intern(std::vector<std::uint32_t>{0, 0, 3, 1, 0, 0, counter});
    std::ranges::replace(content.image.trees[0].paths, PathId(1), blocked);  // one hit, either way
    return content;
  };
  write_cache(folder / "c", counted_content(4));
  CacheContent read;
  ASSERT_EQ(read_cache(folder / "c", read).fault, CacheFault::none);
  EXPECT_EQ(read.image.view.shadow_bits, 2U);
  expect_equal(counted_content(4), read);
  write_cache(folder / "c", counted_content(5));
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::damaged);
}

TEST(Cache, indices_out_of_range_are_refused_although_every_hash_fits) {
  const ScratchFolder folder("cache");
  const auto fault_after = [&](const std::function<void(CacheContent&)>& change) {
    CacheContent content = small_content();
    change(content);
    write_cache(folder / "c", content);
    return fault_of(folder / "c");
  };
  EXPECT_EQ(fault_after([](CacheContent&) {}), CacheFault::none);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.document.assets->meshes[0].triangles[0][1] = 3; }),
            CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.document.assets->meshes[0].normals.pop_back(); }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) {
              c.document.assets->meshes[0].positions[0].x = std::numeric_limits<float>::quiet_NaN();
            }),
            CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.document.assets->mesh_primitives["Triangle"] = {MeshId(1)}; }),
            CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.objects = 0; }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.image.trees[0].paths[1] = PathId(3); }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.image.trees[0].paths[0] = PathId(1); }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.image.trees[1].hits.pop_back(); }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.image.trees[1].hits[0].u = INFINITY; }), CacheFault::damaged);
  EXPECT_EQ(fault_after([](CacheContent& c) { c.image.frame.pixels[5].r = NAN; }), CacheFault::damaged);
}

TEST(Cache, names_in_the_manifest_cannot_leave_the_folder) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  change_manifest(folder / "c", [](Manifest& manifest) { manifest.files[0].name = "../secret"; });
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::damaged);
}

TEST(Cache, links_to_files_outside_are_refused) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  std::filesystem::rename(folder / "c" / "look.json", folder / "outside.json");
  std::filesystem::create_symlink(folder / "outside.json", folder / "c" / "look.json");
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::damaged);
}

TEST(Cache, check_lists_every_finding) {
  const ScratchFolder folder("cache");
  write_cache(folder / "c", small_content());
  overwrite(folder / "c" / "stray.txt", bytes_of("x"));
  overwrite(folder / "c" / "look.json", bytes_of("{}"));
  for (const auto& file : files_below(folder / "c"))
    if (file.filename().string().starts_with("frame-")) std::filesystem::remove(file);
  const CacheReport report = check_cache(folder / "c");
  EXPECT_EQ(report.findings.size(), 3U);
  EXPECT_EQ(report.worst.fault, CacheFault::truncated);
}

TEST(Cache, replaces_a_cache_but_no_other_folder) {
  const ScratchFolder folder("cache");
  CacheContent content = small_content();
  write_cache(folder / "c", content);
  content.scene_hash = hash128(bytes_of("second"));
  write_cache(folder / "c", content);
  CacheContent read;
  ASSERT_EQ(read_cache(folder / "c", read).fault, CacheFault::none);
  EXPECT_EQ(read.scene_hash, content.scene_hash);

  std::filesystem::create_directory(folder / "mine");
  overwrite(folder / "mine" / "thesis.txt", bytes_of("x"));
  EXPECT_THROW(write_cache(folder / "mine", content), UsageError);
  EXPECT_TRUE(std::filesystem::exists(folder / "mine" / "thesis.txt"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 2) << "temporary folders remain";
}

TEST(Cache, two_writers_of_one_output_leave_one_whole_cache) {
  const ScratchFolder folder("cache");
  const CacheContent content = small_content();
  const auto write_often = [&] {
    for (int i = 0; i < 5; ++i) write_cache(folder / "c", content);
  };
  std::thread other(write_often);
  write_often();
  other.join();
  EXPECT_EQ(fault_of(folder / "c"), CacheFault::none);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 1) << "temporary folders remain";
}

TEST(Cache, every_fault_has_its_own_sentence) {
  std::set<std::string_view> sentences;
  for (const CacheFault fault : {CacheFault::none, CacheFault::missing, CacheFault::not_a_cache, CacheFault::unreadable,
                                 CacheFault::other_version, CacheFault::other_arithmetic, CacheFault::other_scene,
                                 CacheFault::other_options, CacheFault::truncated, CacheFault::damaged})
    EXPECT_TRUE(sentences.insert(sentence(fault)).second) << sentence(fault);
}

}  // namespace
}  // namespace relook
