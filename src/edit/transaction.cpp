#include "edit/transaction.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "edit/guide/path_hints.h"
#include "edit/wildcard.h"
#include "scene/look/look_check.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

const Json::json_pointer kContent("/extras/relook/content");
const Json::json_pointer kGeometry("/extras/relook/geometry");
const Json::json_pointer kModel("/extras/relook/model");
const Json::json_pointer kUnlit("/extensions/KHR_materials_unlit");

bool is_prefix(const Tokens& prefix, const Tokens& tokens) {
  return prefix.size() <= tokens.size() && std::equal(prefix.begin(), prefix.end(), tokens.begin());
}

/// The field of the look document that the first `count` tokens lead to; null for entries and what no schema knows.
const SchemaField* field_of(const Tokens& path, std::size_t count) {
  const std::optional<Section> section = section_of(path[0]);
  const std::size_t entry = section ? 2 : 1;
  if (count <= entry) return nullptr;
  const auto tokens = std::span(path).subspan(entry, count - entry);
  if (section) return field_at(schema_of(*section), tokens);
  return path[0] == "scene" ? field_at(scene_schema(), tokens) : nullptr;
}

bool has_required(const Schema& schema) {
  return std::ranges::any_of(schema.fields, &SchemaField::required);
}

/// Who uses what an edit removed, from a pointer to the mention: node "Lamp" (/nodes/Lamp/...).
std::string user_text(const std::string& pointer) {
  const Tokens tokens = split_pointer(pointer, "", "");
  const std::optional<Section> section = section_of(tokens[0]);
  const std::string user =
      section ? std::string(target_noun(static_cast<Target>(*section))) + " \"" + tokens[1] + "\"" : "the " + tokens[0];
  return user + " (" + pointer + ")";
}

bool is_node(const Tokens& tokens) { return tokens.size() == 2 && tokens[0] == "nodes"; }

}  // namespace

Transaction::Transaction(SceneState& state, std::string_view file, std::filesystem::path folder)
    : state_(state), file_(file), folder_(std::move(folder)), mesh_count_(document().assets->meshes.size()) {}

SceneDelta Transaction::apply(const Edit& edit) {
  std::vector<Resolved> done;
  touched_earlier_.merge(std::exchange(touched_, {}));
  touched_nodes_.clear();
  grown_.clear();
  try {
    for (const PatchOperation& operation : edit) run(operation, done);
    return state_.recompile({touched_.begin(), touched_.end()}, file_);
  } catch (const LookError& error) {
    give_up();
    rethrow(error, done);
  } catch (...) {
    give_up();
    throw;
  }
}

/// After a refused edit: the document gets its earlier values, and what the edit touched is forgotten. It has not been
/// compiled, and may have names that no compiler takes.
void Transaction::give_up() {
  restore_document();
  touched_.clear();
  touched_nodes_.clear();
}

Tokens Transaction::resolve(const std::string& pointer, const PatchPlace& place) const {
  if (pointer.empty()) return {};
  Tokens tokens = split_pointer(pointer, place.file, place.where);
  resolve_light_place(state_.document(), tokens);
  if (tokens[0] == "cameras") throw InputError(place.file, place.where, "cameras are fixed and cannot be edited");
  const std::optional<Section> section = section_of(tokens[0]);
  const LookDocument& look = state_.document();
  if (section && tokens.size() > 1 && tokens[1].empty())
    throw InputError(place.file, place.where, "a name must not be empty");
  if (section && tokens.size() > 1 && look.look.contains(tokens[0]) && look.look[tokens[0]].is_object())
    tokens[1] = resolve_token(look, *section, tokens[1]);
  return tokens;
}

/// Runs an operation, a replace with wildcards once for each name that they match.
void Transaction::run(const PatchOperation& operation, std::vector<Resolved>& done) {
  const PatchPlace place{file_, operation.where + "/path"};
  for (const std::string& path : matching_paths(state_.document(), operation, place)) {
    done.push_back({&operation, resolve(path, place), {}});
    if (operation.op == PatchOp::move || operation.op == PatchOp::copy)
      done.back().from = resolve(operation.from, {file_, operation.where + "/from"});
    run(done.back());
  }
}

