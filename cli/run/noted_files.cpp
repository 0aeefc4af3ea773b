#include "run/noted_files.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/hash.h"

namespace relook {
namespace {

std::int64_t nanoseconds(const timespec& time) { return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec; }

}  // namespace

FileStamp stamp_of(const std::filesystem::path& path, std::string hash) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw IoError(path.string(), std::string("cannot be read: ") + std::strerror(errno));
  return {std::move(hash), static_cast<std::uint64_t>(status.st_size), nanoseconds(status.st_mtim)};
}

bool NotedFiles::hold(const Json& entry) {
  for (const auto& [name, stamp] : entry.at("files").items())
    if (!has_bytes(name, stamp, false)) return false;
  return true;
}

bool NotedFiles::seem_to_hold(const Json& entry) {
  for (const auto& [name, stamp] : entry.at("files").items())
    if (!has_bytes(name, stamp, true)) return false;
  return true;
}

bool NotedFiles::has_bytes(const std::string& name, const Json& stamp, bool trusts_time) {
  const std::filesystem::path path = run_ / name;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  Seen now{static_cast<std::uint64_t>(status.st_size), nanoseconds(status.st_mtim), nanoseconds(status.st_ctim),
           stamp.at("hash").get<std::string>()};
  if (now.bytes != stamp.at("bytes").get<std::uint64_t>()) return false;
  if (trusts_time && now.modified == stamp.at("modified").get<std::int64_t>()) return true;
  const std::pair key{std::uint64_t{status.st_dev}, std::uint64_t{status.st_ino}};
  {
    const std::lock_guard lock(mutex_);
    const auto seen = seen_.find(key);
    if (seen != seen_.end() && seen->second.bytes == now.bytes && seen->second.modified == now.modified &&
        seen->second.changed == now.changed)
      return seen->second.hash == now.hash;
  }
  try {
    std::string hash = hash128_of_file(path);
    const bool is_same = hash == now.hash;
    now.hash = std::move(hash);
    const std::lock_guard lock(mutex_);
    seen_.insert_or_assign(key, std::move(now));
    return is_same;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace relook
