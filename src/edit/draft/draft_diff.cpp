#include "edit/draft/draft_diff.h"

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "edit/patch.h"
#include "scene/gltf/gltf_write.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

const Json::json_pointer kGeometry("/extras/relook/geometry");
const Json::json_pointer kInverseBinds("/extras/relook/inverseBinds");
const Json::json_pointer kContent("/extras/relook/content");
const Json::json_pointer kInstances("/extras/relook/instances");

bool equal(const Mesh& a, const Mesh& b) {
  return a.primitive == b.primitive && a.positions == b.positions && a.triangles == b.triangles &&
         a.normals == b.normals && a.tangents == b.tangents && a.uv == b.uv && a.colors == b.colors &&
         a.targets == b.targets && a.joints == b.joints && a.joint_weights == b.joint_weights;
}

bool equal(const EncodedImage& a, const EncodedImage& b) {
  return a.bytes == b.bytes || (a.bytes != nullptr && b.bytes != nullptr && *a.bytes == *b.bytes);
}

/// "Leaves" to "Leaves-0123abcd.png": letters and digits only, distinct for distinct bytes.
std::string file_name_of(const std::string& image, const Bytes& bytes) {
  std::string name;
  for (const char c : image) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    name += is_plain ? c : '_';
  }
  constexpr std::size_t kHashDigits = 16, kLongest = 64;
  const std::string_view text = text_of(bytes);
  const char* extension = text.starts_with("\x89PNG")    ? ".png"
                          : text.starts_with("\xFF\xD8") ? ".jpg"
                          : text.starts_with("glTF")     ? ".glb"
                                                         : "";
  return name.substr(0, kLongest) + "-" + hash128(bytes).substr(0, kHashDigits) + extension;
}

class Differ {
 public:
  Differ(const LookDocument& before, const LookDocument& after, const std::string& folder)
      : before_(before), after_(after), folder_(folder) {}

  DiffDraft run() {
    for (const Section section : {Section::samplers, Section::images, Section::textures, Section::materials,
                                  Section::lights, Section::meshes, Section::skins, Section::nodes})
      diff_section(section);
    diff({"scene"}, before_.look["scene"], after_.look["scene"]);
    remove_rest();
    bring_geometry();
    warn();
    result_.draft.steps.push_back({{"name", before_.file + " to " + after_.file}, {"edit", std::move(edit_)}});
    return std::move(result_);
  }

 private:
  void add_operation(const char* op, const Tokens& path) {
    edit_.push_back({{"op", op}, {"path", pointer_text(path)}});
  }
  void add_operation(const char* op, const Tokens& path, Json value) {
    add_operation(op, path);
    edit_.back()["value"] = std::move(value);
  }

  static Tokens below(Tokens path, std::string token) {
    path.push_back(std::move(token));
    return path;
  }

  /// What turns `from` at `path` into `to`.
  void diff(const Tokens& path, const Json& from, const Json& to) {
    if (from == to) return;
    const bool is_list = from.is_array() && to.is_array() && from.size() == to.size() && !to.empty() &&
                         to[0].is_object() && from[0].is_object();
    if (is_list)
      for (std::size_t i = 0; i < to.size(); ++i) diff(below(path, std::to_string(i)), from[i], to[i]);
    else if (from.is_object() && to.is_object())
      diff_members(path, from, to);
    else
      add_operation("replace", path, to);
  }

  void diff_members(const Tokens& path, const Json& from, const Json& to) {
    for (const auto& member : from.items())
      if (!to.contains(member.key())) add_operation("remove", below(path, member.key()));
    for (const auto& member : to.items()) {
      if (from.contains(member.key()))
        diff(below(path, member.key()), from[member.key()], member.value());
      else
        add_operation("add", below(path, member.key()), member.value());
    }
  }

  void diff_section(Section section) {
    const std::string name(section_name(section));
    const Json& olds = before_.look[name];
    for (const auto& item : after_.look[name].items()) {
      const auto old = olds.find(item.key());
      if (section == Section::images) {
        diff_image(item.key());
        continue;
      }
      Json from = old == olds.end() ? Json() : editable(section, *old);
      Json to = editable(section, item.value());
      if (section == Section::meshes && !name_geometry(item.key(), to)) continue;
      if (section == Section::nodes) name_instances(item.key(), to);
      if (section == Section::skins) name_inverse_binds(item.key(), to);
      if (from.is_null())
        add_operation("add", {name, item.key()}, std::move(to));
      else if (from != to && is_another_kind(section, from, to))
        add_operation("replace", {name, item.key()}, std::move(to));
      else
        diff({name, item.key()}, from, to);
    }
  }

