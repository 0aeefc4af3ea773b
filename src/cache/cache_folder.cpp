#include "cache/cache_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <vector>

#include "base/error.h"
#include "base/file_names.h"
#include "base/json.h"
#include "cache/cache_names.h"
#include "cache/container.h"
#include "cache/manifest.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

/// What lies in a cache's folder or in one of its inner folders.
struct Entry {
  std::string name;  // relative to the folder
  bool is_own = false, is_system = false;
};

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::directory;
}

/// The entries of one folder of a cache, `inner` "", "trees/" or "tunnels/", by name.
std::vector<Entry> entries_of(const fs::path& folder, const std::string& inner, std::error_code& error) {
  std::vector<Entry> entries;
  for (fs::directory_iterator at(folder / inner, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    const std::string name = at->path().filename().string();
    const bool is_file = at->symlink_status(ignored).type() == fs::file_type::regular;
    entries.push_back({inner + name, is_file && is_own_name(inner + name), is_file && is_system_name(name)});
  }
  std::ranges::sort(entries, {}, &Entry::name);
  return entries;
}

bool is_inner_folder(const fs::path& folder, const Entry& entry) {
  return std::ranges::find(kInnerFolders, entry.name) != kInnerFolders.end() && is_folder(folder / entry.name);
}

/// Calls visit(entry) for everything in a cache's folder; instead of an inner folder, for everything in that.
void for_each_entry(const fs::path& folder, std::error_code& error, const std::function<void(const Entry&)>& visit) {
  for (const Entry& entry : entries_of(folder, "", error)) {
    if (!is_inner_folder(folder, entry)) {
      visit(entry);
      continue;
    }
    std::error_code of_inner;
    for (const Entry& inner : entries_of(folder, entry.name + "/", of_inner)) visit(inner);
    if (of_inner) error = of_inner;
  }
}

/// Does a file begin like a .rlk file? That tells a cache of which nothing else is left.
bool starts_like_a_cache(const fs::path& file) {
  std::array<char, kContainerMagic.size()> start{};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(start.data(), start.size()) && std::string_view(start.data(), start.size()) == kContainerMagic;
}

bool is_run(const fs::path& folder) {
  try {
    const fs::path path = folder / "report.json";
    const Json report = parse_json(text_of(read_file(path)), path.string());
    return report.is_object() && report.contains("relook");
  } catch (const InputError&) {
    return false;
  }
}

/// True for a folder that holds a cache, sound or not, of any version.
bool looks_like_cache(const fs::path& path) {
  if (is_manifest_of_cache(path / kManifestName)) return true;
  std::error_code error;
  bool is_cache = false;
  for_each_entry(path, error, [&](const Entry& entry) {
    is_cache = is_cache || (entry.is_own && starts_like_a_cache(path / entry.name));
  });
  return is_cache;
}

/// `error` is "no such file" when another program has put another folder here in this moment.
Occupant what_folder_holds(const fs::path& path, std::error_code& error) {
  Occupant occupant;
  std::string own;
  error.clear();
  for_each_entry(path, error, [&](const Entry& entry) {
    if (entry.is_own && own.empty()) own = entry.name;
    if (!entry.is_own && !entry.is_system && occupant.foreign.empty()) occupant.foreign = printable(entry.name);
  });
  if (error) return occupant;
  if (own.empty() && occupant.foreign.empty()) return occupant;
  occupant.kind = !own.empty() && looks_like_cache(path) ? Occupant::Kind::cache : Occupant::Kind::other;
  if (occupant.kind == Occupant::Kind::cache) return occupant;
  if (is_run(path)) {
    occupant.what = "holds a run, not a cache";
  } else if (!occupant.foreign.empty()) {
    occupant.what = "holds " + occupant.foreign + ", which relook did not write";
  } else {
    occupant.what = "holds " + own + ", but no cache";
  }
  return occupant;
}

/// `path` as an absolute one with all links followed, also those to what is not there yet.
fs::path through_links(const fs::path& path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  fs::path place = fs::absolute(path, error);
  for (int link = 0; link < kMostLinks; ++link) {
    const fs::path known = fs::weakly_canonical(place, error);
    if (error) return place.lexically_normal();
    place = known;
    fs::path so_far;
    bool is_link = false;
    for (auto part = known.begin(); part != known.end(); ++part) {
      const fs::path above = so_far;
      so_far /= *part;
      if (fs::symlink_status(so_far, error).type() != fs::file_type::symlink) continue;
      is_link = true;
      place = above / fs::read_symlink(so_far, error);
      for (++part; part != known.end(); ++part) place /= *part;
      break;
    }
    if (!is_link) break;
  }
  return place;
}

/// Moves a file or folder unless `to` is there already.
void move_entry(const fs::path& from, const fs::path& to) {
  std::error_code ignored;
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0 || errno == EEXIST) return;
  const bool is_free = fs::symlink_status(to, ignored).type() == fs::file_type::not_found;
  if (is_free) fs::rename(from, to, ignored);
}

Occupant what_folder_holds(const fs::path& path) {
  constexpr int kMostTries = 100;
  std::error_code error;
  for (int tries = 0; tries < kMostTries; ++tries) {
    const Occupant occupant = what_folder_holds(path, error);
    if (!error) return occupant;
    if (error != std::errc::no_such_file_or_directory) break;
  }
  throw IoError(path.string(), "cannot be looked into: " + error.message());
}

void remove_empty_folders(const fs::path& folder) {
  for (const std::string_view inner : kInnerFolders) ::rmdir((folder / inner).c_str());
  ::rmdir(folder.c_str());
}

}  // namespace

Occupant occupant_of(const std::filesystem::path& path) {
  const auto is_other = [](const char* what) { return Occupant{Occupant::Kind::other, what, ""}; };
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  switch (type) {
    case fs::file_type::not_found:
      if (fs::symlink_status(path, error).type() == fs::file_type::symlink) return is_other("is a link to nothing");
      return {};
    case fs::file_type::directory:
      return what_folder_holds(path);
    case fs::file_type::regular:
      return is_other("is a file, not a folder");
    case fs::file_type::block:
    case fs::file_type::character:
      return is_other("is a device, not a folder");
    case fs::file_type::none:
      throw IoError(path.string(), "cannot be looked at: " + error.message());
    default:
      return is_other("is not a folder");
  }
}

std::optional<std::filesystem::path> enclosing_cache(const std::filesystem::path& path) {
  for (fs::path folder = through_links(path);; folder = folder.parent_path()) {
    if (looks_like_cache(folder)) return folder;
    if (!folder.has_relative_path()) return std::nullopt;
  }
}

void remove_cache_files(const std::filesystem::path& folder) {
  if (!is_folder(folder)) return;
  std::error_code ignored;
  for_each_entry(folder, ignored, [&](const Entry& entry) {
    if (entry.is_own) ::unlink((folder / entry.name).c_str());
  });
  remove_empty_folders(folder);
}

void retire_cache(const std::filesystem::path& folder, const std::filesystem::path& heir) {
  remove_cache_files(folder);
  if (!is_folder(folder) || !is_folder(heir)) return;
  std::error_code ignored;
  for_each_entry(folder, ignored, [&](const Entry& entry) { move_entry(folder / entry.name, heir / entry.name); });
  remove_empty_folders(folder);
}

}  // namespace relook
