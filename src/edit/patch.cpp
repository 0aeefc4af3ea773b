#include "edit/patch.h"

#include <algorithm>
#include <optional>

#include "base/error.h"

namespace relook {
namespace {

[[noreturn]] void fail(const PatchPlace& place, const std::string& what) {
  throw InputError(place.file, place.where, what);
}

std::string in_place(const Tokens& tokens, std::size_t depth) {
  if (depth == 0) return "";
  return " in " + pointer_text(Tokens(tokens.begin(), tokens.begin() + static_cast<std::ptrdiff_t>(depth)));
}

/// "no material "Gould"" for the names of a section, "no "rougness" in /materials/Gold" below.
[[noreturn]] void fail_missing(const Json& object, const Tokens& tokens, std::size_t depth, const PatchPlace& place) {
  std::vector<std::string> known;
  for (const auto& item : object.items()) known.push_back(item.key());
  const std::string near = nearest_name(tokens[depth], known);
  const std::string hint = near.empty() ? "" : "; did you mean \"" + near + "\"?";
  const bool is_entity = depth == 1 && tokens[0].ends_with('s') && tokens[0] != "extensions";
  if (!is_entity) fail(place, "no \"" + tokens[depth] + "\"" + in_place(tokens, depth) + hint);
  const std::string noun = tokens[0] == "meshes" ? "mesh" : tokens[0].substr(0, tokens[0].size() - 1);
  fail(place, "no " + noun + " \"" + tokens[depth] + "\"" + hint);
}

/// The number of an array index without leading zeros.
std::optional<std::size_t> index_in(const std::string& token) {
  constexpr std::size_t kMostDigits = 9;
  const bool is_index = !token.empty() && token.size() <= kMostDigits && (token == "0" || token[0] != '0') &&
                        std::all_of(token.begin(), token.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_index ? std::optional(std::stoul(token)) : std::nullopt;
}

/// An array index below `end`.
std::size_t index_of(const Tokens& tokens, std::size_t depth, std::size_t end, const PatchPlace& place) {
  const std::string& token = tokens[depth];
  const std::optional<std::size_t> index = index_in(token);
  if (!index) fail(place, "\"" + token + "\" is no array index" + in_place(tokens, depth));
  if (*index >= end)
    fail(place, "index " + token + " is past the end of an array of " + std::to_string(end) + in_place(tokens, depth));
  return *index;
}

Json& child_at(Json& parent, const Tokens& tokens, std::size_t depth, const PatchPlace& place) {
  if (parent.is_array()) return parent[index_of(tokens, depth, parent.size(), place)];
  if (!parent.is_object()) fail(place, "nothing lies below a plain value" + in_place(tokens, depth));
  const auto found = parent.find(tokens[depth]);
  if (found == parent.end()) fail_missing(parent, tokens, depth, place);
  return *found;
}

Json& parent_of(Json& root, const Tokens& tokens, const PatchPlace& place) {
  Json* at = &root;
  for (std::size_t depth = 0; depth + 1 < tokens.size(); ++depth) at = &child_at(*at, tokens, depth, place);
  return *at;
}

}  // namespace

std::string pointer_text(const Tokens& tokens) {
  std::string text;
  for (const std::string& token : tokens) text += "/" + escape_token(token);
  return text;
}

std::size_t existing_depth(const Json& root, const Tokens& tokens) {
  const Json* at = &root;
  for (std::size_t depth = 0; depth < tokens.size(); ++depth) {
    if (at->is_array()) {
      const std::optional<std::size_t> index = index_in(tokens[depth]);
      if (!index || *index >= at->size()) return depth;
      at = &(*at)[*index];
    } else {
      const auto found = at->find(tokens[depth]);
      if (found == at->end()) return depth;
      at = &*found;
    }
  }
  return tokens.size();
}

Json& value_at(Json& root, const Tokens& tokens, const PatchPlace& place) {
  if (tokens.empty()) return root;
  return child_at(parent_of(root, tokens, place), tokens, tokens.size() - 1, place);
}

void add_at(Json& root, Tokens& tokens, Json value, const PatchPlace& place) {
  if (tokens.empty()) {
    root = std::move(value);
    return;
  }
  Json& parent = parent_of(root, tokens, place);
  const std::size_t depth = tokens.size() - 1;
  if (parent.is_array()) {
    if (tokens[depth] == "-") tokens[depth] = std::to_string(parent.size());
    const std::size_t index = index_of(tokens, depth, parent.size() + 1, place);
    parent.insert(parent.begin() + static_cast<std::ptrdiff_t>(index), std::move(value));
  } else if (parent.is_object()) {
    parent[tokens[depth]] = std::move(value);
  } else {
    fail(place, "nothing lies below a plain value" + in_place(tokens, depth));
  }
}

Json remove_at(Json& root, const Tokens& tokens, const PatchPlace& place) {
  if (tokens.empty()) return std::exchange(root, Json());
  Json& parent = parent_of(root, tokens, place);
  const std::size_t depth = tokens.size() - 1;
  Json removed = std::move(child_at(parent, tokens, depth, place));
  if (parent.is_array())
    parent.erase(index_of(tokens, depth, parent.size(), place));
  else
    parent.erase(tokens[depth]);
  return removed;
}

}  // namespace relook