  /// An entity without what no journal edits.
  static Json editable(Section section, Json value) {
    if (section == Section::nodes) value.erase("camera");
    if (section == Section::meshes && value.contains("primitives"))
      for (Json& primitive : value["primitives"]) primitive.erase("extensions");
    return value;
  }

  /// Members exclude each other: only a whole value says it.
  static bool is_another_kind(Section section, const Json& from, const Json& to) {
    if (section == Section::nodes) return from.contains("matrix") != to.contains("matrix");
    return section == Section::lights && from["type"] != to["type"];
  }

  static const EncodedImage& image_of(const LookDocument& document, const std::string& name) {
    return document.assets->images.at(document.look["images"][name][kContent].get<std::string>());
  }

  void diff_image(const std::string& name) {
    const EncodedImage& image = image_of(after_, name);
    const bool is_known = before_.look["images"].contains(name);
    if (is_known && equal(image_of(before_, name), image)) return;
    if (image.bytes == nullptr) {
      if (!is_known) return add_operation("add", {"images", name}, Json::object());
      throw InputError(after_.file, "", "image \"" + name + "\" has no content any more, which no journal can say");
    }
    const std::string file = folder_ + "/" + file_name_of(name, *image.bytes);
    result_.files.push_back({file, image.bytes});
    add_operation("add", {"images", name}, {{"uri", file}});
  }

  /// Puts the name that its geometry has in `before_`, or will have, into a mesh of `after_`. False: unknown, and shown
  /// by no node.
  bool name_geometry(const std::string& mesh, Json& value) {
    const auto& known = before_.assets->mesh_primitives;
    const std::vector<MeshId>& wanted = after_.assets->mesh_primitives.at(value[kGeometry].get<std::string>());
    const auto fits = [&](const std::vector<MeshId>& ids) {
      return std::equal(ids.begin(), ids.end(), wanted.begin(), wanted.end(), [&](MeshId a, MeshId b) {
        return equal(before_.assets->meshes[a.index()], after_.assets->meshes[b.index()]);
      });
    };
    auto found = known.find(key_before(Section::meshes, mesh, kGeometry));
    if (found == known.end() || !fits(found->second))
      found = std::find_if(known.begin(), known.end(), [&](const auto& entry) { return fits(entry.second); });
    if (found != known.end()) {
      value[kGeometry] = found->first;
      return true;
    }
    const bool is_shown =
        std::ranges::any_of(after_.look["nodes"], [&](const Json& node) { return node.value("mesh", Json()) == mesh; });
    if (is_shown) {
      MeshToWrite& brought = geometry_.emplace_back(mesh, value["primitives"].size());
      for (const MeshId id : wanted) brought.primitives.push_back(&after_.assets->meshes[id.index()]);
      value[kGeometry] = carrier_ + "/" + mesh;
      return true;
    }
    result_.draft.warnings.push_back("mesh \"" + mesh + "\" is left out: no node shows it");
    return false;
  }

  /// A node's name under which a file with geometry can be merged: nothing is called like what is below it.
  [[nodiscard]] std::string carrier() const {
    return unique_name("geometry", [&](const std::string& candidate) {
      const std::string below = candidate + "/";
      const auto has_below = [&](const auto& named) {
        const auto next = named.lower_bound(below);
        return next != named.end() && next->first.starts_with(below);
      };
      const auto is_taken = [&](const LookDocument& document) {
        return document.look["nodes"].contains(candidate) || has_below(document.assets->mesh_primitives) ||
               has_below(document.look["meshes"].get_ref<const Json::object_t&>());
      };
      return is_taken(before_) || is_taken(after_);
    });
  }

  /// Geometry comes with the file of a node that the step adds before all else and removes after it, meshes included.
  void bring_geometry() {
    if (geometry_.empty()) return;
    auto bytes = std::make_shared<const Bytes>(glb_of(geometry_));
    const std::string file = folder_ + "/" + file_name_of("geometry", *bytes);
    result_.files.push_back({file, std::move(bytes)});
    const Tokens node = {"nodes", carrier_};
    edit_.insert(edit_.begin(), Json{{"op", "add"}, {"path", pointer_text(node)}, {"value", {{"asset", file}}}});
    add_operation("remove", node);
    for (const MeshToWrite& mesh : geometry_) add_operation("remove", {"meshes", carrier_ + "/" + mesh.name});
  }

