// What a look is made of: images, samplers, textures, materials, meshes, lights.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "scene/compile/compile_material.h"
#include "scene/export/export_values.h"
#include "scene/export/exporter.h"
#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/gltf_json.h"
#include "scene/light.h"
#include "scene/look/light_shares.h"
#include "scene/look/sides.h"

namespace relook {
namespace {

const std::string& key_of(const Json& entity, const char* key) {
  return entity["extras"]["relook"][key].get_ref<const std::string&>();
}

Json& member_of_extension(Json& owner, std::string_view extension, const char* key) {
  return owner["extensions"][std::string(extension)][key];
}

const Json* extension_source(const Json& texture, std::string_view extension) {
  return member_at(texture, {"extensions", extension, "source"});
}

const LightTraits& traits_of_light(const Json& light) {
  const auto& word = light["type"].get_ref<const std::string&>();
  return *std::ranges::find(kLightTraits, word, &LightTraits::word);
}

constexpr const char* kPunctual = "KHR_lights_punctual";
constexpr const char* kArea = "EXT_lights_area";

}  // namespace

/// The index in the source of the entity that gives geometry, an image or matrices of that key.
std::optional<std::size_t> Exporter::source_of_key(Section section, const std::string& key) const {
  if (before(section, key) == nullptr) return std::nullopt;
  const auto& order = source_->before.order[static_cast<std::size_t>(section)];
  const auto found = std::ranges::find(order, key);
  return found == order.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - order.begin()));
}

/// Images without bytes, which nothing shows, are left out.
void Exporter::write_images() {
  Entries& images = entries_[static_cast<std::size_t>(Section::images)];
  const Json source = source_ == nullptr ? Json::array() : gltf_.value("images", Json::array());
  Entries kept;
  kept.moved.assign(images.moved.size(), kNowhere);
  Json list = Json::array();
  std::set<std::string> foreign;
  for (const Slot& slot : images.slots) {
    const std::string& key = key_of(look(Section::images)[slot.name], "content");
    const std::shared_ptr<const Bytes>& bytes = document_.assets->images.at(key).bytes;
    if (bytes == nullptr) {
      remark("image \"" + slot.name + "\", which nothing shows, has no content and is left out");
      continue;
    }
    const auto at = source_of_key(Section::images, key);
    Json item = at && *at < source.size() ? source[*at] : Json::object();
    for (const char* member : {"uri", "mimeType"}) item.erase(member);
    const ImageKind kind = image_kind(*bytes);
    if (item.contains("bufferView"))
      item["mimeType"] = kind.mime_type;
    else
      item.update(image(slot.name, bytes));
    if (item.contains("bufferView") && !kind.is_of_gltf) foreign.emplace(kind.suffix.substr(1));
    item["name"] = slot.name;
    if (slot.source != kNowhere) kept.moved[slot.source] = list.size();
    kept.index.emplace(slot.name, list.size());
    kept.slots.push_back(slot);
    list.push_back(std::move(item));
  }
  gltf_["images"] = std::move(list);
  images = std::move(kept);
  for (const std::string& suffix : foreign)
    remark("an ." + suffix +
           " image is in the file, which relook reads and glTF has no type for; of a .gltf it lies beside it");
}

/// Where an image's bytes are: in the binary, or in a file.
Json Exporter::image(const std::string& name, const std::shared_ptr<const Bytes>& bytes) {
  const auto [placed, is_new] = placed_images_.try_emplace(bytes.get());
  if (!is_new) return placed->second;
  const ImageKind kind = image_kind(*bytes);
  if (folder_.empty()) {
    placed->second = {{"bufferView", columns_.add_view(*bytes)}, {"mimeType", kind.mime_type}};
  } else {
    const std::string file = folder_ + "/" + content_name(name, *bytes, kind.suffix);
    result_.files.push_back({file, bytes});
    placed->second = {{"uri", uri_of(file)}};
    if (kind.is_of_gltf) placed->second["mimeType"] = kind.mime_type;
  }
  return placed->second;
}

void Exporter::write_samplers() {
  const Json source = gltf_.value("samplers", Json::array());
  Json list = Json::array();
  for (const Slot& slot : entries(Section::samplers).slots)
    list.push_back(written(Section::samplers, slot.name, slot.source == kNowhere ? nullptr : &source[slot.source],
                           before(Section::samplers, slot.name)));
  gltf_["samplers"] = std::move(list);
}

