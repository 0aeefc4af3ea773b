#include "image/path_classes.h"

#include <map>

namespace relook {
namespace {

/// A path's words with each object replaced by the one that stands for its atom.
void replace_objects(std::span<const std::uint32_t> path, const PathLayout& layout, const std::vector<ObjectId>& atoms,
                     std::vector<std::uint32_t>& words) {
  words.assign(path.begin(), path.end());
  const auto replace = [&](const std::uint32_t& word) {
    words[static_cast<std::size_t>(&word - path.data())] = atoms[word].index();
  };
  for (PathCursor cursor(path, layout); !cursor.at_end();) {
    const std::uint32_t& object = path[cursor.position()];
    const PathNode node = cursor.next();
    if (node.is_miss()) continue;
    replace(object);
    EntryReader entries(node.entries, layout.shadow_bits);
    for (std::size_t light = 0; light < layout.lights; ++light)
      for (const std::uint32_t& transparent : entries.next(shadow_state(node.lights, light)).objects)
        replace(transparent);
  }
}

}  // namespace

std::vector<ObjectId> atoms_of(const SceneState& state, std::uint32_t depth) {
  const auto& objects = state.scene().objects;
  std::vector<ObjectId> atoms;
  std::map<std::string, ObjectId> of_node;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    std::vector<std::string> way;  // from the object's node up to the root
    for (std::string node = objects[i].node; !node.empty(); node = state.parent_of(node)) way.push_back(node);
    const bool is_below = depth > 0 && way.size() >= depth;
    atoms.push_back(is_below ? of_node.try_emplace(way[way.size() - depth], ObjectId(i)).first->second : ObjectId(i));
  }
  return atoms;
}

void PathClasses::extend(const PathTable& paths, const PathLayout& layout, const std::vector<ObjectId>& atoms) {
  std::vector<std::uint32_t> words;
  for (; paths_ < paths.size(); ++paths_) {
    if (!has_atoms_) continue;
    replace_objects(paths.words(PathId(static_cast<std::uint32_t>(paths_))), layout, atoms, words);
    class_of_.push_back(classes_.intern(words));
  }
}

void PathClasses::clear() {
  paths_ = 0;
  class_of_.clear();
  classes_ = PathTable();
}

}  // namespace relook
