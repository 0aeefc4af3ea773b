#include "cache/staged_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>

#include "base/error.h"
#include "base/files.h"
#include "cache/cache_folder.h"

namespace relook {
namespace {

constexpr int kMostAttempts = 1000;

std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// Absolute, links followed; empty if no folder can be there.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code ignored;
  // Absolute first: weakly_canonical leaves a relative path relative when nothing of it is there.
  const auto final_path =
      std::filesystem::weakly_canonical(std::filesystem::absolute(without_trailing_slash(path), ignored), ignored);
  return final_path.has_filename() ? final_path : std::filesystem::path();
}

/// How the names of temporary folders begin; process and a number follow.
std::string temporary_start(const std::filesystem::path& final_path) {
  return std::string(".").append(final_path.filename().string()) + ".relook-";
}

/// "PROCESS-ATTEMPT", both numbers: not one that replace_in_two_steps() has set aside, which may be the only copy.
bool is_temporary_end(std::string_view end) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t dash = end.find('-');
  if (dash == 0 || dash == std::string_view::npos || dash + 1 == end.size()) return false;
  return end.find_first_not_of(kDigits) == dash && end.find_first_not_of(kDigits, dash + 1) == std::string_view::npos;
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

StagedFolder::StagedFolder(const std::filesystem::path& final_path)
    : given_(without_trailing_slash(final_path)), final_(resolved(final_path)) {
  if (final_.empty()) throw IoError(final_path.string(), "no folder can be written here");
  make_folders(final_.parent_path());
  remove_abandoned(final_);
  const std::string stem = temporary_start(final_) + std::to_string(getpid()) + "-";
  // No name is used twice: who removes what was replaced does so by its name, which must not be another's by then.
  std::random_device number;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    staged_ = final_.parent_path() / (stem + std::to_string(number()));
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
  if (!staged_.empty()) remove_cache_files(staged_);
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::remove_abandoned(const std::filesystem::path& final_path) {
  const std::filesystem::path final_one = resolved(final_path);
  const std::string start = temporary_start(final_one);
  std::error_code error;
  std::filesystem::directory_iterator at(final_one.parent_path(), error);
  for (; !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(start) || !is_temporary_end(std::string_view(name).substr(start.size()))) continue;
    const int lock = open_locked(at->path(), true);
    if (lock < 0) continue;
    remove_cache_files(at->path());
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

void StagedFolder::publish(const std::function<bool()>& may_replace) {
  fill([this] { sync_folder(staged_); });
  int error = 0;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (rename(staged_.c_str(), final_.c_str()) == 0) {
      staged_.clear();
      return sync_folder(final_.parent_path());
    }
    error = errno;
    if (error != ENOTEMPTY && error != EEXIST) break;
    if (!may_replace()) return;
    if (renameat2(AT_FDCWD, staged_.c_str(), AT_FDCWD, final_.c_str(), RENAME_EXCHANGE) == 0) {
      retire_cache(staged_, final_);
      staged_.clear();
      return sync_folder(final_.parent_path());
    }
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
  if (rename(staged_.c_str(), final_.c_str()) == 0) {
    staged_.clear();
    retire_cache(aside, final_);
    return true;
  }
  const bool is_back = rename(aside.c_str(), final_.c_str()) == 0;
  const bool is_replaced = !is_back && (errno == ENOTEMPTY || errno == EEXIST);  // by another writer meanwhile
  if (is_replaced) retire_cache(aside, final_);
  return false;
}

}  // namespace relook
