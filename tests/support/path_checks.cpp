#include "path_checks.h"

#include <gtest/gtest.h>

#include <sstream>
#include <utility>

#include "base/tiles.h"
#include "frame/light_sums.h"
#include "image/cached_image.h"
#include "image/tile_light.h"
#include "scene/light_sums.h"
#include "tree_reader.h"

namespace relook {
namespace {


std::string text_of(const Rgba& value) {
  std::ostringstream text;
  text << std::hexfloat << "(" << value.r << ", " << value.g << ", " << value.b << ", " << value.a << ")";
  return text.str();
}

std::size_t different_values(const PackedSums& a, const PackedSums& b, std::size_t sum) {
  std::size_t different = 0;
  for (std::size_t pixel = 0; pixel < a.pixels(); ++pixel)
    different += a.value(sum, pixel) != b.value(sum, pixel) ? 1 : 0;
  return different;
}

/// What a tile's sums say that others do not.
std::string tile_differences(const PackedSums& found, const PackedSums& expected, const std::vector<LightSum>& sums) {
  if (found.sums() != expected.sums() || found.pixels() != expected.pixels())
    return std::to_string(found.sums()) + " sums of " + std::to_string(found.pixels()) + " pixels instead of " +
           std::to_string(expected.sums()) + " of " + std::to_string(expected.pixels()) + "; ";
  std::string text;
  for (std::size_t sum = 0; sum < found.sums(); ++sum) {
    const std::size_t pixels = different_values(found, expected, sum);
    if (pixels == 0 && found.shapes()[sum] == expected.shapes()[sum]) continue;
    text += (sum < sums.size() ? sums[sum].name : "a sum without a name") + " in " + std::to_string(pixels) +
            " pixels, clamped " + std::to_string(found.shapes()[sum].clamped) + " instead of " +
            std::to_string(expected.shapes()[sum].clamped) + "; ";
  }
  return text.empty() ? "coverage or bytes; " : text;
}

}  // namespace

std::string pixel_differences(const Frame& found, const Frame& expected) {
  const std::vector<std::uint32_t> pixels = different_pixels(found, expected);
  if (pixels.empty()) return "";
  std::string text = std::to_string(pixels.size()) + " of " + std::to_string(expected.pixels.size()) + " pixels";
  const std::uint32_t first = pixels.front();
  if (first >= found.pixels.size() || first >= expected.pixels.size()) return text;
  return text + ", first (" + std::to_string(first % expected.width) + ", " + std::to_string(first / expected.width) +
         "): " + text_of(found.pixels[first]) + " instead of " + text_of(expected.pixels[first]);
}

std::string sum_differences(Replayer& replayer, const Scene& fresh_scene, const Image& fresh) {
  const std::vector<LightSum> sums = light_sums(fresh_scene);
  std::string text;
  for (std::size_t tile = 0; tile < fresh.light_sums.size(); ++tile) {
    const auto lease = replayer.residency().use(PieceKind::light_sums, tile);
    const PackedSums& found = replayer.image().light_sums[tile];
    if (found == fresh.light_sums[tile]) continue;
    text += "tile " + std::to_string(tile) + ": " + tile_differences(found, fresh.light_sums[tile], sums);
  }
  return text;
}

std::string layer_differences(const Scene& scene, const Image& image) {
  const std::vector<LightColor> colors = colors_of(light_sums(scene));
  Frame summed{image.frame.width, image.frame.height, std::vector<Rgba>(image.frame.pixels.size())};
  for (std::size_t tile = 0; tile < image.light_sums.size(); ++tile) {
    const PackedSums& sums = image.light_sums[tile];
    const TileRect rect = tile_rect(tile, summed.width, summed.height);
    for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
      Color total(0, 0, 0);
      for (std::size_t sum = 0; sum < sums.sums(); ++sum)
        total += layer(sums, sum, pixel, colors[sum], image.view.samples);
      const std::size_t x = rect.x0 + pixel % rect.width(), y = rect.y0 + pixel / rect.width();
      const auto coverage = static_cast<float>(sums.coverage(pixel) / image.view.samples);
      summed.pixels[y * summed.width + x] = Rgba(total.x, total.y, total.z, coverage);
    }
  }
  return pixel_differences(image.frame, summed);
}

Frame expect_path_image(Replayer& replayer, const std::string& what, const PathExpectation& expected) {
  const SceneState again = compiled_again(replayer.state());
  const Image fresh = preprocessed(again.scene(), replayer.image().view);
  EXPECT_EQ(pixel_differences(replayer.image().frame, fresh.frame), "") << what;
  EXPECT_EQ(sum_differences(replayer, again.scene(), fresh), "") << what;
  EXPECT_EQ(layer_differences(again.scene(), fresh), "") << what;
  if (expected.trees) {
    EXPECT_EQ(different_trees(replayer.image(), replayer.state().scene(), fresh, again.scene()), 0U)
        << "ray trees: " << what;
  }
  if (expected.render) {
    EXPECT_EQ(pixel_differences(fresh.frame, rendered(again.scene(), replayer.image().view)), "")
        << "preprocess and render: " << what;
  }
  return fresh.frame;
}

StepResult expect_path_step(Replayer& replayer, const Edit& edit, const std::string& what,
                            const PathExpectation& expected, bool is_drag) {
  const Frame before = replayer.image().frame;
  const StepResult step = is_drag ? replayer.drag(edit, "path", ".") : replayer.step(edit, "path", ".");
  const Frame full = expect_path_image(replayer, what, expected);
  EXPECT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full)) << "changed pixels: " << what;
  EXPECT_EQ(step.counters.pixels_changed, step.changed_pixels.size()) << what;
  return step;
}

ViewOptions path_view(std::uint32_t samples) {
  ViewOptions view{samples, 4, 0};
  view.integrator = Integrator::path;
  return view;
}

Replayer path_replayer(const SceneState& state, const ViewOptions& view, const ResidencyOptions& residency,
                       const RegionOptions& regions, const std::filesystem::path& cache) {
  SceneState start = with_integrator(state, Integrator::path);
  Image image = preprocessed(start.scene(), view);
  auto pieces = std::make_unique<Residency>(residency);
  if (cache.empty()) return Replayer(std::move(start), std::move(image), regions, std::move(pieces));
  write_cache(cache, cache_content(start, std::move(image), std::string(32, 'a')));
  OpenedCache opened;
  const CacheAnswer answer = open_cache(cache, true, opened);
  EXPECT_EQ(answer.fault, CacheFault::none) << answer.file << ": " << answer.detail;
  return Replayer(std::move(*opened.state), std::move(opened.image), regions, std::move(pieces));
}

}  // namespace relook
