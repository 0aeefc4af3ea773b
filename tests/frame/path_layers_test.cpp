// Layers of frames of Integrator::path: one a light, which add up to the frame bit for bit; the others are those of
// Integrator::whitted, and a replay writes the files of full renders.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>

#include "base/parallel.h"
#include "frame/frame_layers.h"
#include "image/image_pieces.h"
#include "image/layers/layered_frame.h"
#include "layer_file.h"
#include "run_program.h"
#include "scene/light_sums.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr std::uint32_t kPathWidth = 72, kPathHeight = 66;  // tiles clipped on both sides

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

SceneState path_scene(TestScene which) {
  const SceneState state = test_scene(which, kPathWidth, kPathHeight);
  return {state.document(), state.scene().camera, state.pyramids(), Integrator::path};
}

class PathLayers : public testing::TestWithParam<TestScene> {
 protected:
  [[nodiscard]] LayerFile layers(const Scene& scene, const Image& image, PixelFormat format) const {
    return read_layers(encode_layered_exr({scene, image.view, image.frame, {}, format, &image.light_sums}, {}),
                       folder_ / "layers.exr");
  }
  ScratchFolder folder_{"path_layers"};
};

INSTANTIATE_TEST_SUITE_P(Scenes, PathLayers, testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                         [](const auto& scene) { return std::string(test_scene_name(scene.param)); });

constexpr ViewOptions kView{.samples = 3, .max_depth = 4, .integrator = Integrator::path};

TEST_P(PathLayers, one_a_light_add_up_to_the_frame_bit_for_bit) {
  const SceneState state = path_scene(GetParam());
  RenderStats stats;
  const Image image = render_with_sums(state.scene(), kView, stats);
  const LayerFile file = layers(state.scene(), image, PixelFormat::float32);
  std::vector<std::string> names;
  for (const LightSum& sum : light_sums(state.scene())) names.push_back(sum.name);
  EXPECT_EQ(file.layers_of_sum("relook:lights"), names);
  EXPECT_FALSE(file.attributes.contains("relook:paths"));
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::string name = std::array{"R", "G", "B"}[channel];
    const std::vector<float> total = file.sum("relook:lights", name);
    std::size_t different = 0;
    float brightest = 0;
    for (std::size_t i = 0; i < total.size(); ++i) {
      different += bits(total[i]) != bits(image.frame.pixels[i][static_cast<int>(channel)]) ? 1U : 0U;
      brightest = std::max(brightest, total[i]);
    }
    EXPECT_EQ(different, 0U) << name;
    EXPECT_GT(brightest, 0.01F) << name;
  }
}

TEST_P(PathLayers, are_the_same_when_sums_have_left_memory) {
  const SceneState state = path_scene(GetParam());
  RenderStats stats;
  Image image = render_with_sums(state.scene(), kView, stats);
  const auto encoded = [&](Residency* residency) {
    return encode_layered_exr(
        {state.scene(), kView, image.frame, {}, PixelFormat::float32, &image.light_sums, residency}, {});
  };
  const Bytes expected = encoded(nullptr);
  std::uint64_t most = 0;
  for (const PackedSums& sums : image.light_sums) most = std::max<std::uint64_t>(most, sums.bytes());
  ResidencyOptions options;
  options.memory_bytes = most + 1;
  options.process_bytes = nullptr;
  options.spill_folder = folder_ / ".";
  Residency residency(std::move(options));
  add_image_pieces(residency, image);
  for (std::size_t tile = 0; tile < image.light_sums.size(); ++tile)
    note_sums(residency, tile, image.light_sums[tile]);
  EXPECT_GT(std::ranges::count_if(image.light_sums, &PackedSums::empty), 0);
  set_thread_count(1);
  EXPECT_EQ(encoded(&residency), expected);
  set_thread_count(0);
}

TEST_P(PathLayers, of_first_hits_are_there_and_no_light_is_needed_for_them) {
  const SceneState state = path_scene(GetParam());
  RenderStats stats;
  const Image image = render_with_sums(state.scene(), kView, stats);
  const LayerFile file = layers(state.scene(), image, PixelFormat::half);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < std::size_t{kPathWidth} * kPathHeight; ++i) {
    if (file.channel("depth.Z")[i] == kFarDepth) continue;
    ++hits;
    float length = 0;
    for (const char* axis : {"N.X", "N.Y", "N.Z"}) length += file.channel(axis)[i] * file.channel(axis)[i];
    ASSERT_NEAR(length, 1, 1e-3F) << i;
    ASSERT_GT(file.channel("CryptoObject00.G")[i], 0.3F) << i;
  }
  EXPECT_GT(hits, kPathWidth * kPathHeight / 4U);
}

