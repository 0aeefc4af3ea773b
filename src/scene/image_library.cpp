#include "scene/image_library.h"

#include <dlfcn.h>
#include <sys/mman.h>

#include <cstdlib>
#include <filesystem>
#include <new>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {
namespace {

constexpr const char* kModule = "librelook_images.so";

/// Libraries behind the module end the program when memory runs out while they are loaded: ask first.
void require_address_space() {
  constexpr std::size_t kModuleBytes = std::size_t{512}
                                       << 20;  // address space of OpenImageIO and 240 libraries behind it
  void* room = mmap(nullptr, kModuleBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  munmap(room, kModuleBytes);
}

OpenImageReader* load() {
  require_address_space();
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  std::string reason;
  for (const std::filesystem::path& path : {folder / kModule, folder.parent_path() / "lib" / "relook" / kModule}) {
    if (!std::filesystem::exists(path, ignored)) continue;
    void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded
    set_float_mode();                                            // what libraries do when they are loaded is theirs
    void* function = module != nullptr ? dlsym(module, "relook_open_image") : nullptr;
    if (function != nullptr) return reinterpret_cast<OpenImageReader*>(function);
    if (const char* message = dlerror(); message != nullptr) reason = message;
  }
  throw Error(ExitCode::io, kModule, "", reason.empty() ? "is not beside the program: cannot decode images" : reason);
}

}  // namespace

void limit_image_library_threads() {
  setenv("OPENIMAGEIO_THREADS", "1", 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
}

std::unique_ptr<ImageReader> open_image(const char* format, std::span<const std::byte> bytes, std::string& error) {
  static OpenImageReader* const open = load();
  return open(format, bytes, error);
}

}  // namespace relook
