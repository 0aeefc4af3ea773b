// Images of the formats that extensions bring, and which of a texture's images is read.
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <fstream>

#include "base/error.h"
#include "base/import_memory.h"
#include "gltf_writer.h"
#include "run_program.h"
#include "scene/gltf/import.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

/// Lossless, colours below alpha 0 kept.
std::string webp(const std::vector<std::uint8_t>& rgba, int width, int height) {
  WebPConfig config;
  WebPPicture picture;
  WebPMemoryWriter writer;
  EXPECT_TRUE(WebPConfigInit(&config) && WebPPictureInit(&picture));
  config.lossless = config.exact = 1;
  picture.use_argb = 1;
  picture.width = width;
  picture.height = height;
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  WebPMemoryWriterInit(&writer);
  EXPECT_TRUE(WebPPictureImportRGBA(&picture, rgba.data(), 4 * width) && WebPEncode(&config, &picture));
  std::string bytes(reinterpret_cast<const char*>(writer.mem), writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  return bytes;
}

const std::vector<std::uint8_t> kTexels = {200, 100, 50, 255, 200, 100, 50, 128, 200, 100, 50, 0, 1, 2, 3, 1};

std::shared_ptr<const TexturePyramid> decoded(const std::string& bytes) {
  return decode_pyramid(std::as_bytes(std::span(bytes)), false, "scene", "/images/0");
}
std::string decoding_fault(const std::string& bytes) {
  try {
    (void)decoded(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(WebpImages, colours_are_as_stored_whatever_alpha_is) {
  const auto pyramid = decoded(webp(kTexels, 2, 2));
  const TexturePyramid::Level& level = pyramid->levels.front();
  ASSERT_EQ(level.width, 2U);
  for (std::size_t i = 0; i < kTexels.size(); ++i)
    EXPECT_EQ(pyramid->texels8.at(4 * level.offset + i), kTexels[i]) << i;
}

TEST(WebpImages, damage_is_refused) {
  const std::string whole = webp(kTexels, 2, 2);
  for (std::size_t bytes = 12; bytes + 2 < whole.size(); ++bytes) EXPECT_NE(decoding_fault(whole.substr(0, bytes)), "");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x41);
    (void)decoding_fault(damaged);  // an answer, whichever
  }
}

TEST(WebpImages, a_small_file_of_many_pixels_is_bounded_before_it_is_decoded) {
  constexpr int kSide = 3000;  // one colour: some 60 bytes
  const std::string bytes = webp(std::vector<std::uint8_t>(std::size_t{4} * kSide * kSide, 7), kSide, kSide);
  EXPECT_LT(bytes.size(), 1000U);
  EXPECT_EQ(decoding_fault(bytes), "");
  set_import_memory(std::uint64_t{64} << 20);
  EXPECT_NE(decoding_fault(bytes).find("--import-memory"), std::string::npos) << decoding_fault(bytes);
  set_import_memory(kImportMemory);
}

/// RIFF, VP8X with the flag of an animation.
std::string animated() {
  std::string bytes("RIFF\x16\0\0\0WEBPVP8X\x0A\0\0\0\x02\0\0\0\x01\0\0\x01\0\0", 30);
  return bytes;
}

TEST(WebpImages, an_animated_one_is_refused_in_a_line) {
  EXPECT_EQ(decoding_fault(animated()), "scene: /images/0: cannot decode the image: an animated WebP image");
}

class TextureSources : public testing::Test {
 protected:
  /// `textures` over an animated WebP, a WebP, a KTX2 and another WebP image, drawn on a square.
  [[nodiscard]] std::filesystem::path scene(const Json& texture, bool is_drawn = true) const {
    SceneFile file = square();
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2", 2);
    for (const std::string& bytes : {animated(), webp(kTexels, 2, 2), std::string("\xABKTX 20\xBB\r\n\x1A\n and more"),
                                     webp(std::vector<std::uint8_t>(4, 9), 1, 1)})
      file.gltf["images"].push_back(
          {{"bufferView", file.add_view<char>({bytes.begin(), bytes.end()})}, {"mimeType", "image/webp"}});
    file.gltf["images"][2]["name"] = "Wood";
    file.gltf["textures"] = {texture};
    if (!is_drawn) file.gltf["materials"][0].erase("pbrMetallicRoughness");
    std::ofstream(folder_ / "scene.glb", std::ios::binary) << file.glb();
    return folder_ / "scene.glb";
  }
  [[nodiscard]] static Json extended(const char* name, std::size_t source) {
    return {{"extensions", {{name, {{"source", source}}}}}};
  }

  ScratchFolder folder_{"texture_sources"};
};

TEST_F(TextureSources, the_image_that_is_read) {
  const auto source = [&](const Json& texture) {
    return import_gltf(scene(texture)).gltf["textures"][0].value("source", std::size_t{99});
  };
  Json webp_texture = extended("EXT_texture_webp", 1), ktx = extended("KHR_texture_basisu", 2);
  EXPECT_EQ(source(webp_texture), 1U);
  webp_texture["source"] = 3;
  EXPECT_EQ(source(webp_texture), 1U) << "the extension's goes before the other";
  webp_texture["extensions"]["EXT_texture_webp"]["source"] = 0;
  EXPECT_EQ(source(webp_texture), 3U) << "an animated image does not";
  ktx["source"] = 3;
  EXPECT_EQ(source(ktx), 3U);
  const auto warnings = import_gltf(scene(ktx)).warnings;
  EXPECT_EQ(
      std::ranges::count(warnings, "KHR_texture_basisu: the other images of 1 texture are read instead of KTX2 images"),
      1);
  EXPECT_THROW((void)source(extended("EXT_texture_webp", 9)), InputError);
}

TEST_F(TextureSources, a_ktx2_image_without_another_is_refused_where_it_is_drawn) {
  const auto run = [&](bool is_drawn) {
    return run_program({RELOOK_PROGRAM, "render", scene(extended("KHR_texture_basisu", 2), is_drawn).string(), "-o",
                        (folder_ / "frame.exr").string(), "--resolution", "8x8", "--lights", "auto"});
  };
  const ProgramResult drawn = run(true);
  EXPECT_EQ(drawn.exit_code, 2);
  EXPECT_NE(drawn.output.find("/images/Wood: KTX2 images (KHR_texture_basisu) are not supported; `gltf-transform "
                              "ktxdecompress IN.glb OUT.glb` makes PNG images of them"),
            std::string::npos)
      << drawn.output;
  const ProgramResult unused = run(false);
  EXPECT_EQ(unused.exit_code, 0) << unused.output;
}

}  // namespace
}  // namespace relook