void Exporter::write_textures() {
  const Json source = gltf_.value("textures", Json::array());
  Json list = Json::array();
  for (const Slot& slot : entries(Section::textures).slots) {
    const Json* item = slot.source == kNowhere ? nullptr : &source[slot.source];
    Json texture = written(Section::textures, slot.name, item, before(Section::textures, slot.name));
    set_texture_source(slot, texture);
    if (texture.contains("sampler"))
      texture["sampler"] = index_of(Section::samplers, texture["sampler"].get<std::string>());
    list.push_back(std::move(texture));
  }
  gltf_["textures"] = std::move(list);
}

/// The image goes where its type belongs; other images that the file has for the same texture stay while no edit chose
/// one. Requires: `source` is still a name.
void Exporter::set_texture_source(const Slot& slot, Json& texture) {
  const std::string name = texture.value("source", "");
  texture.erase("source");
  if (texture.contains("extensions")) {
    for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu"}) texture["extensions"].erase(extension);
    if (texture["extensions"].empty()) texture.erase("extensions");
  }
  const std::size_t index = name.empty() ? kNowhere : index_of(Section::images, name);
  if (index == kNowhere) return;
  const std::string& key = key_of(look(Section::images)[name], "content");
  const ImageKind kind = image_kind(*document_.assets->images.at(key).bytes);
  if (kind.extension.empty())
    texture["source"] = index;
  else
    member_of_extension(texture, kind.extension, "source") = index;
  const Json* then = before(Section::textures, slot.name);
  const bool is_as_was = then != nullptr && then->value("source", "") == name;
  const Json empty = Json::array();
  const Json& originals = source_ == nullptr ? empty : array_or_empty(source_->as_was, "textures");
  if (is_as_was && slot.source < originals.size()) {
    const Json& original = originals[slot.source];
    const std::size_t plain = moved(Section::images, original.value("source", Json()));
    if (!texture.contains("source") && plain != kNowhere) texture["source"] = plain;
    const Json* basis = extension_source(original, "KHR_texture_basisu");
    const std::size_t other = basis == nullptr ? kNowhere : moved(Section::images, *basis);
    if (kind.extension.empty() && other != kNowhere)
      member_of_extension(texture, "KHR_texture_basisu", "source") = other;
  }
  if (!texture.contains("source")) required_.emplace_back(kind.extension);
}

void Exporter::write_materials() {
  const Json source = gltf_.value("materials", Json::array());
  const Schema& schema = schema_of(Section::materials);
  Json list = Json::array();
  for (const Slot& slot : entries(Section::materials).slots) {
    Json item = slot.source == kNowhere ? Json() : source[slot.source];
    visit_foreign_textures(&schema, item, [&](Json& info) {
      const std::size_t index = moved(Section::textures, info["index"]);
      if (index != kNowhere) info["index"] = index;
      return index != kNowhere;
    });
    Json material =
        written(Section::materials, slot.name, item.is_null() ? nullptr : &item, before(Section::materials, slot.name));
    const Json& now = look(Section::materials)[slot.name];
    const Json& model = now["extras"]["relook"]["model"];
    // An unlit material of a file is unlit unless the model is there.
    if (member_at(material, {"extensions", "KHR_materials_unlit"}) != nullptr && model != "unlit")
      material["extras"]["relook"]["model"] = model;
    write_sides(now["doubleSided"].get<bool>(), material);
    name_to_index(Section::materials, material);
    list.push_back(std::move(material));
  }
  gltf_["materials"] = std::move(list);
}

void Exporter::write_meshes() {
  const Json source = gltf_.value("meshes", Json::array());
  const Json::json_pointer place("/extensions/KHR_materials_variants/variants");
  const Json variants = document_.look.contains(place) ? document_.look[place] : Json::array();
  Json list = Json::array();
  for (const Slot& slot : entries(Section::meshes).slots) {
    const std::string& key = key_of(look(Section::meshes)[slot.name], "geometry");
    const auto at = source_of_key(Section::meshes, key);
    Json mesh =
        at ? written(Section::meshes, slot.name, &source[*at], before(Section::meshes, key)) : new_mesh(slot.name, key);
    name_to_index(Section::meshes, mesh);
    for (Json& primitive : mesh["primitives"])
      if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_materials_variants"))
        for (Json& mapping : primitive["extensions"]["KHR_materials_variants"]["mappings"])
          for (Json& variant : mapping["variants"])
            if (variant.is_string())
              variant = static_cast<std::size_t>(std::ranges::find(variants, variant) - variants.begin());
    list.push_back(std::move(mesh));
  }
  gltf_["meshes"] = std::move(list);
}

