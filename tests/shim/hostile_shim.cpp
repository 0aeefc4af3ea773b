// Preloaded into relook by tests: stands for a fault in what reads an input. When a file whose name ends in
// $RELOOK_HOSTILE_AT is opened to be read for the first time, a new thread tries all hostile calls, and those on files
// in $RELOOK_HOSTILE_FOLDER; what came of them goes to stderr, a line "hostile: NAME: ERRNO" each.
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <atomic>
#include <string_view>
#include <thread>

#include "hostile_calls.h"

namespace {

void attack_at(const char* path, int flags) {
  static std::atomic<bool> is_done{false};
  const char *const name = getenv("RELOOK_HOSTILE_AT"), *const folder = getenv("RELOOK_HOSTILE_FOLDER");
  if ((flags & O_PATH) != 0) return;  // only looked up
  if (name == nullptr || folder == nullptr || !std::string_view(path).ends_with(name) || is_done.exchange(true)) return;
  std::thread([folder] {
    for (const auto& calls : {relook::hostile_calls(), relook::hostile_file_calls(folder)})
      for (const relook::HostileCall& call : calls) fprintf(stderr, "hostile: %s: %d\n", call.name, call.error);
  }).join();
}

int open_by(const char* name, const char* path, int flags, mode_t mode) {
  attack_at(path, flags);
  return reinterpret_cast<int (*)(const char*, int, ...)>(dlsym(RTLD_NEXT, name))(path, flags, mode);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>(va_arg(arguments, int));
  va_end(arguments);
  return open_by("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>(va_arg(arguments, int));
  va_end(arguments);
  return open_by("open64", path, flags, mode);
}
}
