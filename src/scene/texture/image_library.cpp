#include "scene/texture/image_library.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

#include "base/system/module.h"

namespace relook {
namespace {

/// Throws when there is not enough address space for the module: the libraries behind it end the program when memory
/// runs out while they are loaded.
void require_address_space() {
  constexpr std::size_t kModuleBytes = std::size_t{512}
                                       << 20;  // address space of OpenImageIO and 240 libraries behind it
  void* room = mmap(nullptr, kModuleBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  munmap(room, kModuleBytes);
}

OpenImageReader* load() {
  require_address_space();
  return reinterpret_cast<OpenImageReader*>(
      module_function("librelook_images.so", "relook_open_image", "decode images"));
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
