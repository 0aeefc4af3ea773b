#include "report/line_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 18, kLongestLine = std::size_t{64} << 20;

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
  if (descriptor_ < 0) throw InputError(path_.string(), "", std::string("cannot open: ") + std::strerror(errno));
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) return;
  ::close(descriptor_);
  throw InputError(path_.string(), "", "is not a regular file");
}

LineReader::~LineReader() { ::close(descriptor_); }

bool LineReader::next(std::string& line) {
  for (std::size_t searched = taken_;;) {
    const std::size_t end = waiting_.find('\n', searched);
    if (end != std::string::npos) {
      line.assign(waiting_, taken_, end - taken_);
      offset_ = next_offset_;
      next_offset_ += line.size() + 1;
      taken_ = end + 1;
      return true;
    }
    waiting_.erase(0, std::exchange(taken_, 0));
    searched = waiting_.size();
    if (searched > kLongestLine) throw InputError(path_.string(), "", "a line is too long");
    waiting_.resize(searched + kBlockBytes);
    ssize_t got = 0;
    do got = ::read(descriptor_, waiting_.data() + searched, kBlockBytes);
    while (got < 0 && errno == EINTR);
    waiting_.resize(searched + static_cast<std::size_t>(got > 0 ? got : 0));
    if (got < 0) throw InputError(path_.string(), "", std::string("cannot read: ") + std::strerror(errno));
    if (got == 0) return false;
  }
}

std::string LineReader::read_at(std::uint64_t offset, std::size_t bytes) const {
  std::string text(bytes, '\0');
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t got = ::pread(descriptor_, text.data() + done, bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      throw InputError(path_.string(), "", got < 0 ? std::string("cannot read: ") + std::strerror(errno) : "cut short");
    done += static_cast<std::size_t>(got);
  }
  return text;
}

}  // namespace relook
