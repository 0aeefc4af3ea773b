// --import-memory: what small files may unpack to, in images, geometry and sections of a cache, is asked before memory
// is. Peaks are those that the operating system sees.
#include "base/import_memory.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/json.h"
#include "base/system/sanitizers.h"
#include "cache/scene_parts.h"
#include "run_program.h"
#include "scene/texture/decode_pyramid.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

void append_number(std::string& to, std::uint64_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 0xFF);
}

void append_chunk(std::string& png, const std::string& type, const std::string& data) {
  append_number(png, data.size());
  const std::string body = type + data;
  png += body;
  append_number(png, crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
}

/// Black, and small: rows are deflated one by one.
std::string black_png(std::uint32_t width, std::uint32_t height, unsigned bits, bool interlaced = false) {
  std::vector<Bytef> row(width * std::size_t{bits} / 8 + 1, 0), out(1 << 16);
  z_stream stream{};
  EXPECT_EQ(deflateInit(&stream, 9), Z_OK);
  std::string data;
  for (std::uint32_t y = 0; y <= height; ++y) {
    stream.next_in = row.data();
    stream.avail_in = y < height ? static_cast<uInt>(row.size()) : 0;
    do {
      stream.next_out = out.data();
      stream.avail_out = static_cast<uInt>(out.size());
      deflate(&stream, y < height ? Z_NO_FLUSH : Z_FINISH);
      data.append(reinterpret_cast<const char*>(out.data()), out.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  deflateEnd(&stream);
  std::string header;
  append_number(header, width);
  append_number(header, height);
  header += {static_cast<char>(bits), 0, 0, 0, static_cast<char>(interlaced ? 1 : 0)};
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", data);
  append_chunk(png, "IEND", "");
  return png;
}

/// A triangle whose material has the images as base colour and emission.
Json scene_of(const std::vector<std::string>& images) {
  Json scene = parse_json(R"({"asset": {"version": "2.0"},
    "buffers": [{"byteLength": 44, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA="}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "materials": [{"name": "M", "pbrMetallicRoughness": {}}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})",
                          "scene");
  Json& material = scene["materials"][0];
  for (std::size_t i = 0; i < images.size(); ++i) {
    scene["images"].push_back({{"uri", images[i]}});
    scene["textures"].push_back({{"source", i}});
    Json& slot = i == 0 ? material["pbrMetallicRoughness"]["baseColorTexture"] : material["emissiveTexture"];
    slot["index"] = i;
  }
  return scene;
}

class ImportMemory : public testing::Test {
 protected:
  void TearDown() override { set_import_memory(kImportMemory); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(at(name), std::ios::binary) << content;
    return at(name);
  }
  [[nodiscard]] MeasuredResult render(const std::string& scene, const std::string& option = "2G") const {
    return measure_relook({"render", scene, "--integrator", "whitted", "-o", at("x.exr"), "--overwrite", "--quiet",
                           "--camera", "auto", "--lights", "auto", "--resolution", "16x9", "--import-memory", option});
  }
  static void expect_refused(const MeasuredResult& result, const std::string& place) {
    EXPECT_EQ(result.exit_code, 4) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_NE(result.output.find(place), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("--import-memory"), std::string::npos) << result.output;
    EXPECT_LT(result.peak_mib, kBaseMiB) << result.output;
  }
  static constexpr double kBaseMiB = 512;
  ScratchFolder folder_{"import_memory"};
};

TEST_F(ImportMemory, images_unpack_to_their_pyramid_and_nothing_beside_it) {
  if (kIsInstrumented) GTEST_SKIP() << "sanitizers take memory of their own";
  write("1bit.png", black_png(16384, 16384, 1));
  write("16bit.png", black_png(8192, 8192, 16));
  constexpr double kPyramidMiB = 1366;  // of each: 2^28 texels of 4 bytes or 2^26 of 16, and a third
  for (const std::string name : {"1bit", "16bit"}) {
    const std::string scene = write(name + ".gltf", scene_of({name + ".png"}).dump());
    const MeasuredResult kept = render(scene);
    EXPECT_EQ(kept.exit_code, 0) << kept.output;
    EXPECT_LT(kept.peak_mib, kBaseMiB + kPyramidMiB);
    expect_refused(render(scene, "1G"), name + ".gltf: /images/image_0: the image of ");
  }
}

TEST_F(ImportMemory, all_images_and_geometry_share_one_budget) {
  write("a.png", black_png(2048, 2048, 1));  // 21.3 MiB of texels
  write("b.png", black_png(2048, 2040, 1));
  const std::string scene = write("two.gltf", scene_of({"a.png", "b.png"}).dump());
  EXPECT_EQ(render(scene, "44M").exit_code, 0);
  expect_refused(render(scene, "42M"), "two.gltf: /images/");

  Json with_mesh = scene_of({"a.png", "b.png"});
  with_mesh["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 18}, {"type", "VEC3"}});
  with_mesh["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}}}});
  const std::string fuller = write("mesh.gltf", with_mesh.dump());
  EXPECT_EQ(render(fuller, "48M").exit_code, 0);
  expect_refused(render(fuller, "44M"), "mesh.gltf: /images/");
  expect_refused(render(fuller, "2M"), "mesh.gltf: /meshes: the geometry takes 20 MiB");
}

TEST_F(ImportMemory, accessors_without_data_are_refused_before_columns_are_made) {
  Json scene = scene_of({});
  scene["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 22}, {"type", "VEC3"}});
  for (int i = 0; i < 2; ++i)
    scene["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}, {"NORMAL", 2}}}});
  expect_refused(render(write("zeros.gltf", scene.dump()), "256M"), "zeros.gltf: /meshes");

  for (int i = 0; i < 100'000; ++i) scene["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}}}});
  const MeasuredResult many = render(write("many.gltf", scene.dump()));
  EXPECT_EQ(many.exit_code, 2) << many.output;
  EXPECT_LT(many.peak_mib, kBaseMiB);

  scene["accessors"][2] = {
      {"componentType", 5126},
      {"count", std::uint64_t{1} << 31},
      {"type", "VEC3"},
      {"sparse",
       {{"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}}}};
  const MeasuredResult sparse = render(write("sparse.gltf", scene.dump()));
  EXPECT_EQ(sparse.exit_code, 2) << sparse.output;
  EXPECT_EQ(std::count(sparse.output.begin(), sparse.output.end(), '\n'), 1) << sparse.output;
}

TEST_F(ImportMemory, a_buffer_that_is_named_often_is_counted_as_often) {
  write("zeros.bin", std::string(kMiB, '\0'));
  Json scene = scene_of({});
  for (int i = 0; i < 100; ++i) scene["buffers"].push_back({{"byteLength", kMiB}, {"uri", "zeros.bin"}});
  const std::string path = write("buffers.gltf", scene.dump());
  EXPECT_EQ(render(path, "128M").exit_code, 0);
  expect_refused(render(path, "64M"), "buffers.gltf: /buffers/64: the buffer takes 1 MiB");
}

TEST_F(ImportMemory, a_cache_is_held_to_it_and_names_the_file) {
  write("a.png", black_png(2048, 2048, 1));
  write("b.png", black_png(2048, 2040, 1));
  const std::string scene = write("two.gltf", scene_of({"a.png", "b.png"}).dump()), journal = at("j.json");
  write("j.json", R"({"relook": "journal/1", "steps": []})");
  ASSERT_EQ(measure_relook({"preprocess", scene, "--integrator", "whitted", "-o", at("c"), "--quiet", "--camera",
                            "auto", "--lights", "auto", "--resolution", "16x9"})
                .exit_code,
            0);
  const auto replay = [&](const std::string& size) {
    return measure_relook(
        {"replay", at("c"), journal, "-o", at("run"), "--quiet", "--overwrite", "--import-memory", size});
  };
  EXPECT_EQ(replay("44M").exit_code, 0);
  expect_refused(replay("42M"), "textures-");
  expect_refused(measure_relook({"check", at("c"), "--import-memory", "42M"}), "textures-");
}

const CacheIdentity kIdentity{std::string(32, 'a'), std::string(32, 'b')};

void decode(const Bytes& file) {
  Assets assets;
  PyramidStore pyramids;
  decode_textures(file, kIdentity, assets, pyramids);
}

TEST_F(ImportMemory, sections_with_right_hashes_unpack_to_no_more) {
  ContainerWriter texts;
  texts.add("names", bytes_of(std::string(64 * kMiB, ' ')));
  texts.add("ranges", {});
  const Bytes spaces = texts.finish(kIdentity);
  EXPECT_LT(spaces.size(), 16'384U);
  set_import_memory(256 * kMiB);
  EXPECT_THROW(decode(spaces), ResourceError);

  ContainerWriter blobs;
  blobs.add("names", bytes_of(R"({"images": [{"name": "A", "blob": 0}], "pyramids": []})"));
  blobs.add("ranges", {});
  blobs.add("image0", bytes_of(std::string(64 * kMiB, '\0')));
  const Bytes zeros = blobs.finish(kIdentity);
  decode(zeros);
  decode(zeros);  // what is gone counts no more
  set_import_memory(32 * kMiB);
  EXPECT_THROW(decode(zeros), ResourceError);
}

TEST_F(ImportMemory, wide_values_of_a_large_section_come_back_without_a_second_copy) {
  std::vector<Rgba> values(6 * kMiB);  // 96 MiB
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = Rgba(static_cast<float>(i), 1.0F / static_cast<float>(i + 1), -1, static_cast<float>(i % 7));
  ContainerWriter writer;
  writer.add_column("colors", values, sizeof(Rgba));
  writer.add_column("zeros", std::vector<float>(20 * kMiB, 0.0F), sizeof(float));
  const Bytes file = writer.finish(kIdentity);
  const ContainerReader reader(file, kIdentity);
  EXPECT_TRUE(reader.column<Rgba>("colors", values.size()) == values);
  EXPECT_EQ(std::ranges::count(reader.column<float>("zeros", 20 * kMiB), 0.0F), 20 * kMiB);
}

TEST_F(ImportMemory, what_a_decoder_must_hold_whole_counts_too) {
  const std::string plain = black_png(1024, 1024, 8);
  set_import_memory(6 * kMiB);
  EXPECT_NO_THROW((void)decode_pyramid(bytes_of(plain), true, "scene", ""));
  const std::string interlaced = black_png(1024, 1024, 8, true);
  EXPECT_EQ(png_pixels(bytes_of(interlaced)).held_bytes, kMiB);
  EXPECT_EQ(png_pixels(bytes_of(plain)).held_bytes, 0U);
  EXPECT_THROW((void)decode_pyramid(bytes_of(interlaced), true, "scene", ""), ResourceError);
}

TEST_F(ImportMemory, a_jpeg_of_endless_scans_is_refused) {
  const std::string start("\xFF\xD8\xFF\xC2\0\x0B\x08\0\x08\0\x08\x01\x01\x11\0", 15);
  const std::string scan("\xFF\xDA\0\x08\x01\x01\0\0\0\0\0", 11), end = "\xFF\xD9";
  std::string scans;
  for (int i = 0; i < 100; ++i) scans += scan;
  const ImageStream allowed = jpeg_pixels(bytes_of(start + scans + end));
  EXPECT_EQ(allowed.fault, "");
  EXPECT_EQ(allowed.held_bytes, 8U * 8U * 2U);
  EXPECT_EQ(jpeg_pixels(bytes_of(start + scans + scan + end)).fault, "the JPEG has more than 100 scans");
}

TEST_F(ImportMemory, the_image_that_was_found_by_attack_is_a_picture_or_a_line) {
  const auto found = std::filesystem::path(RELOOK_SOURCE_DIR).parent_path() / "shared/hostile/found/png16k_1bit.gltf";
  if (!std::filesystem::exists(found)) GTEST_SKIP() << "NOT TESTED: there is no " << found;
  expect_refused(render(found.string(), "1G"), "/images/I: the image of 16384x16384 pixels takes 1366 MiB");
}

}  // namespace
}  // namespace relook
