// Caches whose content is anything and whose hashes are right: opened, checked, and two edits replayed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cache_bytes.h"
#include "fuzz_targets.h"
#include "image/cached_image.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kWidth = 68, kHeight = 3;  // two tiles
constexpr std::size_t kMostChanges = 8;

Rgba checker(std::uint32_t x, std::uint32_t y) {
  return ((x / 2 + y / 2) & 1U) != 0 ? Rgba(0.2F, 0.7F, 0.4F, 1) : Rgba(0.9F, 0.5F, 0.1F, 0.4F);
}

/// A textured floor, a mirror box and a veil before it under two lights: every kind of path.
SceneState tiny_scene() {
  SceneBuilder builder;
  const int picture = builder.texture("Picture", builder.image("Checker", single_level_image(4, checker)));
  const int grey = builder.material("Grey", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", picture}}}}}});
  const int mirror =
      builder.material("Mirror", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
  const int veil = builder.material(
      "Veil", {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.9, 0.5, 0.5}}}}});
  builder.node("Floor", {{"mesh", builder.mesh("Floor", plane_mesh(4, 1), grey)}});
  builder.node("Box",
               {{"mesh", builder.mesh("Box", box_mesh({0.5F, 0.5F, 0.5F}), mirror)}, {"translation", {0, 0.5, 0}}});
  builder.node("Card", {{"mesh", builder.mesh("Card", card_mesh(0.6F, 0.6F), veil)}, {"translation", {0.9, 0.6, 0.8}}});
  builder.light("Lamp", {{"type", "point"}, {"intensity", 100}}, {{"translation", {2, 3, 2}}});
  builder.light("Sun", {{"type", "directional"}, {"intensity", 1}}, {{"rotation", {-0.6, 0, 0, 0.8}}});
  builder.look_at({0, 1.5F, 4}, {0, 0.5F, 0}, 20, kWidth, kHeight);
  return builder.state();
}

RegionOptions regions() {
  RegionOptions options;
  options.tunnels = 2;
  return options;
}

/// Of the tiny scene.
CacheBytes sound_cache(const fs::path& folder) {
  const SceneState state = tiny_scene();
  TunnelRecord tunnels;
  tunnels.shape = regions().shape();
  RenderStats stats;
  Image image = preprocess(state.scene(), {1, 4, 2}, stats, {}, &tunnels);
  write_cache(folder, cache_content(state, std::move(image), std::string(32, 'a'), std::move(tunnels)));
  return CacheBytes::of(folder);
}

void replay(OpenedCache opened, const fs::path& folder) {
  Replayer replayer(std::move(*opened.state), std::move(opened.image), regions(), nullptr, std::move(opened.tunnels));
  const Edit edits[] = {
      replace_edit("/materials/Grey/pbrMetallicRoughness/baseColorFactor", {0.1, 0.2, 0.3, 1}),
      replace_edit("/nodes/Box/translation", {0.2, 0.6, 0.1}),
      replace_edit("/materials/Veil/extensions/KHR_materials_ior/ior", 1.2),
  };
  for (const Edit& edit : edits)
    is_answered({ExitCode::bad_input, ExitCode::damaged_cache}, [&] { replayer.step(edit, "edit", folder); });
}

/// What is lost is traced again: for as many samples as a test may take.
bool may_trace(const Json& content) {
  if (!content.is_object() || !content.contains("camera") || !content["camera"].is_object()) return false;
  const auto is_at_most = [](const Json& value, const char* key, double most) {
    return value.contains(key) && value[key].is_number() && value[key].get<double>() <= most;
  };
  return is_at_most(content["camera"], "width", kWidth) && is_at_most(content["camera"], "height", 64) &&
         is_at_most(content, "samples", 4) && is_at_most(content, "max_depth", 8);
}

void open(const fs::path& cache, bool mends) {
  is_answered({ExitCode::out_of_resources}, [&] {
    OpenedCache opened;
    const CacheAnswer answer = open_cache(cache, mends, opened);
    if (std::getenv("RELOOK_FUZZ_SAYS") != nullptr) std::fprintf(stderr, "answer: %s\n", explanation(answer).c_str());
    expect(answer.fault != CacheFault::missing && answer.fault != CacheFault::unreadable, "the cache is there");
    if (answer.fault == CacheFault::none) replay(std::move(opened), cache);
  });
}

}  // namespace

int fuzz_cache(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  static const FuzzFolder folder("cache");
  static const CacheBytes sound = sound_cache(folder.path() / "sound");
  const fs::path cache = folder.path() / "c";
  fs::remove_all(cache);
  fs::create_directory(cache);
  CacheBytes bytes = sound;
  Choices choices(fuzz_bytes(data, size));
  for (std::size_t i = 0; i < kMostChanges && !choices.at_end(); ++i) bytes.change(choices);
  bytes.write(cache);
  open(cache, false);
  if (may_trace(bytes.content)) open(cache, true);
  is_answered({ExitCode::out_of_resources}, [&] { (void)check_cache(cache); });
  return 0;
}

}  // namespace relook
