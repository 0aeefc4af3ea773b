// Perceptual metrics against other programs' values; thresholds and verdicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/flip.h"
#include "compare/flip_ldr.h"
#include "compare/frame_comparison.h"
#include "compare/similarity.h"

namespace relook {
namespace {

constexpr std::uint32_t kWidth = 150, kHeight = 140;

struct FramePair {
  Frame a, b;
};

/// Colours up to 8, exact in float32; b is brighter in a block, bluer along lines and darker at the bottom.
FramePair pattern() {
  FramePair pair{{kWidth, kHeight, {}}, {kWidth, kHeight, {}}};
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      Rgba pixel(static_cast<float>((x * 7 + y * 3) % 32) / 32, static_cast<float>((x * x + y * 5) % 64) / 64,
                 static_cast<float>((x + y * y) % 128) / 128, 1);
      const float scale = (x / 16 + y / 16) % 5 == 0 ? 8 : 1;
      pixel = Rgba(pixel.r * scale, pixel.g * scale, pixel.b * scale, 1);
      pair.a.pixels.push_back(pixel);
      if (x > 20 && x < 60 && y > 30 && y < 90) pixel.r *= 1.25F;
      if ((x + y) % 17 == 0) pixel.b += 0.25F;
      if (y > 120) pixel = Rgba(pixel.r * 0.5F, pixel.g * 0.5F, pixel.b * 0.5F, 1);
      pair.b.pixels.push_back(pixel);
    }
  return pair;
}

/// Linear grids of a whole frame, clamped to [0, 1], its last rows and columns repeated as far as the filters see.
RgbGrids clamped_grids(const Frame& frame) {
  const std::size_t width = frame.width + 2 * kFlipRadius, height = frame.height + 2 * kFlipRadius;
  RgbGrids grids{Grid(width, height), Grid(width, height), Grid(width, height)};
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t column = std::clamp<std::size_t>(x, kFlipRadius, frame.width + kFlipRadius - 1) - kFlipRadius;
      const std::size_t row = std::clamp<std::size_t>(y, kFlipRadius, frame.height + kFlipRadius - 1) - kFlipRadius;
      const Rgba& pixel = frame.pixels[row * frame.width + column];
      grids.r.values[y * width + x] = std::clamp(pixel.r, 0.0F, 1.0F);
      grids.g.values[y * width + x] = std::clamp(pixel.g, 0.0F, 1.0F);
      grids.b.values[y * width + x] = std::clamp(pixel.b, 0.0F, 1.0F);
    }
  return grids;
}

// Expected values: the formulas of NVIDIA's numpy implementation (github.com/NVlabs/flip, python/flip_api.py) in
// Python, run on the same pattern; its two-dimensional float32 filters are not separated, hence the tolerance.
constexpr double kFlipTolerance = 2e-5;

TEST(Flip, exposures_are_those_of_the_published_implementation) {
  const ExposureRange range = flip_exposures(pattern().a);
  EXPECT_NEAR(range.start, -1.856388, 1e-5);
  EXPECT_NEAR(range.stop, 1.877853, 1e-5);
  EXPECT_EQ(range.count, 4);
}

TEST(Flip, hdr_errors_are_those_of_the_published_implementation) {
  const FramePair pair = pattern();
  const auto flip = hdr_flip(pair.a, pair.b);
  ASSERT_TRUE(flip);
  EXPECT_NEAR(flip->mean(), 0.1240863, kFlipTolerance);
  EXPECT_NEAR(*std::ranges::max_element(flip->errors), 0.7133973, kFlipTolerance);
  EXPECT_NEAR(flip->errors[60 * kWidth + 40], 0.141273, kFlipTolerance);
  EXPECT_NEAR(flip->errors[17], 0.178274, kFlipTolerance);
  EXPECT_NEAR(flip->errors[139 * kWidth + 149], 0.575132, kFlipTolerance);
}

