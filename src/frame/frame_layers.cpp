#include "frame/frame_layers.h"

#include <map>

#include "base/error.h"
#include "base/tiles.h"

namespace relook {
namespace {

using NamedParts = std::vector<std::pair<std::string, LayerPart>>;

constexpr std::size_t kLongestLayer = 255 - 2;  // bytes; OpenEXR takes 255 for a channel, ".R" is one's end

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80; }

/// `name` cut to `bytes` at most, between two characters of UTF-8.
std::string shortened(const std::string& name, std::size_t bytes) {
  if (name.size() <= bytes) return name;
  while (bytes > 0 && is_continuation(name[bytes])) --bytes;
  return name.substr(0, bytes);
}

/// Spaces, marks of direction, and what else has no shape of its own, beyond ASCII.
bool is_shapeless(char32_t c) {
  return c == 0xA0 || c == 0xAD || c == 0x1680 || (c >= 0x2000 && c <= 0x200F) || (c >= 0x2028 && c <= 0x202F) ||
         (c >= 0x205F && c <= 0x206F) || c == 0x3000 || c == 0xFEFF || (c >= 0xFFF0 && c <= 0xFFFB) || c >= 0xE0000;
}

/// A name as part of a channel's: ASCII's letters, digits, "_" and "-" stay, and the characters of other alphabets; of
/// the rest some divide channels or our own lists, each is "_".
std::string channel_name(std::string_view name) {
  std::string result;
  const std::string clean = printable(name);
  for (std::size_t i = 0; i < clean.size();) {
    std::size_t end = i + 1;
    while (end < clean.size() && is_continuation(clean[end])) ++end;
    const auto first = static_cast<unsigned char>(clean[i]);
    char32_t character = first < 0x80 ? first : first & (0xFFU >> (end - i + 1));
    for (std::size_t k = i + 1; k < end; ++k)
      character = character << 6 | (static_cast<unsigned char>(clean[k]) & 0x3FU);
    const bool is_plain = first < 0x80 ? (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') ||
                                             (first >= '0' && first <= '9') || first == '-'
                                       : !is_shapeless(character);
    result += is_plain ? clean.substr(i, end - i) : "_";
    i = end;
  }
  return result;
}

/// Gives layers names that differ and that channels can have.
class LayerNames {
 public:
  std::string take(const std::string& wanted) {
    const std::string name = shortened(wanted, kLongestLayer);
    int& next = next_[name];  // what its next copy is numbered
    if (next == 0) {
      next = 2;
      return name;
    }
    for (;;) {
      const std::string number = "_" + std::to_string(next++);
      std::string result = shortened(name, kLongestLayer - number.size()) + number;
      if (next_.try_emplace(result, 2).second) return result;
    }
  }

 private:
  std::map<std::string, int> next_;  // by name that is taken
};

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
                     " lamps; the scene has " + std::to_string(scene.light_order.size()));
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
  add_sum("relook:lights", parts_by_light(scene), "lights_rest");
  add_sum("relook:paths", parts_by_path(), "paths_rest");
}

void FrameLayers::add_color(const std::string& layer) {
  for (const char* name : {".R", ".G", ".B"}) channels.push_back({layer + name, PixelFormat::float32});
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
