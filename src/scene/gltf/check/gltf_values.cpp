#include "scene/gltf/check/gltf_values.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/import_rules.h"
#include "scene/look/json_place.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

/// One entity of a file: its fields against the table.
class ValueCheck {
 public:
  ValueCheck(bool is_used, std::string_view file, std::vector<std::string>& warnings)
      : is_used_(is_used), file_(file), warnings_(warnings) {}

  /// Whether nothing had to be left out.
  bool object(const Schema& schema, Json& value, const JsonPlace& at) {
    for (const SchemaField& field : schema.fields) {
      const auto found = value.find(field.key);
      const bool must_be_there = field.required && field.kind == FieldKind::choice;
      if (found == value.end() && must_be_there) {
        const std::string fault = "\"" + std::string(field.key) + "\" is missing";
        if (is_used_) throw InputError(file_, at.text(), fault);
        tolerate(file_, at.text(), fault + "; the scene does not use it", warnings_);
        value[std::string(field.key)] = field.choices.front();
        is_whole_ = false;
      }
      if (found == value.end()) continue;
      if (field.key == "extras") continue;  // relook's own, or anybody's: look_check reads what is relook's
      const std::optional<Fault> fault = member(field, *found, {&at, field.key});
      if (!fault) continue;
      if (is_used_) throw InputError(file_, fault->place, fault->what);
      tolerate(file_, fault->place, fault->what + "; the scene does not use it: ignored", warnings_);
      value.erase(found);
      if (must_be_there) value[std::string(field.key)] = field.choices.front();
      is_whole_ = false;
    }
    return is_whole_;
  }

 private:
  struct Fault {
    std::string place, what;
  };
  static std::optional<Fault> wrong_type(const JsonPlace& place, std::string_view wanted, const Json& value) {
    return Fault{place.text(), "expected " + std::string(wanted) + ", got " + std::string(type_noun(value))};
  }

  /// What is wrong with a member, if it cannot be put right.
  std::optional<Fault> member(const SchemaField& field, Json& value, const JsonPlace& place) {
    switch (field.kind) {
      case FieldKind::number:
        return number(field, value, place);
      case FieldKind::integer:
        return integer(field, value, place);
      case FieldKind::boolean:
        if (!value.is_boolean()) return wrong_type(place, "true or false", value);
        break;
      case FieldKind::text:
        if (!value.is_string()) return wrong_type(place, "a string", value);
        break;
      case FieldKind::choice:
        return choice(field, value, place);
      case FieldKind::reals:
        return reals(field, value, place);
      case FieldKind::object:
        if (!value.is_object()) return wrong_type(place, "an object", value);
        (void)object(*field.inner, value, place);
        break;
      case FieldKind::list:
        if (!value.is_array()) return wrong_type(place, "an array", value);
        for (std::size_t i = 0; i < value.size(); ++i)
          if (value[i].is_object()) (void)object(*field.inner, value[i], {&place, {}, i});
        break;
      case FieldKind::texts:
      case FieldKind::name:
      case FieldKind::names:
        break;  // references: check_document()
    }
    return {};
  }

  /// 1.0 stands for 1 (glTF 2.0 section 3.1 wants no fraction).
  std::optional<Fault> integer(const SchemaField& field, Json& value, const JsonPlace& place) {
    constexpr double kMostExact = 1e9;
    if (!value.is_number_integer()) {
      const double x = value.is_number() ? value.get<double>() : 0.5;
      if (std::floor(x) != x || !(std::abs(x) <= kMostExact)) return wrong_type(place, "an integer", value);
      tolerate(file_, place.text(), "an integer is written with a fraction", warnings_);
      value = static_cast<std::int64_t>(x);
    }
    return number(field, value, place);
  }

  std::optional<Fault> number(const SchemaField& field, Json& value, const JsonPlace& place) {
    if (!value.is_number()) return wrong_type(place, "a number", value);
    const auto x = value.get<double>();
    const std::optional<double> fit = fitted(field, x);
    if (!fit) return Fault{place.text(), range_fault(field, value)};
    if (*fit == x) return {};
    const bool is_harmless = *fit == kAboveZero || std::abs(*fit) == kUnbounded;  // a float holds no other number
    if (!is_harmless) tolerate(file_, place.text(), range_fault(field, value) + ": the bound stands", warnings_);
    value = *fit;
    return {};
  }

