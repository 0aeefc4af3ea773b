// Files that an edit brings in: images by uri, glTF assets under a new node. All lie below the journal's own folder or
// one of the roots (scene/gltf/import_rules.h).
#include <map>

#include "base/hash.h"
#include "base/import_memory.h"
#include "edit/transaction.h"
#include "scene/gltf/import.h"
#include "scene/gltf/import_rules.h"
#include "scene/look/counted_assets.h"
#include "scene/look/look_check.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

using Renames = std::array<std::map<std::string, std::string>, kSectionCount>;

/// Every name of `part` with the prefix, unique in `document`.
Renames renames_for(const LookDocument& part, const LookDocument& document, const std::string& prefix) {
  Renames renames;
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const std::string section(section_name(static_cast<Section>(s)));
    UniqueNames unique([&](const std::string& candidate) { return document.look[section].contains(candidate); });
    for (const auto& item : part.look[section].items())
      renames[s].emplace(item.key(), unique.give(prefix + item.key()));
  }
  return renames;
}

/// A name like this one under which a document keeps nothing yet: what is kept outlives the entry that names it, since
/// a journal may go back to it.
template <class Kept>
std::string free_key(const Kept& kept, const std::string& name) {
  UniqueNames unique([&](const std::string& candidate) { return kept.contains(candidate); });
  return unique.give(name);
}

/// Roots of a document in the order of its file.
std::vector<std::string> roots_of(const LookDocument& part) {
  std::set<std::string> children;
  for (const Json& node : part.look["nodes"])
    for (const Json& child : node["children"]) children.insert(child.get<std::string>());
  std::vector<std::string> roots;
  for (const std::string& name : part.order[static_cast<std::size_t>(Section::nodes)])
    if (part.look["nodes"].contains(name) && !children.contains(name)) roots.push_back(name);
  return roots;
}

void rename_references(Section section, const Renames& renames, Json& value) {
  visit_names(schema_of(section), value, [&](Target target, Json& name) {
    if (target == Target::cameras || target == Target::variants) return;
    name = renames[static_cast<std::size_t>(target)].at(name.get<std::string>());
  });
}

}  // namespace

/// The key of these bytes among the stored images: equal bytes have one key, so no pyramid goes stale.
std::string Transaction::keep_image(std::shared_ptr<const Bytes> bytes) {
  std::string key = hash128(*bytes);
  const auto [image, is_new] = document().assets->images.try_emplace(key);
  if (is_new) {
    image->second = {key, std::move(bytes)};
    new_images_.push_back(key);
  }
  return key;
}

void Transaction::load_image(const std::string& name, const PatchPlace& place) {
  Json& value = *find({"images", name});
  if (!value["uri"].is_string()) throw InputError(place.file, place.where, "expected a string");
  const std::filesystem::path path = allowed_path(folder_, value["uri"].get<std::string>(), place.file, place.where);
  Bytes content = read_file(path);
  ImportShare share(content.size(), place.file, place.where + ": the image");
  auto bytes = kept_with(std::move(share), std::move(content));
  (void)read_image_header(*bytes, place.file, place.where);
  Json& extras = value["extras"];
  if (!extras.is_object()) extras = Json::object();
  if (!extras.contains("relook") || !extras["relook"].is_object()) extras["relook"] = Json::object();
  extras["relook"]["content"] = keep_image(std::move(bytes));
}

void Transaction::merge_asset(const std::string& node, const PatchPlace& place) {
  check_sections(document(), file_);  // entries are added to them
  Json& value = *find({"nodes", node});
  if (!value["asset"].is_string()) throw InputError(place.file, place.where, "expected the name of a glTF file");
  LookDocument part = make_look_document(
      import_gltf(allowed_path(folder_, value["asset"].get<std::string>(), place.file, place.where)));
  value.erase("asset");
  const Renames renames = renames_for(part, document(), node + "/");
  const auto renamed = [&](Section section, const std::string& name) {
    return renames[static_cast<std::size_t>(section)].at(name);
  };
  if (!value.contains("children")) value["children"] = Json::array();
  if (!value["children"].is_array()) throw InputError(place.file, place.where, "\"children\" is no array of names");
  for (const std::string& root : roots_of(part)) value["children"].push_back(renamed(Section::nodes, root));

  std::map<std::string, std::string> geometry_keys, instance_keys, skin_keys;  // by the name of the entry
  Assets& assets = *document().assets;
  const auto offset = static_cast<std::uint32_t>(assets.meshes.size());
  for (Mesh& mesh : part.assets->meshes) {
    mesh.name = renamed(Section::meshes, mesh.name);
    assets.meshes.push_back(std::move(mesh));
  }
  for (auto& [geometry, ids] : part.assets->mesh_primitives) {
    const std::string key = free_key(assets.mesh_primitives, renamed(Section::meshes, geometry));
    for (MeshId& id : ids) id = MeshId(id.index() + offset);
    assets.mesh_primitives[key] = std::move(ids);
    new_geometry_.push_back(key);
    geometry_keys[renamed(Section::meshes, geometry)] = key;
  }
  for (auto& [name, matrices] : part.instances) {
    new_instances_.push_back(free_key(document().instances, renamed(Section::nodes, name)));
    document().instances[new_instances_.back()] = std::move(matrices);
    instance_keys[renamed(Section::nodes, name)] = new_instances_.back();
  }
  for (auto& [name, matrices] : part.inverse_binds) {
    new_inverse_binds_.push_back(free_key(document().inverse_binds, renamed(Section::skins, name)));
    document().inverse_binds[new_inverse_binds_.back()] = std::move(matrices);
    skin_keys[renamed(Section::skins, name)] = new_inverse_binds_.back();
  }
  part.inverse_binds.clear();
  count_geometry(part);  // nothing is left there
  count_geometry(document());
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    const std::string section_text(section_name(section));
    for (const auto& item : part.look[section_text].items()) {
      Json entry = std::move(item.value());
      rename_references(section, renames, entry);
      const std::string& name = renamed(section, item.key());
      if (section == Section::images)
        entry["extras"]["relook"]["content"] = keep_image(part.assets->images.at(item.key()).bytes);
      if (section == Section::meshes) {
        entry["extras"]["relook"]["geometry"] = geometry_keys.contains(name) ? geometry_keys.at(name) : name;
        if (entry.contains("primitives"))
          for (Json& primitive : entry["primitives"]) primitive.erase("extensions");  // variants of the asset's own
      }
      if (section == Section::skins)
        entry["extras"]["relook"]["inverseBinds"] = skin_keys.contains(name) ? skin_keys.at(name) : name;
      if (section == Section::nodes) {
        entry.erase("camera");
        if (const auto key = instance_keys.find(name); key != instance_keys.end())
          entry["extras"]["relook"]["instances"] = key->second;
      }
      add_entry(section_text, name, std::move(entry));
    }
  }
}

}  // namespace relook
