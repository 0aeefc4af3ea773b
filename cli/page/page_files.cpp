#include "page/page_files.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>

#include "base/error.h"
#include "base/files.h"

namespace relook {
namespace {

constexpr std::size_t kFewestDigits = 5, kMostDigits = 9;

/// Cuts off the number that ends a text and returns it; none: the text ends with something else, or with more digits
/// than new_file() writes.
std::optional<std::size_t> take_number(std::string_view& text) {
  const std::size_t last = text.find_last_not_of("0123456789");
  const std::size_t start = last == std::string_view::npos ? 0 : last + 1;
  if (start == text.size() || text.size() - start > kMostDigits) return std::nullopt;
  const std::size_t number = std::stoul(std::string(text.substr(start)));
  text.remove_suffix(text.size() - start);
  return number;
}

/// The number of the page in the name of one of its files; 0 for the names of older pages.
std::optional<std::size_t> page_number_in(std::string_view name) {
  if (!name.ends_with(".js")) return std::nullopt;
  name.remove_suffix(3);
  bool has_kind = false;
  for (const std::string_view kind : {std::string_view("steps_"), std::string_view("relight_")}) {
    if (has_kind || !name.starts_with(kind)) continue;
    has_kind = true;
    name.remove_prefix(kind.size());
  }
  const std::size_t digits = name.size();
  const std::optional<std::size_t> number = take_number(name);
  if (!number) return std::nullopt;
  if (name.empty()) return !has_kind && digits >= kFewestDigits ? std::optional<std::size_t>(0) : std::nullopt;
  if (name.back() != '_') return std::nullopt;
  name.remove_suffix(1);
  const std::size_t first_digits = name.size();
  return take_number(name) && name.empty() && first_digits >= kFewestDigits ? number : std::nullopt;
}

bool begins_with_a_call(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  constexpr std::array kCalls{kPixelsCall, kStepsCall, kRelightCall};
  std::string start(std::ranges::max(kCalls, {}, &std::string_view::size).size(), '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return std::ranges::any_of(kCalls, [&](std::string_view call) { return start.starts_with(call); });
}

/// The file under the temporary name that write_file() gives it, left by a run that was killed: its name, or "".
std::string_view unfinished_name(std::string_view name) {
  const std::size_t end = name.find(".js.");
  if (!name.starts_with(".") || !name.ends_with(".tmp") || end == std::string_view::npos) return "";
  return name.substr(1, end + 2);
}

}  // namespace

bool is_page_file_name(std::string_view name) { return page_number_in(name).has_value(); }

PageFiles::PageFiles(const std::filesystem::path& run) : folder_(run / "pixels") {
  std::error_code error;
  const auto status = std::filesystem::status(folder_, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_directory(status))
    throw UsageError(folder_.string(), "is in the way of the page's folder for pixels");
  const std::filesystem::directory_iterator entries(folder_, error);
  if (error) throw IoError(folder_.string(), "cannot be read: " + error.message());
  for (const auto& entry : entries) {
    std::string name = entry.path().filename().string();
    const std::string_view unfinished = unfinished_name(name);
    const bool is_regular = std::filesystem::is_regular_file(entry.symlink_status());
    if (!unfinished.empty() && is_page_file_name(unfinished) && is_regular) old_.push_back(name);
    const auto number = page_number_in(name);
    if (!number) continue;
    if (!is_regular || !begins_with_a_call(entry.path()))
      throw UsageError(entry.path().string(), "has the name of a file of the page and is none: move it away");
    page_number_ = std::max(page_number_, *number + 1);
    old_.push_back(std::move(name));
  }
}

PageFiles::~PageFiles() {
  std::error_code ignored;
  for (const std::string& name : new_) std::filesystem::remove(folder_ / name, ignored);
  if (!new_.empty()) std::filesystem::remove(folder_, ignored);
}

std::filesystem::path PageFiles::new_file(std::string_view kind, std::size_t number) {
  if (new_.empty()) make_folders(folder_);
  char digits[64];
  std::snprintf(digits, sizeof digits, "%05zu_%zu.js", number, page_number_);
  new_.push_back(std::string(kind) + digits);
  return folder_ / new_.back();
}

void PageFiles::keep_new() {
  new_.clear();
  std::error_code error;
  for (const std::string& name : old_) {
    std::filesystem::remove(folder_ / name, error);
    if (error) throw IoError((folder_ / name).string(), "cannot be removed: " + error.message());
  }
  // Fails, as it should, when anything else is in the folder.
  if (!old_.empty()) std::filesystem::remove(folder_, error);
}

}  // namespace relook
