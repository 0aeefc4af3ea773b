#include "scene/export/export_values.h"

#include <algorithm>

#include "base/hash.h"

namespace relook {
namespace {

const SchemaField* field_of(const Schema* schema, std::string_view key) {
  if (schema == nullptr) return nullptr;
  const auto found = std::ranges::find(schema->fields, key, &SchemaField::key);
  return found == schema->fields.end() ? nullptr : &*found;
}

bool is_list_of_objects(const Json& value) { return value.is_array() && !value.empty() && value.front().is_object(); }

Json without_defaults(const SchemaField& field, Json value) {
  if (field.kind == FieldKind::object) drop_defaults(*field.inner, value);
  if (field.kind == FieldKind::list && value.is_array())
    for (Json& item : value) drop_defaults(*field.inner, item);
  return value;
}

void write_member(const SchemaField& field, const Json* before, const Json& after, Json& target) {
  const std::string key(field.key);
  if (before != nullptr && *before == after) return;
  if (before != nullptr && before->is_object() && after.is_object()) {
    const bool is_there = target.contains(key) && target[key].is_object();
    Json inner = is_there ? std::move(target[key]) : Json::object();
    write_changes(*field.inner, *before, after, inner);
    if (is_there || !inner.empty()) target[key] = std::move(inner);
    return;
  }
  const bool is_list = before != nullptr && is_list_of_objects(*before) && is_list_of_objects(after) &&
                       before->size() == after.size() && target.contains(key) && target[key].size() == after.size();
  if (!is_list) {
    target[key] = without_defaults(field, after);
    return;
  }
  for (std::size_t i = 0; i < after.size(); ++i) write_changes(*field.inner, (*before)[i], after[i], target[key][i]);
}

bool is_plain(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_texture_name(std::string_view key) { return key.ends_with("Texture"); }

}  // namespace

Json without_keys(Json value) {
  if (!value.is_object() || !value.contains("extras") || !value["extras"].is_object()) return value;
  Json& extras = value["extras"];
  if (!extras.contains("relook") || !extras["relook"].is_object()) return value;
  for (const char* key : {"content", "geometry", "instances", "inverseBinds"}) extras["relook"].erase(key);
  if (extras["relook"].empty()) extras.erase("relook");
  if (extras.empty()) value.erase("extras");
  return value;
}

void drop_defaults(const Schema& schema, Json& value) {
  if (!value.is_object()) return;
  for (const SchemaField& field : schema.fields) {
    const auto member = value.find(field.key);
    if (member == value.end()) continue;
    if (field.kind == FieldKind::object || field.kind == FieldKind::list) *member = without_defaults(field, *member);
    const bool is_default = !field.fallback.is_null() && *member == field.fallback;
    if (is_default || (field.implied && member->empty())) value.erase(member);
  }
}

void write_changes(const Schema& schema, const Json& before, const Json& after, Json& target) {
  if (!target.is_object()) target = Json::object();
  for (const auto& member : after.items()) {
    const SchemaField* field = field_of(&schema, member.key());
    const auto old = before.find(member.key());
    if (field != nullptr) write_member(*field, old == before.end() ? nullptr : &*old, member.value(), target);
  }
  for (const auto& member : before.items())
    if (!after.contains(member.key())) target.erase(member.key());
}

void visit_foreign_textures(const Schema* schema, Json& value, const std::function<bool(Json&)>& visit) {
  if (!value.is_object()) return;
  for (auto member = value.begin(); member != value.end();) {
    const SchemaField* field = field_of(schema, member.key());
    const bool is_foreign = field == nullptr && member.key() != "extras" && member->is_object();
    const bool is_texture = is_foreign && is_texture_name(member.key()) && member->contains("index");
    if (is_texture && !visit(*member)) {
      member = value.erase(member);
      continue;
    }
    const bool is_known_object = field != nullptr && field->kind == FieldKind::object;
    if (is_known_object || (is_foreign && !is_texture))
      visit_foreign_textures(is_known_object ? field->inner : nullptr, *member, visit);
    ++member;
  }
}

std::string uri_of(std::string_view path) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri;
  for (const char c : path) {
    if (is_plain(c) || std::string_view("/-._~").find(c) != std::string_view::npos) {
      uri += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    uri += {'%', kDigits[byte >> 4], kDigits[byte & 0xF]};
  }
  return uri;
}

std::string content_name(const std::string& name, const Bytes& bytes, std::string_view suffix) {
  constexpr std::size_t kHashDigits = 16, kLongest = 64;
  std::string plain = name.substr(0, kLongest);
  std::ranges::replace_if(
      plain, [](char c) { return !is_plain(c); }, '_');
  return plain + "-" + hash128(bytes).substr(0, kHashDigits) + std::string(suffix);
}

ImageKind image_kind(const Bytes& bytes) {
  const std::string_view text = text_of(bytes);
  if (text.starts_with("\xFF\xD8")) return {"image/jpeg", ".jpg"};
  if (text.starts_with("RIFF")) return {"image/webp", ".webp", "EXT_texture_webp"};
  if (text.starts_with("\xABKTX 20")) return {"image/ktx2", ".ktx2", "KHR_texture_basisu"};
  if (text.starts_with("#?")) return {"image/vnd.radiance", ".hdr", "", false};
  if (text.starts_with("v/1\x01")) return {"image/x-exr", ".exr", "", false};
  return {"image/png", ".png"};
}

}  // namespace relook
