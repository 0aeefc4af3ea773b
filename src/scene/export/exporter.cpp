#include "scene/export/exporter.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "scene/export/export_values.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/gltf_source.h"
#include "scene/gltf/import.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

constexpr const char* kGenerator = "relook export";
const Json::json_pointer kStamp("/asset/extras/relook/export");

/// Every extension that an object below `value` has.
void collect_extensions(const Json& value, std::set<std::string>& names) {
  if (value.is_array())
    for (const Json& item : value) collect_extensions(item, names);
  if (!value.is_object()) return;
  for (const auto& member : value.items()) {
    if (member.key() == "extras") continue;
    if (member.key() == "extensions" && member.value().is_object())
      for (const auto& extension : member.value().items()) names.insert(extension.key());
    collect_extensions(member.value(), names);
  }
}

std::set<std::string> texts_of(const Json& gltf, const char* key) {
  std::set<std::string> texts;
  for (const Json& text : array_or_empty(gltf, key))
    if (text.is_string()) texts.insert(text.get<std::string>());
  return texts;
}

void set_or_erase(Json& owner, const char* key, Json value) {
  if (value.empty())
    owner.erase(key);
  else
    owner[key] = std::move(value);
}

}  // namespace

ExportSource read_export_source(const std::filesystem::path& path) {
  ExportSource source;
  ImportedGltf imported = import_gltf(path);
  source.gltf = imported.gltf;
  GltfSource file = read_gltf_source(path);
  ImportShare share;
  source.buffers = load_buffers(file, share);
  source.as_was = std::move(file.json);
  source.before = make_look_document(std::move(imported));
  source.before.assets = std::make_shared<Assets>();
  return source;
}

Exporter::Exporter(const LookDocument& document, const ExportSource* source, std::string folder)
    : document_(document), source_(source), folder_(std::move(folder)) {
  for (const auto& node : look(Section::nodes).items())
    for (const Json& child : node.value().value("children", Json::array()))
      parents_[child.get<std::string>()] = node.key();
}

ExportedScene Exporter::run() {
  gltf_ = source_ == nullptr ? Json::object() : source_->gltf;
  Json& asset = gltf_["asset"];
  asset["version"] = "2.0";
  if (asset.contains("generator") && asset["generator"] != kGenerator)
    asset["extras"]["generator"] = asset["generator"];
  if (asset.contains("extras") && !asset["extras"].is_object()) asset.erase("extras");
  asset["generator"] = kGenerator;
  take_buffers();
  for (std::size_t s = 0; s < kSectionCount; ++s) place(static_cast<Section>(s));
  write_cameras();
  write_images();
  write_samplers();
  write_textures();
  write_materials();
  write_variants();
  write_meshes();
  write_lights();
  write_skins();
  write_nodes();
  write_scenes();
  write_animations();
  finish();
  return std::move(result_);
}

/// Puts the source's buffers behind one another into the binary; those without bytes stay buffers of their own.
void Exporter::take_buffers() {
  if (source_ == nullptr) return;
  std::vector<std::size_t> offsets, numbers;
  Json kept = Json::array({Json::object()});
  for (std::size_t i = 0; i < source_->buffers.size(); ++i) {
    const auto& bytes = source_->buffers[i];
    result_.binary.resize((result_.binary.size() + 7) / 8 * 8);
    offsets.push_back(bytes.empty() ? 0 : result_.binary.size());
    numbers.push_back(bytes.empty() ? kept.size() : 0);
    if (bytes.empty())
      kept.push_back(gltf_["buffers"][i]);
    else
      result_.binary.insert(result_.binary.end(), std::as_bytes(std::span(bytes)).begin(),
                            std::as_bytes(std::span(bytes)).end());
  }
  const auto move_view = [&](Json& view) {
    const auto buffer = view["buffer"].get<std::size_t>();
    view["byteOffset"] = view.value("byteOffset", std::size_t{0}) + offsets.at(buffer);
    view["buffer"] = numbers.at(buffer);
  };
  if (gltf_.contains("bufferViews"))
    for (Json& view : gltf_["bufferViews"]) {
      move_view(view);
      for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (view.contains("extensions") && view["extensions"].contains(name)) move_view(view["extensions"][name]);
    }
  gltf_["buffers"] = std::move(kept);
}

const Json* Exporter::before(Section section, const std::string& name) const {
  if (source_ == nullptr) return nullptr;
  const Json& entities = source_->before.look.at(std::string(section_name(section)));
  const auto found = entities.find(name);
  return found == entities.end() ? nullptr : &*found;
}

/// The source's entries first, as far as they are still there, then those that are new, by name. Nodes and skins that
/// the active scene does not use have no place in a document and stay.
void Exporter::place(Section section) {
  Entries& placed = entries_[static_cast<std::size_t>(section)];
  const Json& now = look(section);
  const bool may_be_idle = section == Section::nodes || section == Section::skins;
  const auto add = [&](const std::string& name, std::size_t source) {
    if (!name.empty()) placed.index.emplace(name, placed.slots.size());
    placed.slots.push_back({name, source});
  };
  if (source_ != nullptr) {
    const std::vector<std::string>& order = source_->before.order[static_cast<std::size_t>(section)];
    placed.moved.assign(order.size(), kNowhere);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool was_there = before(section, order[i]) != nullptr;
      if (was_there ? !now.contains(order[i]) : !may_be_idle) continue;
      placed.moved[i] = placed.slots.size();
      add(was_there ? order[i] : "", i);
    }
  }
  for (const auto& entity : now.items())
    if (!placed.index.contains(entity.key())) add(entity.key(), kNowhere);
}

