// Depth of field: an edge out of focus is covered as the disc of a lens sees it, one in focus is as sharp as without;
// the command line takes the lens, caches and reports hold it.
#include <array>
#include <cmath>
#include <numbers>

#include "cli/cli_fixture.h"
#include "image/render.h"
#include "scenes/test_scenes.h"

namespace relook {
namespace {

constexpr std::uint32_t kSize = 32;
constexpr float kHeight = 5, kDegrees = 40;

/// A plane that begins at x = 0, looked down at from kHeight above the edge.
SceneState edge_scene() {
  SceneBuilder builder;
  const int grey = builder.material("Grey", Json::object());
  builder.node("Plane", {{"mesh", builder.mesh("Plane", plane_mesh(50, 1), grey)}, {"translation", {50, 0, 0}}});
  builder.light("Sun", {{"type", "directional"}}, {{"rotation", {-0.7071068, 0, 0, 0.7071068}}});
  builder.look_at({0, kHeight, 0}, {0, 0, 0.0001F}, kDegrees, kSize, kSize);
  const SceneState whitted = builder.state();
  return {whitted.document(), whitted.scene().camera, whitted.pyramids(), Integrator::path};
}

/// Coverage by column, a mean over the rows; of columns that run along x, from low to high or the other way round.
std::array<double, kSize> coverage(const Lens& lens) {
  const SceneState state = edge_scene();
  ViewOptions view{.samples = 64, .integrator = Integrator::path};
  view.lens = lens;
  RenderStats stats;
  const Frame frame = render(state.scene(), view, stats);
  std::array<double, kSize> columns{};
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    columns[i % kSize] += static_cast<double>(frame.pixels[i].a) / kSize;
  return columns;
}

/// The share of a disc of radius r about `x` that lies above 0.
double share_of_disc(double x, double r) {
  const double u = x / r;
  if (u <= -1) return 0;
  if (u >= 1) return 1;
  return 0.5 + (u * std::sqrt(1 - u * u) + std::asin(u)) / std::numbers::pi;
}

TEST(Lens, blurs_an_edge_by_how_far_it_is_out_of_focus) {
  const double across = kHeight * std::tan(kDegrees * std::numbers::pi / 360), pixel = 2 * across / kSize;
  for (const Lens lens : {Lens{0.2F, 2.5F}, Lens{0.4F, 10}, Lens{0.1F, 1}}) {
    const std::array<double, kSize> found = coverage(lens);
    const double sign = found.front() < found.back() ? 1 : -1;
    const auto radius = static_cast<double>(lens.radius * std::fabs(kHeight - lens.focus) / lens.focus);
    for (std::uint32_t column = 0; column < kSize; ++column) {
      double expected = 0;
      for (int part = 0; part < 16; ++part)
        expected += share_of_disc(sign * ((column + (part + 0.5) / 16) * pixel - across), radius) / 16;
      const double bound = 5 * std::sqrt(expected * (1 - expected) / (64 * kSize)) + 2e-3;
      EXPECT_NEAR(found[column], expected, bound) << "lens " << lens.radius << ", " << lens.focus << ", " << column;
    }
  }
}

TEST(Lens, leaves_what_is_in_focus_sharp) {
  const std::array<double, kSize> sharp = coverage({}), focused = coverage({0.3F, kHeight});
  for (std::uint32_t column = 0; column < kSize; ++column) EXPECT_NEAR(focused[column], sharp[column], 2e-3) << column;
}

class LensCli : public Cli {};

TEST_F(LensCli, is_of_the_cache_its_replays_and_their_reports) {
  write_text(at("j.json"), kJournal);
  const std::vector<std::string> view{"--resolution", "32x18", "--samples", "4", "--quiet"};
  const auto with_view = [&](std::vector<std::string> words, const std::string& lens) {
    words.insert(words.end(), view.begin(), view.end());
    if (!lens.empty()) words.insert(words.end(), {"--lens", lens});
    return words;
  };
  ASSERT_EQ(relook(with_view({"preprocess", kScene, "-o", at("c")}, "0.25:4")).exit_code, 0);
  EXPECT_EQ(relook(with_view({"preprocess", kScene, "-o", at("c")}, "0.25:4")).exit_code, 0) << "complete";
  expect_error(relook(with_view({"preprocess", kScene, "-o", at("c")}, "0.25:5")), 1, "--lens (0.25:4)");
  expect_error(relook(with_view({"preprocess", kScene, "-o", at("c")}, "")), 1, "--lens (0.25:4)");
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("r"), "--verify", "--float", "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_json(at("r/report.json"))["options"]["lens"], (Json{0.25, 4.0}));
  EXPECT_NE(relook({"inspect", at("c")}).output.find("lens 0.25:4"), std::string::npos);
  ASSERT_EQ(relook(with_view({"render", kScene, "--float", "-o", at("f.exr")}, "0.25:4")).exit_code, 0);
  ASSERT_EQ(relook(with_view({"render", kScene, "--float", "-o", at("sharp.exr")}, "")).exit_code, 0);
  EXPECT_EQ(relook({"compare", at("f.exr"), at("r/frames/0000.exr"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(relook({"compare", at("f.exr"), at("sharp.exr"), "--quiet"}).exit_code, 10);
}

TEST_F(LensCli, refuses_what_is_no_lens) {
  for (const char* text : {"1", "0:1", "1:0", "-1:2", "1:2:3", "nan:1", "1:inf", "a:b", "1e10:1"}) {
    expect_error(relook({"render", kScene, "-o", at("x.exr"), "--lens=" + std::string(text)}), 1, "--lens");
    EXPECT_FALSE(std::filesystem::exists(at("x.exr")));
  }
  expect_error(relook({"render", kScene, "-o", at("x.exr"), "--lens", "0.1:1", "--integrator", "whitted"}), 1,
               "it is for --integrator path");
}

}  // namespace
}  // namespace relook
