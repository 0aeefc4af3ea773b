// A field of a material is one row of a table: a test's own row is seen by the schema, the compiler, the masks of
// colour expressions, the sentence and the class of a change. No member of Material is without one.
#include "scene/material_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "edit/effect/effect.h"
#include "edit/effect/material_changes.h"
#include "look_fixture.h"
#include "scene/compile/compile_material.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

struct LustrousMaterial : Material {
  float lustre = 0.25F;
};

constexpr unsigned kLustreBit = kMappingField + 1;

/// The rows of a material and one of a LustrousMaterial's own.
std::vector<MaterialRow> rows_with_lustre(unsigned traits = 0) {
  const auto rows = material_rows();
  std::vector<MaterialRow> all(rows.begin(), rows.end());
  all.push_back({.bit = kLustreBit,
                 .words = "lustre",
                 .pointer = "extensions/KHR_materials_lustre/lustreFactor",
                 .member = static_cast<float Material::*>(&LustrousMaterial::lustre),
                 .fallback = {0.25},
                 .low = 0,
                 .high = 2,
                 .choices = {},
                 .traits = traits});
  return all;
}

LustrousMaterial with_lustre(float lustre) {
  LustrousMaterial material;
  material.lustre = lustre;
  return material;
}

/// The class of a change of the lustre alone.
ChangeClass class_of_lustre(LustrousMaterial material, unsigned traits) {
  const LustrousMaterial before = material;
  material.lustre = 1;
  const Mesh mesh = square_mesh();
  return class_of(effect_of(before, surface_optics(before, mesh), material, surface_optics(material, mesh),
                            mesh, Integrator::whitted, rows_with_lustre(traits)));
}

TEST(MaterialFields, a_row_adds_its_key_to_the_schema_with_bounds_and_default) {
  std::deque<Schema> parts;
  const Schema schema = material_schema(rows_with_lustre(), parts);
  const std::vector<std::string> tokens{"extensions", "KHR_materials_lustre", "lustreFactor"};
  const SchemaField* field = field_at(schema, tokens);
  ASSERT_NE(field, nullptr);
  EXPECT_EQ(field->kind, FieldKind::number);
  EXPECT_EQ(range_fault(*field, 2.5), "2.5 is above 2");
  EXPECT_EQ(range_fault(*field, -0.5), "-0.5 is below 0");
  Json value = Json::object();
  fill_from_schema(schema, value);
  EXPECT_EQ(value["extensions"]["KHR_materials_lustre"]["lustreFactor"], 0.25);
  EXPECT_EQ(field_at(schema_of(Section::materials), tokens), nullptr);
}

TEST(MaterialFields, a_row_is_compiled) {
  const Json value = {{"extensions", {{"KHR_materials_lustre", {{"lustreFactor", 0.75}}}}}};
  LustrousMaterial material;
  set_fields(value, material, rows_with_lustre());
  EXPECT_EQ(material.lustre, 0.75F);
  set_fields(Json::object(), material, rows_with_lustre());
  EXPECT_EQ(material.lustre, 0.75F) << "what is not given stays as it is";
}

TEST(MaterialFields, a_row_has_its_bit_and_its_value_in_colour_expressions) {
  const LustrousMaterial before = with_lustre(0), after = with_lustre(0.5F);
  EXPECT_TRUE(changed_fields(before, after, rows_with_lustre()) == FieldMask{1} << kLustreBit);
  EXPECT_TRUE(changed_fields(before, before, rows_with_lustre()) == 0);
  EXPECT_TRUE(changed_fields(before, after, rows_with_lustre(MaterialRow::unread)) == 0);
  EXPECT_EQ(field_value(after, rows_with_lustre().back(), 0), 0.5F);
  EXPECT_EQ(field_value(after, rows_with_lustre(MaterialRow::angle).back(), 0), static_cast<float>(std::cos(0.5)));
  EXPECT_EQ(field_value(after, rows_with_lustre(MaterialRow::angle).back(), 1), static_cast<float>(std::sin(0.5)));
}

TEST(MaterialFields, a_row_has_its_words_after_those_of_lower_bits) {
  LustrousMaterial after = with_lustre(0.5F);
  after.roughness = 0;
  EXPECT_EQ(describe_material_change(with_lustre(0), after, rows_with_lustre()), "roughness 1 -> 0, lustre 0 -> 0.5");
}

TEST(MaterialFields, the_class_of_a_change_follows_from_the_traits_of_the_row) {
  LustrousMaterial plain, cut, mirror, coated;
  cut.alpha_mode = AlphaMode::mask;
  mirror.roughness = 0;
  coated.clearcoat = 1;
  for (const LustrousMaterial& material : {plain, cut, mirror, coated})
    EXPECT_EQ(class_of_lustre(material, 0), ChangeClass::color);
  EXPECT_EQ(class_of_lustre(plain, MaterialRow::cuts), ChangeClass::color) << "it has no holes";
  EXPECT_EQ(class_of_lustre(cut, MaterialRow::cuts), ChangeClass::geometric);
  EXPECT_EQ(class_of_lustre(plain, MaterialRow::bends), ChangeClass::color) << "it spawns no rays";
  EXPECT_EQ(class_of_lustre(mirror, MaterialRow::bends), ChangeClass::optical);
  EXPECT_EQ(class_of_lustre(mirror, MaterialRow::bends_coat), ChangeClass::color) << "it has no coat";
  EXPECT_EQ(class_of_lustre(coated, MaterialRow::bends_coat), ChangeClass::optical);
}

