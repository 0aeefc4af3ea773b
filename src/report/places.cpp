#include "report/places.h"

#include <cstdio>
#include <string>

#include "base/error.h"
#include "scene/gltf/gltf_source.h"

namespace relook {
namespace {

std::string encoded(const std::filesystem::path& path) {
  std::string text;
  for (const char c : path.native()) {
    const auto byte = static_cast<unsigned char>(c);
    char escape[8];
    std::snprintf(escape, sizeof escape, "%%%02X", byte);
    if (byte > 0x20 && byte < 0x7F && c != '%' && c != '"' && c != '\\')
      text += c;
    else
      text += escape;
  }
  return text;
}

}  // namespace

Json place_json(const std::filesystem::path& run, const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path full =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  const std::filesystem::path folder =
      std::filesystem::weakly_canonical(std::filesystem::absolute(run, ignored), ignored);
  return {encoded(full.lexically_relative(folder)), encoded(full)};
}

std::optional<std::filesystem::path> find_place(const std::filesystem::path& run, const Json& places) {
  if (!places.is_array()) return std::nullopt;
  for (const Json& place : places) {
    if (!place.is_string()) continue;
    try {
      const std::filesystem::path path = run / percent_decoded(place.get_ref<const std::string&>(), "", "");
      std::error_code error;
      if (std::filesystem::exists(path, error)) return path;
    } catch (const InputError&) {  // not as it was written
    }
  }
  return std::nullopt;
}

}  // namespace relook
