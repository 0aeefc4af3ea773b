// Layers for compositing: they add up to the frame bit for bit, show what the scene says, and come out of a replay as
// out of a full render.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "edit/apply.h"
#include "frame/cryptomatte.h"
#include "frame/exact_sum.h"
#include "image/layers/layered_frame.h"
#include "layer_file.h"
#include "run_program.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr std::uint32_t kLayersWidth = 96, kLayersHeight = 72;  // tiles clipped on both sides

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

class Layers : public testing::TestWithParam<TestScene> {
 protected:
  [[nodiscard]] LayerFile layers(const SceneState& state, std::uint32_t samples, PixelFormat format,
                                 const ChangedPixels& changed = {}) {
    const ViewOptions view{samples, 6, 0};
    const Frame frame = rendered(state.scene(), view);
    return read_layers(encode_layered_exr({state.scene(), view, frame, changed, format}, {}), folder_ / "layers.exr");
  }
  ScratchFolder folder_{"layers"};
};

INSTANTIATE_TEST_SUITE_P(Scenes, Layers, testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                         [](const auto& scene) { return std::string(test_scene_name(scene.param)); });

TEST(ExactSum, hits_every_total) {
  std::mt19937 random(20260101);
  const auto any_float = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random())); };
  for (int round = 0; round < 200'000; ++round) {
    std::vector<float> terms(static_cast<std::size_t>(2 + round % 5));
    for (float& term : terms)
      term = round % 3 == 0 ? any_float() : std::ldexp(any_float() > 0 ? 1.37F : -0.91F, round % 40 - 20);
    const float total = round % 2 == 0 ? any_float() : std::ldexp(1.001F, round % 37 - 18);
    if (std::isnan(total) || (bits(total) << 1 != 0 && (bits(total) >> 23 & 0xFFU) == 0)) continue;  // no denormal
    settle_sum(terms, total);
    float sum = terms[0];
    for (std::size_t i = 1; i < terms.size(); ++i) sum += terms[i];
    ASSERT_EQ(bits(sum), bits(total)) << round;
  }
}

TEST(ExactSum, keeps_terms_that_nearly_add_up) {
  std::vector<float> terms{0.1F, 0.2F, 0.7F, 0};
  settle_sum(terms, 1.0009765625F);
  EXPECT_EQ(terms[0], 0.1F);
  EXPECT_EQ(terms[1], 0.2F);
  EXPECT_EQ(terms[2], 0.7F);
}

TEST(ExactSum, gives_what_no_rest_can_mend_to_the_rest) {
  for (const float total : {-0.0F, 1e-35F}) {
    std::vector<float> terms{0.5F, 3.0F, 0};
    settle_sum(terms, total);
    EXPECT_EQ(bits(terms[0]), bits(-0.0F));
    EXPECT_EQ(bits(terms[2]), bits(total));
  }
}

TEST_P(Layers, add_up_to_the_frame_bit_for_bit) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  for (const PixelFormat format : {PixelFormat::half, PixelFormat::float32}) {
    const LayerFile file = layers(state, 3, format);
    for (const char* sum : {"relook:lights", "relook:paths"})
      for (const char* channel : {"R", "G", "B"}) {
        const std::vector<float> total = file.sum(sum, channel);
        const std::vector<float>& expected = file.channel(channel);
        std::size_t different = 0;
        for (std::size_t i = 0; i < total.size(); ++i) different += bits(total[i]) != bits(expected[i]) ? 1U : 0U;
        EXPECT_EQ(different, 0U) << sum << " " << channel;
      }
  }
}

TEST_P(Layers, leave_no_more_to_the_rest_than_rounding) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const LayerFile file = layers(state, 3, PixelFormat::float32);
  for (const char* sum : {"relook:lights", "relook:paths"})
    for (const char* channel : {"R", "G", "B"}) {
      const std::vector<float>& rest = file.channel(file.layers_of_sum(sum).back() + "." + channel);
      const std::vector<float>& frame = file.channel(channel);
      for (std::size_t i = 0; i < rest.size(); ++i)
        ASSERT_LE(std::fabs(rest[i]), 1e-5F * frame[i] + 1e-30F) << sum << i;
    }
}

