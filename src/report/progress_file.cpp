#include "report/progress_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"

namespace relook {
namespace {

constexpr std::size_t kHashDigits = 32;
constexpr off_t kLongestHead = 1 << 16;

/// Locks or unlocks bytes of an open file; false with errno when somebody else has one of them.
bool set_lock(int descriptor, short kind, std::uint64_t first, std::uint64_t count) {
  if (count == 0) return true;  // to the system that is all bytes
  struct flock lock {};
  lock.l_type = kind;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(first);
  lock.l_len = static_cast<off_t>(count);
  int result = 0;
  do result = ::fcntl(descriptor, F_OFD_SETLK, &lock);
  while (result != 0 && errno == EINTR);
  return result == 0;
}

/// Whether a lock was refused because somebody has it, not because the file system has none.
bool is_held(int error) { return error == EAGAIN || error == EACCES; }

/// Whether a file that ends within a line has no other line.
bool has_one_line(int descriptor, off_t size) {
  if (size >= kLongestHead) return false;
  std::string text(static_cast<std::size_t>(size), '\0');
  return ::pread(descriptor, text.data(), text.size(), 0) == size && text.find('\n') == std::string::npos;
}

/// Whether the open file is still the one under its name.
bool is_current(int descriptor, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

std::string steps_text(std::uint32_t first, std::uint32_t last) {
  return first == last ? "step " + std::to_string(first)
                       : "one of the steps " + std::to_string(first) + " to " + std::to_string(last);
}

}  // namespace

std::string_view progress_text(std::string_view line) {
  if (line.size() <= kHashDigits) return "";
  const std::string_view text = line.substr(kHashDigits + 1);
  return line.substr(0, kHashDigits) == hash128(bytes_of(text)) ? text : "";
}

ProgressFile::ProgressFile(const std::filesystem::path& run, std::uint32_t first_step, std::uint32_t last_step)
    : path_(run / kProgressName), first_step_(first_step), last_step_(last_step) {
  constexpr int kMostTries = 20;
  constexpr auto kPause = std::chrono::milliseconds(50);
  for (int tries = 1;; ++tries) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_to_write(path_, "create the file", errno);
    const bool is_locked = set_lock(descriptor_, F_WRLCK, first_step, std::uint64_t{last_step} - first_step + 1);
    const int error = errno;
    const bool is_done = is_locked ? is_current(descriptor_, path_) : !is_held(error);
    if (is_done) return;
    ::close(std::exchange(descriptor_, -1));
    if (is_locked) continue;  // another command has removed the file in this moment
    if (tries == kMostTries)
      throw BusyError(run.string(), "another replay is at " + steps_text(first_step, last_step) + " of this run");
    std::this_thread::sleep_for(kPause);  // it may hold all steps for a moment
  }
}

ProgressFile::~ProgressFile() { ::close(descriptor_); }

ProgressFile::Turn::Turn(const ProgressFile& file, std::uint64_t byte, int most_seconds) : file_(file), byte_(byte) {
  constexpr auto kPause = std::chrono::milliseconds(5);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(most_seconds);
  for (;;) {
    is_ours_ = set_lock(file.descriptor_, F_WRLCK, byte, 1) || !is_held(errno);
    if (is_ours_ || std::chrono::steady_clock::now() >= end) return;
    std::this_thread::sleep_for(kPause);
  }
}

ProgressFile::Turn::~Turn() {
  if (is_ours_) static_cast<void>(set_lock(file_.descriptor_, F_UNLCK, byte_, 1));
}

/// Ends what a killed command has left of a line; removes it if it is the first line, which tells what the file is.
void ProgressFile::append_in_turn(std::span<const Json> entries) {
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  if (size < 0) fail_to_write(path_, "write", errno);
  char last = '\n';
  const bool is_cut = size > 0 && ::pread(descriptor_, &last, 1, size - 1) == 1 && last != '\n';
  const bool is_first = is_cut && has_one_line(descriptor_, size);
  if (is_first) {
    clear();
    if (::lseek(descriptor_, 0, SEEK_SET) < 0) fail_to_write(path_, "write", errno);
  }
  std::string lines = is_cut && !is_first ? "\n" : "";
  for (const Json& entry : entries) {
    const std::string text = json_text(entry);
    lines.append(hash128(bytes_of(text))).append(" ").append(text).append("\n");
  }
  append_synced(descriptor_, bytes_of(lines), path_);
}

void ProgressFile::clear() {
  if (::ftruncate(descriptor_, 0) != 0) fail_to_write(path_, "empty the file", errno);
}

bool ProgressFile::is_being_done(std::uint32_t first_step, std::uint32_t last_step) const {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(first_step);
  lock.l_len = static_cast<off_t>(std::uint64_t{last_step} - first_step + 1);
  return ::fcntl(descriptor_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

bool ProgressFile::lock_all_steps() { return set_lock(descriptor_, F_WRLCK, 0, kStepBytes) || !is_held(errno); }

void ProgressFile::unlock_other_steps() {
  static_cast<void>(set_lock(descriptor_, F_UNLCK, 0, first_step_));
  static_cast<void>(set_lock(descriptor_, F_UNLCK, std::uint64_t{last_step_} + 1, kStepBytes - last_step_ - 1));
}

std::uint64_t ProgressFile::size_bytes() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw IoError(path_.string(), std::strerror(errno));
  return static_cast<std::uint64_t>(status.st_size);
}

void ProgressFile::remove() {
  if (::unlink(path_.c_str()) != 0) fail_to_write(path_, "remove the file", errno);
}

}  // namespace relook