  std::optional<Fault> reals(const SchemaField& field, Json& value, const JsonPlace& place) {
    if (!value.is_array()) return wrong_type(place, "an array of numbers", value);
    if (field.count != 0 && value.size() != field.count)
      return Fault{place.text(), "expected an array of " + std::to_string(field.count) + " numbers, got " +
                              std::to_string(value.size())};
    for (std::size_t i = 0; i < value.size(); ++i)
      if (auto fault = number(field, value[i], {&place, {}, i})) return fault;
    return {};
  }

  static std::optional<Fault> choice(const SchemaField& field, const Json& value, const JsonPlace& place) {
    if (!value.is_string()) return wrong_type(place, "a string", value);
    const auto& word = value.get_ref<const std::string&>();
    if (std::ranges::find(field.choices, word) != field.choices.end()) return {};
    std::string known;
    for (const std::string_view option : field.choices) known += (known.empty() ? "" : ", ") + std::string(option);
    return Fault{place.text(), "\"" + printable(word) + "\" is not one of " + known};
  }

  bool is_used_, is_whole_ = true;
  std::string_view file_;
  std::vector<std::string>& warnings_;
};

/// The array at a pointer, if there is one.
Json* array_at(Json& gltf, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  return gltf.contains(place) ? &gltf[place] : nullptr;
}

/// Emission above 1, as it was written before KHR_materials_emissive_strength: the same light by factor and strength.
void split_emission(Json& material, const std::string& pointer, std::string_view file,
                    std::vector<std::string>& warnings) {
  const auto found = material.find("emissiveFactor");
  if (found == material.end() || !found->is_array() || found->size() != 3) return;
  constexpr double kRounding = 1e-6;
  double largest = 0;
  for (const Json& factor : *found) {
    if (!factor.is_number() || !(factor.get<double>() >= 0)) return;
    largest = std::max(largest, factor.get<double>());
  }
  if (!(largest > 1 + kRounding)) return;
  Json& extensions = material["extensions"];
  if (extensions.is_null()) extensions = Json::object();
  if (!extensions.is_object()) return;
  Json& owner = extensions["KHR_materials_emissive_strength"];
  if (owner.is_null()) owner = Json::object();
  if (!owner.is_object()) return;
  const Json strength = owner.value("emissiveStrength", Json(1.0));
  if (!strength.is_number()) return;
  tolerate(file, pointer + "/emissiveFactor",
           "a factor is above 1: KHR_materials_emissive_strength takes what is beyond", warnings);
  for (Json& factor : *found) factor = factor.get<double>() / largest;
  owner["emissiveStrength"] = strength.get<double>() * largest;
}

/// A cone whose inner angle is the outer one, or beyond it by rounding, has a hard edge.
void fit_cone(Json& light, const std::string& pointer, bool is_used, std::string_view file,
              std::vector<std::string>& warnings) {
  if (light.value("type", Json()) != "spot") return;
  if (!light.contains("spot")) return;
  Json& spot = light["spot"];
  const double inner = spot.value("innerConeAngle", 0.0), outer = spot.value("outerConeAngle", 0.7853981633974483);
  if (inner < outer) return;
  constexpr double kRounding = 1e-6;
  const std::string what = "outerConeAngle must be greater than innerConeAngle";
  if (inner > outer + kRounding && is_used) throw InputError(file, pointer + "/spot", what);
  tolerate(file, pointer + "/spot", what + ": the cone gets a hard edge", warnings);
  spot["innerConeAngle"] = outer;
}

/// The cone of a light that is none: KHR_lights_punctual reads it of spots alone.
void check_idle_cone(Json& light, const std::string& pointer, std::string_view file,
                     std::vector<std::string>& warnings) {
  if (light.value("type", Json()) == "spot" || !light.contains("spot")) return;
  Json cone = {{"type", "point"}, {"spot", light["spot"]}};
  if (!ValueCheck(false, file, warnings).object(schema_of(Section::lights), cone, {nullptr, pointer}))
    light.erase("spot");
}

/// What no table says of a node's transform. Rounding errors of a matrix pass; its fourth row then is 0 0 0 1.
void check_transform(Json& node, const std::string& pointer, std::string_view file) {
  if (const auto matrix = node.find("matrix"); matrix != node.end()) {
    const std::string place = pointer + "/matrix";
    for (const char* key : {"translation", "rotation", "scale"})
      if (node.contains(key))
        throw InputError(file, place, "a node has either a matrix or \"" + std::string(key) + "\"");
    constexpr double kRounding = 1e-5;
    for (const std::size_t i : {3U, 7U, 11U, 15U}) {
      const double wanted = i == 15 ? 1 : 0;
      if (std::abs((*matrix)[i].get<double>() - wanted) > kRounding)
        throw InputError(file, place, "the matrix is not affine: its fourth row must be 0 0 0 1");
      (*matrix)[i] = wanted;
    }
  }
  const auto rotation = node.find("rotation");
  if (rotation == node.end()) return;
  double squared = 0;
  for (const Json& part : *rotation) squared += part.get<double>() * part.get<double>();
  if (!(squared > 1e-18)) throw InputError(file, pointer + "/rotation", "the quaternion is zero");
}

