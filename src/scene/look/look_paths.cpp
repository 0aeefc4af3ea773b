#include "scene/look/look_paths.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "scene/light.h"
#include "scene/look/look_check.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 4> kOwn{"content", "geometry", "instances", "inverseBinds"};

bool has_required_members(const Schema& schema) { return std::ranges::any_of(schema.fields, &SchemaField::required); }

/// Has a light of this kind, or a node without a light, any use for the field?
bool is_of_use(std::string_view section, const Json& entity, std::string_view key) {
  if (section == "nodes" && (key == "visible" || key == "excludes")) {
    const Json& extensions = entity.value("extensions", Json::object());
    return extensions.contains("KHR_lights_punctual") || extensions.contains("EXT_lights_area");
  }
  if (section != "lights") return true;
  const std::string type = entity.value("type", "");
  const auto traits = std::ranges::find(kLightTraits, type, &LightTraits::word);
  if (traits == kLightTraits.end()) return true;
  if (key == "radius") return traits->has_radius;
  if (key == "angle") return traits->has_angle;
  if (key == "range") return traits->has_place && !traits->has_size;
  return true;
}

class PathWalk {
 public:
  PathWalk(std::string_view section, const Json& entity, const std::function<void(const LookPath&)>& visit)
      : section_(section), entity_(entity), visit_(visit) {}

  /// `value`: null for an object that is not there, of which only what a replace creates is visited.
  void object(const Schema& schema, const Json* value, std::string& pointer) {
    for (const SchemaField& field : schema.fields) {
      const bool is_relook = pointer.ends_with("/relook");
      if (is_relook && std::ranges::find(kOwn, field.key) != kOwn.end()) continue;
      const Json* member = nullptr;
      if (value != nullptr && value->is_object())
        if (const auto found = value->find(field.key); found != value->end()) member = &*found;
      const bool is_own = is_relook || (section_ == "lights" && field.key == "range");
      if (is_own && !is_of_use(section_, entity_, field.key)) continue;
      const std::size_t length = pointer.size();
      pointer.append("/").append(field.key);
      this->field(field, member, pointer);
      pointer.resize(length);
    }
  }

 private:
  void field(const SchemaField& field, const Json* value, std::string& pointer) {
    if (field.kind == FieldKind::list) {
      for (std::size_t i = 0; value != nullptr && i < value->size(); ++i) {
        const std::size_t length = pointer.size();
        pointer.append("/").append(std::to_string(i));
        object(*field.inner, &(*value)[i], pointer);
        pointer.resize(length);
      }
      return;
    }
    const bool is_there = value != nullptr && !value->is_null();
    if (field.kind == FieldKind::object && (is_there || !field.unwritten)) {
      if (is_there || !has_required_members(*field.inner)) object(*field.inner, value, pointer);
      return;
    }
    if (is_there || field.unwritten) visit_({pointer, field, is_there ? value : nullptr, entity_, section_});
  }

  std::string_view section_;
  const Json& entity_;
  const std::function<void(const LookPath&)>& visit_;
};

std::string short_limit_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

std::string bounds_text(const SchemaField& field) {
  if (!field.codes.empty()) {
    std::string text = "one of";
    for (const int code : field.codes) text += (code == field.codes.front() ? " " : ", ") + std::to_string(code);
    return text;
  }
  const bool has_low = field.low > -kCeiling, has_high = field.high < kCeiling;
  const std::string low = field.low == kAboveZero ? "above 0" : short_limit_text(field.low);
  std::string text = has_low && has_high
                         ? low + (field.low == kAboveZero ? ", up to " : " to ") + short_limit_text(field.high)
                     : has_low  ? (field.low == kAboveZero ? low : low + " or more")
                     : has_high ? "up to " + short_limit_text(field.high)
                                : "any number";
  return field.zero_too ? "0, or " + text : text;
}

struct Unit {
  std::string_view end, unit;  // of pointers that end so
};
constexpr Unit kUnits[] = {
    {"/translation", "m"},
    {"/rotation", "quaternion x, y, z, w"},
    {"/matrix", "4x4, by column"},
    {"/baseColorFactor", "linear RGB, alpha"},
    {"/thicknessFactor", "m"},
    {"/attenuationDistance", "m"},
    {"/iridescenceThicknessMinimum", "nm"},
    {"/iridescenceThicknessMaximum", "nm"},
    {"/anisotropyRotation", "radians"},
    {"/emissiveStrength", "nits"},
    {"/innerConeAngle", "radians"},
    {"/outerConeAngle", "radians"},
    {"/extras/relook/angle", "radians"},
    {"/extras/relook/radius", "m"},
    {"/extras/relook/temperature", "kelvin"},
    {"/displacement/scale", "m"},
};

bool is_color(const SchemaField& field, std::string_view pointer) {
  return field.kind == FieldKind::reals && field.count == 3 && field.low == 0 && !pointer.ends_with("/scale");
}

}  // namespace

void for_each_path(const LookDocument& document, const std::function<void(const LookPath&)>& visit) {
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const std::string_view section = section_name(static_cast<Section>(s));
    for (const auto& [name, entity] : document.look.at(std::string(section)).items()) {
      std::string pointer = "/" + std::string(section) + "/" + escape_token(name);
      PathWalk(section, entity, visit).object(schema_of(static_cast<Section>(s)), &entity, pointer);
    }
  }
  std::string pointer = "/scene";
  const Json& scene = document.look.at("scene");
  PathWalk("scene", scene, visit).object(scene_schema(), &scene, pointer);
}

std::string range_text(const SchemaField& field) {
  switch (field.kind) {
    case FieldKind::boolean:
      return "true or false";
    case FieldKind::text:
      return "text";
    case FieldKind::texts:
      return "texts";
    case FieldKind::choice: {
      std::string text = "one of";
      for (const std::string_view choice : field.choices)
        text += (choice == field.choices.front() ? " " : ", ") + std::string(choice);
      return text;
    }
    case FieldKind::name:
      return "a " + std::string(target_noun(field.target));
    case FieldKind::names:
      return "names of " + std::string(target_noun(field.target)) + "s";
    case FieldKind::object:
    case FieldKind::list:
      return "an object";
    case FieldKind::reals:
      return (field.count > 0 ? std::to_string(field.count) + " numbers, " : "numbers, ") + bounds_text(field);
    case FieldKind::number:
      return bounds_text(field);
    case FieldKind::integer:
      return field.codes.empty() ? "a whole number, " + bounds_text(field) : bounds_text(field);
  }
  return "";
}

std::string_view unit_of(const LookPath& path) {
  const std::string_view pointer = path.pointer;
  if (path.section == "lights") {
    if (pointer.ends_with("/size") || pointer.ends_with("/range")) return "m";
    if (pointer.ends_with("/intensity")) {
      const std::string type = path.entity.value("type", "");
      return type == "directional" ? "lux" : type == "point" || type == "spot" ? "cd" : "nits";
    }
  }
  if (is_color(path.field, pointer)) return "linear RGB";
  if (pointer.ends_with("/rotation") && path.field.kind == FieldKind::number) return "radians";
  for (const Unit& unit : kUnits)
    if (pointer.ends_with(unit.end)) return unit.unit;
  return "";
}

}  // namespace relook
