// The scene side of a cache as files: look document, geometry, textures (texture_parts.cpp). Each encode_ has its
// decode_, which checks every index, count and number and throws CacheDamage; what entities say is for look_check.h to
// check.
#pragma once
#include <string>

#include "cache/cache.h"
#include "cache/container.h"

namespace relook {

[[nodiscard]] Bytes encode_look(const LookDocument& document);
[[nodiscard]] Bytes encode_geometry(const LookDocument& document, const CacheIdentity& identity);
[[nodiscard]] Bytes encode_textures(const Assets& assets, const PyramidStore& pyramids, const CacheIdentity& identity);

void decode_look(BytesView file, LookDocument& document);
/// Meshes, names, cameras, instances and skins.
void decode_geometry(BytesView file, const CacheIdentity& identity, LookDocument& document, Assets& assets);
void decode_textures(BytesView file, const CacheIdentity& identity, Assets& assets, PyramidStore& pyramids);

}  // namespace relook
