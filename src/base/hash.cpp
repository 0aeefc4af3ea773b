#include "base/hash.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "base/error.h"

namespace relook {

std::uint64_t hash64(BytesView bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

namespace {

std::string digits_of(const XXH128_hash_t& hash) {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return digits;
}

struct CloseFile {
  int descriptor;
  ~CloseFile() { ::close(descriptor); }
};

}  // namespace

std::string hash128(BytesView bytes) { return digits_of(XXH3_128bits(bytes.data(), bytes.size())); }

std::string hash128_of_file(const std::filesystem::path& path) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) throw InputError(path.string(), "", std::string("cannot open: ") + std::strerror(errno));
  const CloseFile closing{descriptor};
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
    throw InputError(path.string(), "", "is not a regular file");
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  if (!state || XXH3_128bits_reset(state.get()) == XXH_ERROR) throw std::bad_alloc();
  std::vector<char> block(kBlockBytes);
  for (;;) {
    const ssize_t got = ::read(descriptor, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError(path.string(), "", std::string("cannot read: ") + std::strerror(errno));
    if (got == 0) return digits_of(XXH3_128bits_digest(state.get()));
    static_cast<void>(XXH3_128bits_update(state.get(), block.data(), static_cast<std::size_t>(got)));
  }
}

}  // namespace relook