/// What no table says of a camera's lens.
std::string lens_fault(const Json& camera) {
  const bool is_perspective = camera["type"] == "perspective";
  const char* const key = is_perspective ? "perspective" : "orthographic";
  if (camera.contains(is_perspective ? "orthographic" : "perspective"))
    return "has both \"perspective\" and \"orthographic\"";
  if (!camera.contains(key)) return "\"" + std::string(key) + "\" is missing";
  const Json& lens = camera[key];
  std::vector<const char*> required{"znear"};
  if (is_perspective) required.push_back("yfov");
  else required.insert(required.end(), {"xmag", "ymag", "zfar"});
  for (const char* name : required)
    if (!lens.contains(name)) return "\"" + std::string(name) + "\" is missing";
  for (const char* name : {"xmag", "ymag"})
    if (lens.contains(name) && lens[name] == 0) return std::string(name) + " must not be 0";
  if (lens.contains("zfar") && lens["zfar"].get<double>() <= lens["znear"].get<double>())
    return "zfar must be greater than znear";
  return "";
}

void check_camera(Json& camera, const std::string& pointer, bool is_used, std::string_view file,
                  std::vector<std::string>& warnings) {
  if (!ValueCheck(is_used, file, warnings).object(camera_schema(), camera, {nullptr, pointer})) return;
  const std::string fault = lens_fault(camera);
  if (fault.empty()) return;
  if (is_used) throw InputError(file, pointer, fault);
  tolerate(file, pointer, fault + "; the scene does not use it: ignored", warnings);
}

/// The lights of EXT_lights_area, from which a cone is dropped that only another kind has.
void check_area_lights(Json& gltf, const GltfUse& use, std::string_view file, std::vector<std::string>& warnings) {
  const std::string place = "/extensions/EXT_lights_area/lights";
  Json* const lights = array_at(gltf, place);
  if (lights == nullptr) return;
  for (std::size_t i = 0; i < lights->size(); ++i) {
    const std::string pointer = place + "/" + std::to_string(i);
    for (const char* foreign : {"spot", "range"}) (*lights)[i].erase(foreign);
    (void)ValueCheck(use.area_lights[i], file, warnings).object(area_light_schema(), (*lights)[i], {nullptr, pointer});
  }
}

void check_section(Json& gltf, Section section, const GltfUse& use, std::string_view file,
                   std::vector<std::string>& warnings) {
  const std::string place = section == Section::lights ? "/extensions/KHR_lights_punctual/lights"
                                                       : "/" + std::string(section_name(section));
  Json* const things =
      section == Section::lights ? array_at(gltf, place) : find_array(gltf, section_name(section));
  if (things == nullptr) return;
  const std::string prefix = place + "/";
  for (std::size_t i = 0; i < things->size(); ++i) {
    const std::string pointer = prefix + std::to_string(i);
    Json& thing = (*things)[i];
    const bool is_used = use.of(section)[i];
    if (section == Section::materials) split_emission(thing, pointer, file, warnings);
    const Schema& schema = section == Section::materials ? file_material_schema()
                           : section == Section::lights  ? punctual_light_schema()
                                                         : schema_of(section);
    if (section == Section::lights) check_idle_cone(thing, pointer, file, warnings);
    if (section == Section::lights)
      for (const char* foreign : {"size", "rect"}) thing.erase(foreign);
    (void)ValueCheck(is_used, file, warnings).object(schema, thing, {nullptr, pointer});
    if (section == Section::nodes && is_used) check_transform(thing, pointer, file);
    if (section == Section::lights) fit_cone(thing, pointer, is_used, file, warnings);
  }
}

}  // namespace

void check_gltf_values(Json& gltf, const GltfUse& use, std::string_view file, std::vector<std::string>& warnings) {
  for (std::size_t s = 0; s < kSectionCount; ++s) check_section(gltf, static_cast<Section>(s), use, file, warnings);
  check_area_lights(gltf, use, file, warnings);
  if (Json* const cameras = find_array(gltf, "cameras"))
    for (std::size_t i = 0; i < cameras->size(); ++i)
      check_camera((*cameras)[i], "/cameras/" + std::to_string(i), use.cameras[i], file, warnings);
}

}  // namespace relook
