#include "render_error.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "image/render.h"
#include "scratch.h"
#include "setup.h"
#include "standard_tracer.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr std::uint32_t kConverged = 1024;
constexpr unsigned kRuns = 4;  // of each picture, with different numbers

/// What `state` shows, as the middle of a picture that has `margin` more pixels on each side: so it has other numbers.
std::vector<Vec> path_colors(const SceneState& state, const ViewOptions& view, std::uint32_t margin) {
  Camera camera = state.scene().camera;
  const std::uint32_t width = camera.width, height = camera.height;
  camera.width += 2 * margin;
  camera.height += 2 * margin;
  camera.half_width *= static_cast<float>(camera.width) / static_cast<float>(width);
  camera.half_height *= static_cast<float>(camera.height) / static_cast<float>(height);
  RenderStats stats;
  const Frame frame = render(with_camera(state, camera).scene(), view, stats);
  std::vector<Vec> colors;
  for (std::uint32_t y = margin; y < margin + height; ++y)
    for (std::uint32_t x = margin; x < margin + width; ++x) {
      const Rgba& pixel = frame.pixels[std::size_t{y} * camera.width + x];
      colors.emplace_back(pixel.r, pixel.g, pixel.b);
    }
  return colors;
}

/// Mean squares over pixels and channels.
struct Errors {
  double plain = 0;   // of the difference
  double mapped = 0;  // of that of x / (x + m), m the mean of the converged picture: relative where it is dark

  [[nodiscard]] Errors over(const Errors& other) const {
    return {std::sqrt(plain / other.plain), std::sqrt(mapped / other.mapped)};
  }
};
double mean_of(const std::vector<Vec>& colors) {
  double sum = 0;
  for (const Vec& color : colors) sum += (color.x + color.y + color.z) / 3;
  return sum / static_cast<double>(colors.size());
}
Errors errors_of(const std::vector<Vec>& colors, const std::vector<Vec>& converged) {
  const double middle = mean_of(converged), weight = 1 / (3 * static_cast<double>(colors.size()));
  Errors errors;
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double a = colors[i][c], b = converged[i][c];
      errors.plain += (a - b) * (a - b) * weight;
      errors.mapped += std::pow(a / (a + middle) - b / (b + middle), 2) * weight;
    }
  return errors;
}
/// The mean over runs.
Errors mean_errors(const std::vector<Vec>& converged, const std::function<std::vector<Vec>(unsigned)>& run) {
  Errors mean;
  for (unsigned i = 0; i < kRuns; ++i) {
    const Errors errors = errors_of(run(i), converged);
    mean.plain += errors.plain / kRuns;
    mean.mapped += errors.mapped / kRuns;
  }
  return mean;
}
Errors standard_errors(const SceneState& state, const ViewOptions& view, SamplingRules rules,
                       const std::vector<Vec>& converged) {
  const StandardTracer tracer(state.scene(), view, rules);
  return mean_errors(converged, [&](unsigned run) { return tracer.pixels(view.samples, run); });
}

struct NamedRules {
  const char* name;
  SamplingRules rules;
};
constexpr SamplingRules kAsRelook{.apart = true, .plain_shares = true, .buckets = true, .split = true};
constexpr SamplingRules with_least_specular(double share) {
  SamplingRules rules = kAsRelook;
  rules.least_specular = share;
  return rules;
}
constexpr std::array kChoices{NamedRules{"lobes estimated apart", {.apart = true}},
                              NamedRules{"shares without colours", {.plain_shares = true}},
                              NamedRules{"both", {.apart = true, .plain_shares = true}},
                              NamedRules{"buckets of alpha", {.buckets = true}},
                              NamedRules{"sky by lobes, suns by samples", {.split = true}},
                              NamedRules{"all four, as relook", kAsRelook},
                              NamedRules{"all four, specular share at least 1/4", with_least_specular(0.25)},
                              NamedRules{"independent random numbers", {.unstratified = true}}};

void print_scene_errors(const char* name, const SceneState& state, const BenchOptions& options) {
  const ViewOptions& view = options.view;
  ViewOptions many = view;
  many.samples = kConverged;
  const std::vector<Vec> converged = path_colors(state, many, kRuns);
  const double middle = mean_of(converged);
  const Errors own = mean_errors(converged, [&](unsigned run) { return path_colors(state, view, run); });
  const Errors standard = standard_errors(state, view, {}, converged);
  const Errors ratio = own.over(standard);
  std::printf("%s: RMSE %.4f relook, %.4f standard, of a mean of %.3f; tone-mapped %.4f, %.4f\n", name,
              std::sqrt(own.plain), std::sqrt(standard.plain), middle, std::sqrt(own.mapped),
              std::sqrt(standard.mapped));
  std::printf("  %-42s %8.2f %8.2f\n", "relook / standard (at most 1.25)", ratio.plain, ratio.mapped);
  options.note("Error", name, "relook / standard path tracer", ratio.plain, "", "", Goal{1.25, true});
  options.note("Error", name, "the same, tone-mapped", ratio.mapped, "", "", Goal{1.25, true});
  for (const auto& [choice, rules] : kChoices) {
    const Errors cost = standard_errors(state, view, rules, converged).over(standard);
    std::printf("  %-42s %8.2f %8.2f\n", choice, cost.plain, cost.mapped);
  }
  std::fflush(stdout);
}

std::shared_ptr<const TexturePyramid> sky_of(const ScratchFolder& folder, const char* file) {
  return decode_pyramid(read_file(folder / file), false, file, "");
}

}  // namespace

BenchOptions error_options(const std::vector<std::string>& words) {
  std::vector<std::string> all{"-", "-"};
  all.insert(all.end(), words.begin(), words.end());
  BenchOptions options = parse_options(all, 96, 64);
  if (options.view.samples == 1) options.view.samples = 16;
  options.view.integrator = Integrator::path;
  options.view.diffuse_depth = 2;
  return options;
}

void print_errors(const BenchOptions& options) {
  const std::uint32_t width = options.width, height = options.height;
  const ScratchFolder folder;
  run_program({"python3", "-B", "-c",
               "import sys; sys.path.insert(0, sys.argv[1]); import hdri; hdri.write(sys.argv[2])",
               RELOOK_SOURCE_DIR "/scenes", (folder / "").string()});
  std::printf("path, %ux%u, %u samples a pixel: ratios of RMSE, plain and tone-mapped\n", width, height,
              options.view.samples);
  const auto sky = sky_of(folder, "sky.hdr"), studio = sky_of(folder, "studio.hdr");
  print_scene_errors("clear sky", still_life_scene(sky, 1, width, height), options);
  print_scene_errors("clear sky, grey plastics", still_life_scene(sky, 0.3F, width, height), options);
  print_scene_errors("clear sky, black plastics", still_life_scene(sky, 0.05F, width, height), options);
  print_scene_errors("studio", still_life_scene(studio, 1, width, height), options);
  print_scene_errors("rectangle", still_life_scene(nullptr, 1, width, height), options);
}

}  // namespace relook
