#include "options/version_text.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/system/module.h"
#include "base/system/sandbox.h"
#include "cache/arithmetic.h"
#include "cache/container.h"
#include "options/command_help.h"
#include "report/report.h"

#ifndef RELOOK_LIBRARIES
#define RELOOK_LIBRARIES ""  // "OpenEXR 3.1.5,Imath 3.1.6,": as CMake found them
#endif

namespace relook {
namespace {

/// Name -> version of the libraries at build time; Embree's is that of the one loaded.
Json libraries() {
  Json result{{"Embree", own_arithmetic().embree}, {"libc", own_arithmetic().libc}};
  std::string_view rest = RELOOK_LIBRARIES;
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(','));
    const std::size_t space = entry.find(' ');
    if (space != std::string_view::npos && space + 1 < entry.size())
      result[std::string(entry.substr(0, space))] = entry.substr(space + 1);
    rest.remove_prefix(std::min(entry.size() + 1, rest.size()));
  }
  return result;
}

Json features() {
  return {{"integrators", {"path", "whitted"}},
          {"images", has_module("librelook_images.so")},
          {"compressed_meshes", has_module("librelook_meshes.so")},
          {"ocio_views", has_module("librelook_views.so")}};
}

}  // namespace

std::string version_text() {
  return "relook " + std::string(program_version()) + "\n" + arithmetic_text(own_arithmetic()) + "\ncache format " +
         std::to_string(kCacheFormat) + "\nsandbox: " + sandbox_text();
}

Json version_json() {
  Json verbs = Json::object();
  for (const VerbHelp& verb : command_line_help()) {
    verbs[verb.name] = Json::array();
    for (const VerbHelp& part : verb.parts) verbs[verb.name].push_back(part.name);
  }
  const std::string cache = "cache/" + std::to_string(kCacheFormat);
  return {{"relook", "version/1"},
          {"program", program_version()},
          {"arithmetic", arithmetic_json(own_arithmetic())},
          {"sandbox", sandbox_text()},
          {"libraries", libraries()},
          {"features", features()},
          {"verbs", std::move(verbs)},  // with the parts of each
          {"schemas", {cache, "compare/1", "journal/1", "plan/1", "report/1", "version/1"}}};
}

}  // namespace relook