void Transaction::run(Resolved& resolved) {
  const PatchOperation& operation = *resolved.operation;
  const PatchPlace place{file_, operation.where + "/path"}, from_place{file_, operation.where + "/from"};
  Json& look = document().look;
  Tokens& path = resolved.path;
  const bool makes_place = operation.op == PatchOp::add || operation.op == PatchOp::move || operation.op == PatchOp::copy;
  const bool is_new_entry = makes_place && path.size() == 2;  // it need not be there, whatever its name is like
  for (const Tokens* tokens : {&resolved.path, &resolved.from}) {
    if (tokens == &path && is_new_entry) continue;
    if (const std::string hint = path_hint(document(), *tokens); !hint.empty())
      throw InputError(file_, tokens == &path ? place.where : from_place.where, hint);
  }
  if (operation.op == PatchOp::test) return run_test(resolved, place);
  const std::string& camera = state_.scene().camera.node;
  for (const Tokens* tokens : {&resolved.path, operation.op == PatchOp::move ? &resolved.from : &resolved.path})
    if (!camera.empty() && tokens->size() > 1 && (*tokens)[0] == "nodes" && (*tokens)[1] == camera)
      throw InputError(file_, place.where, "node \"" + camera + "\" holds the active camera, which is fixed");
  touch(path);
  switch (operation.op) {
    case PatchOp::add:
      require_shallow(operation.value, path.size(), file_, operation.value_where);
      add_at(look, path, operation.value, place);
      break;
    case PatchOp::replace:
      require_shallow(operation.value, path.size(), file_, operation.value_where);
      if (operation.may_create && existing_depth(look, path) + 1 == path.size() && field_of(path, path.size()) != nullptr)
        add_at(look, path, operation.value, place);
      else
        replaced_value(path, place) = operation.value;
      break;
    case PatchOp::remove:
      (void)value_at(look, path, place);
      if (is_node(path))
        remove_node(path[1]);
      else
        (void)remove_at(look, path, place);
      break;
    case PatchOp::copy: {
      const Json& original = value_at(look, resolved.from, from_place);
      count_copy(original, path, place);
      Json value = original;
      add_at(look, path, std::move(value), place);
      if (is_node(path) && is_node(resolved.from)) copy_descendants(path[1], place);
      break;
    }
    case PatchOp::move: {
      if (is_prefix(resolved.from, path) && resolved.from != path)
        throw InputError(file_, place.where, "a value cannot be moved into itself");
      touch(resolved.from);
      require_shallow(value_at(look, resolved.from, from_place), path.size(), file_, place.where);
      Json value = remove_at(look, resolved.from, from_place);
      add_at(look, path, std::move(value), place);
      if (is_node(path) && is_node(resolved.from)) rename_node(resolved.from[1], path[1]);
      break;
    }
    case PatchOp::test:
      break;
  }
  normalize(resolved);
}

void Transaction::count_copy(const Json& value, const Tokens& to, const PatchPlace& place) {
  require_shallow(value, to.size(), place.file, place.where);
  Extent left = kMostCopied;
  left -= copied_before_;
  left -= copied_;
  Extent extent = extent_of(value, left);
  if (is_node(to)) extent.values += kValuesOfCopiedNode;
  if (extent.exceeds(left))
    throw JournalLimitError(place.file, place.where,
                            "\"copy\" may make " + std::to_string(kMostCopied.values) + " values and " +
                                std::to_string(kMostCopied.bytes) + " bytes of text in a journal, and no more");
  if (to.size() > 2 && section_of(to[0])) {
    const auto [grown, is_new] = grown_.try_emplace({to[0], to[1]});
    const Json* entry = is_new ? find({to[0], to[1]}) : nullptr;
    if (entry != nullptr) grown->second = extent_of(*entry, kMostInEntry);
    grown->second += extent;
    if (grown->second.exceeds(kMostInEntry))
      throw JournalLimitError(place.file, place.where,
                              "\"copy\" may make an entry of " + std::to_string(kMostInEntry.values) + " values and " +
                                  std::to_string(kMostInEntry.bytes) + " bytes of text, and no more");
  }
  copied_ += extent;
}

Json& Transaction::replaced_value(const Tokens& path, const PatchPlace& place) {
  Json& look = document().look;
  const std::size_t depth = existing_depth(look, path);
  if (depth == path.size()) return value_at(look, path, place);
  Json* at = &value_at(look, Tokens(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth)), place);
  const SchemaField* missing = field_of(path, depth + 1);
  if (!at->is_object() || missing == nullptr) return value_at(look, path, place);
  const SchemaField* field = field_of(path, path.size());
  bool is_creatable = field != nullptr && field->unwritten;
  for (std::size_t count = depth + 1; count < path.size() && is_creatable; ++count)
    is_creatable = !has_required(*field_of(path, count)->inner);
  if (is_creatable) {
    for (std::size_t i = depth; i < path.size(); ++i) at = &(*at)[path[i]];
    return *at;
  }
  // What has a default is absent only beside what excludes it (translation beside matrix), and cannot be added.
  if (!missing->fallback.is_null()) return value_at(look, path, place);
  const std::string parent = pointer_text(Tokens(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth)));
  throw InputError(place.file, place.where, "no \"" + path[depth] + "\" in " + parent + " (use add)");
}

Json* Transaction::find(const TouchedEntity& entity) { return const_cast<Json*>(find_entry(document().look, entity)); }

void Transaction::touch(const TouchedEntity& entity) {
  if (entity.section.empty() || (section_of(entity.section) && entity.name.empty()))
    note_section(entity.section);
  else
    note(entity);
  if (!saved_.insert(entity).second) return;
  const Json* value = find(entity);
  before_.emplace_back(entity, value == nullptr ? std::nullopt : std::optional<Json>(*value));
}

