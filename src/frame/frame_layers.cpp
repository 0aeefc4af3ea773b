#include "frame/frame_layers.h"

#include "base/error.h"
#include "base/layer_names.h"
#include "base/tiles.h"
#include "scene/light_sums.h"

namespace relook {
namespace {

using NamedParts = std::vector<std::pair<std::string, LayerPart>>;

ColorPart of_sources(std::uint8_t sources) { return {.sources = sources, .all_lamps = false}; }
LayerPart of_aspect(Aspect aspect) {
  return {{.aspect = aspect, .sources = 0, .branches = {}, .all_lamps = false}, true};
}
ColorPart through(std::initializer_list<Branch> branches) {
  ColorPart part{.sources = 0, .branches = {}, .all_lamps = false};
  for (const Branch branch : branches)
    part.branches.add(branch);
  return part;
}

/// What lit the pixel, on whatever way.
NamedParts parts_by_light(const Scene& scene) {
  NamedParts parts;
  LayerNames names;
  for (const LightId light : scene.light_order) {
    const std::string name = names.take("light_" + channel_name(scene.light(light).node));
    parts.push_back({name, {{.sources = 0, .all_lamps = false, .lamp = light}, false}});
  }
  parts.push_back({"ambient", {of_sources(kAmbientSource), false}});
  parts.push_back({"environment", {of_sources(kEnvironmentSource), false}});
  parts.push_back({"emission", {of_sources(kEmissionSource), false}});
  return parts;
}

/// What the first hit does with the light.
NamedParts parts_by_path() {
  return {
      {"direct", {{.sources = kAmbientSource, .branches = {}}, true}},
      {"reflected", {through({Branch::reflection, Branch::coat}), true}},
      {"refracted",
       {through({Branch::refraction, Branch::refracted_red, Branch::refracted_green, Branch::refracted_blue}), true}},
      {"transparent", {through({Branch::transparency}), true}},
      {"emitted", {{.sources = kEmissionSource, .branches = {}, .all_lamps = false}, true}},
      {"background", {{.sources = kEnvironmentSource, .branches = {}, .all_lamps = false}, true}}};
}

}  // namespace

std::string matte_name(const Material& material) { return material.name.empty() ? "default" : material.name; }

void require_layers(const Scene& scene) {
  // OpenEXR counts the bytes of a tile in 31 bits; other channels than lamps' are less than 100.
  constexpr std::size_t kTilePixels = std::size_t{kTileSize} * kTileSize;
  constexpr std::size_t kMostChannels = 0x7FFFFFFF / (kTilePixels * sizeof(float)),
                        kMostLamps = (kMostChannels - 100) / 3;
  if (scene.light_order.size() > kMostLamps)
    throw UsageError("--aovs: a frame holds layers of at most " + std::to_string(kMostLamps) +
                     (scene.integrator == Integrator::path ? " lights" : " lamps") + "; the scene has " +
                     std::to_string(scene.light_order.size()));
}

FrameLayers::FrameLayers(const Scene& scene, std::uint32_t samples, PixelFormat format)
    : objects("CryptoObject", samples), materials("CryptoMaterial", samples) {
  require_layers(scene);
  for (const char* name : {"R", "G", "B", "A"}) channels.push_back({name, format});
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "depth.Z",
                           "uv.U", "uv.V", "changed.A"})
    channels.push_back({name, PixelFormat::float32});
  for (const Object& object : scene.objects) {
    if (!object.alive) continue;
    objects.add_name(object.node);
    materials.add_name(matte_name(scene.material(object.material)));
  }
  for (const auto& [matte, column] : {std::pair{&objects, &object_column}, std::pair{&materials, &material_column}}) {
    *column = channels.size();
    for (ExrChannel& channel : matte->channels()) channels.push_back(std::move(channel));
    for (auto& attribute : matte->attributes()) attributes.push_back(std::move(attribute));
  }
  parts = {of_aspect(Aspect::albedo), of_aspect(Aspect::normal)};
  if (scene.integrator == Integrator::path) {
    add_lights(scene, samples);
    return;
  }
  add_sum("relook:lights", parts_by_light(scene), "lights_rest");
  add_sum("relook:paths", parts_by_path(), "paths_rest");
}

void FrameLayers::add_color(const std::string& layer) {
  for (const char* name : {".R", ".G", ".B"}) channels.push_back({layer + name, PixelFormat::float32});
}

void FrameLayers::add_lights(const Scene& scene, std::uint32_t samples) {
  light_column = channels.size();
  std::string names;
  for (const LightSum& sum : light_sums(scene)) {
    light_colors.push_back(sum.color);
    add_color(sum.name);
    names += (names.empty() ? "" : " ") + sum.name;
  }
  attributes.emplace_back("relook:lights", names);
  if (samples < 2) return;
  variance_column = channels.size();
  add_color("variance");
}

void FrameLayers::add_sum(const char* attribute, const NamedParts& layers, const std::string& rest) {
  sums.push_back({parts.size(), layers.size(), channels.size()});
  std::string names;
  for (const auto& [name, part] : layers) {
    parts.push_back(part);
    add_color(name);
    names += name + " ";
  }
  add_color(rest);
  attributes.emplace_back(attribute, names + rest);
}

}  // namespace relook
