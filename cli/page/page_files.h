// The data scripts beside a run's page, pixels/*.js. Their names have the number of the page, which is one more than
// that of the page before: until the new page is there, the old one finds its own files unchanged. Only files of such a
// name that begin with one of the calls below, or that write_file() left unfinished, are ever removed.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace relook {

/// What a data script calls, and so begins with.
inline constexpr std::string_view kPixelsCall = "relook_pixels(";
inline constexpr std::string_view kStepsCall = "relook_steps(";
inline constexpr std::string_view kRelightCall = "relook_relight(";

/// Whether a file of a run's pixels/ may be one of a page, going by its name: "00012_3.js", "steps_00001_3.js",
/// "relight_00012_3.js", with the number of the page last; "00012.js" of older ones.
[[nodiscard]] bool is_page_file_name(std::string_view name);

class PageFiles {
 public:
  /// Throws UsageError when something that is not of a page has the name of one of its files. Writes nothing.
  explicit PageFiles(const std::filesystem::path& run);
  /// Removes the new files, unless keep_new() was called.
  ~PageFiles();
  PageFiles(const PageFiles&) = delete;
  PageFiles& operator=(const PageFiles&) = delete;

  [[nodiscard]] std::size_t page_number() const { return page_number_; }
  /// The path for a new file of pixels, of details or of layers of light; makes its folder. `number`: of the entry or
  /// of the chunk.
  [[nodiscard]] std::filesystem::path new_pixels(std::size_t number) { return new_file("", number); }
  [[nodiscard]] std::filesystem::path new_steps(std::size_t number) { return new_file("steps_", number); }
  [[nodiscard]] std::filesystem::path new_relight(std::size_t number) { return new_file("relight_", number); }
  /// The page that uses the new files is there: removes those of earlier pages. Throws IoError.
  void keep_new();

 private:
  [[nodiscard]] std::filesystem::path new_file(std::string_view kind, std::size_t number);

  std::filesystem::path folder_;
  std::size_t page_number_ = 1;
  std::vector<std::string> old_, new_;  // names
};

}  // namespace relook
