#include "scene/look/look_names.h"

#include <algorithm>

namespace relook {

std::string_view section_name(Section section) {
  constexpr std::array<std::string_view, kSectionCount> kNames{"materials", "textures", "images", "samplers",
                                                               "meshes",    "lights",   "nodes",  "skins"};
  return kNames[static_cast<std::size_t>(section)];
}

std::optional<Section> section_of(std::string_view name) {
  for (std::size_t i = 0; i < kSectionCount; ++i)
    if (section_name(static_cast<Section>(i)) == name) return static_cast<Section>(i);
  return std::nullopt;
}

std::string unique_name(std::string wanted, const std::function<bool(const std::string&)>& is_taken) {
  if (!is_taken(wanted)) return wanted;
  for (std::size_t i = 2;; ++i) {
    std::string candidate = wanted + "_" + std::to_string(i);
    if (!is_taken(candidate)) return candidate;
  }
}

bool UniqueNames::take(const std::string& name) {
  ++probes_;
  if (given_.contains(name) || (is_taken_ && is_taken_(name))) return false;
  return given_.insert(name).second;
}

std::string UniqueNames::give(std::string wanted) {
  if (take(wanted)) return wanted;
  std::size_t& suffix = next_suffix_.try_emplace(wanted, 2).first->second;
  for (;;) {
    std::string candidate = wanted + "_" + std::to_string(suffix++);
    if (take(candidate)) return candidate;
  }
}

namespace {

const std::string* camera_of_index(const LookDocument& document, std::uint64_t index) {
  if (!document.cameras.is_object()) return nullptr;
  for (auto camera = document.cameras.begin(); camera != document.cameras.end(); ++camera)
    if (camera->value("index", std::uint64_t{0}) == index) return &camera.key();
  return nullptr;
}

/// The name of glTF index `index`, if the scene file has that many.
const std::string* name_of_index(const LookDocument& document, Section section, std::uint64_t index) {
  const auto& order = document.order[static_cast<std::size_t>(section)];
  return index < order.size() ? &order[index] : nullptr;
}

}  // namespace

std::string resolve_token(const LookDocument& document, Section section, const std::string& token) {
  constexpr std::size_t kLongestIndex = 9;
  const Json& entities = document.look.at(std::string(section_name(section)));
  const bool is_index = !token.empty() && token.size() <= kLongestIndex && (token == "0" || token[0] != '0') &&
                        std::all_of(token.begin(), token.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!is_index || entities.contains(token)) return token;
  const std::string* name = name_of_index(document, section, std::stoull(token));
  return name == nullptr ? token : *name;
}

void name_indices(const LookDocument& document, Section section, Json& value) {
  visit_names(schema_of(section), value, [&](Target target, Json& reference) {
    if (!reference.is_number_unsigned()) return;
    const auto index = reference.get<std::uint64_t>();
    const std::string* name = nullptr;
    if (target == Target::cameras) {
      name = camera_of_index(document, index);
    } else if (target == Target::variants) {
      const Json::json_pointer variants("/extensions/KHR_materials_variants/variants");
      if (document.look.contains(variants) && index < document.look[variants].size() &&
          document.look[variants][index].is_string())
        name = &document.look[variants][index].get_ref<const std::string&>();
    } else {
      name = name_of_index(document, static_cast<Section>(target), index);
    }
    if (name != nullptr) reference = std::string(*name);
  });
}

}  // namespace relook