TEST_P(Layers, of_a_light_show_the_scene_lit_by_it_alone) {
  SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const LayerFile file = layers(state, 1, PixelFormat::float32);
  const LightId kept = state.scene().light_order.front();
  const std::string layer = file.layers_of_sum("relook:lights").front();
  EXPECT_EQ(layer, "light_" + state.scene().light(kept).node);
  Scene alone = state.scene();
  for (const LightId light : alone.light_order)
    if (light != kept) alone.lights[light.index()].intensity = 0;
  alone.ambient = Color(0, 0, 0);
  alone.environment.intensity = 0;
  for (Material& material : alone.materials) {
    material.emissive = Color(0, 0, 0);
    if (material.model == IlluminationModel::unlit) material.base_color = Rgba(0, 0, 0, material.base_color.a);
  }
  const Frame frame = rendered(alone, {1, 6, 0});
  const std::vector<float>& green = file.channel(layer + ".G");
  float brightest = 0;
  for (std::size_t i = 0; i < green.size(); ++i) {
    ASSERT_NEAR(green[i], frame.pixels[i].g, 1e-5F * (1 + frame.pixels[i].g)) << i;
    brightest = std::max(brightest, green[i]);
  }
  EXPECT_GT(brightest, 0.01F);
}

TEST_P(Layers, leave_the_frame_as_it_is) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const LayerFile file = layers(state, 2, PixelFormat::half);
  const Frame frame = rendered(state.scene(), {2, 6, 0});
  const Frame plain = decode_exr(encode_exr(frame, {}, PixelFormat::half), "plain");
  for (std::size_t i = 0; i < plain.pixels.size(); ++i)
    ASSERT_EQ(Rgba(file.channel("R")[i], file.channel("G")[i], file.channel("B")[i], file.channel("A")[i]),
              plain.pixels[i]);
}

TEST_P(Layers, place_every_hit_in_its_pixel) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const Camera& camera = state.scene().camera;
  const LayerFile file = layers(state, 1, PixelFormat::half);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < file.channel("depth.Z").size(); ++i) {
    const float depth = file.channel("depth.Z")[i];
    const auto triple = [&](const std::string& layer) {
      return Point(file.channel(layer + ".X")[i], file.channel(layer + ".Y")[i], file.channel(layer + ".Z")[i]);
    };
    const Normal normal = triple("N");
    if (depth == 1e10F) {
      EXPECT_EQ(normal, Normal(0, 0, 0));
      EXPECT_EQ(file.channel("CryptoObject00.G")[i], 0.0F);
      continue;
    }
    ++hits;
    const CameraRay ray =
        camera_ray(camera, static_cast<float>(i % kLayersWidth) + 0.5F, static_cast<float>(i / kLayersWidth) + 0.5F);
    const Point along = ray.origin + ray.direction * (depth / ray.direction.dot(camera.forward));
    const Point in_world(WidePoint(along) + camera.eye);
    EXPECT_LT((in_world - triple("P")).length(), 1e-3F * depth) << i;
    EXPECT_NEAR(normal.length(), 1, 1e-4F);
    EXPECT_EQ(file.channel("CryptoObject00.G")[i], 1.0F);
  }
  EXPECT_GT(hits, kLayersWidth * kLayersHeight / 4U);
}

TEST_P(Layers, name_what_covers_a_pixel) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const LayerFile file = layers(state, 4, PixelFormat::half);
  std::map<std::uint32_t, std::string> names;
  for (const auto& [key, text] : file.attributes) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/manifest")) continue;
    const Json manifest = parse_json(text, "manifest");
    for (const auto& [name, id] : manifest.items())
      names[static_cast<std::uint32_t>(std::stoul(id.get<std::string>(), nullptr, 16))] = name;
  }
  std::map<std::string, double> shown;
  for (const char* layer : {"CryptoObject", "CryptoMaterial"})
    for (std::size_t i = 0; i < std::size_t{kLayersWidth} * kLayersHeight; ++i) {
      float last = 1, total = 0;
      for (const auto& [id, coverage] :
           {std::pair{"00.R", "00.G"}, {"00.B", "00.A"}, {"01.R", "01.G"}, {"01.B", "01.A"}}) {
        const float share = file.channel(std::string(layer) + coverage)[i];
        EXPECT_LE(share, last);
        last = share;
        total += share;
        if (share == 0) continue;
        const auto found = names.find(bits(file.channel(std::string(layer) + id)[i]));
        ASSERT_NE(found, names.end());
        shown[found->second] += share;
      }
      EXPECT_LE(total, 1.0F);
    }
  EXPECT_GT(shown["Ground"], 100);
}

