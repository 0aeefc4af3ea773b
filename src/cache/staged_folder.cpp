#include "cache/staged_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/files.h"

namespace relook {
namespace {

constexpr int kMostAttempts = 1000;

std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// A descriptor of a folder with a lock on it; -1 if there is no such folder or somebody else has the lock. Where
/// folders cannot be locked: only if `needs_lock` is false.
int open_locked(const std::filesystem::path& folder, bool needs_lock) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return -1;
  const bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) == 0;
  const bool is_refused = !is_locked && (needs_lock || errno == EWOULDBLOCK);
  struct stat opened {
  }, named{};
  const bool is_there = ::fstat(file, &opened) == 0 && ::lstat(folder.c_str(), &named) == 0 &&
                        opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  if (!is_refused && is_there) return file;
  ::close(file);
  return -1;
}

}  // namespace

StagedFolder::StagedFolder(const std::filesystem::path& final_path) : given_(without_trailing_slash(final_path)) {
  std::error_code ignored;
  // Absolute first: weakly_canonical leaves a relative path relative when nothing of it is there.
  final_ = std::filesystem::weakly_canonical(std::filesystem::absolute(given_, ignored), ignored);
  if (final_.empty() || !final_.has_filename()) throw IoError(final_path.string(), "no folder can be written here");
  make_folders(final_.parent_path());
  const std::string start = std::string(".").append(final_.filename().string()) + ".relook-";
  remove_abandoned(start);
  const std::string stem = start + std::to_string(getpid()) + "-";
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    staged_ = final_.parent_path() / (stem + std::to_string(attempt));
    if (mkdir(staged_.c_str(), 0777) == 0) {
      lock_ = open_locked(staged_, false);
      if (lock_ >= 0) return;
      continue;  // taken for abandoned by somebody in this moment
    }
    if (errno == ENOSPC || errno == EDQUOT) throw ResourceError(final_path.string(), std::strerror(errno));
    if (errno != EEXIST) throw IoError(final_path.string(), std::string("cannot be written: ") + std::strerror(errno));
  }
  throw IoError(final_path.string(), "too many unfinished folders beside it");
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staged_.empty()) std::filesystem::remove_all(staged_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::remove_abandoned(const std::string& start) const {
  constexpr std::string_view kSetAside = "-old";  // may be the only copy of a cache: see replace_in_two_steps()
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(final_.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || name.ends_with(kSetAside)) continue;
    const int lock = open_locked(entry.path(), true);
    if (lock < 0) continue;
    std::filesystem::remove_all(entry.path(), ignored);
    ::close(lock);
  }
}

void StagedFolder::fill(const std::function<void()>& fill) const {
  try {
    fill();
  } catch (const Error& error) {
    std::string what = error.what();
    const std::string temporary = printable(staged_.string());
    const std::size_t place = what.find(temporary);
    if (place == std::string::npos) throw;
    throw Error(error.code(), "", "", what.replace(place, temporary.size(), printable(given_.string())));
  }
}

void StagedFolder::publish() {
  fill([this] { sync_folder(staged_); });
  int error = 0;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    const bool is_new = rename(staged_.c_str(), final_.c_str()) == 0;
    error = errno;
    const bool is_exchanged = !is_new && (error == ENOTEMPTY || error == EEXIST) &&
                              renameat2(AT_FDCWD, staged_.c_str(), AT_FDCWD, final_.c_str(), RENAME_EXCHANGE) == 0;
    if (is_new) staged_.clear();
    if (is_new || is_exchanged) return sync_folder(final_.parent_path());
    if (error != ENOTEMPTY && error != EEXIST) break;
    error = errno;
    const bool cannot_exchange = error == EINVAL || error == ENOSYS;
    if (cannot_exchange && replace_in_two_steps()) return sync_folder(final_.parent_path());
    if (!cannot_exchange && error != ENOENT) break;
  }
  throw IoError(given_.string(), std::string("cannot be published: ") + std::strerror(error));
}

bool StagedFolder::replace_in_two_steps() {
  const std::filesystem::path aside = staged_.string() + "-old";
  if (rename(final_.c_str(), aside.c_str()) != 0) return false;
  const bool is_published = rename(staged_.c_str(), final_.c_str()) == 0;
  if (is_published) staged_.clear();
  std::error_code ignored;
  if (is_published || rename(aside.c_str(), final_.c_str()) != 0) std::filesystem::remove_all(aside, ignored);
  return is_published;
}

}  // namespace relook
