// Checked reading and atomic writing over POSIX calls. A temporary file is named ".NAME.PID.N.tmp" beside its target.
#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/error.h"

namespace relook {
namespace {

/// An open descriptor, closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }
  /// Closes now; false with errno set if the system reports a late write error.
  bool close() {
    const int result = ::close(number_);
    number_ = -1;
    return result == 0;
  }

 private:
  int number_;
};

std::string reason(int error) { return std::generic_category().message(error); }

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// A file that exists under its temporary name until it is published; removed again otherwise.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target) {
    const std::string stem = "." + target.filename().string() + "." + std::to_string(::getpid()) + ".";
    for (int attempt = 0; attempt < 10000; ++attempt) {
      path_ = folder_of(target) / (stem + std::to_string(attempt) + ".tmp");
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) return;
      if (errno != EEXIST) break;
    }
    fail_to_write(target, "create the file", errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!published_) ::unlink(path_.c_str());
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  void publish(const std::filesystem::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) fail_to_write(target, "rename the finished file", errno);
    published_ = true;
  }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  bool published_ = false;
};

void write_all(int descriptor, BytesView bytes, const std::filesystem::path& path) {
  constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), kMostAtOnce));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path, "write", errno);
    if (written == 0) fail_to_write(path, "write", ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

/// Fills `bytes` from the descriptor; shortens it when the file ends early.
void read_all(int descriptor, Bytes& bytes, const std::string& name) {
  constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(descriptor, bytes.data() + filled, std::min(bytes.size() - filled, kMostAtOnce));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError(name, "", "cannot read: " + reason(errno));
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
}

bool lies_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() && rest != path.end();
}

/// `base`, and the roots as they are spelled and as they are.
std::vector<std::filesystem::path> allowed_folders(const std::filesystem::path& base,
                                                   std::span<const std::filesystem::path> roots) {
  std::vector<std::filesystem::path> folders{base};
  for (const std::filesystem::path& root : roots) {
    std::error_code error;
    const auto spelled = std::filesystem::absolute(root, error).lexically_normal();
    folders.push_back(spelled.has_filename() ? spelled : spelled.parent_path());
    if (auto real = std::filesystem::canonical(root, error); !error) folders.push_back(std::move(real));
  }
  return folders;
}

}  // namespace

Bytes read_file(const std::filesystem::path& path, std::size_t limit_bytes) {
  const std::string name = path.string();
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (!file.is_open()) {
    if (errno == ENOENT) throw InputError(name, "", "no such file");
    throw InputError(name, "", "cannot open: " + reason(errno));
  }
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) throw InputError(name, "", "cannot open: " + reason(errno));
  if (S_ISDIR(status.st_mode)) throw InputError(name, "", "is a folder, not a file");
  if (!S_ISREG(status.st_mode)) throw InputError(name, "", "is not a regular file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > limit_bytes)
    throw InputError(name, "",
                     "has " + std::to_string(size) + " bytes; at most " + std::to_string(limit_bytes) + " are read");
  Bytes bytes(size);
  read_all(file.number(), bytes, name);
  return bytes;
}

std::filesystem::path contained_path(const std::filesystem::path& folder,
                                     std::span<const std::filesystem::path> roots, std::string_view uri,
                                     std::string_view file, std::string_view where) {
  const std::string quoted = "\"" + printable(uri) + "\"";
  if (uri.empty()) throw InputError(file, where, "an empty file name");
  if (uri.find('\0') != std::string_view::npos) throw InputError(file, where, quoted + " contains a zero byte");
  const std::filesystem::path name(uri);
  if (uri.find(':') != std::string_view::npos || uri.find('\\') != std::string_view::npos)
    throw InputError(file, where, quoted + " is not a relative path");
  if (name.is_absolute() && roots.empty())
    throw InputError(file, where, quoted + " is not a relative path (--root DIR allows files below DIR)");

  std::error_code error;
  const auto base = std::filesystem::canonical(folder.empty() ? std::filesystem::path(".") : folder, error);
  if (error) throw InputError(file, where, "cannot open the folder of " + quoted + ": " + error.message());
  const std::vector<std::filesystem::path> allowed = allowed_folders(base, roots);
  const auto require_allowed = [&](const std::filesystem::path& path) {
    if (std::ranges::any_of(allowed, [&](const auto& above) { return lies_below(path, above); })) return;
    throw InputError(file, where, quoted + " leads out of its folder (--root DIR allows files below DIR)");
  };
  const auto wanted = (base / name).lexically_normal();
  require_allowed(wanted);
  auto target = std::filesystem::canonical(wanted, error);
  if (error == std::errc::no_such_file_or_directory) throw MissingFileError(file, where, "no such file: " + quoted);
  if (error) throw InputError(file, where, "cannot open " + quoted + ": " + error.message());
  require_allowed(target);
  return target;
}

void fail_to_write(const std::filesystem::path& path, std::string_view action, int error) {
  const std::string what = "cannot " + std::string(action) + ": " + reason(error);
  if (error == ENOSPC || error == EDQUOT || error == EFBIG || error == ENOMEM) throw ResourceError(path.string(), what);
  throw IoError(path.string(), what);
}

void append_synced(int descriptor, BytesView bytes, const std::filesystem::path& path) {
  write_all(descriptor, bytes, path);
  if (::fsync(descriptor) != 0) fail_to_write(path, "write to disk", errno);
}

struct FileWriter::Temporary {
  explicit Temporary(const std::filesystem::path& path) : name(path), file(name.descriptor()) {}
  TemporaryFile name;
  Descriptor file;
};

FileWriter::FileWriter(std::filesystem::path path)
    : path_(std::move(path)), temporary_(std::make_unique<Temporary>(path_)) {}
FileWriter::~FileWriter() = default;

void FileWriter::append(BytesView bytes) {
  constexpr std::size_t kMostWaiting = std::size_t{1} << 18;
  written_bytes_ += bytes.size();
  if (waiting_.size() + bytes.size() > kMostWaiting) write_out();
  if (bytes.size() > kMostWaiting)
    write_all(temporary_->file.number(), bytes, path_);
  else
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void FileWriter::write_out() {
  write_all(temporary_->file.number(), waiting_, path_);
  waiting_.clear();
}

void FileWriter::publish() {
  write_out();
  if (::fsync(temporary_->file.number()) != 0) fail_to_write(path_, "write to disk", errno);
  if (!temporary_->file.close()) fail_to_write(path_, "close", errno);
  temporary_->name.publish(path_);
  sync_folder(folder_of(path_));
}

void write_file(const std::filesystem::path& path, BytesView bytes) {
  FileWriter file(path);
  file.append(bytes);
  file.publish();
}

void sync_folder(const std::filesystem::path& folder) {
  Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!file.is_open()) fail_to_write(folder, "open the folder", errno);
  if (::fsync(file.number()) != 0) fail_to_write(folder, "write the folder to disk", errno);
}

void make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) fail_to_write(folder, "create the folder", error.value());
}

}  // namespace relook
