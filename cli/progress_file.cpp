#include "progress_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"

namespace relook {
namespace {

constexpr std::string_view kFormat = "progress/1";
constexpr std::size_t kHashDigits = 32;

std::string line_of(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return hash128(bytes_of(text)) + " " + text + "\n";
}

Json header(const std::string& run_hash) { return {{"relook", kFormat}, {"run", run_hash}}; }

/// Takes the first line off `text`; false when it is cut short or not as it was written.
bool take_line(std::string_view& text, Json& value) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos || end <= kHashDigits) return false;
  const std::string_view body = text.substr(kHashDigits + 1, end - kHashDigits - 1);
  if (text.substr(0, kHashDigits) != hash128(bytes_of(body))) return false;
  value = parse_json(body, kProgressName);
  text.remove_prefix(end + 1);
  return true;
}

/// Whether the open file is still the one under its name.
bool is_current(int descriptor, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

ProgressFile::ProgressFile(const std::filesystem::path& run) : path_(run / kProgressName) {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_to_write(path_, "create the file", errno);
    const bool is_locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    const int error = errno;
    const bool is_done = is_locked ? is_current(descriptor_, path_) : error != EWOULDBLOCK;
    if (is_done) return;  // file systems without locks: two runs of one folder are the user's to avoid
    ::close(descriptor_);
    if (!is_locked) throw IoError(run.string(), "another replay is writing this run");
  }
}

ProgressFile::~ProgressFile() { ::close(descriptor_); }

std::vector<Json> ProgressFile::entries(const std::string& run_hash) const {
  const Bytes bytes = read_file(path_);
  std::string_view text = text_of(bytes);
  std::vector<Json> entries;
  Json value;
  if (!take_line(text, value) || value != header(run_hash)) return entries;
  while (take_line(text, value)) entries.push_back(std::move(value));
  return entries;
}

void ProgressFile::restart(const std::string& run_hash, const std::vector<Json>& entries) {
  std::string text = line_of(header(run_hash));
  for (const Json& entry : entries) text += line_of(entry);
  const Bytes before = read_file(path_);
  const std::size_t kept = text_of(before).starts_with(text) ? text.size() : 0;  // what holds is never written again
  if (::ftruncate(descriptor_, static_cast<off_t>(kept)) != 0 || ::lseek(descriptor_, 0, SEEK_END) < 0)
    fail_to_write(path_, "write", errno);
  append_synced(descriptor_, bytes_of(std::string_view(text).substr(kept)), path_);
}

void ProgressFile::append(const Json& entry) { append_synced(descriptor_, bytes_of(line_of(entry)), path_); }

void ProgressFile::remove() {
  if (::unlink(path_.c_str()) != 0) fail_to_write(path_, "remove the file", errno);
}

}  // namespace relook