  /// Puts the name that its matrices have in `before_` into a skin of `after_`.
  void name_inverse_binds(const std::string& skin, Json& value) const {
    const std::vector<Transform>& wanted = after_.inverse_binds.at(value[kInverseBinds].get<std::string>());
    const auto& known = before_.inverse_binds;
    auto found = known.find(key_before(Section::skins, skin, kInverseBinds));
    if (found == known.end() || found->second != wanted)
      found = std::ranges::find_if(known, [&](const auto& entry) { return entry.second == wanted; });
    if (found == known.end())
      throw InputError(after_.file, "",
                       "skin \"" + skin + "\" has other inverse bind matrices, which no journal can say");
    value[kInverseBinds] = found->first;
  }

  /// What the entity of a name has in `before_`; the name itself where there is none.
  [[nodiscard]] std::string key_before(Section section, const std::string& name,
                                       const Json::json_pointer& place) const {
    const Json& entities = before_.look[std::string(section_name(section))];
    const auto found = entities.find(name);
    return found != entities.end() && found->contains(place) ? (*found)[place].get<std::string>() : name;
  }

  /// The instances of a node that shows a mesh; null: it has none.
  static const std::vector<Transform>* instances_of(const LookDocument& document, const std::string& node) {
    const auto found = document.look["nodes"].find(node);
    if (found == document.look["nodes"].end() || !found->contains("mesh") || !found->contains(kInstances))
      return nullptr;
    return &document.instances.find((*found)[kInstances].get<std::string>())->second;
  }

  /// Puts the key that a node's instances have in `before_` into its value.
  void name_instances(const std::string& node, Json& value) const {
    const std::vector<Transform>* now = instances_of(after_, node);
    if (now == nullptr) return;
    const std::vector<Transform>* then = instances_of(before_, node);
    if (then == nullptr || *then != *now)
      throw InputError(after_.file, "", "the instances of node \"" + node + "\" differ, which no journal can say");
    value[kInstances] = key_before(Section::nodes, node, kInstances);
  }

  /// What only `before_` has. A node loses its children first, which may be elsewhere now.
  void remove_rest() {
    const Json &olds = before_.look["nodes"], &news = after_.look["nodes"];
    for (const auto& node : olds.items())
      if (!news.contains(node.key()) && !node.value()["children"].empty())
        add_operation("replace", {"nodes", node.key(), "children"}, Json::array());
    for (const Section section : {Section::skins, Section::nodes, Section::meshes, Section::lights, Section::materials,
                                  Section::textures, Section::images, Section::samplers}) {
      const std::string name(section_name(section));
      for (const auto& item : before_.look[name].items())
        if (!after_.look[name].contains(item.key())) add_operation("remove", {name, item.key()});
    }
  }

  void warn() {
    std::vector<std::string>& warnings = result_.draft.warnings;
    const auto cameras = [](Json all) {
      for (Json& camera : all) camera.erase("index");
      return all;
    };
    if (cameras(before_.cameras) != cameras(after_.cameras))
      warnings.emplace_back("the cameras differ: a journal keeps the one of its cache");
    const auto variants = [](const LookDocument& document) {
      std::vector<Json> found{document.look.value("extensions", Json())};
      for (const Json& mesh : document.look["meshes"])
        for (const Json& primitive : mesh.value("primitives", Json::array()))
          if (primitive.contains("extensions")) found.push_back(primitive["extensions"]);
      return found;
    };
    if (variants(before_) != variants(after_))
      warnings.emplace_back("the material variants differ: a journal changes materials only, see journal variants");
    if (edit_.empty()) warnings.emplace_back("nothing differs that a journal edits");
  }

  const LookDocument &before_, &after_;
  std::string folder_;
  std::string carrier_ = carrier();    // node that brings geometry
  std::vector<MeshToWrite> geometry_;  // that only `after_` has
  Json edit_ = Json::array();
  DiffDraft result_;
};

}  // namespace

DiffDraft draft_diff(const LookDocument& before, const LookDocument& after, const std::string& folder) {
  return Differ(before, after, folder).run();
}

}  // namespace relook
