// What all fuzz targets share: how a case runs, what counts as an answer, a folder in memory, choices out of bytes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/files.h"

namespace relook {

inline constexpr std::uint64_t kFuzzImportMemory = std::uint64_t{64} << 20;  // bytes

/// As at the start of the program, for a case: one thread, kFuzzImportMemory.
void begin_fuzz_case();

/// Runs `work`. True: it came to its end; false: it threw an Error of one of the codes, in one printable line (of
/// InputErrors a few); RELOOK_FUZZ_SAYS in the environment prints it. Anything else ends the process.
bool is_answered(std::initializer_list<ExitCode> codes, const std::function<void()>& work);

/// Ends the process with a sentence unless `condition`.
void expect(bool condition, std::string_view sentence);

/// A folder of this process for one target, removed when it ends: below /dev/shm where there is one.
class FuzzFolder {
 public:
  explicit FuzzFolder(const std::string& target);
  ~FuzzFolder();
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Written in place, without a sync.
void overwrite_file(const std::filesystem::path& path, BytesView bytes);

[[nodiscard]] inline BytesView fuzz_bytes(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span<const std::uint8_t>(data, size));
}

/// Choices read from bytes; zero at their end.
class Choices {
 public:
  explicit Choices(BytesView bytes) : bytes_(bytes) {}
  [[nodiscard]] bool at_end() const { return next_ >= bytes_.size(); }
  std::uint64_t number(std::size_t bytes);  // little-endian
  std::size_t below(std::size_t count) {    // [0, count); 0 for none
    return count < 2 ? 0 : static_cast<std::size_t>(number(count > 256 ? 4 : 1)) % count;
  }
  BytesView rest() { return bytes_.subspan(std::min(next_, bytes_.size())); }

 private:
  BytesView bytes_;
  std::size_t next_ = 0;
};

}  // namespace relook
