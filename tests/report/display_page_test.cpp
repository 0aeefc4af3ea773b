// How the page of a run shows frames: its curves against the previews' bytes, scopes and regions against numbers worked
// out here, WebGL against the canvas; and the lattice of a display view against the view.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "base/files.h"
#include "frame/deflate.h"
#include "frame/frame_file.h"
#include "page/view_lut.h"
#include "page_browser.h"
#include "synthetic_run.h"

namespace relook {
namespace {

float srgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

/// As the views of studios are: some red into green, a shoulder, sRGB codes; not clamped.
class Shoulder final : public DisplayView {
 public:
  [[nodiscard]] Rgba apply(const Rgba& linear) const override {
    const auto shown = [](float light) { return srgb(std::max(0.0F, 1.1F * light / (light + 0.6F))); };
    return {shown(linear.r), shown(0.9F * linear.g + 0.1F * linear.r), shown(linear.b), 1};
  }
  [[nodiscard]] std::string id() const override { return "shoulder"; }
  [[nodiscard]] std::string name() const override { return "Wall, <b>Shoulder</b>"; }
};

class PlainSrgb final : public DisplayView {
 public:
  [[nodiscard]] Rgba apply(const Rgba& linear) const override {
    return {srgb(linear.r), srgb(linear.g), srgb(linear.b), 1};
  }
  [[nodiscard]] std::string id() const override { return "srgb"; }
  [[nodiscard]] std::string name() const override { return "sRGB"; }
};

double code(float value) { return value > 0 ? std::min(value, 1.0F) * 255.0 : 0.0; }

TEST(ViewLut, is_as_far_off_as_it_says) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> stops(-10, 5);
  const Shoulder shoulder;
  const PlainSrgb plain;
  for (const DisplayView* view : std::initializer_list<const DisplayView*>{&shoulder, &plain}) {
    const ViewLut lut(*view);
    EXPECT_LT(lut.error().mean, 0.25) << view->id();
    EXPECT_LT(lut.error().most, 1.5) << view->id();
    double mean = 0, most = 0;
    constexpr int kCount = 20'000;
    for (int i = 0; i < kCount; ++i) {
      const Rgba linear(std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random)), 1);
      const Rgba wanted = view->apply(linear), found = lut.show(linear);
      for (int channel = 0; channel < 3; ++channel) {
        const double error = std::abs(code(wanted[channel]) - code(found[channel]));
        mean += error / (3.0 * kCount);
        most = std::max(most, error);
      }
    }
    EXPECT_LT(mean, lut.error().mean * 1.2 + 0.02) << view->id();
    EXPECT_LT(most, lut.error().most * 1.2 + 0.02) << view->id();
    for (const float dark : {0.0F, -3.0F}) EXPECT_NEAR(lut.show({dark, dark, dark, 1}).g, 0, 1e-4F);
    const Rgba bright = lut.show({1e9F, 1e9F, 1e9F, 1});
    EXPECT_NEAR(bright.r, view->apply({32, 32, 32, 1}).r, 1e-3F) << "beyond its range it is as at its end";
  }
}

TEST(ViewLut, holds_views_that_give_no_numbers) {
  class Broken final : public DisplayView {
    [[nodiscard]] Rgba apply(const Rgba& linear) const override { return {std::sqrt(-1 - linear.r), 1e30F, -1e30F, 1}; }
    [[nodiscard]] std::string id() const override { return ""; }
    [[nodiscard]] std::string name() const override { return ""; }
  };
  const Rgba shown = ViewLut(Broken()).show({0.5F, 0.5F, 0.5F, 1});
  EXPECT_LE(shown.r, 0);
  EXPECT_GE(shown.g, 1);
  EXPECT_LE(shown.b, 0);
}

