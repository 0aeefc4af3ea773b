// glTF samplers: which texels a lookup takes, by filter and level; in pictures, and after edits.
#include <gtest/gtest.h>

#include <cmath>

#include "image/render.h"
#include "replay/replay.h"
#include "scene/gltf/import.h"
#include "scene/texture/texture.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// 4 x 4 texels of value x + 4 y: level 1 has 2 i + 8 j + 2.5, level 2 has 7.5.
TexturePyramid ramp() {
  std::vector<float> texels;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) texels.insert(texels.end(), 4, static_cast<float>(x + 4 * y));
  return build_pyramid(4, 4, std::move(texels));
}

TEST(TextureFilters, take_the_texels_that_their_names_say) {
  // At uv (0.3, 0.8): level 0 has texel (1, 3) = 13, mixed (x, y) = (0.7, 2.7): 11.5; level 1 has texel (0, 1) = 10.5,
  // mixed (0.1, 1 clamped from 1.1): 10.7; level 2 has 7.5.
  struct Case {
    TexelFilter minified;
    LevelFilter levels;
    double at_quarter, at_three_quarters, at_one_and_a_quarter, far_away;  // by level
  };
  const std::vector<Case> cases = {
      {TexelFilter::nearest, LevelFilter::full, 13, 13, 13, 13},
      {TexelFilter::linear, LevelFilter::full, 11.5, 11.5, 11.5, 11.5},
      {TexelFilter::nearest, LevelFilter::nearest, 13, 10.5, 10.5, 7.5},
      {TexelFilter::linear, LevelFilter::nearest, 11.5, 10.7, 10.7, 7.5},
      {TexelFilter::nearest, LevelFilter::linear, 12.375, 11.125, 9.75, 7.5},
      {TexelFilter::linear, LevelFilter::linear, 11.3, 10.9, 9.9, 7.5},
  };
  const TexturePyramid pyramid = ramp();
  for (const TexelFilter magnified : {TexelFilter::nearest, TexelFilter::linear})
    for (const Case& c : cases) {
      const TextureSampler sampler{Wrap::clamp, Wrap::clamp, magnified, c.minified, c.levels};
      const auto at = [&](float level) { return sample(pyramid, Uv(0.3F, 0.8F), level, sampler).r; };
      SCOPED_TRACE(std::to_string(static_cast<int>(c.minified)) + std::to_string(static_cast<int>(c.levels)));
      for (const float level : {-127.0F, -2.0F, 0.0F})
        EXPECT_NEAR(at(level), magnified == TexelFilter::nearest ? 13 : 11.5, 1e-5);
      EXPECT_NEAR(at(0.25F), c.at_quarter, 1e-5);
      EXPECT_NEAR(at(0.75F), c.at_three_quarters, 1e-5);
      EXPECT_NEAR(at(1.25F), c.at_one_and_a_quarter, 1e-5);
      for (const float level : {2.0F, 9.0F, std::numeric_limits<float>::infinity()})
        EXPECT_NEAR(at(level), c.far_away, 1e-5);
      EXPECT_NEAR(at(std::numeric_limits<float>::quiet_NaN()), at(0), 0);
    }
}

/// A card of 16 x 16 black and white texels, straight before the camera.
SceneState checkered_card(std::uint32_t size) {
  std::vector<std::uint8_t> texels;
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) {
      texels.insert(texels.end(), 3, (x + y) % 2 == 0 ? 255 : 0);
      texels.push_back(255);
    }
  SceneBuilder scene;
  const auto pyramid = std::make_shared<TexturePyramid>(build_pyramid(TexelFormat::srgb8, 16, 16, std::move(texels)));
  Json material;
  material["extensions"]["KHR_materials_unlit"] = Json::object();
  material["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", scene.texture("Checks", scene.image("ChecksImage", pyramid))}};
  scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(1, 1), scene.material("Card", material))}});
  scene.look_orthographic(Point(0, 0, 3), Point(0, 0, 0), 1, size, size);
  return scene.state();
}

