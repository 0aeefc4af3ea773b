#include "base/system/module.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {
namespace {

/// Where a module may lie.
std::array<std::filesystem::path, 2> places_of(const char* module) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  return {folder / module, folder.parent_path() / "lib" / "relook" / module};
}

}  // namespace

bool has_module(const char* module) {
  std::error_code ignored;
  return std::ranges::any_of(places_of(module),
                             [&](const auto& path) { return std::filesystem::exists(path, ignored); });
}

void* module_function(const char* module, const char* function, const char* purpose) {
  std::error_code ignored;
  std::string reason;
  for (const std::filesystem::path& path : places_of(module)) {
    if (!std::filesystem::exists(path, ignored)) continue;
    void* loaded = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    set_float_mode();  // libraries may change the mode as they are loaded
    void* found = loaded != nullptr ? dlsym(loaded, function) : nullptr;
    if (found != nullptr) return found;
    if (const char* message = dlerror(); message != nullptr) reason = message;
  }
  if (reason.empty()) reason = std::string("is not beside the program: cannot ") + purpose;
  throw Error(ExitCode::io, module, "", reason);
}

}  // namespace relook
