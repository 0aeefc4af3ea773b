#include "render_measures.h"

#include <cstdio>

#include "bare_rays.h"
#include "base/parallel.h"
#include "image/render.h"

namespace relook {
namespace {

void print_rays(const BenchOptions& options, const BareRays& bare, double render_seconds) {
  const double rays = static_cast<double>(bare.rays + bare.shadow_segments);
  std::printf("%-46s %10.2f M rays, %.2f M shadow segments\n", "rays of the full render",
              static_cast<double>(bare.rays) * 1e-6, static_cast<double>(bare.shadow_segments) * 1e-6);
  std::printf("%-46s %10.3f s, %.2f M rays/s\n", "bare Embree loop over the same rays", bare.seconds,
              rays / bare.seconds * 1e-6);
  std::printf("%-46s %10.1f %% (to reach: 70 %%)\n", "rays/s of the full render over the bare loop",
              100 * bare.seconds / render_seconds);
  options.note("Full render", "rays/s", "of the bare Embree loop", 100 * bare.seconds / render_seconds, "%", "",
               Goal{70});
}

/// Nanoseconds of a lookup at random places; `sum` keeps the compiler from leaving the lookups out.
double lookup_nanoseconds(const TextureSlot& slot, float& sum) {
  constexpr int kLookups = 1 << 20;
  const double seconds = fastest(3, [&] {
    std::uint32_t random = 1;
    for (int i = 0; i < kLookups; ++i) {
      random = random * 1664525U + 1013904223U;
      const Uv uv(static_cast<float>(random >> 8) * 0x1p-24F, static_cast<float>(random & 0xFFFFU) * 0x1p-16F);
      sum += sample(*slot.pyramid, uv, 1.5F, slot.sampler).r;
    }
  });
  return seconds / kLookups * 1e9;
}

}  // namespace

RenderTimes print_render(const BenchOptions& options, const SceneState& state, Image& image) {
  RenderTimes times;
  RenderStats stats;
  double render_seconds = 0;  // without the acceleration structures, of the fastest run too
  times.full_seconds = fastest(5, [&] {
    stats = {};
    static_cast<void>(render(state.scene(), options.view, stats));
    if (render_seconds == 0 || stats.render_seconds < render_seconds) render_seconds = stats.render_seconds;
  });
  RenderStats kept;
  times.preprocess_seconds = fastest(3, [&] {
    kept = {};
    image = preprocess(state.scene(), options.view, kept);
  });
  const BareRays bare = time_bare_rays(state.scene(), image, 5);
  std::printf("%-46s %10.3f s (acceleration structures %.3f s)\n", "full render", times.full_seconds,
              stats.build_seconds);
  options.note("Full render", "seconds", "full render", times.full_seconds, "s", "640 (256x256, in 1996)");
  print_rays(options, bare, render_seconds);
  std::printf("%-46s %10.2f (paper: 1.72; to reach: 1.3)\n", "preprocess / full render",
              times.preprocess_seconds / times.full_seconds);
  options.note("Full render", "seconds", "preprocess / full render", times.preprocess_seconds / times.full_seconds, "",
               "1.72", Goal{1.3, true});
  times.ray_nanoseconds = render_seconds * static_cast<double>(thread_count()) /
                          static_cast<double>(bare.rays + bare.shadow_segments) * 1e9;
  return times;
}

void print_texture_price(const SceneState& state, const RenderTimes& times) {
  for (const Material& material : state.scene().materials) {
    for (const TextureSlot& slot : material.slots) {
      if (slot.kind != TextureKind::image) continue;
      float sum = 0;
      const double nanoseconds = lookup_nanoseconds(slot, sum);
      std::printf("%-46s %10.1f ns; a ray %.1f ns of one thread (sum %g)\n", "trilinear lookup, random places",
                  nanoseconds, times.ray_nanoseconds, static_cast<double>(sum));
      return;
    }
  }
}

}  // namespace relook
