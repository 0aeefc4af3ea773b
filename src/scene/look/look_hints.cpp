#include "scene/look/look_hints.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace relook {
namespace {

struct Alias {
  std::string_view word, place;
};
// The first place that a schema has is meant.
constexpr Alias kAliases[] = {
    {"color", "pbrMetallicRoughness/baseColorFactor"},
    {"basecolor", "pbrMetallicRoughness/baseColorFactor"},
    {"albedo", "pbrMetallicRoughness/baseColorFactor"},
    {"diffusecolor", "pbrMetallicRoughness/baseColorFactor"},
    {"alpha", "pbrMetallicRoughness/baseColorFactor/3"},
    {"opacity", "pbrMetallicRoughness/baseColorFactor/3"},
    {"roughness", "pbrMetallicRoughness/roughnessFactor"},
    {"metallic", "pbrMetallicRoughness/metallicFactor"},
    {"metalness", "pbrMetallicRoughness/metallicFactor"},
    {"texture", "pbrMetallicRoughness/baseColorTexture"},
    {"map", "pbrMetallicRoughness/baseColorTexture"},
    {"normal", "normalTexture"},
    {"normalmap", "normalTexture"},
    {"bump", "normalTexture"},
    {"emission", "emissiveFactor"},
    {"emissive", "emissiveFactor"},
    {"emissioncolor", "emissiveFactor"},
    {"emissionstrength", "extensions/KHR_materials_emissive_strength/emissiveStrength"},
    {"transmission", "extensions/KHR_materials_transmission/transmissionFactor"},
    {"clearcoat", "extensions/KHR_materials_clearcoat/clearcoatFactor"},
    {"coat", "extensions/KHR_materials_clearcoat/clearcoatFactor"},
    {"thickness", "extensions/KHR_materials_volume/thicknessFactor"},
    {"sheen", "extensions/KHR_materials_sheen/sheenColorFactor"},
    {"specular", "extensions/KHR_materials_specular/specularFactor"},
    {"anisotropy", "extensions/KHR_materials_anisotropy/anisotropyStrength"},
    {"position", "translation"},
    {"location", "translation"},
    {"move", "translation"},
    {"rotate", "rotation"},
    {"quaternion", "rotation"},
    {"orientation", "rotation"},
    {"size", "scale"},
    {"hidden", "extensions/KHR_node_visibility/visible"},
    {"hide", "extensions/KHR_node_visibility/visible"},
    {"visible", "extensions/KHR_node_visibility/visible"},
    {"visibility", "extensions/KHR_node_visibility/visible"},
    {"power", "intensity"},
    {"energy", "intensity"},
    {"strength", "intensity"},
    {"brightness", "intensity"},
    {"multiplier", "intensity"},
    {"kelvin", "extras/relook/temperature"},
    {"softness", "extras/relook/radius"},
    {"kind", "type"},
    {"hdri", "extras/relook/environment/image"},
    {"image", "extras/relook/environment/image"},
    {"background", "extras/relook/environment/background"},
};

/// Lower case, with American spelling.
std::string plain(std::string_view word) {
  std::string text;
  for (const char c : word) text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  constexpr std::pair<std::string_view, std::string_view> kSpellings[] = {
      {"colour", "color"}, {"grey", "gray"}, {"metre", "meter"}, {"fibre", "fiber"}, {"centre", "center"}};
  for (const auto& [british, american] : kSpellings)
    for (std::size_t at = text.find(british); at != std::string::npos; at = text.find(british, at))
      text.replace(at, british.size(), american);
  return text;
}

std::vector<std::string> tokens_of(std::string_view place) {
  std::vector<std::string> tokens{""};
  for (const char c : place)
    if (c == '/')
      tokens.emplace_back();
    else
      tokens.back() += c;
  return tokens;
}

struct Place {
  const Schema* schema;
  std::string path;  // "" or "a/b/"
};

/// All objects at and below a schema that keys lead to without an index, the shallowest first.
std::vector<Place> places_below(const Schema& schema) {
  std::vector<Place> places{{&schema, ""}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place at = places[i];
    for (const SchemaField& field : at.schema->fields)
      if (field.kind == FieldKind::object) places.push_back({field.inner, at.path + std::string(field.key) + "/"});
  }
  return places;
}

std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// The quaternion of turns about fixed x, then y, then z.
std::string quaternion_text(const Json& degrees) {
  double sine[3], cosine[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const double half = degrees[i].get<double>() * std::numbers::pi / 360;
    sine[i] = std::sin(half);
    cosine[i] = std::cos(half);
  }
  const double x = sine[0] * cosine[1] * cosine[2] - cosine[0] * sine[1] * sine[2];
  const double y = cosine[0] * sine[1] * cosine[2] + sine[0] * cosine[1] * sine[2];
  const double z = cosine[0] * cosine[1] * sine[2] - sine[0] * sine[1] * cosine[2];
  const double w = cosine[0] * cosine[1] * cosine[2] + sine[0] * sine[1] * sine[2];
  return "[" + short_text(x) + ", " + short_text(y) + ", " + short_text(z) + ", " + short_text(w) + "]";
}

double linear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

bool are_bytes(const Json& value) {
  return std::ranges::all_of(
      value, [](const Json& x) { return x.is_number() && x.get<double>() >= 0 && x.get<double>() <= 255; });
}

}  // namespace

