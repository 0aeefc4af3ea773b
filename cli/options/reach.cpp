#include "options/reach.h"

#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/system/standard_input.h"
#include "cache/cache_names.h"
#include "options/named_files.h"
#include "report/progress_file.h"
#include "report/report_file.h"

namespace relook {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

/// The absolute path without a slash at the end, so that its parent is the folder that it lies in.
fs::path full_path(const fs::path& path) {
  std::error_code ignored;
  const fs::path full = fs::absolute(path, ignored);
  return full.has_filename() ? full : full.parent_path();
}

/// The absolute path with links followed, as far as it is there.
fs::path without_links(const fs::path& path) {
  std::error_code error;
  const fs::path known = fs::weakly_canonical(full_path(path), error);
  return error ? full_path(path) : known;
}

/// The folder, or the nearest one above it that is there.
fs::path existing_folder(fs::path folder) {
  std::error_code error;
  while (folder.has_relative_path() && !fs::is_directory(folder, error)) folder = folder.parent_path();
  return folder;
}

void add_all(const std::string& list, char between, Paths& paths) {
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(between, begin), list.size());
    if (end > begin) paths.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// What the links in a folder lead to, and those in its folders, linked ones too, down to `depth`: frames on another
/// disk.
void add_links(const fs::path& folder, int depth, Paths& paths) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (at->is_symlink(ignored)) paths.push_back(at->path());
    if (depth > 0 && at->is_directory(ignored)) add_links(at->path(), depth - 1, paths);
  }
}
constexpr int kDepth = 2;  // RUN/JOURNAL/frames

/// The name of a device or descriptor (/dev/stdin, /dev/fd/3, /proc/self/fd/3) has no folder.
bool is_descriptor(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder == "/dev" || folder == "/dev/fd" ||
         (folder.filename() == "fd" && folder.string().starts_with("/proc/"));
}

void add_input(const fs::path& input, Paths& readable) {
  const fs::path path = full_path(input);
  readable.push_back(path);
  if (is_descriptor(path)) return;
  readable.push_back(path.parent_path());
  const fs::path final_path = without_links(path);
  std::error_code error;
  if (!fs::is_directory(final_path, error)) return;
  readable.push_back(final_path.parent_path());
  add_links(final_path, kDepth, readable);
}

/// A file, or a folder that is exchanged as a whole: made beside its final place.
void add_output_beside(const fs::path& output, Reach& reach) {
  reach.writable.push_back(existing_folder(full_path(output).parent_path()));
  reach.writable.push_back(existing_folder(without_links(output).parent_path()));
  reach.readable.push_back(full_path(output));
}

void add_output_folder(const fs::path& output, Reach& reach) {
  reach.writable.push_back(existing_folder(full_path(output)));
  reach.writable.push_back(existing_folder(without_links(output)));
  std::error_code error;
  if (fs::is_directory(output, error)) add_links(output, kDepth, reach.writable);
}

bool has_names_of_cache(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (is_own_name(name) || std::ranges::find(kInnerFolders, name) != kInnerFolders.end()) return true;
  }
  return false;
}

/// Adds the folders above an output that may be a cache or a run: an output must not lie in one, so the program looks
/// whether they are.
void add_owners(const fs::path& output, Paths& readable) {
  for (fs::path folder = without_links(output).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (has_names_of_cache(folder)) readable.push_back(folder);
    for (const std::string_view name : {std::string_view(kReportName), std::string_view(kProgressName)})
      readable.push_back(folder / name);
  }
}

/// The folders of what is loaded already; others of the same installation lie beside it.
int add_library(dl_phdr_info* library, std::size_t, void* readable) {
  const fs::path path(library->dlpi_name);
  if (path.is_absolute()) static_cast<Paths*>(readable)->push_back(path.parent_path());
  return 0;
}

void add_system(Reach& reach) {
  Paths& readable = reach.readable;
  for (const char* path : {"/usr", "/lib", "/lib64", "/lib32", "/opt", "/nix/store", "/gnu/store", "/etc/ld.so.cache",
                           "/etc/ld.so.preload", "/etc/localtime", "/etc/ssl/openssl.cnf", "/proc", "/sys",
                           "/dev/urandom", "/dev/random", "/dev/zero"})
    readable.emplace_back(path);
  reach.writable.emplace_back("/dev/null");
  dl_iterate_phdr(add_library, &readable);
  if (const char* folders = std::getenv("LD_LIBRARY_PATH")) {
    std::string list(folders);
    std::ranges::replace(list, ';', ':');
    add_all(list, ':', readable);
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {program, program.parent_path() / "lib" / "relook"}) {
    readable.push_back(folder);
    for (const char* module : {"librelook_images.so", "librelook_meshes.so", "librelook_views.so", "librelook_text.so"})
      readable.push_back(folder / module);  // links
  }
}

}  // namespace

Reach reach_of(const Arguments& arguments) {
  Reach reach;
  add_system(reach);
  for (const NamedInput& input : inputs_of(arguments)) add_input(input.path, reach.readable);
  for (const fs::path& root : arguments.import.roots) add_input(root, reach.readable);
  // An OpenColorIO config names its tables in many ways, by variables of the environment, too: only the library knows.
  if (std::getenv("OCIO") != nullptr) reach.readable.emplace_back("/");
  const bool has_standard_input = std::ranges::find(arguments.inputs, kStandardInput) != arguments.inputs.end() ||
                                  arguments.journal == kStandardInput || arguments.view.look_patch == kStandardInput;
  if (has_standard_input) reach.readable.emplace_back(".");
  const bool is_told_by_run = arguments.verb == Verb::blame && (arguments.cache.empty() || arguments.journal.empty());
  if (is_told_by_run) reach.readable.emplace_back("/");
  for (const NamedOutput& output : outputs_of(arguments)) {
    const bool is_folder = !output.kind && arguments.verb != Verb::preprocess;
    if (is_folder)
      add_output_folder(output.path, reach);
    else
      add_output_beside(output.path, reach);
    add_owners(output.path, reach.readable);
  }
  if (arguments.verb == Verb::watch) {
    add_output_beside(arguments.cache, reach);
    add_output_beside(arguments.output, reach);  // its folder has the journal and the files of it
  }
  if (arguments.verb == Verb::export_scene)
    reach.readable.push_back(existing_folder(full_path(arguments.output).parent_path()));
  if (arguments.verb == Verb::report && arguments.output.empty())  // their pages are made anew
    for (const std::string& run : arguments.inputs) add_output_folder(run, reach);
  if (!arguments.spill.empty()) reach.writable.emplace_back(arguments.spill);
  for (Paths* paths : {&reach.readable, &reach.writable}) {
    std::ranges::sort(*paths);
    const auto repeated = std::ranges::unique(*paths);
    paths->erase(repeated.begin(), repeated.end());
  }
  return reach;
}

}  // namespace relook
