#include "base/system/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {

void* module_function(const char* module, const char* function, const char* purpose) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  std::string reason;
  for (const std::filesystem::path& path : {folder / module, folder.parent_path() / "lib" / "relook" / module}) {
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
