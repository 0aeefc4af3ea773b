#include "cache/cache_parts.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/error.h"
#include "cache/image_parts.h"
#include "cache/scene_parts.h"

namespace relook {

std::vector<PartFile> parts_of(const CacheContent& content) {
  std::vector<PartFile> parts{{Part::look}, {Part::geometry}, {Part::textures}, {Part::frame}, {Part::paths}};
  const std::size_t groups = cache_group_count(content.camera, content.image.view.samples);
  for (std::size_t group = 0; group < groups; ++group) parts.push_back({Part::trees, group});
  if (has_tunnels(content.storage, content.camera))
    for (std::size_t group = 0; group < groups; ++group) parts.push_back({Part::tunnels, group});
  return parts;
}

std::string stem(const PartFile& part) {
  constexpr std::array<std::string_view, 7> kPartNames{"look.json", "geometry", "textures", "frame",
                                                       "paths",     "trees",    "tunnels"};
  if (part.part == Part::look) return "look.json";
  std::string name(kPartNames[static_cast<std::size_t>(part.part)]);
  if (part.part == Part::trees || part.part == Part::tunnels) {
    char digits[24];
    std::snprintf(digits, sizeof digits, "/%05zu", part.group);
    name += digits;
  }
  return name + "-";
}

Bytes encode(const PartFile& part, const CacheContent& content, const CacheIdentity& identity) {
  switch (part.part) {
    case Part::look:
      return encode_look(content.document);
    case Part::geometry:
      return encode_geometry(content.document, identity);
    case Part::textures:
      return encode_textures(*content.document.assets, *content.pyramids, identity);
    case Part::frame:
      return encode_frame(content.image, identity);
    case Part::paths:
      return encode_paths(content.image, identity);
    case Part::trees:
      return encode_trees(content.image, part.group, identity);
    case Part::tunnels:
      break;
  }
  require(false, "tunnels are encoded with what they are bound to");
  return {};
}

const CacheFile& find_file(const Manifest& manifest, const PartFile& part) {
  const std::string start = stem(part);
  const auto found = std::find_if(manifest.files.begin(), manifest.files.end(),
                                  [&](const CacheFile& file) { return file.name.starts_with(start); });
  check_sound(found != manifest.files.end(), "the manifest names no file " + start);
  return *found;
}

std::string hashes_bound_to(const Manifest& manifest, std::size_t group) {
  return find_file(manifest, {Part::trees, group}).hash + find_file(manifest, {Part::paths}).hash;
}

}  // namespace relook
