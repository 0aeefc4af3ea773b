// A run folder that no replay has made: frames, previews and entries of any number, for tests of its page.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/json.h"
#include "edit/journal.h"
#include "frame/display_view.h"
#include "frame/image.h"
#include "report/report_entries.h"

namespace relook {

class SyntheticRun {
 public:
  /// Frame i is `pixel(i, x, y)`.
  using Pixel = std::function<Rgba(std::size_t i, std::uint32_t x, std::uint32_t y)>;
  SyntheticRun(std::filesystem::path folder, std::uint32_t width, std::uint32_t height, Pixel pixel);

  /// Writes frame and preview and adds the entry of a step; `within`: "_01" for a frame of a drag. Returns the entry.
  Json& add(std::size_t step, const std::string& within = "");
  /// Adds an entry that shares the frame of the last one, as the step of a drag does.
  Json& add_sharing(std::size_t step);
  /// Adds the frames of a wedge or grid, with their values, and its own entry, which is returned. `axes`: {path, label,
  /// texts}, as a report has them; the first varies slowest.
  Json& add_wedge(std::size_t step, const Json& axes);
  /// Adds an entry whose frame and preview are links to those of an entry before.
  Json& add_linked(std::size_t step, std::size_t to);

  /// Writes the page; `check` as in RunPageInput.
  void write_page(std::size_t count = SIZE_MAX, bool reads_pixels = true, std::function<void()> check = {}) const;
  /// What the browser tests take for the report.
  void write_report() const;
  /// A pixel of an entry's frame, as report_page.py expects it.
  [[nodiscard]] Json expected_pixel(std::size_t entry, std::uint32_t x, std::uint32_t y) const;

  Json head;
  std::vector<Json> entries;
  Journal journal;
  PreviewStyle previews;  // set before add()

 private:
  Json& add_entry(std::size_t step, const std::string& stem, bool is_within);

  std::filesystem::path folder_;
  std::uint32_t width_, height_;
  Pixel pixel_;
};

/// Bytes of all files in a folder; 0 without one.
[[nodiscard]] std::uint64_t folder_bytes(const std::filesystem::path& folder);
/// Hashes of all files below a folder, by path.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> folder_hashes(const std::filesystem::path& folder);

}  // namespace relook
