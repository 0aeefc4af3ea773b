// What a transaction keeps of the values before it: to take edits back, to go back to an earlier state, to tell what
// was touched.
#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "edit/transaction.h"
#include "scene/look/look_names.h"

namespace relook {

const Json* find_entry(const Json& look, const TouchedEntity& entity) {
  if (entity.section.empty()) return &look;
  if (!look.is_object()) return nullptr;
  const auto section = look.find(entity.section);
  if (section == look.end()) return nullptr;
  if (entity.name.empty()) return &*section;
  if (!section->is_object()) return nullptr;
  const auto found = section->find(entity.name);
  return found == section->end() ? nullptr : &*found;
}

SceneDelta Transaction::restore(const EntryValues& values) {
  touched_earlier_.merge(std::exchange(touched_, {}));
  touched_nodes_.clear();
  Json& look = document().look;
  for (const auto& [entity, value] : values) {
    touch(entity);
    Json& parent = entity.name.empty() ? look : look[entity.section];
    const std::string& key = entity.name.empty() ? entity.section : entity.name;
    if (value)
      parent[key] = *value;
    else
      parent.erase(key);
  }
  return state_.recompile({touched_.begin(), touched_.end()}, file_);
}

void Transaction::visit_touched(const std::function<void(const TouchedEntity&, const Json*)>& visit) const {
  const Json none = Json::object();
  const auto visit_section = [&](const std::string& section, const Json& before) {
    for (const auto& [name, value] : before.items()) visit({section, name}, &value);
    const Json* now = find_entry(state_.document().look, {section, ""});
    for (const auto& [name, value] : (now != nullptr ? *now : none).items())
      if (!before.contains(name)) visit({section, name}, nullptr);
  };
  const auto visit_document = [&](const Json& before) {
    for (const auto& [section, part] : before.items())
      if (section_of(section))
        visit_section(section, part);
      else
        visit({section, ""}, &part);
    for (const auto& [section, part] : state_.document().look.items())
      if (!before.contains(section) && !section_of(section)) visit({section, ""}, nullptr);
  };
  std::set<std::string> whole;  // sections that were touched whole: what is touched in them later was not there before
  for (const auto& [entity, value] : before_) {
    if (whole.contains("") || whole.contains(entity.section)) continue;
    const Json* before = value ? &*value : nullptr;
    if (entity.section.empty()) {
      whole.insert("");
      if (before != nullptr) visit_document(*before);
    } else if (entity.name.empty() && section_of(entity.section)) {
      whole.insert(entity.section);
      visit_section(entity.section, before != nullptr ? *before : none);
    } else {
      visit(entity, before);
    }
  }
}

void Transaction::undo() {
  restore_document();
  touched_earlier_.merge(std::exchange(touched_, {}));
  if (!touched_earlier_.empty()) (void)state_.recompile({touched_earlier_.begin(), touched_earlier_.end()}, file_);
}

void Transaction::absorb(Transaction&& later) {
  for (auto& entry : later.before_)
    if (saved_.insert(entry.first).second) before_.push_back(std::move(entry));
  touched_earlier_.merge(later.touched_);
  touched_earlier_.merge(later.touched_earlier_);
  const auto append = [](std::vector<std::string>& names, std::vector<std::string>& more) {
    std::ranges::move(more, std::back_inserter(names));
  };
  append(new_geometry_, later.new_geometry_);
  append(new_images_, later.new_images_);
  append(new_instances_, later.new_instances_);
  append(new_inverse_binds_, later.new_inverse_binds_);
  copied_ += later.copied_;
}

bool Transaction::has_changes() {
  return std::ranges::any_of(before_, [&](const auto& entry) {
    const auto& [entity, before] = entry;
    const Json* now = find(entity);
    return (now != nullptr) != before.has_value() || (now != nullptr && *now != *before);
  });
}

void Transaction::restore_document() {
  Json& look = document().look;
  for (auto entry = before_.rbegin(); entry != before_.rend(); ++entry) {
    const auto& [section, name] = entry->first;
    std::optional<Json>& value = entry->second;
    if (section.empty()) {
      look = std::move(*value);
      continue;
    }
    if (!look.is_object()) continue;
    if (name.empty()) {
      if (value)
        look[section] = std::move(*value);
      else
        look.erase(section);
      continue;
    }
    // A section that is no object any more was itself touched, and comes back whole.
    if (!look.contains(section) || !look[section].is_object()) continue;
    if (value)
      look[section][name] = std::move(*value);
    else
      look[section].erase(name);
  }
  before_.clear();
  copied_ = {};
  Assets& assets = *document().assets;
  assets.meshes.erase(assets.meshes.begin() + static_cast<std::ptrdiff_t>(mesh_count_), assets.meshes.end());
  for (const std::string& geometry : new_geometry_) assets.mesh_primitives.erase(geometry);
  for (const std::string& image : new_images_) assets.images.erase(image);
  for (const std::string& instances : new_instances_) document().instances.erase(instances);
  for (const std::string& skin : new_inverse_binds_) document().inverse_binds.erase(skin);
}

}  // namespace relook