TEST(Flip, ldr_errors_are_those_of_the_published_implementation) {
  const FramePair pair = pattern();
  const std::vector<float> errors = ldr_flip(clamped_grids(pair.a), clamped_grids(pair.b), flip_filters());
  ASSERT_EQ(errors.size(), pair.a.pixels.size());
  double sum = 0;
  for (const float error : errors) sum += double{error};
  EXPECT_NEAR(sum / static_cast<double>(errors.size()), 0.1366954, kFlipTolerance);
}

TEST(Flip, is_zero_where_nothing_near_differs) {
  const FramePair pair = pattern();
  Frame b = pair.a;
  b.pixels[10 * kWidth + 10].g += 0.5F;
  const auto flip = hdr_flip(pair.a, b);
  ASSERT_TRUE(flip);
  EXPECT_GT(flip->errors[10 * kWidth + 10], 0);
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x)
      ASSERT_TRUE(flip->errors[y * kWidth + x] == 0 || std::max(x, y) <= 10 + kFlipRadius) << x << "," << y;
}

TEST(Flip, black_and_bright_frames_and_small_ones_have_finite_errors) {
  const Frame black{3, 2, std::vector<Rgba>(6, Rgba(0, 0, 0, 1))};
  Frame bright = black, negative = black;
  bright.pixels[4] = Rgba(3e38F, 3e38F, 3e38F, 1);
  negative.pixels[0] = Rgba(-3e38F, -1, 0, 1);
  for (const auto& [a, b] : {FramePair{black, bright}, FramePair{bright, black}, FramePair{negative, bright}}) {
    const auto flip = hdr_flip(a, b);
    ASSERT_TRUE(flip);
    for (const float error : flip->errors) EXPECT_TRUE(error >= 0 && error <= 1) << error;
    EXPECT_GT(flip->mean(), 0);
  }
  Frame broken = black;
  broken.pixels[2].b = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(hdr_flip(black, broken));
}

// Expected: the formula in double precision (scipy's correlate1d); PSNR is 20 log10(white / RMS error).
TEST(Similarity, ssim_and_psnr_have_the_values_of_their_definitions) {
  const FramePair pair = pattern();
  EXPECT_NEAR(*ssim(pair.a, pair.b), 0.98712546, 2e-6);
  EXPECT_EQ(ssim(pair.a, pair.a), 1.0);
  const FrameDifference difference = compare_frames(pair.a, pair.b);
  EXPECT_NEAR(difference.rms_error, 0.35487872, 1e-8);
  EXPECT_NEAR(*psnr(difference, {1}), 8.998401, 1e-5);
  EXPECT_NEAR(*psnr(difference, {10}), 28.998401, 1e-5);
  EXPECT_FALSE(psnr(compare_frames(pair.a, pair.a), {1}));
  const Frame small{10, 40, std::vector<Rgba>(400)};
  EXPECT_FALSE(ssim(small, small));
}