TEST(ViewLut, is_small_in_a_page) {
  const Json json = view_lut_json(Shoulder());
  EXPECT_EQ(json["name"], "Wall, <b>Shoulder</b>");
  EXPECT_LT(json["codes"].get<std::string>().size(), 260'000U);
}

Rgba of_halves(std::uint16_t r, std::uint16_t g, std::uint16_t b, float alpha) {
  const auto value = [](std::uint16_t bits) { return static_cast<float>(half(half::FromBits, bits)); };
  return {value(r), value(g), value(b), alpha};
}

/// All halves, those that are no numbers, too.
Rgba all_halves(std::uint32_t x, std::uint32_t y) {
  const std::uint32_t i = y * 256 + x;
  return of_halves(static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(i * 7919),
                   static_cast<std::uint16_t>(i * 40503 + 12345), static_cast<float>(x) / 255);
}

/// Grey, a stop more at the upper left, red four times white beside it, a pixel below zero and one that is no number.
Rgba known(std::uint32_t x, std::uint32_t y) {
  if (x == 10 && y == 200) return {-1, 0.5F, 0.5F, 1};
  if (x == 20 && y == 200) return {std::nanf(""), 0.5F, 0.5F, 1};
  if (x < 64 && y < 32) return {0.36F, 0.36F, 0.36F, 1};
  if (x < 128 && y < 16) return {4, 0.25F, 0.25F, 1};
  return {0.18F, 0.18F, 0.18F, x < 128 ? 1.0F : 0.5F};
}

/// Rows of the page's table, in double precision.
Json rows_of(const Frame& frame, std::uint32_t x0, std::uint32_t y0, std::uint32_t width, std::uint32_t height,
             double gain) {
  std::array<double, 4> least, sum{}, most;
  least.fill(1e30);
  most.fill(-1e30);
  double count = 0;
  for (std::uint32_t y = y0; y < y0 + height; ++y) {
    for (std::uint32_t x = x0; x < x0 + width; ++x) {
      const Rgba& pixel = frame.pixels[std::size_t{y} * frame.width + x];
      const std::array<double, 4> values{pixel.r, pixel.g, pixel.b,
                                         0.2126 * pixel.r + 0.7152 * pixel.g + 0.0722 * pixel.b};
      if (std::isnan(values[3])) continue;
      count += 1;
      for (std::size_t k = 0; k < 4; ++k) {
        least[k] = std::min(least[k], values[k]);
        sum[k] += values[k];
        most[k] = std::max(most[k], values[k]);
      }
    }
  }
  for (double& value : sum) value /= count;
  Json rows;
  for (const auto& [name, values] : {std::pair("b-min", least), std::pair("b-mean", sum), std::pair("b-max", most)})
    rows[name] = {values[0], values[1], values[2], values[3], std::log2(values[3] * gain / 0.18)};
  return {{"region", {x0, y0, width, height}}, {"rows", rows}};
}

/// A run of two frames, all halves and the known one, and what a browser must find.
Json made_run(SyntheticRun& run, const std::filesystem::path& folder) {
  run.add(0);
  run.add(1);
  run.write_report();
  run.write_page();
  Json expected = page_expectations(folder, false);
  const double gain = std::exp2(run.previews.exposure);
  const Frame frame = decode_exr(folder / "frames/0001.exr");
  expected["light"] = {{"whole", rows_of(frame, 0, 0, 256, 256, gain)},
                       {"region", rows_of(frame, 48, 8, 32, 16, gain)}};
  expected["marks"] = {{"above", gain >= 1 && !run.previews.view ? 64 * 16 : 0}, {"below", 1}, {"undefined", 1}};
  return expected;
}

TEST(DisplayPage, shows_the_previews_bytes_and_known_numbers) {
  const ScratchFolder folder("display_page");
  SyntheticRun run(folder / "run", 256, 256, [](std::size_t i, std::uint32_t x, std::uint32_t y) {
    return i == 0 ? all_halves(x, y) : known(x, y);
  });
  Json expected = made_run(run, folder / "run");
  expected["previews"] = {{{"entry", 0}, {"file", "previews/0000.png"}, {"within", 0}},
                          {{"entry", 1}, {"file", "previews/0001.png"}, {"within", 0}}};
  const auto at = [](int x, int y, const char* display, std::array<int, 3> codes) {
    return Json{{"x", x}, {"y", y}, {"display", display}, {"code", codes}};
  };
  // Codes of 0.18, of twice it, of 4 and 0.25; false colours of 0, +1 and +2 stops and of 3.1: 0.2126 * 4 + 0.7874 / 4.
  expected["codes"] = {at(40, 100, "", {118, 118, 118}),      at(40, 20, "", {162, 162, 162}),
                       at(90, 8, "", {255, 137, 137}),        at(90, 8, "clip", {255, 0, 0}),
                       at(10, 200, "clip", {0, 72, 255}),     at(20, 200, "clip", {255, 0, 255}),
                       at(40, 100, "clip", {118, 118, 118}),  at(40, 100, "false", {128, 128, 128}),
                       at(40, 20, "false", {178, 178, 84}),   at(40, 100, "1,false", {178, 178, 84}),
                       at(40, 20, "-2,false", {62, 160, 76}), at(90, 8, "R", {255, 255, 255}),
                       at(90, 8, "G", {137, 137, 137}),       at(200, 100, "A", {128, 128, 128}),
                       at(40, 100, "A", {255, 255, 255}),     at(40, 20, "luma", {162, 162, 162}),
                       at(40, 100, "1", {162, 162, 162})};
  // A stop has 16 levels from -10 on; halves of 0.18 and 0.36 lie a little below.
  const int grey = 256 * 256 - 64 * 32 - 64 * 16 - 2;
  for (int channel = 0; channel < 4; ++channel) {
    expected["levels"].push_back({{"channel", channel}, {"level", 159}, {"count", grey}});
    expected["levels"].push_back({{"channel", channel}, {"level", 175}, {"count", 64 * 32}});
  }
  expected["levels"].push_back({{"channel", 0}, {"level", 231}, {"count", 64 * 16}});  // 4: +4.47 stops
  use_in_browser("display_page.py", folder / "run", expected, folder);
}

TEST(DisplayPage, of_previews_with_an_exposure_starts_from_it) {
  const ScratchFolder folder("display_exposure");
  SyntheticRun run(folder / "run", 256, 256, [](std::size_t i, std::uint32_t x, std::uint32_t y) {
    return i == 0 ? all_halves(x, y) : known(x, y);
  });
  run.previews.exposure = -3.3;
  Json expected = made_run(run, folder / "run");
  expected["previews"] = {{{"entry", 0}, {"file", "previews/0000.png"}, {"within", 0}},
                          {{"entry", 1}, {"file", "previews/0001.png"}, {"within", 0}}};
  expected["codes"] = {{{"x", 40}, {"y", 100}, {"display", "3.3,false"}, {"code", {128, 128, 128}}}};
  expected["levels"] = Json::array();
  use_in_browser("display_page.py", folder / "run", expected, folder);
}

TEST(DisplayPage, shows_the_view_of_the_previews_as_near_as_its_lattice_says) {
  const ScratchFolder folder("display_view");
  SyntheticRun run(folder / "run", 256, 256, [](std::size_t i, std::uint32_t x, std::uint32_t y) {
    const auto light = [](std::uint32_t k) { return std::exp2(static_cast<float>(k % 256) / 16 - 11.5F); };
    return i == 0 ? Rgba(light(x), light(y), light(x * 3 + y * 7), 1) : known(x, y);
  });
  run.previews.view = std::make_shared<const Shoulder>();
  Json expected = made_run(run, folder / "run");
  expected["hasView"] = true;
  const double within = std::ceil(ViewLut(*run.previews.view).error().most) + 1;
  expected["previews"] = {{{"entry", 0}, {"file", "previews/0000.png"}, {"within", within}}};
  expected["codes"] = {{{"x", 40}, {"y", 100}, {"display", "srgb"}, {"code", {118, 118, 118}}}};
  expected["levels"] = Json::array();
  use_in_browser("display_page.py", folder / "run", expected, folder);
}

}  // namespace
}  // namespace relook
