#include "report/run_source.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.h"
#include "base/hash.h"

namespace relook {

Json run_source(const Json& manifest, const FrameStyle& style) {
  const Json& content = manifest.at("content");
  return {{"scene", content.at("scene")},
          {"resolution", content.at("camera").at("width").dump() + "x" + content.at("camera").at("height").dump()},
          {"camera", content.at("camera").at("name")},
          {"samples", content.at("samples").dump()},
          {"integrator", content.at("integrator")},
          {"max_depth", content.at("max_depth").dump()},
          {"options", content.at("options")},
          {"arithmetic", content.at("arithmetic")},
          {"frames", style.is_float ? "float" : "half"},
          {"layers", style.has_layers ? "layers" : "no layers"},
          {"view", style.view}};
}

std::string hash_of_source(const Json& source) { return hash128(bytes_of(source.dump())); }

std::optional<std::string> difference_of_sources(const Json& there, const Json& here) {
  if (there == here) return std::nullopt;
  const auto text = [](const Json& source, const char* key) {
    const Json value = source.is_object() ? source.value(key, Json()) : Json();
    return value.is_string() ? printable(value.get<std::string>()) : value.dump();
  };
  const auto differs = [&](const char* key) { return text(there, key) != text(here, key); };
  if (!there.is_object() || !there.contains("integrator")) return "a run of another version of relook";
  if (differs("scene")) return "a run of another scene";
  constexpr std::array<std::pair<const char*, const char*>, 6> kSaid{{{"resolution", "frames of "},
                                                                      {"camera", "frames of camera "},
                                                                      {"samples", "frames with samples a pixel: "},
                                                                      {"integrator", "frames of --integrator "},
                                                                      {"max_depth", "frames of a depth of "},
                                                                      {"frames", "frames in "}}};
  for (const auto& [key, what] : kSaid)
    if (differs(key)) return what + text(there, key) + ", not " + text(here, key);
  if (differs("layers")) return "frames with " + text(there, "layers") + ", not " + text(here, "layers");
  if (differs("view")) return "previews of another display view";
  if (differs("options")) return "frames of another camera or sampling";
  if (differs("arithmetic")) return "frames made with other arithmetic (another build, library or processor)";
  return "another run";
}

}  // namespace relook