TEST(PathLayersOfAScene, albedo_is_the_base_color) {
  SceneBuilder builder;
  const int red = builder.material("Red", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.75, 0.25, 0.125, 1}}}}});
  builder.node("Plane", {{"mesh", builder.mesh("Plane", plane_mesh(50, 1), red)}});
  builder.light("Sun", {{"type", "directional"}}, {{"rotation", {-0.7071068, 0, 0, 0.7071068}}});
  builder.look_at({0, 5, 0.01F}, {0, 0, 0}, 40, 16, 16);
  const SceneState whitted = builder.state();
  const SceneState state(whitted.document(), whitted.scene().camera, whitted.pyramids(), Integrator::path);
  RenderStats stats;
  const Image image = render_with_sums(state.scene(), kView, stats);
  const ScratchFolder folder("path_albedo");
  const LayerFile file =
      read_layers(encode_layered_exr({state.scene(), kView, image.frame, {}, PixelFormat::half, &image.light_sums}, {}),
                  folder / "a.exr");
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(file.channel("albedo.R")[i], 0.75F);
    EXPECT_EQ(file.channel("albedo.G")[i], 0.25F);
    EXPECT_EQ(file.channel("albedo.B")[i], 0.125F);
    EXPECT_EQ(file.channel("N.Y")[i], 1.0F);
    EXPECT_NEAR(file.channel("depth.Z")[i], 5, 1e-2F);
  }
}

/// The layer is that of its definition, and as a mean about as large as the square of the error.
TEST_P(PathLayers, have_the_variance_that_halves_of_the_samples_tell) {
  const SceneState state = path_scene(GetParam());
  const auto render_of = [&](std::uint32_t samples) {
    ViewOptions view = kView;
    view.samples = samples;
    RenderStats stats;
    return render_with_sums(state.scene(), view, stats);
  };
  const Image image = render_of(16), first_half = render_of(8), converged = render_of(256);
  const LayerFile file = layers(state.scene(), image, PixelFormat::float32);
  double told = 0, found = 0;
  for (std::size_t i = 0; i < image.frame.pixels.size(); ++i) {
    const float mean = image.frame.pixels[i].g, difference = first_half.frame.pixels[i].g - mean;
    EXPECT_EQ(file.channel("variance.G")[i], difference * difference) << i;
    const double error = static_cast<double>(mean - converged.frame.pixels[i].g);
    // A bright dot that few samples meet would decide both sums.
    if (std::fabs(error) > 0.5) continue;
    told += static_cast<double>(file.channel("variance.G")[i]);
    found += error * error;
  }
  EXPECT_GT(told, 0.4 * found);
  EXPECT_LT(told, 8 * found) << "the whole set is stratified better than its halves";
}

TEST(PathLayersOfAScene, of_one_sample_a_pixel_know_no_variance) {
  const SceneState state = path_scene(TestScene::spheres);
  EXPECT_FALSE(FrameLayers(state.scene(), 1, PixelFormat::half).variance_column.has_value());
  EXPECT_TRUE(FrameLayers(state.scene(), 2, PixelFormat::half).variance_column.has_value());
}

TEST(PathLayersOfAReplay, are_those_of_full_renders) {
  const std::string scene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
  const ScratchFolder folder("path_layers_cli");
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  const auto relook = [](std::vector<std::string> words) {
    words.insert(words.begin(), RELOOK_PROGRAM);
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 0) << result.output;
  };
  std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": [
    {"name": "dim", "edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 40}]},
    {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                                "value": [0.1, 0.9, 0.1, 1]}]},
    {"name": "away", "edit": [{"op": "remove", "path": "/nodes/LeftSphere"}]}]})";
  const std::vector<std::string> view{"--resolution", "72x40", "--samples", "2", "--integrator", "path", "--quiet"};
  const auto with_view = [&](std::vector<std::string> words) {
    words.insert(words.end(), view.begin(), view.end());
    return words;
  };
  relook(with_view({"preprocess", scene, "-o", at("c")}));
  relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--aovs", "--float", "--quiet", "--verify"});
  relook({"replay", at("c"), at("j.json"), "-o", at("tight"), "--aovs", "--float", "--quiet", "--memory", "2G"});
  for (const std::string step : {"0", "1", "2", "3"}) {
    relook(with_view({"render", scene, "-o", at(step + ".exr"), "--aovs", "--float", "--journal", at("j.json"),
                      "--step", step}));
    const std::string frame = "/frames/000" + step + ".exr";
    EXPECT_EQ(frame_bytes(at(step + ".exr")), frame_bytes(at("run" + frame))) << step;
    EXPECT_EQ(frame_bytes(at("tight" + frame)), frame_bytes(at("run" + frame))) << step;
    const LayerFile file = read_layers(at(step + ".exr"));
    EXPECT_EQ(file.sum("relook:lights", "G"), file.channel("G")) << step;
  }
}

}  // namespace
}  // namespace relook
