#include "scene/look/look_warnings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "scene/compile/compile_material.h"
#include "scene/compile/place_light.h"
#include "scene/light.h"
#include "scene/look/look_bounds.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

constexpr std::size_t kMostOfAKind = 20;

/// Collects sentences of one kind; beyond kMostOfAKind it only counts them.
class Kind {
 public:
  explicit Kind(std::vector<std::string>& warnings) : warnings_(warnings) {}
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;
  ~Kind() {
    if (count_ > kMostOfAKind) warnings_.push_back("and " + std::to_string(count_ - kMostOfAKind) + " more like that");
  }
  void add(std::string sentence) {
    if (++count_ <= kMostOfAKind) warnings_.push_back(std::move(sentence));
  }

 private:
  std::vector<std::string>& warnings_;
  std::size_t count_ = 0;
};

/// False for a node that flattens nothing, by a look at the node alone: it has no small scale, no matrix, no instances.
bool may_flatten(const Json& node) {
  constexpr double kSmall = 1e-3;
  if (node.contains("matrix") || node.contains("extras")) return true;
  const auto scale = node.find("scale");
  return scale != node.end() && std::ranges::any_of(*scale, [](const Json& part) {
           return std::abs(part.get<double>()) < kSmall;
         });
}

LightKind kind_of(const Json& light) {
  constexpr auto kWords = light_words();
  return static_cast<LightKind>(std::ranges::find(kWords, light.at("type").get<std::string>()) - kWords.begin());
}

/// What of a node's mesh is flattened to nothing, in words; "" if nothing is, or if a skin places it.
std::string what_is_lost(const LookDocument& document, const Json& node, const WideTransform& world) {
  if (!node.contains("mesh") || node.contains("skin")) return "";
  const Json* instances = member_at(node, {"extras", "relook", "instances"});
  const std::vector<Transform> alone(1);
  const std::vector<Transform>& matrices =
      instances == nullptr ? alone : document.instances.at(instances->get<std::string>());
  const auto lost = std::ranges::count_if(matrices, [&](const Transform& matrix) {
    const WideTransform placed = widened(matrix) * world;
    return is_in_range(placed) && dimensions_of(rounded(placed, WidePoint(0, 0, 0))) < 2;
  });
  if (lost == 0) return "";
  if (static_cast<std::size_t>(lost) == matrices.size()) return "its mesh is not drawn";
  return std::to_string(lost) + " of its " + std::to_string(matrices.size()) + " instances are not drawn";
}

void warn_of_places(const LookDocument& document, std::vector<std::string>& warnings) {
  if (std::ranges::none_of(document.look.at("nodes"), may_flatten)) return;
  Kind objects(warnings), lights(warnings);
  for_each_place(document, [&](const std::string& name, const Json& node, const WideTransform& world) {
    if (const std::string lost = what_is_lost(document, node, world); !lost.empty())
      objects.add("node \"" + name + "\" is scaled to nothing: " + lost);
    const Json* name_of_light = light_name_of(node);
    if (name_of_light == nullptr) return;
    Light light;
    light.kind = kind_of(document.look.at("lights").at(name_of_light->get<std::string>()));
    if (place_light(world, WidePoint(0, 0, 0), light)) return;
    lights.add("node \"" + name + "\" is scaled to nothing: its light has no direction and gives no light");
  });
}

/// One sentence on the lights of a kind that Integrator::whitted does without.
void warn_of_kind(const LookDocument& document, const std::function<bool(const Json&)>& is_meant,
                  std::string_view what, std::string_view fault, std::vector<std::string>& warnings) {
  std::size_t count = 0;
  std::string first;
  for (const auto& light : document.look.at("lights").items())
    if (is_meant(light.value()) && count++ == 0) first = light.key();
  if (count == 0) return;
  warnings.push_back("light \"" + first + "\"" +
                     (count > 1 ? " and " + std::to_string(count - 1) + " more have " : " has ") + std::string(what) +
                     ": " + std::string(fault) + " only with --integrator path");
}

void warn_of_what_whitted_lacks(const LookDocument& document, std::vector<std::string>& warnings) {
  warn_of_kind(document, [](const Json& light) { return traits_of(kind_of(light)).path_only; }, "an area",
               "it gives light", warnings);
  warn_of_kind(
      document,
      [](const Json& light) {
        const LightTraits& traits = traits_of(kind_of(light));
        const Json* radius = member_at(light, {"extras", "relook", "radius"});
        const Json* angle = member_at(light, {"extras", "relook", "angle"});
        return (traits.has_radius && radius != nullptr && *radius != 0) ||
               (traits.has_angle && angle != nullptr && *angle != 0);
      },
      "a radius or an angle", "its shadows are soft", warnings);
  const Json& environment = document.look.at("scene").at("extras").at("relook").at("environment");
  if (environment.contains("image"))
    warnings.emplace_back("the environment has an image: it lights surfaces only with --integrator path");
}

/// Visits the names of textures below a value.
void visit_textures(const Schema& schema, const Json& value, const std::function<void(const std::string&)>& visit) {
  visit_names(schema, value, [&](Target target, const Json& name) {
    if (target == Target::textures && name.is_string()) visit(name.get_ref<const std::string&>());
  });
}

/// The names of all materials that some node shows, also in a variant.
std::set<std::string> shown_materials(const LookDocument& document) {
  std::set<std::string> shown;
  for (const Json& node : document.look.at("nodes")) {
    const Json* mesh = member_at(node, {"mesh"});
    if (mesh == nullptr) continue;
    visit_names(schema_of(Section::meshes), document.look.at("meshes").at(mesh->get<std::string>()),
                [&](Target target, const Json& name) {
                  if (target == Target::materials && name.is_string()) shown.insert(name.get<std::string>());
                });
  }
  return shown;
}

void warn_of_textures(const LookDocument& document, std::vector<std::string>& warnings) {
  Kind kind(warnings);
  const Json& textures = document.look.at("textures");
  for (const std::string& material : shown_materials(document)) {
    const auto entry = document.look.at("materials").find(material);
    if (entry == document.look.at("materials").end()) continue;
    visit_textures(schema_of(Section::materials), *entry, [&](const std::string& name) {
      const auto texture = textures.find(name);
      if (texture == textures.end() || texture->contains("source")) return;
      if (member_at(*texture, {"extras", "relook", "procedural"}) != nullptr) return;
      kind.add("texture \"" + name + "\" has no image that is read: material \"" + material +
               "\" is drawn without it");
    });
  }
}

}  // namespace

std::vector<std::string> look_warnings(const LookDocument& document, Integrator integrator) {
  std::vector<std::string> warnings;
  warn_of_places(document, warnings);
  warn_of_textures(document, warnings);
  if (integrator == Integrator::whitted) warn_of_what_whitted_lacks(document, warnings);
  return warnings;
}

}  // namespace relook