void Transaction::touch(const Tokens& tokens) {
  if (tokens.empty()) return touch(TouchedEntity{"", ""});
  const bool has_names = section_of(tokens[0]).has_value();
  touch(TouchedEntity{tokens[0], has_names && tokens.size() > 1 ? tokens[1] : ""});
}

/// All entries of a section ("": of all sections) that exist now are touched.
void Transaction::note_section(const std::string& section) {
  const Json& look = document().look;
  if (!look.is_object()) return;
  for (const auto& item : look.items()) {
    if (!section.empty() && item.key() != section) continue;
    if (!section_of(item.key()))
      note({item.key(), ""});
    else if (item.value().is_object())
      for (const auto& entity : item.value().items()) note({item.key(), entity.key()});
  }
}

void Transaction::note(const TouchedEntity& entity) {
  touched_.insert(entity);
  if (entity.section == "nodes") touched_nodes_.insert(entity.name);
}

void Transaction::normalize(const Resolved& resolved) {
  const Tokens& path = resolved.path;
  if (path.empty() || (path.size() == 1 && section_of(path[0]))) {
    note_section(path.empty() ? "" : path[0]);
    const std::set<TouchedEntity> all = touched_;
    for (const TouchedEntity& entity : all)
      if (path.empty() || entity.section == path[0]) normalize_entity(entity, resolved);
    return;
  }
  normalize_entity({path[0], section_of(path[0]) ? path[1] : ""}, resolved);
  if (!resolved.from.empty() && resolved.operation->op == PatchOp::move)
    normalize_entity(
        {resolved.from[0], resolved.from.size() > 1 && section_of(resolved.from[0]) ? resolved.from[1] : ""}, resolved);
}

/// Names for indices, defaults, and the files that an entry names.
void Transaction::normalize_entity(const TouchedEntity& entity, const Resolved& resolved) {
  Json* value = find(entity);
  if (value == nullptr || !value->is_object()) return;
  if (entity.section == "scene") return fill_from_schema(scene_schema(), *value);
  const std::optional<Section> section = section_of(entity.section);
  if (!section || entity.name.empty()) return;
  name_indices(document(), *section, *value);
  const bool is_whole = resolved.path.size() <= 2;
  const bool names_uri = resolved.path.size() == 3 && resolved.path[2] == "uri";
  const PatchPlace place{file_, resolved.operation->value_where};
  if (*section == Section::nodes && value->contains("asset")) {
    merge_asset(entity.name, {file_, is_whole ? place.where + "/asset" : place.where});
    value = find(entity);
  }
  if (*section == Section::images && (names_uri || !value->contains(kContent)) && value->contains("uri"))
    load_image(entity.name, {file_, is_whole ? place.where + "/uri" : place.where});
  if (*section == Section::meshes && !value->contains(kGeometry) &&
      document().assets->mesh_primitives.contains(entity.name))
    set_relook_extra(*value, "geometry", entity.name);
  if (*section == Section::materials && resolved.path.size() > 3 && resolved.path.back() == "KHR_materials_unlit" &&
      value->contains(kModel))
    (*value)[kModel] = value->contains(kUnlit) ? "unlit" : "metallic-roughness";
  fill_defaults(*section, *value);
}

/// Says which operation wrote the value that the compiler refuses.
void Transaction::rethrow(const LookError& error, const std::vector<Resolved>& done) const {
  const Resolved* culprit = nullptr;
  for (const Resolved& resolved : done) {
    const std::string path = pointer_text(resolved.path);
    const PatchOp op = resolved.operation->op;
    if (op == PatchOp::test) continue;
    if (error.pointer == path || error.pointer.starts_with(path + "/")) {
      const bool is_unknown_place = error.pointer == path && error.reason.starts_with("unknown key");
      if (is_unknown_place) throw InputError(file_, resolved.operation->where + "/path", error.reason);
      if (op == PatchOp::add || op == PatchOp::replace)
        throw InputError(file_, resolved.operation->value_where + error.pointer.substr(path.size()), error.reason);
      culprit = &resolved;
    } else if (path.starts_with(error.pointer + "/") || culprit == nullptr || op == PatchOp::remove) {
      culprit = &resolved;
    }
  }
  for (auto resolved = done.rbegin(); resolved != done.rend() && !error.missing.empty(); ++resolved) {
    const bool is_move = resolved->operation->op == PatchOp::move;
    const Tokens& removed = is_move ? resolved->from : resolved->path;
    if (pointer_text(removed) != error.missing || (!is_move && resolved->operation->op != PatchOp::remove)) continue;
    throw InputError(file_, resolved->operation->where + (is_move ? "/from" : "/path"),
                     std::string(target_noun(static_cast<Target>(*section_of(removed[0])))) + " \"" + removed[1] +
                         "\" is still used by " + user_text(error.pointer));
  }
  if (culprit == nullptr) throw InputError(file_, error.pointer, error.reason);
  throw InputError(file_, culprit->operation->where + "/path", error.pointer + ": " + error.reason);
}

}  // namespace relook
