// The table of bounds against files: what rounding puts beyond a bound is put right with a warning, what is further out
// is refused where the scene uses it and ignored where not, --strict-gltf refuses all of it.
#include <gtest/gtest.h>

#include <cmath>

#include "import_values.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

/// A number of glTF with a place for a value in a file.
struct Number {
  const SchemaField* field;
  std::string pointer;  // below the entity
};

/// All numbers below a schema but relook's own.
void collect_numbers(const Schema& schema, const std::string& at, std::vector<Number>& numbers) {
  for (const SchemaField& field : schema.fields) {
    if (field.key == "extras") continue;
    const std::string pointer = at + "/" + std::string(field.key);
    if (field.kind == FieldKind::number || field.kind == FieldKind::reals) numbers.push_back({&field, pointer});
    if (field.kind == FieldKind::object) collect_numbers(*field.inner, pointer, numbers);
  }
}

/// Where entities of a section are in square(), and another that the scene does not use.
struct Home {
  const Schema* schema;
  std::string used, unused;
};

const std::vector<Home>& homes() {
  static const std::vector<Home> all{
      {&schema_of(Section::materials), "/materials/0", "/materials/1"},
      {&schema_of(Section::lights), "/extensions/KHR_lights_punctual/lights/0",
       "/extensions/KHR_lights_punctual/lights/1"},
      {&schema_of(Section::nodes), "/nodes/1", "/nodes/3"},
      {&camera_schema(), "/cameras/0", "/cameras/1"},
  };
  return all;
}

/// square() with a second material, light, node and camera that nothing names.
SceneFile with_unused() {
  SceneFile file = square();
  file.gltf["materials"].push_back(Json::object());
  Json& lights = file.gltf["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(lights[0]);
  file.gltf["nodes"].push_back(Json::object());
  file.gltf["cameras"].push_back(file.gltf["cameras"][0]);
  return file;
}

void set_number(SceneFile& file, const std::string& home, const Number& number, double value) {
  Json& entity = file.gltf[Json::json_pointer(home)];
  const bool is_array = number.field->kind == FieldKind::reals;
  const std::string key(number.field->key);
  if (key == "innerConeAngle") entity["spot"]["outerConeAngle"] = 1.5707963267948966;
  if (key == "matrix") entity.erase("translation");
  if (key == "xmag" || key == "ymag" || number.pointer.starts_with("/orthographic")) {
    entity.erase("perspective");
    entity["type"] = "orthographic";
    entity["orthographic"] = {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.1}, {"zfar", 1e3}};
  }
  // The slots on the way name a texture.
  const Json::json_pointer place(number.pointer);
  for (Json::json_pointer at = place.parent_pointer(); !at.empty(); at = at.parent_pointer())
    if (at.back().ends_with("Texture")) entity[at]["index"] = 0;
  if (!is_array) {
    entity[place] = value;
    return;
  }
  Json values = number.field->fallback;
  if (values.is_null()) values = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (number.field->count == 0) values = {0};
  values[0] = value;
  entity[place] = values;
}

std::vector<Number> numbers_of(const Home& home) {
  std::vector<Number> numbers;
  collect_numbers(*home.schema, "", numbers);
  return numbers;
}

double step_up(double x) { return static_cast<double>(std::nextafter(static_cast<float>(x), HUGE_VALF)); }
double step_down(double x) {  // denormal numbers count as zero
  return x == 0 ? -1e-8 : static_cast<double>(std::nextafter(static_cast<float>(x), -HUGE_VALF));
}

TEST_F(ImportValues, one_float_beyond_a_bound_of_gltf_is_the_bound_with_a_warning) {
  std::size_t tried = 0;
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home)) {
      const SchemaField& field = *number.field;
      std::vector<std::pair<double, double>> beyond;  // value, bound
      if (field.high < kCeiling) beyond.emplace_back(step_up(step_up(field.high)), field.high);
      if (std::abs(field.low) < kCeiling && field.low != kAboveZero)
        beyond.emplace_back(step_down(field.low), field.low);
      for (const auto& [value, bound] : beyond) {
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        const std::string where = home.used + number.pointer + " = " + std::to_string(value);
        const Answer tolerant = answer(file);
        EXPECT_EQ(tolerant.error, "") << where;
        EXPECT_FALSE(tolerant.imported.warnings.empty()) << where;
        const Json kept = tolerant.imported.gltf.value(Json::json_pointer(home.used + number.pointer), Json());
        EXPECT_EQ(kept.is_array() ? kept.at(0) : kept, bound) << where;
        set_import_rules({.is_strict = true, .roots = {}});
        EXPECT_NE(answer(file).error, "") << where << " --strict-gltf";
        set_import_rules({});
        ++tried;
      }
    }
  EXPECT_GT(tried, 40U);
}

TEST_F(ImportValues, a_value_far_beyond_is_refused_where_it_is_used_and_ignored_where_not) {
  std::size_t tried = 0;
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home)) {
      const SchemaField& field = *number.field;
      std::vector<double> beyond;
      if (field.high < kCeiling) beyond.push_back(field.high + 1.5);
      if (std::abs(field.low) < kCeiling) beyond.push_back(field.low - 1.5);
      for (const double value : beyond) {
        if (field.key == "emissiveFactor" && value > 1) continue;  // split, see below
        if (field.key == "size" || field.key == "aspect") continue;  // of EXT_lights_area: area_lights_test.cpp
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        EXPECT_NE(answer(file).error.find(": " + home.used + number.pointer), std::string::npos)
            << home.used << number.pointer << ": " << answer(file).error;
        file = with_unused();
        set_number(file, home.unused, number, value);
        EXPECT_EQ(answer(file).error, "") << home.unused << number.pointer;
        EXPECT_FALSE(answer(file).imported.warnings.empty()) << home.unused << number.pointer;
        ++tried;
      }
    }
  EXPECT_GT(tried, 40U);
}

TEST_F(ImportValues, where_gltf_has_no_bound_any_number_is_read) {
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home))
      for (const double value : {1e7, 3.4028235e38, 1.7976931348623157e308}) {
        if (number.field->high < kCeiling || number.field->key == "znear") continue;  // beyond zfar
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        EXPECT_EQ(answer(file).error, "") << home.used << number.pointer << " = " << value;
      }
}

TEST_F(ImportValues, emission_above_1_keeps_its_light) {
  SceneFile file = square();
  file.gltf["materials"][0]["emissiveFactor"] = {2, 1, 0};
  file.gltf["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3;
  const Answer read = answer(file);
  ASSERT_EQ(read.error, "");
  const Json& material = read.imported.gltf["materials"][0];
  EXPECT_EQ(material["emissiveFactor"], (Json{1.0, 0.5, 0.0}));
  EXPECT_EQ(material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 6.0);
  EXPECT_EQ(read.imported.warnings.size(), 1U);
}

TEST_F(ImportValues, a_cone_as_wide_inside_as_outside_has_a_hard_edge) {
  SceneFile file = square();
  Json& spot = file.gltf["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"];
  spot = {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}};
  EXPECT_EQ(answer(file).error, "");
  EXPECT_EQ(answer(file).imported.warnings.size(), 1U);
  spot["innerConeAngle"] = 0.6;
  EXPECT_NE(answer(file).error, "");
}

}  // namespace
}  // namespace relook