TEST(FirstHit, albedo_of_an_untextured_material_is_its_base_color) {
  SceneBuilder builder;
  const int red = builder.material("Red", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.75, 0.25, 0.125, 1}}}}});
  builder.node("Plane", {{"mesh", builder.mesh("Plane", plane_mesh(50, 1), red)}});
  builder.light("Sun", {{"type", "directional"}}, {{"rotation", {-0.7071068, 0, 0, 0.7071068}}});
  builder.look_at({0, 5, 0.01F}, {0, 0, 0}, 40, 16, 16);
  const SceneState state = builder.state();
  const ViewOptions view{1, 6, 0};
  const Frame frame = rendered(state.scene(), view);
  const ScratchFolder folder("albedo");
  const LayerFile file =
      read_layers(encode_layered_exr({state.scene(), view, frame, {}, PixelFormat::half}, {}), folder / "a.exr");
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(file.channel("albedo.R")[i], 0.75F);
    EXPECT_EQ(file.channel("albedo.G")[i], 0.25F);
    EXPECT_EQ(file.channel("albedo.B")[i], 0.125F);
    EXPECT_EQ(file.channel("N.Y")[i], 1.0F);
    EXPECT_NEAR(file.channel("depth.Z")[i], 5, 1e-2F);
    // uv runs from 0 to 1 over the 100 metres of the plane.
    EXPECT_NEAR(file.channel("uv.U")[i], file.channel("P.X")[i] / 100 + 0.5F, 1e-5F);
  }
}

TEST_P(Layers, mark_the_pixels_that_changed) {
  const SceneState state = test_scene(GetParam(), kLayersWidth, kLayersHeight);
  const std::vector<std::uint32_t> pixels{0, 63, 64, kLayersWidth * 70 + 95};
  const LayerFile file = layers(state, 1, PixelFormat::half, ChangedPixels(pixels, kLayersWidth));
  for (std::uint32_t i = 0; i < kLayersWidth * kLayersHeight; ++i)
    EXPECT_EQ(file.channel("changed.A")[i], std::ranges::count(pixels, i) > 0 ? 1.0F : 0.0F) << i;
}

// Values of SMHasher's reference implementation, as widely quoted.
TEST(Cryptomatte, hashes_as_murmur3) {
  EXPECT_EQ(murmur3(""), 0U);
  EXPECT_EQ(murmur3("hello"), 0x248BFA47U);
  EXPECT_EQ(murmur3("hello, world"), 0x149BBB7FU);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2E4FF723U);
}

// The values that the specification's authors test their own plug-ins with.
TEST(Cryptomatte, ids_are_those_of_other_programs) {
  const std::pair<const char*, float> ids[]{
      {"hello", 6.0705627102400005616e-17F},    {"cube", -4.08461912519e+15F},
      {"sphere", 2.79018604383e+15F},           {"plane", 3.66557617593e-11F},
      {"равнина", -1.3192631212399999468e-25F}, {"mädchen", 6.2361298211599995797e+25F}};
  for (const auto& [name, id] : ids)
    EXPECT_FLOAT_EQ(std::bit_cast<float>(cryptomatte_id(name)), id) << name;  // quoted to 12 digits
}

TEST(Cryptomatte, ids_are_normal_numbers) {
  EXPECT_EQ(cryptomatte_id(""), 1U << 23);
  for (int i = 0; i < 20'000; ++i) {
    const float id = std::bit_cast<float>(cryptomatte_id("object" + std::to_string(i)));
    ASSERT_TRUE(std::isnormal(id)) << i;
  }
}

TEST(Cryptomatte, ranks_by_coverage) {
  const Cryptomatte matte("CryptoObject", 8);
  EXPECT_EQ(matte.channel_count(), 12U);
  std::vector<float> out(12);
  const std::uint32_t a = cryptomatte_id("a"), b = cryptomatte_id("b"), c = cryptomatte_id("c");
  matte.rank(std::vector{c, a, b, b, a, b}, out);
  EXPECT_EQ(bits(out[0]), b);
  EXPECT_EQ(out[1], 3.0F / 8);
  EXPECT_EQ(bits(out[2]), a);
  EXPECT_EQ(out[3], 2.0F / 8);
  EXPECT_EQ(bits(out[4]), c);
  EXPECT_EQ(out[7], 0.0F);
}

}  // namespace
}  // namespace relook
