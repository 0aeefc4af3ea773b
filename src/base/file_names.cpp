#include "base/file_names.h"

#include <algorithm>
#include <array>
#include <string>

namespace relook {
namespace {

constexpr std::string_view kDigits = "0123456789", kHexadecimal = "0123456789abcdef";

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

}  // namespace

std::string_view name_of_temporary(std::string_view name) {
  constexpr std::string_view kSuffix = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(kSuffix)) return {};
  name.remove_prefix(1);
  name.remove_suffix(kSuffix.size());
  for (int number = 0; number < 2; ++number) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos || !consists_of(name.substr(dot + 1), kDigits)) return {};
    name = name.substr(0, dot);
  }
  return name;
}

bool is_system_name(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  constexpr std::array<std::string_view, 6> kNames{".ds_store",   "thumbs.db",  "ehthumbs.db",
                                                   "desktop.ini", ".directory", ".localized"};
  if (std::ranges::find(kNames, lower) != kNames.end()) return true;
  constexpr std::string_view kNfs = ".nfs", kAppleDouble = "._";
  if (lower.starts_with(kNfs)) return consists_of(std::string_view(lower).substr(kNfs.size()), kHexadecimal);
  return lower.starts_with(kAppleDouble) && lower.size() > kAppleDouble.size();
}

}  // namespace relook