std::string deeper_place(const Schema& schema, std::string_view key) {
  const std::string word = plain(key);
  const std::vector<Place> places = places_below(schema);
  for (const Place& place : places)
    for (const SchemaField& field : place.schema->fields)
      if (plain(field.key) == word) return place.path + std::string(field.key);
  for (const Alias& alias : kAliases)
    if (alias.word == word && knows_place(schema, tokens_of(alias.place))) return std::string(alias.place);
  std::string best;
  std::size_t best_distance = word.size() / 4 + 1;
  for (const Place& place : places)
    for (const SchemaField& field : place.schema->fields)
      if (const std::size_t distance = edit_distance(word, plain(field.key)); distance < best_distance) {
        best_distance = distance;
        best = place.path + std::string(field.key);
      }
  return best;
}

bool knows_place(const Schema& schema, std::span<const std::string> tokens) {
  const Schema* level = &schema;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (level == nullptr) return false;
    const auto field = std::ranges::find(level->fields, tokens[i], &SchemaField::key);
    if (field == level->fields.end()) return false;
    const bool has_items = field->kind == FieldKind::list || field->kind == FieldKind::reals ||
                           field->kind == FieldKind::names || field->kind == FieldKind::texts;
    if (has_items) ++i;
    level = field->inner;
  }
  return true;
}

std::string value_hint(const SchemaField& field, const Json& value) {
  if (field.key == "rotation" && field.count == 4 && value.is_array() && value.size() == 3 &&
      std::ranges::all_of(value, [](const Json& x) { return x.is_number(); }))
    return "; a rotation is a quaternion: " + value.dump() + " degrees about x, then y, then z are " +
           quaternion_text(value);
  const bool is_color =
      field.kind == FieldKind::reals && (field.count == 3 || field.count == 4) && field.low == 0 && field.high == 1;
  if (is_color && value.is_array() && value.size() == field.count && are_bytes(value)) {
    std::string text;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double byte = value[i].get<double>();
      const bool is_alpha = i == 3;
      text += (i == 0 ? "[" : ", ") + short_text(is_alpha ? (byte > 1 ? byte / 255 : byte) : linear(byte / 255));
    }
    return "; colours are linear, from 0 to 1: " + value.dump() + " of sRGB from 0 to 255 is " + text + "]";
  }
  const bool is_angle = field.key.ends_with("Angle") || field.key == "angle";
  if (is_angle && value.is_number() && value.get<double>() > field.high && value.get<double>() <= 360)
    return "; angles are in radians: " + short_text(value.get<double>()) + " degrees are " +
           short_text(value.get<double>() * std::numbers::pi / 180);
  return "";
}

}  // namespace relook