struct Anything {
  template <class T>
  operator T() const;  // NOLINT: whatever a member is
};
/// How many members an aggregate has.
template <class Aggregate, class... Given>
consteval std::size_t member_count() {
  if constexpr (requires { Aggregate{Given{}..., Anything{}}; })
    return member_count<Aggregate, Given..., Anything>();
  else
    return sizeof...(Given);
}

void alter(float& member) { member = member == 0.5F ? 0.25F : 0.5F; }
void alter(bool& member) { member = !member; }
void alter(Color& member) { alter(member.y); }
void alter(Rgba& member) { alter(member.a); }
void alter(IlluminationModel& member) { member = IlluminationModel::unlit; }
void alter(AlphaMode& member) { member = AlphaMode::blend; }

/// A material that differs from another in one field.
Material altered(Material material, const MaterialRow& row) {
  std::visit(
      [&](const auto member) {
        if constexpr (std::is_same_v<decltype(member), const Slot>)
          material.slot(member).kind = TextureKind::procedural;
        else
          alter(material.*member);
      },
      row.member);
  return material;
}

TEST(MaterialFields, every_member_of_a_material_has_a_row) {
  const auto values = std::ranges::count_if(material_rows(), [](const MaterialRow& row) { return !row.slot(); });
  // The name and the slots are no fields.
  EXPECT_EQ(static_cast<std::size_t>(values), member_count<Material>() - 2);
  EXPECT_EQ(values, static_cast<int>(Field::count));
  EXPECT_EQ(material_rows().size(), static_cast<std::size_t>(Field::count) + kSlotCount);
  std::set<unsigned> bits;
  for (const MaterialRow& row : material_rows()) EXPECT_TRUE(bits.insert(row.bit).second) << row.words;
}

TEST(MaterialFields, each_row_alone_is_found_by_every_comparison) {
  const Material before;
  for (const MaterialRow& row : material_rows()) {
    const Material after = altered(before, row);
    EXPECT_NE(before, after) << row.words;
    for (const MaterialRow& other : material_rows())
      EXPECT_EQ(differs(other, before, after), &other == &row) << row.words << ", " << other.words;
    const FieldMask expected = row.has(MaterialRow::unread) ? 0 : FieldMask{1} << row.bit;
    EXPECT_TRUE(changed_fields(before, after) == expected) << row.words;
    EXPECT_TRUE(describe_material_change(before, after).starts_with(row.words)) << row.words;
  }
}

TEST(MaterialFields, a_row_tells_the_member_that_colour_expressions_name) {
  Material material;
  material.roughness = 0.125F;
  material.base_color.a = 0.375F;
  material.phong_specular.z = 0.625F;
  EXPECT_EQ(field_value(material, Field::roughness, 0), 0.125F);
  EXPECT_EQ(field_value(material, Field::base_color, 3), 0.375F);
  EXPECT_EQ(field_value(material, Field::phong_specular, 2), 0.625F);
  EXPECT_EQ(field_value(material, Field::alpha_mode, 0), 0);
}

TEST(MaterialFields, defaults_of_the_schema_are_those_of_the_members) {
  Json value = {{"normalTexture", {{"index", "T"}}}, {"occlusionTexture", {{"index", "T"}}}};
  fill_from_schema(schema_of(Section::materials), value);
  Material material;
  for (const MaterialRow& row : material_rows())
    if (!row.slot()) material = altered(material, row);
  material.attenuation_distance = Material().attenuation_distance;  // no document writes it
  material.clearcoat_normal_scale = 1;                              // of a texture that is not there
  set_fields(value, material);
  EXPECT_EQ(describe_material_change(Material(), material), "");
}

/// Pointers to what stands in a schema, but for the members that every textureInfo has.
void collect_leaves(const Schema& schema, const std::string& at, std::set<std::string>& leaves) {
  const bool is_texture = std::ranges::find(schema.fields, "index", &SchemaField::key) != schema.fields.end();
  const std::set<std::string_view> info{"index", "texCoord", "extensions", "extras"};
  for (const SchemaField& field : schema.fields) {
    if (is_texture && info.contains(field.key)) continue;
    const std::string pointer = at + std::string(field.key);
    if (field.kind != FieldKind::object || field_at(*field.inner, std::vector<std::string>{"index"}) != nullptr)
      leaves.insert(pointer);
    if (field.kind == FieldKind::object) collect_leaves(*field.inner, pointer + "/", leaves);
  }
}

TEST(MaterialFields, everything_in_the_schema_of_materials_is_a_row) {
  std::set<std::string> leaves, pointers{"name"};
  collect_leaves(schema_of(Section::materials), "", leaves);
  for (const MaterialRow& row : material_rows()) pointers.emplace(row.pointer);
  EXPECT_EQ(leaves, pointers);
}

}  // namespace
}  // namespace relook
