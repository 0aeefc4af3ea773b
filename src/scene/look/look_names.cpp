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
  return index < order.size() && !order[index].empty() ? &order[index] : nullptr;
}

/// Where the lights of EXT_lights_area begin.
std::size_t first_area_light(const LookDocument& document) {
  const auto& order = document.order[static_cast<std::size_t>(Section::lights)];
  const auto gap = std::ranges::find(order, "");
  return static_cast<std::size_t>(gap - order.begin()) + 1;
}

/// The node's light of EXT_lights_area counts in an array of its own.
void name_area_light(const LookDocument& document, Json& node) {
  const Json::json_pointer place("/extensions/EXT_lights_area/light");
  if (!node.is_object() || !node.contains(place) || !node[place].is_number_unsigned()) return;
  const std::uint64_t index = node[place].get<std::uint64_t>();
  const std::string* name =
      index > UINT32_MAX ? nullptr : name_of_index(document, Section::lights, index + first_area_light(document));
  if (name != nullptr) node[place] = std::string(*name);
}

/// The index that a token of a JSON pointer is: no leading zeros, nine digits at most.
std::optional<std::size_t> index_of_token(const std::string& token) {
  constexpr std::size_t kLongestIndex = 9;
  const bool is_index = !token.empty() && token.size() <= kLongestIndex && (token == "0" || token[0] != '0') &&
                        std::all_of(token.begin(), token.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_index ? std::optional(std::stoul(token)) : std::nullopt;
}

}  // namespace

void resolve_light_place(const LookDocument& document, std::vector<std::string>& tokens) {
  const bool is_light = tokens.size() > 2 && tokens[0] == "extensions" && tokens[2] == "lights";
  const bool is_area = is_light && tokens[1] == "EXT_lights_area";
  if (!is_area && !(is_light && tokens[1] == "KHR_lights_punctual")) return;
  tokens.erase(tokens.begin(), tokens.begin() + 2);
  if (!is_area || tokens.size() < 2 || document.look.at("lights").contains(tokens[1])) return;
  const std::optional<std::size_t> index = index_of_token(tokens[1]);
  const std::string* name =
      index ? name_of_index(document, Section::lights, *index + first_area_light(document)) : nullptr;
  if (name != nullptr) tokens[1] = *name;
}

std::string resolve_token(const LookDocument& document, Section section, const std::string& token) {
  const Json& entities = document.look.at(std::string(section_name(section)));
  const std::optional<std::size_t> index = index_of_token(token);
  if (!index || entities.contains(token)) return token;
  const std::string* name = name_of_index(document, section, *index);
  return name == nullptr ? token : *name;
}

void name_indices(const LookDocument& document, Section section, Json& value) {
  if (section == Section::nodes) name_area_light(document, value);
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
