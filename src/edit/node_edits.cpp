// What removing, renaming and copying a node means for its parent and its descendants.
#include <algorithm>

#include "edit/transaction.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

/// The names in a node's list of children, as far as it is well-formed.
std::vector<std::string> children_of(const Json* node) {
  std::vector<std::string> names;
  if (node == nullptr || !node->is_object() || !node->contains("children")) return names;
  const Json& children = (*node)["children"];
  if (!children.is_array()) return names;
  for (const Json& child : children)
    if (child.is_string()) names.push_back(child.get<std::string>());
  return names;
}

bool has_child(const Json* node, const std::string& name) {
  if (node == nullptr || !node->is_object() || !node->contains("children")) return false;
  const Json& children = (*node)["children"];
  return children.is_array() && std::find(children.begin(), children.end(), name) != children.end();
}

}  // namespace

/// The parent in the document as edited so far: the compiled one, or a node that this edit touched.
std::string Transaction::current_parent(const std::string& node) {
  const std::string compiled = state_.parent_of(node);
  if (!compiled.empty() && has_child(find({"nodes", compiled}), node)) return compiled;
  for (const std::string& candidate : touched_nodes_)
    if (has_child(find({"nodes", candidate}), node)) return candidate;
  return "";
}

/// Puts another name into a parent's list of children, or takes it out ("").
void Transaction::replace_mention(const std::string& parent, const std::string& child, const std::string& by) {
  if (parent.empty()) return;
  touch(TouchedEntity{"nodes", parent});
  Json& children = (*find({"nodes", parent}))["children"];
  const auto mention = std::find(children.begin(), children.end(), Json(child));
  if (by.empty())
    children.erase(mention);
  else
    *mention = by;
}

void Transaction::remove_node(const std::string& name) {
  replace_mention(current_parent(name), name, "");
  std::vector<std::string> todo{name};
  while (!todo.empty()) {
    const std::string node = std::move(todo.back());
    todo.pop_back();
    if (find({"nodes", node}) == nullptr) continue;
    for (std::string& child : children_of(find({"nodes", node}))) todo.push_back(std::move(child));
    touch(TouchedEntity{"nodes", node});
    document().look["nodes"].erase(node);
    touched_nodes_.erase(node);
    replace_joint(node, "");
  }
}

void Transaction::rename_node(const std::string& from, const std::string& to) {
  const std::string parent = current_parent(from);
  if (parent != to) replace_mention(parent, from, to);
  replace_joint(from, to);
  replace_excluded(from, to);
}

/// Gives a node its new name where lights exclude it. One that is removed keeps its mention, which the compiler
/// refuses.
void Transaction::replace_excluded(const std::string& node, const std::string& by) {
  const Json* nodes = find({"nodes", ""});
  if (nodes == nullptr || !nodes->is_object()) return;
  const Json::json_pointer place("/extras/relook/excludes");
  std::vector<std::string> mentioning;
  for (const auto& other : nodes->items()) {
    if (!other.value().is_object() || !other.value().contains("extras") || !other.value().contains(place)) continue;
    const Json& excludes = other.value()[place];
    if (excludes.is_array() && std::ranges::find(excludes, Json(node)) != excludes.end())
      mentioning.push_back(other.key());
  }
  for (const std::string& name : mentioning) {
    touch(TouchedEntity{"nodes", name});
    std::ranges::replace((*find({"nodes", name}))[place], Json(node), Json(by));
  }
}

/// Gives a joint its new name in all skins. A skin goes with the last of its joints (by ""); one that keeps others
/// keeps its mention of what is removed, which the compiler refuses.
void Transaction::replace_joint(const std::string& joint, const std::string& by) {
  Json* skins = find({"skins", ""});
  if (skins == nullptr || !skins->is_object()) return;
  std::vector<std::string> mentioning;
  for (const auto& skin : skins->items())
    if (skin.value().is_object() && skin.value().contains("joints") && skin.value()["joints"].is_array() &&
        std::ranges::find(skin.value()["joints"], Json(joint)) != skin.value()["joints"].end())
      mentioning.push_back(skin.key());
  for (const std::string& name : mentioning) {
    touch(TouchedEntity{"skins", name});
    Json& joints = (*skins)[name]["joints"];
    if (!by.empty()) std::ranges::replace(joints, Json(joint), Json(by));
    const auto is_there = [&](const Json& other) {
      return other.is_string() && find({"nodes", other.get<std::string>()}) != nullptr;
    };
    if (by.empty() && std::ranges::none_of(joints, is_there)) skins->erase(name);
  }
}

/// A copied node's descendants are copied too, as "<copy>/<name>": a node has one parent.
void Transaction::copy_descendants(const std::string& copy, const PatchPlace& place) {
  std::set<std::string> copied{copy};
  std::vector<std::string> todo{copy};
  UniqueNames unique([&](const std::string& candidate) { return find({"nodes", candidate}) != nullptr; });
  while (!todo.empty()) {
    const std::string node = std::move(todo.back());
    todo.pop_back();
    std::vector<std::string> copies;
    for (const std::string& child : children_of(find({"nodes", node}))) {
      const Json* original = find({"nodes", child});
      if (original == nullptr) continue;
      if (!copied.insert(child).second)
        throw InputError(place.file, place.where, "a node cannot be copied over one of its own descendants");
      const std::string last = child.substr(child.rfind('/') + 1);
      const std::string name = unique.give(copy + "/" + last);
      count_copy(*original, {"nodes", name}, place);
      add_entry("nodes", name, Json(*original));
      copied.insert(name);
      copies.push_back(name);
      todo.push_back(name);
    }
    if (Json* value = find({"nodes", node}); value != nullptr && value->is_object()) (*value)["children"] = copies;
  }
}

void Transaction::add_entry(const std::string& section, const std::string& name, Json value) {
  touch(TouchedEntity{section, name});
  document().look[section][name] = std::move(value);
}

}  // namespace relook