/// A mesh whose geometry is in no file of the source.
Json Exporter::new_mesh(const std::string& name, const std::string& geometry) {
  Json mesh = written(Section::meshes, name, nullptr, nullptr);
  Json primitives = mesh.value("primitives", Json::array());
  const auto [known, is_new] = geometry_.try_emplace(geometry);
  if (is_new) {
    MeshToWrite columns{name, primitives.size(), {}};
    for (const MeshId id : document_.assets->mesh_primitives.at(geometry))
      columns.primitives.push_back(&document_.assets->meshes[id.index()]);
    known->second = columns_.add_primitives(columns);
  }
  Json written = known->second;
  for (std::size_t i = 0; i < std::min(written.size(), primitives.size()); ++i)
    for (const char* member : {"material", "extensions"})
      if (primitives[i].contains(member)) written[i][member] = primitives[i][member];
  mesh["primitives"] = std::move(written);
  return mesh;
}

const Json* Exporter::source_light(const std::string& name) const {
  if (before(Section::lights, name) == nullptr) return nullptr;
  const auto& order = source_->before.order[static_cast<std::size_t>(Section::lights)];
  const auto at = static_cast<std::size_t>(std::ranges::find(order, name) - order.begin());
  const Json& punctual = gltf_array(source_->gltf, Section::lights);
  return at < punctual.size() ? &punctual[at] : &gltf_area_lights(source_->gltf)[at - punctual.size() - 1];
}

/// A light with what its type has, and nothing else.
Json Exporter::light(const std::string& name) const {
  const Json* then = before(Section::lights, name);
  const Json& now = look(Section::lights)[name];
  Json light = written(Section::lights, name, source_light(name), then);
  const LightTraits& traits = traits_of_light(now);
  const bool is_another_kind = then == nullptr || (*then)["type"] != now["type"];
  if (traits.has_size || is_another_kind) light["intensity"] = now["intensity"];  // whose default differs by type
  if (traits.has_size)
    light["size"] = now["size"];
  else
    light.erase("size");
  if (now["type"] != "rect") light.erase("rect");
  if (traits.has_size) light.erase("range");
  if (!traits.has_cone) {
    light.erase("spot");
    return light;
  }
  // glTF wants the inner angle below the outer one; a float does not tell the two apart.
  const Json& spot = now["spot"];
  const double inner = spot["innerConeAngle"].get<double>(), outer = spot["outerConeAngle"].get<double>();
  if (!light.contains("spot")) light["spot"] = Json::object();
  if (!(inner < outer)) light["spot"]["innerConeAngle"] = std::nextafter(outer, 0.0);
  return light;
}

void Exporter::write_lights() {
  std::size_t placed = 0;
  for (const Json& node : look(Section::nodes))
    if (light_name_of(node) != nullptr) ++placed;
  std::map<std::string, Json> lists;
  for (const Slot& slot : entries(Section::lights).slots) {
    Json item = light(slot.name);
    if (placed > kLightsAlone)  // an import would share them out anew
      for (const auto& [member, own] : {std::pair<const char*, Json>{"sum", ""}, {"rate", 1.0}})
        if (member_at(item, {"extras", "relook", member}) == nullptr) item["extras"]["relook"][member] = own;
    const char* extension = traits_of_light(look(Section::lights)[slot.name]).has_size ? kArea : kPunctual;
    lights_[slot.name] = {extension, lists[extension].size()};
    lists[extension].push_back(std::move(item));
  }
  for (const char* extension : {kPunctual, kArea}) {
    if (lists.contains(extension))
      gltf_["extensions"][extension]["lights"] = std::move(lists[extension]);
    else if (gltf_.contains("extensions"))
      gltf_["extensions"].erase(extension);
  }
}

}  // namespace relook
