#include "base/layer_names.h"

#include "base/error.h"

namespace relook {
namespace {

constexpr std::size_t kLongestLayer = 255 - 2;  // bytes; OpenEXR takes 255 for a channel, ".R" is one's end

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80; }

/// `name` cut to `bytes` at most, between two characters of UTF-8.
std::string shortened(const std::string& name, std::size_t bytes) {
  if (name.size() <= bytes) return name;
  while (bytes > 0 && is_continuation(name[bytes])) --bytes;
  return name.substr(0, bytes);
}

/// Spaces, marks of direction, and what else has no shape of its own, beyond ASCII.
bool is_shapeless(char32_t c) {
  return c == 0xA0 || c == 0xAD || c == 0x1680 || (c >= 0x2000 && c <= 0x200F) || (c >= 0x2028 && c <= 0x202F) ||
         (c >= 0x205F && c <= 0x206F) || c == 0x3000 || c == 0xFEFF || (c >= 0xFFF0 && c <= 0xFFFB) || c >= 0xE0000;
}

}  // namespace

std::string channel_name(std::string_view name) {
  std::string result;
  const std::string clean = printable(name);
  for (std::size_t i = 0; i < clean.size();) {
    std::size_t end = i + 1;
    while (end < clean.size() && is_continuation(clean[end])) ++end;
    const auto first = static_cast<unsigned char>(clean[i]);
    char32_t character = first < 0x80 ? first : first & (0xFFU >> (end - i + 1));
    for (std::size_t k = i + 1; k < end; ++k)
      character = character << 6 | (static_cast<unsigned char>(clean[k]) & 0x3FU);
    const bool is_plain = first < 0x80 ? (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') ||
                                             (first >= '0' && first <= '9') || first == '-'
                                       : !is_shapeless(character);
    result += is_plain ? clean.substr(i, end - i) : "_";
    i = end;
  }
  return result;
}

std::string LayerNames::take(const std::string& wanted) {
  const std::string name = shortened(wanted, kLongestLayer);
  int& next = next_[name];
  if (next == 0) {
    next = 2;
    return name;
  }
  for (;;) {
    const std::string number = "_" + std::to_string(next++);
    std::string result = shortened(name, kLongestLayer - number.size()) + number;
    if (next_.try_emplace(result, 2).second) return result;
  }
}

}  // namespace relook
