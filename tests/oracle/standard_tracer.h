// What relook's rule of sampling is measured against: the light of color/PATH.md, as in path_reference.h, estimated as
// usual path tracers do. A lobe is chosen in proportion to what it reflects, a direction drawn at the hit's own alpha,
// and what both lobes reflect there is weighted by the density of both; each rectangle and the environment as a whole
// give a sample to every vertex; the two are weighed by the power heuristic. Single choices can be made as relook makes
// them. Opaque surfaces without textures and coats; rectangles, and an unturned environment image.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "frame/image.h"
#include "luminance_map.h"
#include "path_reference.h"

namespace relook {

/// Choices of relook's instead of the usual ones. None changes a mean.
struct SamplingRules {
  bool apart = false;         // the chosen lobe brings its own light alone
  bool plain_shares = false;  // of the lobes, without their colours
  double least_specular = 0;  // with plain shares: of the specular lobe beside a diffuse one
  bool buckets = false;       // directions by the bucket of alpha
  bool split = false;         // samples of the suns alone; the sky is left to the lobes
  bool unstratified = false;  // not relook's: independent random numbers instead of its point sets
};

class StandardTracer : private PathReference {
 public:
  /// Depths as `view` says.
  StandardTracer(const Scene& scene, const ViewOptions& view, SamplingRules rules = {});

  /// Row by row, from so many samples each. Another seed gives other, independent ones.
  [[nodiscard]] std::vector<Vec> pixels(std::uint32_t samples, std::uint64_t seed) const;

 private:
  enum Kind : std::size_t { kDiffuse, kSpecular };
  /// How directions of a hit are drawn.
  struct Lobes {
    std::array<double, 2> share;  // by Kind
    double alpha, even;           // of the specular directions, and their part by the cosine
  };
  /// A ray, and the density of its direction; none from the eye. `met`: the weight of lights that it meets.
  struct Step {
    Ray ray;
    Vec met, on;  // `on`: the weight of what is scattered where it ends
    std::optional<double> density;
  };
  class Numbers;

  [[nodiscard]] Vec sample(const Ray& eye, Numbers numbers) const;
  [[nodiscard]] Vec met(const Step& step, const Found& found) const;
  [[nodiscard]] Vec gathered(const Surface& s, const Lobes& lobes, const Numbers& numbers) const;
  /// Of light of radiance 1 that a sample of this density finds.
  [[nodiscard]] Vec weighed(const Surface& s, const Lobes& lobes, const Vec& way, double density) const;
  [[nodiscard]] std::optional<Step> scattered(const Surface& s, const Lobes& lobes, const Step& before,
                                              const Numbers& numbers) const;

  [[nodiscard]] Lobes lobes_of(const Surface& s) const;
  [[nodiscard]] static Vec drawn(const Surface& s, const Lobes& lobes, Kind kind, const Uv& u);
  /// Per steradian.
  [[nodiscard]] static double density_of(const Surface& s, const Lobes& lobes, Kind kind, const Vec& way);

  /// What the environment's samples stand for, and the rest of it.
  struct Surroundings {
    Vec sampled, rest;
  };
  [[nodiscard]] Surroundings seen(const Vec& way) const;
  [[nodiscard]] LuminanceMap map_of_samples() const;

  SamplingRules rules_;
  double threshold_;  // luminance of an image's sky, at most
  LuminanceMap map_;
};

}  // namespace relook