double greyest(const Frame& frame) {  // 0: black and white only; 1: middle grey somewhere
  double grey = 0;
  for (const Rgba& pixel : frame.pixels) grey = std::max(grey, 1 - std::fabs(2 * static_cast<double>(pixel.r) - 1));
  return grey;
}

TEST(TextureFilters, editing_them_gives_the_picture_of_a_full_render) {
  // 7 pixels over 16 texels: every pixel is a minified lookup between levels 1 and 2. 64 pixels: magnified.
  for (const std::uint32_t size : {7U, 64U}) {
    const ViewOptions view{1, 2, 0};
    SceneState state = checkered_card(size);
    Image image = preprocessed(state.scene(), view);
    Replayer replayer(std::move(state), std::move(image));
    replayer.step(edit_of(Json::array({{{"op", "add"}, {"path", "/samplers/S"}, {"value", Json::object()}},
                                       {{"op", "add"}, {"path", "/textures/Checks/sampler"}, {"value", "S"}}})),
                  "", ".");
    for (const char* filter : {"magFilter", "minFilter"})
      for (const int value : {9728, 9984, 9985, 9986, 9987, 9729}) {
        if (value > 9729 && std::string(filter) == "magFilter") continue;
        const StepResult step = replayer.step(
            edit_of(Json::array({{{"op", "add"}, {"path", std::string("/samplers/S/") + filter}, {"value", value}}})),
            "", ".");
        EXPECT_EQ(step.counters.ray_updates, 0U) << "a colour edit";
        const Frame& frame = replayer.image().frame;
        EXPECT_EQ(different_pixels(frame, rendered(replayer.state().scene(), view)).size(), 0U) << filter << value;
        const bool is_sharp = value == 9728 && (std::string(filter) == "minFilter") == (size == 7);
        EXPECT_EQ(greyest(frame) == 0, is_sharp) << filter << " " << value << ", " << size << " pixels";
      }
  }
}

TEST(TextureFilters, khronos_texture_sampler_models_read_as_named) {
  // Asset generator, Texture_Sampler: 05 magFilter NEAREST, 06 LINEAR; 07 .. 12 minFilter in the order of the numbers.
  const std::filesystem::path folder =
      std::filesystem::path(RELOOK_SOURCE_DIR) / "../shared/assets/khronos-asset-generator-0.6/Texture_Sampler";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: samplers of files are NOT tested";
  const auto sampler_of = [&](const char* number) {
    LookDocument document =
        make_look_document(import_gltf(folder / ("Texture_Sampler_" + std::string(number) + ".gltf")));
    const Camera camera = choose_camera(document, "auto", 8, 8);
    const SceneState state(std::move(document), camera, std::make_shared<PyramidStore>());
    for (const Material& material : state.scene().materials)
      if (material.slot(Slot::base_color).kind == TextureKind::image) return material.slot(Slot::base_color).sampler;
    ADD_FAILURE() << number << " has no texture";
    return TextureSampler{};
  };
  EXPECT_EQ(sampler_of("05").magnified, TexelFilter::nearest);
  EXPECT_EQ(sampler_of("06").magnified, TexelFilter::linear);
  const std::vector<std::pair<TexelFilter, LevelFilter>> by_number = {
      {TexelFilter::nearest, LevelFilter::full},    {TexelFilter::linear, LevelFilter::full},
      {TexelFilter::nearest, LevelFilter::nearest}, {TexelFilter::linear, LevelFilter::nearest},
      {TexelFilter::nearest, LevelFilter::linear},  {TexelFilter::linear, LevelFilter::linear}};
  const char* const numbers[] = {"07", "08", "09", "10", "11", "12"};
  for (std::size_t i = 0; i < by_number.size(); ++i) {
    const TextureSampler sampler = sampler_of(numbers[i]);
    EXPECT_EQ(sampler.minified, by_number[i].first) << numbers[i];
    EXPECT_EQ(sampler.levels, by_number[i].second) << numbers[i];
  }
}

}  // namespace
}  // namespace relook
