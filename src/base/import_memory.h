// What the files of scenes and caches may unpack to: one budget of the process for images, geometry and animations
// alike, in bytes of the format that is kept. The budget is asked before memory is.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

namespace relook {

inline constexpr std::uint64_t kImportMemory = std::uint64_t{2} << 30;  // bytes, unless told otherwise

/// Sets the budget; to be called while nothing is read. What decoders held until then counts no longer.
void set_import_memory(std::uint64_t bytes);

/// A part of the budget, given back when it goes.
class ImportShare {
 public:
  ImportShare() = default;
  /// Throws ResourceError when less than `bytes` is left: "FILE: WHERE takes ... --import-memory".
  ImportShare(std::uint64_t bytes, std::string_view file, std::string_view where);
  ImportShare(ImportShare&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}
  ImportShare& operator=(ImportShare&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~ImportShare();
  void add(ImportShare other) { bytes_ += std::exchange(other.bytes_, 0); }

 private:
  std::uint64_t bytes_ = 0;
};

/// What a decoder holds beside the result while one image is decoded: the most of all images counts, once, in whatever
/// order they come. Throws ResourceError as above.
void take_working_memory(std::uint64_t bytes, std::string_view file, std::string_view where);

/// Throws ResourceError for what takes more than the whole budget, and counts it nowhere.
void require_import_memory(std::uint64_t bytes, std::string_view file, std::string_view where);

/// `value` with its part of the budget, given back with it.
template <class T>
std::shared_ptr<const T> kept_with(ImportShare share, T value) {
  struct Kept {
    ImportShare share;
    T value;
  };
  const auto kept = std::make_shared<Kept>(Kept{std::move(share), std::move(value)});
  return {kept, &kept->value};
}

/// Saturating, so that no count of a file wraps around.
[[nodiscard]] constexpr std::uint64_t bounded_product(std::uint64_t a, std::uint64_t b) {
  return b != 0 && a > UINT64_MAX / b ? UINT64_MAX : a * b;
}
[[nodiscard]] constexpr std::uint64_t bounded_sum(std::uint64_t a, std::uint64_t b) {
  return a > UINT64_MAX - b ? UINT64_MAX : a + b;
}

}  // namespace relook
