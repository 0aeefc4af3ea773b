#include "base/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace relook {
namespace {

std::string one_line(std::string_view file, std::string_view where, std::string_view what) {
  std::string line;
  for (std::string_view part : {file, where, what}) {
    if (part.empty()) continue;
    if (!line.empty()) line += ": ";
    line += printable(part);
  }
  return line;
}

/// Length of the well-formed UTF-8 sequence at the start of `text`, or 0.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
  if (length == 0 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  if (first == 0xE0 && byte(1) < 0xA0) return 0;
  if (first == 0xED && byte(1) > 0x9F) return 0;
  if (first == 0xF0 && byte(1) < 0x90) return 0;
  if (first == 0xF4 && byte(1) > 0x8F) return 0;
  return length;
}

/// U+061C, U+200E, U+200F, U+2028 to U+202E, U+2066 to U+2069, at the start of `text`.
bool is_reordering(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.size() >= 2 && byte(0) == 0xD8) return byte(1) == 0x9C;
  if (text.size() < 3 || byte(0) != 0xE2) return false;
  if (byte(1) == 0x80) return byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xA8 && byte(2) <= 0xAE);
  return byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9;
}

}  // namespace

Error::Error(ExitCode code, std::string_view file, std::string_view where, std::string_view what)
    : std::runtime_error(one_line(file, where, what)), code_(code) {}

void require(bool condition, const char* message, std::source_location place) {
  if (condition) return;
  std::fprintf(stderr, "relook: internal error at %s:%u: %s\n", place.file_name(), place.line(), message);
  std::abort();
}

std::string printable(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const bool is_c1_control =
        length == 2 && static_cast<unsigned char>(text[0]) == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
    if (length == 0 || is_reordering(text))
      clean += '?';
    else if (length > 1 && !is_c1_control)
      clean += text.substr(0, length);
    else if (length == 1 && static_cast<unsigned char>(text[0]) >= 0x20 && text[0] != 0x7F)
      clean += text[0];
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return clean;
}

std::string without_reordering(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    if (!is_reordering(text.substr(i, 3))) {
      clean += text[i++];
      continue;
    }
    clean += "\xEF\xBF\xBD";
    i += utf8_length(text.substr(i));
  }
  return clean;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  constexpr std::size_t kLongestCompared = 256;
  a = a.substr(0, kLongestCompared);
  b = b.substr(0, kLongestCompared);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace relook
