#include "cache/cache_names.h"

#include <string>

#include "base/file_names.h"

namespace relook {
namespace {

constexpr std::string_view kDigits = "0123456789", kHexadecimal = "0123456789abcdef";

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

}  // namespace

bool is_hash(std::string_view text) { return text.size() == 32 && consists_of(text, kHexadecimal); }

bool is_content_name(std::string_view name) {
  if (name == "look.json") return true;
  constexpr std::string_view kSuffix = ".rlk";
  if (!name.ends_with(kSuffix)) return false;
  name.remove_suffix(kSuffix.size());
  const std::size_t dash = name.rfind('-');
  if (dash == std::string_view::npos || !is_hash(name.substr(dash + 1))) return false;
  const std::string_view stem = name.substr(0, dash);
  for (const std::string_view folder : kInnerFolders)
    if (stem.starts_with(folder) && stem.size() > folder.size() && stem[folder.size()] == '/')
      return consists_of(stem.substr(folder.size() + 1), kDigits);
  return stem == "geometry" || stem == "textures" || stem == "frame" || stem == "paths";
}

bool is_own_name(std::string_view name) {
  if (name == kManifestName || is_content_name(name)) return true;
  const std::size_t slash = name.rfind('/');
  const std::size_t start = slash == std::string_view::npos ? 0 : slash + 1;
  const std::string_view inner = name_of_temporary(name.substr(start));
  const std::string final_name = std::string(name.substr(0, start)).append(inner);
  return !inner.empty() && (final_name == kManifestName || is_content_name(final_name));
}

}  // namespace relook
