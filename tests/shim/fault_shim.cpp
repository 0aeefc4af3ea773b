// Preloaded into relook by tests: makes the n-th call that changes a file system fail, or kills the process there.
//   RELOOK_FAULT=n:MODE     MODE: kill (before the call), after (kill after it), eio (this call fails), enospc (this
//                           and all later calls that need space fail), short (this write writes half of its bytes)
//   RELOOK_FAULT_COUNT=FILE the number of such calls is written there at the end
//   RELOOK_EXCHANGE=n:A:B   before the n-th opening of a MANIFEST.json the folders A and B change names
// Writes to standard output and error do not count.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <string>

namespace {

enum class Mode { none, kill, after, eio, enospc, shortened };

struct Plan {
  long at = 0;
  Mode mode = Mode::none;
  int count_file = -1;
  std::atomic<long> calls{0};

  Plan() {
    if (const char* file = getenv("RELOOK_FAULT_COUNT")) {
      const auto real = reinterpret_cast<int (*)(const char*, int, ...)>(dlsym(RTLD_NEXT, "open"));
      count_file = real(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    const char* text = getenv("RELOOK_FAULT");
    const char* colon = text != nullptr ? strchr(text, ':') : nullptr;
    if (colon == nullptr) return;
    at = atol(text);
    const std::string name = colon + 1;
    mode = name == "kill"     ? Mode::kill
           : name == "after"  ? Mode::after
           : name == "eio"    ? Mode::eio
           : name == "enospc" ? Mode::enospc
           : name == "short"  ? Mode::shortened
                              : Mode::none;
  }
};

Plan& plan() {
  static Plan* const the_plan = new Plan;  // outlives every call at exit
  return *the_plan;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

[[noreturn]] void die() {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}

/// Counts a call and makes it, or not.
template <class Call>
auto faulty(bool needs_space, const Call& call) -> decltype(call()) {
  Plan& p = plan();
  const long number = ++p.calls;
  if (number == p.at && p.mode == Mode::kill) die();
  const bool fails = p.mode == Mode::eio ? number == p.at : p.mode == Mode::enospc && needs_space && number >= p.at;
  if (p.at > 0 && fails) {
    errno = p.mode == Mode::eio ? EIO : ENOSPC;
    return -1;
  }
  const auto result = call();
  if (number == p.at && p.mode == Mode::after) die();
  return result;
}

bool changes_files(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT | O_DIRECTORY)) != 0; }

/// Another program that exchanges two caches at the worst moment.
void exchange_at(const char* path) {
  static const char* const wish = getenv("RELOOK_EXCHANGE");
  static std::atomic<long> openings{0};
  constexpr const char* kName = "MANIFEST.json";
  const size_t length = strlen(path);
  if (wish == nullptr || length < strlen(kName) || strcmp(path + length - strlen(kName), kName) != 0) return;
  if (++openings != atol(wish)) return;
  const std::string text = strchr(wish, ':') + 1;
  const size_t colon = text.find(':');
  const auto real = next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2");
  (void)real(AT_FDCWD, text.substr(0, colon).c_str(), AT_FDCWD, text.substr(colon + 1).c_str(), 2 /* exchange */);
}

int open_by(const char* name, const char* path, int flags, mode_t mode) {
  exchange_at(path);
  const auto real = next<int (*)(const char*, int, ...)>(name);
  if (!changes_files(flags) || strncmp(path, "/dev/", 5) == 0) return real(path, flags, mode);
  return faulty((flags & O_CREAT) != 0, [&] { return real(path, flags, mode); });
}

/// The file is opened here: it may be out of reach once the program is in its sandbox.
__attribute__((constructor)) void begin() { plan(); }

__attribute__((destructor)) void write_count() {
  const Plan& p = plan();
  if (p.count_file < 0) return;
  const std::string text = std::to_string(p.calls.load()) + "\n";
  (void)!next<ssize_t (*)(int, const void*, size_t)>("write")(p.count_file, text.data(), text.size());
  close(p.count_file);
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

ssize_t write(int file, const void* bytes, size_t count) {
  const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (file <= STDERR_FILENO) return real(file, bytes, count);
  return faulty(true, [&] {
    const Plan& p = plan();
    const bool is_short = p.mode == Mode::shortened && p.calls == p.at && count > 1;
    return real(file, bytes, is_short ? count / 2 : count);
  });
}

int fsync(int file) {
  return faulty(false, [&] { return next<int (*)(int)>("fsync")(file); });
}
int ftruncate(int file, off_t size) {
  return faulty(false, [&] { return next<int (*)(int, off_t)>("ftruncate")(file, size); });
}
int rename(const char* from, const char* to) {
  return faulty(true, [&] { return next<int (*)(const char*, const char*)>("rename")(from, to); });
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  const auto real = next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2");
  return faulty(true, [&] { return real(from_folder, from, to_folder, to, flags); });
}
int mkdir(const char* path, mode_t mode) {
  return faulty(true, [&] { return next<int (*)(const char*, mode_t)>("mkdir")(path, mode); });
}
int unlink(const char* path) {
  return faulty(false, [&] { return next<int (*)(const char*)>("unlink")(path); });
}
int unlinkat(int folder, const char* path, int flags) {
  return faulty(false, [&] { return next<int (*)(int, const char*, int)>("unlinkat")(folder, path, flags); });
}
int rmdir(const char* path) {
  return faulty(false, [&] { return next<int (*)(const char*)>("rmdir")(path); });
}
int remove(const char* path) {
  return faulty(false, [&] { return next<int (*)(const char*)>("remove")(path); });
}
}
