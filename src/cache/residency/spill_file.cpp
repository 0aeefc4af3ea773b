#include "cache/residency/spill_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.h"

namespace relook {
namespace {

/// Sizes are rounded up, so that a piece that has grown a little fits where it was.
constexpr std::uint64_t kGrainBytes = 16 << 10;
std::uint64_t rounded(std::uint64_t bytes) { return (bytes + kGrainBytes - 1) / kGrainBytes * kGrainBytes; }

int open_unnamed(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Not every file system has files without names.
  std::string name = (folder / ".spill-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named < 0) throw IoError(folder.string(), std::string("cannot hold a spill file: ") + std::strerror(errno));
  ::unlink(name.c_str());
  return named;
}

}  // namespace

SpillFile::SpillFile(const std::filesystem::path& folder, std::uint64_t limit_bytes)
    : folder_(folder), limit_(limit_bytes), descriptor_(open_unnamed(folder)) {}

SpillFile::~SpillFile() { ::close(descriptor_); }

std::optional<SpillFile::Extent> SpillFile::write(BytesView bytes) {
  const std::uint64_t size = rounded(bytes.size());
  const auto fitting = free_.lower_bound(size);
  const bool is_reused = fitting != free_.end() && fitting->first <= size + size / 4;
  if (!is_reused && end_ + size > limit_) return std::nullopt;
  const Extent extent{is_reused ? fitting->second : end_, bytes.size(), is_reused ? fitting->first : size};
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(extent.offset + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return std::nullopt;  // a full disk, say: the caller does without
    done += static_cast<std::size_t>(written);
  }
  if (is_reused)
    free_.erase(fitting);
  else
    end_ += size;
  used_ += extent.room;
  return extent;
}

Bytes SpillFile::read(const Extent& extent) const {
  Bytes bytes(extent.bytes);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(extent.offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      throw IoError(folder_.string(), std::string("the spill file cannot be read: ") +
                                          (got < 0 ? std::strerror(errno) : "it ends early"));
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

void SpillFile::expect(const Extent& extent) const {
  ::posix_fadvise(descriptor_, static_cast<off_t>(extent.offset), static_cast<off_t>(extent.bytes),
                  POSIX_FADV_WILLNEED);
}

void SpillFile::free(const Extent& extent) {
  free_.emplace(extent.room, extent.offset);
  used_ -= extent.room;
}

}  // namespace relook
