#include "options/outputs.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cache/cache_folder.h"
#include "options/named_files.h"
#include "report/progress_file.h"
#include "report/report_file.h"

namespace relook {
namespace {

/// The file or folder itself, whatever it is called; what is not there yet by the name it would have.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path full = std::filesystem::absolute(path, ignored);
  return std::filesystem::weakly_canonical(full.has_filename() ? full : full.parent_path(), ignored);
}

bool are_one(const std::filesystem::path& a, const std::filesystem::path& b) {
  struct stat first {
  }, second{};
  const bool has_first = ::stat(a.c_str(), &first) == 0, has_second = ::stat(b.c_str(), &second) == 0;
  if (has_first && has_second) return first.st_dev == second.st_dev && first.st_ino == second.st_ino;
  return resolved(a) == resolved(b);
}

bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const std::filesystem::path inner = resolved(path), outer = resolved(folder);
  const auto [end, rest] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return end == outer.end() && rest != inner.end();
}

/// The run that a file is part of: RUN/report.json, RUN/frames/0003.exr; "" if of none.
std::filesystem::path run_of(const std::filesystem::path& file) {
  const std::filesystem::path full = resolved(file);
  for (const std::filesystem::path& folder : {full.parent_path(), full.parent_path().parent_path()})
    if (is_own_file(folder / kReportName, OwnKind::report) || is_own_file(folder / kProgressName, OwnKind::progress))
      if (folder == full.parent_path().parent_path() || full.filename() == kReportName ||
          full.filename() == "report.html" || full.filename() == kProgressName)
        return folder;
  return {};
}

/// Whether a file has another name, by a hard link, in a folder or below it.
bool is_linked_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || status.st_nlink < 2) return false;
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder, error);
       !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error))
    if (std::error_code none; entry->is_regular_file(none) && are_one(entry->path(), file)) return true;
  return false;
}

/// Whether an output is a file in a folder of inputs, and no earlier output there.
bool is_read_from(const NamedOutput& output, const std::filesystem::path& folder) {
  std::error_code error;
  if (!output.kind || !std::filesystem::is_directory(folder, error)) return false;
  return std::filesystem::exists(output.path, error) && !is_own_file(output.path, *output.kind) &&
         (lies_in(output.path, folder) || is_linked_in(output.path, folder));
}

[[noreturn]] void refuse(const NamedOutput& output, const std::string& why) {
  throw UsageError(output.path.string(), std::string(output.option) + ": " + why);
}

void check_file(const NamedOutput& output, bool overwrites) {
  std::error_code error;
  const auto status = std::filesystem::status(output.path, error);
  const auto name = std::filesystem::symlink_status(output.path, error);
  if (name.type() == std::filesystem::file_type::not_found) return;
  if (status.type() == std::filesystem::file_type::not_found) refuse(output, "is a link to nothing");
  if (status.type() == std::filesystem::file_type::directory) refuse(output, "is a folder");
  if (status.type() != std::filesystem::file_type::regular) refuse(output, "is no regular file");
  if (overwrites) return;
  if (!is_own_file(output.path, *output.kind))
    refuse(output,
           "is there and not " + std::string(own_kind_name(*output.kind)) + " of relook; --overwrite replaces it");
  if (const std::filesystem::path run = run_of(output.path); !run.empty())
    refuse(output, "is part of the run " + run.string() + "; --overwrite replaces it");
}

/// Whether a path has one of the names that a run has for itself in its folder.
bool is_reserved(const std::filesystem::path& path, const std::filesystem::path& folder) {
  constexpr std::array<std::string_view, 9> kNames{kReportName, "report.html", "index.html", kProgressName, "frames",
                                                   "previews",  "overlays",    "relight",    "pixels"};
  const std::string first = resolved(path).lexically_relative(resolved(folder)).begin()->string();
  return std::ranges::find(kNames, first) != kNames.end();
}

void check_together(const std::vector<NamedOutput>& outputs, Verb verb) {
  for (std::size_t i = 0; i < outputs.size(); ++i)
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const NamedOutput &one = outputs[i], &other = outputs[k];
      if (k < i && are_one(one.path, other.path))
        refuse(one, "is the output of " + std::string(other.option) + ", too");
      if (i == k || other.kind || !lies_in(one.path, other.path)) continue;
      if (verb == Verb::preprocess) refuse(one, "lies in the cache that is to be written");
      if (verb == Verb::replay && is_reserved(one.path, other.path)) refuse(one, "is a file of the run");
    }
}

}  // namespace

void check_outputs(const Arguments& arguments) {
  const std::vector<NamedOutput> outputs = outputs_of(arguments);
  for (const NamedInput& input : inputs_of(arguments))
    require_not_outputs(arguments, std::span(&input.path, 1), input.what);
  for (const NamedOutput& output : outputs) {
    const std::optional<std::filesystem::path> cache = enclosing_cache(resolved(output.path));
    const bool is_cache_itself =
        cache && arguments.verb == Verb::preprocess && !output.kind && are_one(*cache, output.path);
    if (cache && !is_cache_itself) refuse(output, "lies inside the cache " + cache->string());
    if (output.kind) check_file(output, arguments.overwrite);
  }
  check_together(outputs, arguments.verb);
}

void require_not_outputs(const Arguments& arguments, std::span<const std::filesystem::path> inputs,
                         std::string_view what) {
  for (const NamedOutput& output : outputs_of(arguments))
    for (const std::filesystem::path& input : inputs)
      if (are_one(output.path, input) || is_read_from(output, input))
        refuse(output, "is " + std::string(what) + ": an input is never replaced");
}

}  // namespace relook