std::size_t Exporter::index_of(Section section, const std::string& name) const {
  const auto found = entries(section).index.find(name);
  return found == entries(section).index.end() ? kNowhere : found->second;
}

std::size_t Exporter::moved(Section section, const Json& index) const {
  const auto& all = entries(section).moved;
  const bool is_one = index.is_number_unsigned() && index.get<std::size_t>() < all.size();
  return is_one ? all[index.get<std::size_t>()] : kNowhere;
}

Json Exporter::written(Section section, const std::string& name, const Json* source, const Json* before) const {
  const Json after = without_keys(look(section)[name]);
  Json item;
  if (source == nullptr) {
    item = after;
    drop_defaults(schema_of(section), item);
  } else {
    item = *source;
    name_indices(source_->before, section, item);
    write_changes(schema_of(section), without_keys(*before), after, item);
  }
  item["name"] = name;
  return item;
}

void Exporter::name_to_index(Section section, Json& value) const {
  visit_names(schema_of(section), value, [&](Target target, Json& name) {
    if (target >= Target::cameras || !name.is_string()) return;
    const std::size_t index = index_of(static_cast<Section>(target), name.get_ref<const std::string&>());
    require(index != kNowhere, "what a document names is in it");
    name = index;
  });
}

/// Of a cache, which keeps them in the order of their names.
void Exporter::write_cameras() {
  if (source_ != nullptr || !document_.cameras.is_object()) return;
  std::map<std::size_t, Json> cameras;
  for (const auto& camera : document_.cameras.items()) {
    Json value = camera.value().value("camera", Json::object());
    value["name"] = camera.key();
    cameras[camera.value().value("index", cameras.size())] = std::move(value);
  }
  for (auto& [index, camera] : cameras) gltf_["cameras"].push_back(std::move(camera));
}

void Exporter::write_variants() {
  const Json::json_pointer place("/extensions/KHR_materials_variants/variants");
  const Json names = document_.look.contains(place) ? document_.look[place] : Json::array();
  const Json then = source_ != nullptr && source_->before.look.contains(place) ? source_->before.look[place] : Json();
  if (names == then) return;
  Json variants = Json::array();
  for (const Json& name : names) variants.push_back({{"name", name}});
  if (variants.empty() && !gltf_.contains("extensions")) return;
  set_or_erase(gltf_["extensions"], "KHR_materials_variants",
               variants.empty() ? Json() : Json{{"variants", std::move(variants)}});
}

/// Those that something has, and those of the source that nothing has by nature (KHR_mesh_quantization).
void Exporter::list_extensions() {
  std::set<std::string> had, has;
  collect_extensions(gltf_, has);
  std::set<std::string> used = has, required(required_.begin(), required_.end());
  if (source_ != nullptr) {
    collect_extensions(source_->as_was, had);
    for (const std::string& name : texts_of(source_->as_was, "extensionsUsed"))
      if (!had.contains(name)) used.insert(name);
    for (const std::string& name : texts_of(source_->as_was, "extensionsRequired"))
      if (used.contains(name)) required.insert(name);
  }
  set_or_erase(gltf_, "extensionsUsed", used);
  set_or_erase(gltf_, "extensionsRequired", required);
}

void Exporter::finish() {
  list_extensions();
  Json& buffers = gltf_["buffers"];
  if (!result_.binary.empty()) {
    if (!buffers.is_array()) buffers = Json::array({Json::object()});
    result_.binary.resize((result_.binary.size() + 3) / 4 * 4);
    buffers[0] = {{"byteLength", result_.binary.size()}};
  } else {
    gltf_.erase("buffers");
  }
  for (const char* key : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                          "meshes", "nodes", "samplers", "scenes", "skins", "textures", "extensions"})
    if (gltf_.contains(key) && gltf_[key].empty()) gltf_.erase(key);
}

ExportedScene export_gltf(const LookDocument& document, const ExportSource* source, const std::string& folder) {
  return Exporter(document, source, folder).run();
}

namespace {

/// Marks the document as an export's, by a hash of all that it says.
Json stamped(Json gltf) {
  gltf[kStamp] = "";
  gltf[kStamp] = hash128(bytes_of(gltf.dump()));
  return gltf;
}

}  // namespace

Bytes glb_of(const ExportedScene& scene) { return glb_file(stamped(scene.gltf), scene.binary); }

std::string gltf_text(ExportedScene& scene, const std::string& folder) {
  if (!scene.binary.empty()) {
    auto bytes = std::make_shared<const Bytes>(std::move(scene.binary));
    const std::string name = folder + "/" + content_name("buffer", *bytes, ".bin");
    scene.gltf["buffers"][0]["uri"] = uri_of(name);
    scene.files.push_back({name, std::move(bytes)});
  }
  return stamped(scene.gltf).dump(2) + "\n";
}

bool is_exported_scene(BytesView file) {
  constexpr std::size_t kHead = 20, kLengthAt = 12;  // of a GLB and its first chunk
  std::string_view text = text_of(file);
  if (text.starts_with("glTF")) {
    if (file.size() < kHead) return false;
    std::size_t length = 0;
    for (std::size_t i = sizeof(std::uint32_t); i-- > 0;)
      length = length << 8 | std::to_integer<std::size_t>(file[kLengthAt + i]);
    text = text.substr(kHead, length);
  }
  Json gltf = Json::parse(text, nullptr, false);
  if (!gltf.is_object() || !gltf.contains(kStamp) || !gltf[kStamp].is_string()) return false;
  const auto stamp = gltf[kStamp].get<std::string>();
  return stamped(std::move(gltf))[kStamp] == stamp;
}

}  // namespace relook
