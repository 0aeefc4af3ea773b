// Values of a look document on their way back into a glTF file: only what differs from what the file says is written,
// and of what is new no default. Used by export_gltf.cpp alone.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "scene/look/look.h"
#include "scene/look/look_schema.h"

namespace relook {

/// Without extras.relook's keys to geometry, images and matrices, which imports give anew.
[[nodiscard]] Json without_keys(Json value);

/// Removes members that say a default, and objects that are empty then, where their absence says the same.
void drop_defaults(const Schema& schema, Json& value);

/// Writes into an entity of a file, in the form of look documents (names for indices), what an edit made of `before`.
void write_changes(const Schema& schema, const Json& before, const Json& after, Json& target);

/// Calls visit(textureInfo) for the textures of a material that no schema knows, of foreign extensions; where it
/// returns false the texture is removed.
void visit_foreign_textures(const Schema* schema, Json& value, const std::function<bool(Json&)>& visit);

/// A relative path as a URI: "my shot.files/a.png" to "my%20shot.files/a.png".
[[nodiscard]] std::string uri_of(std::string_view path);

/// "Leaves" to "Leaves-0123456789abcdef.png": plain characters alone, distinct for distinct bytes.
[[nodiscard]] std::string content_name(const std::string& name, const Bytes& bytes, std::string_view suffix);

/// What an image's bytes are, by their first ones.
struct ImageKind {
  std::string_view mime_type, suffix;
  std::string_view extension = "";  // that a texture needs for it; "": none
  bool is_of_gltf = true;           // false: no extension has it either
};
[[nodiscard]] ImageKind image_kind(const Bytes& bytes);

}  // namespace relook
