#include "cache/cache_parts.h"

#include <cstdio>

#include "cache/image_parts.h"
#include "cache/scene_parts.h"

namespace relook {

std::vector<PartFile> parts_of(const CacheContent& content) {
  std::vector<PartFile> parts{{Part::look}, {Part::geometry}, {Part::textures}, {Part::frame}, {Part::paths}};
  for (std::size_t group = 0; group < cache_group_count(content.camera, content.samples); ++group)
    parts.push_back({Part::trees, group});
  return parts;
}

std::string stem(const PartFile& part) {
  if (part.part == Part::look) return "look.json";
  std::string name(kPartNames[static_cast<std::size_t>(part.part)]);
  if (part.part == Part::trees) {
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
      return encode_frame(content, identity);
    case Part::paths:
      return encode_paths(content, identity);
    case Part::trees:
      return encode_trees(content, part.group, identity);
  }
  return {};
}

}  // namespace relook
