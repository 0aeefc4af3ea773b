#include "base/system/standard_input.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace relook {
namespace {

constexpr const char* kName = "stdin";

/// Reads what is there, at the end of `bytes`; false at the end of the input.
bool read_some(Bytes& bytes) {
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  const std::size_t before = bytes.size();
  bytes.resize(before + kPiece);
  const ssize_t got = ::read(STDIN_FILENO, bytes.data() + before, kPiece);
  const int error = errno;
  bytes.resize(before + (got > 0 ? static_cast<std::size_t>(got) : 0));
  if (got < 0 && error != EINTR && error != EAGAIN)
    throw InputError(kName, "", "cannot read: " + std::generic_category().message(error));
  return got != 0;
}

}  // namespace

std::filesystem::path input_name(const std::filesystem::path& path) {
  return path == kStandardInput ? std::filesystem::path(kName) : path;
}

Bytes read_input(const std::filesystem::path& path, const WhileWaiting& while_waiting) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  constexpr int kWaitMilliseconds = 100;
  if (path != kStandardInput) return read_file(path);
  if (isatty(STDIN_FILENO) != 0) throw InputError(kName, "", "is a terminal; \"-\" reads from a pipe or a file");
  Bytes bytes;
  for (bool is_open = true; is_open;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const bool is_ready = poll(&input, 1, kWaitMilliseconds) > 0;
    if (while_waiting) while_waiting();
    if (is_ready) is_open = read_some(bytes);
    if (bytes.size() > kMostBytes)
      throw InputError(kName, "", "is larger than " + std::to_string(kMostBytes) + " bytes");
  }
  return bytes;
}

}  // namespace relook
