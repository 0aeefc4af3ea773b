// An environment image as light, split for sampling (color/PATH.md, "Sky and suns"): the sky is the image scaled down,
// hue kept, to a luminance of at most t; the suns are the rest. Lobe rays alone gather the sky; the suns have a
// distribution of their own. t = 4 x the solid-angle mean of min(L, t), the largest such t, over the texels'
// luminances L.
//
// The split acts on the *interpolated* texel, so that a colour program that looks up the image can compute it with
// equal bits, in this order:
//   c = max(texel, 0) by channel;  L = c.r * 0.2126 + c.g * 0.7152 + c.b * 0.0722;
//   k = L - t > 0 ? t / L : 1;     sky = c * k;  suns = c - sky.
// Directions are local to the image, before its rotation: +y up, -z in the middle. All functions are pure, with the
// same bits on every machine.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/math.h"
#include "light/table_sampling.h"
#include "scene/texture/texture.h"

namespace relook {

/// Where an environment image is read for a unit direction: as Op::environment_map does, without rotation.
[[nodiscard]] Uv environment_uv(const Direction& way);
/// The unit direction that is read at uv, uv in [0, 1].
[[nodiscard]] Direction environment_way(double u, double v);

/// How much of an interpolated texel's colour is sky, for its luminance.
[[nodiscard]] inline float sky_share(float luminance, float threshold) {
  return luminance - threshold > 0 ? threshold / luminance : 1.0F;
}

class EnvironmentLight {
 public:
  struct Parts {
    Color sky, suns;
  };
  /// A direction to the suns, and its density per steradian.
  struct Sun {
    Direction way;
    float density = 0;
  };

  /// Level 0 of a lat-long image. Null: one colour, (1, 1, 1), without suns.
  explicit EnvironmentLight(std::shared_ptr<const TexturePyramid> image);

  /// t, a luminance; infinity where no texel exceeds it.
  [[nodiscard]] float threshold() const { return threshold_; }
  [[nodiscard]] bool has_suns() const { return !suns_.empty(); }
  /// What clamping takes: light of negative channels as a share of all, both as absolute values, by luminance and solid
  /// angle. (Decoded images have none: decode_pyramid clamps its texels.)
  [[nodiscard]] double negative_share() const { return negative_share_; }
  /// The suns' part of the image's light, by luminance and solid angle of the texels.
  [[nodiscard]] double sun_share() const { return sun_share_; }

  /// Radiance from a unit direction, for a tint of 1.
  [[nodiscard]] Parts parts(const Direction& way) const;
  [[nodiscard]] Color sky(const Direction& way) const { return parts(way).sky; }
  [[nodiscard]] Color suns(const Direction& way) const { return parts(way).suns; }

  /// A direction to the suns for a point of the unit square. None without suns, and where rounding leads out of them.
  [[nodiscard]] std::optional<Sun> sample(Uv u) const;
  /// The same for several points. Requires: as many suns as points.
  void sample(std::span<const Uv> u, std::span<std::optional<Sun>> suns) const;
  /// The density per steradian with which sample() gives a unit direction; positive wherever suns() is, finite.
  [[nodiscard]] float density(const Direction& way) const;

 private:
  /// `luminances`: of the clamped texels, [height][width].
  void weigh_suns(const std::vector<float>& luminances);
  [[nodiscard]] GridDistribution cells_of_suns() const;
  [[nodiscard]] std::optional<Sun> sun_in(const GridDistribution::Choice& cell) const;
  /// The weight at a texel's place, not wrapped in x and clamped in y.
  [[nodiscard]] float weight(std::uint32_t column, std::int64_t row) const;

  std::shared_ptr<const TexturePyramid> image_;
  std::uint32_t width_ = 0, height_ = 0;
  float threshold_ = std::numeric_limits<float>::infinity();
  double negative_share_ = 0, sun_share_ = 0;
  // The suns' luminance of each texel times the sine of its polar angle, scaled so that its bilinear interpolation over
  // the sine at a direction is the density: continuous, and nowhere less than a multiple of the suns' own luminance
  // times the sine, as max(mean of L - t, 0) <= mean of max(L - t, 0). [rows][width], of the rows from the first to the
  // last one with suns; 0 elsewhere.
  std::vector<float> weights_;
  std::uint32_t first_row_ = 0, rows_ = 0;
  // Cells between four texels' middles, half cells at the poles: row r lies below row r - 1 of texels, column c right
  // of column c - 1, which wraps.
  GridDistribution suns_;
};

}  // namespace relook