TEST(Similarity, a_bright_pixel_that_both_frames_have_does_not_raise_psnr) {
  FramePair pair{{20, 10, std::vector<Rgba>(200, Rgba(0.1F, 0.6F, 0.1F, 1))},
                 {20, 10, std::vector<Rgba>(200, Rgba(0.6F, 0.1F, 0.1F, 1))}};
  const std::optional<double> plain = compare_closely(pair.a, pair.b, {}, DisplayWhite()).psnr;
  for (Frame* frame : {&pair.a, &pair.b}) frame->pixels[7] = Rgba(50'000, 50'000, 50'000, 1);
  const std::optional<double> with_highlight = compare_closely(pair.a, pair.b, {}, DisplayWhite()).psnr;
  EXPECT_NEAR(*plain, 20 * std::log10(1 / std::sqrt(0.125)), 1e-4);
  EXPECT_NEAR(*with_highlight, *plain, 0.03);
}

FramePair one_pixel(float from, float to) {
  FramePair pair{{20, 10, std::vector<Rgba>(200, Rgba(1, 1, 1, 1))}, {}};
  pair.b = pair.a;
  pair.a.pixels[47].g = from;
  pair.b.pixels[47].g = to;
  return pair;
}

Verdict verdict(const FramePair& pair, const Thresholds& thresholds) {
  return compare_closely(pair.a, pair.b, thresholds, DisplayWhite()).verdict;
}

TEST(FrameComparison, without_thresholds_one_bit_is_a_failure) {
  EXPECT_EQ(verdict(one_pixel(0.5F, 0.5F), {}), Verdict::equal);
  EXPECT_EQ(verdict(one_pixel(0.5F, std::nextafter(0.5F, 1.0F)), {}), Verdict::failure);
  EXPECT_EQ(verdict(one_pixel(0, -0.0F), {}), Verdict::failure);
}

TEST(FrameComparison, thresholds_allow_what_they_say) {
  const FramePair pair = one_pixel(0.5F, 0.75F);  // half a percent of the pixels
  EXPECT_EQ(verdict(pair, {.fail = 0.25}), Verdict::within);
  EXPECT_EQ(verdict(pair, {.fail = 0.24}), Verdict::failure);
  EXPECT_EQ(verdict(pair, {.fail_percent = 0.5}), Verdict::within);
  EXPECT_EQ(verdict(pair, {.fail_percent = 0.4}), Verdict::failure);
  EXPECT_EQ(verdict(pair, {.fail_percent = 1, .hard_fail = 0.2}), Verdict::failure);
  EXPECT_EQ(verdict(pair, {.fail_percent = 1, .hard_fail = 0.3}), Verdict::within);
  EXPECT_EQ(verdict(pair, {.fail = 1, .fail_flip = 1e-6}), Verdict::failure);
  EXPECT_EQ(verdict(pair, {.fail = 1, .fail_flip = 0.9}), Verdict::within);
  EXPECT_EQ(verdict(pair, {.fail = 1, .warn = 0.1}), Verdict::warning);
  EXPECT_EQ(verdict(pair, {.fail = 1, .warn = 0.1, .warn_percent = 1}), Verdict::within);
  EXPECT_EQ(verdict(one_pixel(0, -0.0F), {.fail = 0}), Verdict::within);
}

TEST(FrameComparison, differences_that_are_not_finite_never_pass) {
  const Thresholds lenient{.fail = 1e30, .fail_percent = 100};
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const auto& [from, to] :
       {std::pair{nan, 1.0F}, {1.0F, nan}, {infinity, 1.0F}, {-infinity, infinity}, {nan, -nan}})
    EXPECT_EQ(verdict(one_pixel(from, to), lenient), Verdict::failure) << from << " " << to;
  const FrameComparison same = compare_closely(one_pixel(1, nan).b, one_pixel(1, nan).b, {}, DisplayWhite());
  EXPECT_EQ(same.verdict, Verdict::equal) << "the same bits";
  EXPECT_EQ(same.not_finite_a, 1U);
}

TEST(FrameComparison, the_worst_pixel_is_named_with_all_channels) {
  FramePair pair = one_pixel(0.5F, 0.75F);
  pair.b.pixels[3].a = 0.9F;
  pair.b.pixels[150].r = 1.25F;  // as bad, but later
  const Json json = comparison_json(compare_closely(pair.a, pair.b, {}, DisplayWhite()));
  EXPECT_EQ(json["worst_pixel"]["x"], 7);
  EXPECT_EQ(json["worst_pixel"]["y"], 2);
  EXPECT_EQ(json["worst_pixel"]["a"], Json::parse("[1.0, 0.5, 1.0, 1.0]"));
  EXPECT_EQ(json["worst_pixel"]["b"], Json::parse("[1.0, 0.75, 1.0, 1.0]"));
  EXPECT_EQ(json["pixels_above_fail"], 3);
  pair.b.pixels[150].r = std::numeric_limits<float>::quiet_NaN();
  const Json broken = comparison_json(compare_closely(pair.a, pair.b, {}, DisplayWhite()));
  EXPECT_EQ(broken["worst_pixel"]["x"], 10);
  EXPECT_EQ(broken["worst_pixel"]["b"][0], "nan");
  EXPECT_TRUE(broken["flip"].is_null());
  EXPECT_TRUE(broken["psnr"].is_null());
}

}  // namespace
}  // namespace relook
