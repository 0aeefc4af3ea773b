#include "edit/wildcard.h"

#include <cstddef>

#include "base/error.h"
#include "scene/look/look_names.h"

namespace relook {

bool matches_wildcard(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, after_star = std::string_view::npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      after_star = ++p;
      from = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (after_star != std::string_view::npos) {
      p = after_star;
      t = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<std::string> matching_paths(const LookDocument& document, const PatchOperation& operation,
                                        const PatchPlace& place) {
  if (operation.op != PatchOp::replace || operation.path.find('*') == std::string::npos) return {operation.path};
  Tokens tokens = split_pointer(operation.path, place.file, place.where);
  resolve_light_place(document, tokens);
  const std::optional<Section> section = section_of(tokens[0]);
  if (!section || tokens.size() < 2 || tokens[1].find('*') == std::string::npos) return {operation.path};
  const auto names = document.look.find(tokens[0]);
  if (names == document.look.end() || !names->is_object() || names->contains(tokens[1])) return {operation.path};
  const std::string pattern = tokens[1];
  std::vector<std::string> paths;
  for (const auto& entry : names->items()) {
    if (!matches_wildcard(pattern, entry.key())) continue;
    tokens[1] = entry.key();
    paths.push_back(pointer_text(tokens));
  }
  if (paths.empty())
    throw InputError(place.file, place.where,
                     "no " + std::string(target_noun(static_cast<Target>(*section))) + " matches \"" + pattern + "\"");
  return paths;
}

}  // namespace relook
