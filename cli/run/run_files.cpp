#include "run/run_files.h"

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/file_names.h"

namespace relook {

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::not_found;
}

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (!is_system_name(entry.path().filename().string())) entries.push_back(entry.path());
  if (error && is_there(folder)) throw IoError(folder.string(), "cannot be read: " + error.message());
  std::ranges::sort(entries);
  return entries;
}

std::vector<std::filesystem::path> entries_not_beyond_link(const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_folder = std::filesystem::symlink_status(folder, error).type() == std::filesystem::file_type::directory;
  return is_folder ? entries_of(folder) : std::vector<std::filesystem::path>();
}

std::string unfinished_name(const std::filesystem::path& path) {
  return std::string(name_of_temporary(path.filename().string()));
}

std::string frame_stem(const std::string& name) {
  const std::size_t end = name.find_first_not_of("0123456789_");
  const std::string stem = name.substr(0, end);
  return stem.ends_with('_') ? stem.substr(0, stem.size() - 1) : stem;
}

bool is_frame_stem(const std::string& name) {
  const std::string stem = frame_stem(name);
  const std::size_t step_digits = std::min(stem.find('_'), stem.size());
  const std::string_view rest = std::string_view(name).substr(std::min(stem.size(), name.size()));
  const bool has_kind =
      rest == ".exr" || rest == ".png" || rest == "_dependent.png" || rest == "_touched.png" || rest == "_groups.png";
  return has_kind && step_digits >= 4 && step_digits <= 9 && std::ranges::count(stem, '_') <= 1;
}

std::uint32_t step_of(const std::string& name) {
  std::uint32_t step = 0;
  std::from_chars(name.data(), name.data() + name.size(), step);
  return step;
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw IoError(path.string(), "cannot be removed: " + error.message());
}

}  // namespace relook
