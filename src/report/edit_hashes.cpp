#include "report/edit_hashes.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"
#include "edit/journal_walk.h"
#include "scene/gltf/gltf_source.h"
#include "scene/gltf/import_rules.h"

namespace relook {
namespace {

/// The file names that a value has under a key of journals that brings in a file.
void collect_files(const Json& value, std::vector<std::string>& names) {
  for (const auto& [key, part] : value.items()) {
    if (value.is_object() && (key == "asset" || key == "uri") && part.is_string())
      names.push_back(part.get<std::string>());
    else if (part.is_structured())
      collect_files(part, names);
  }
}

/// Images name no other files; a model may be called anything.
bool is_image_name(const std::string& name) {
  return std::ranges::any_of(std::array{".png", ".jpg", ".jpeg", ".webp", ".hdr", ".exr"},
                             [&](const char* ending) { return name.ends_with(ending); });
}

/// A file that a journal names, and what it names itself; none when there is no such file.
std::vector<std::filesystem::path> with_named_files(const Journal& journal, const std::string& name) {
  std::vector<std::filesystem::path> paths;
  try {
    paths.push_back(allowed_path(journal.path.parent_path(), name, journal.file, ""));
    if (!is_image_name(name)) std::ranges::copy(external_files(read_gltf_source(paths.back())), std::back_inserter(paths));
  } catch (const InputError&) {  // said by the step itself, or data within the journal
  }
  return paths;
}

std::string file_hash(const std::filesystem::path& path) {
  try {
    return hash128(read_file(path));
  } catch (const InputError&) {
    return "";
  }
}

const char* name_of(StepForm form) {
  switch (form) {
    case StepForm::drag:
      return "drag";
    case StepForm::wedge:
      return "wedge";
    case StepForm::edit:
      break;
  }
  return "edit";
}

}  // namespace

EditHashes::EditHashes(const Journal& journal) : by_step_(journal.steps.size() + 1) {
  std::map<std::string, std::string> hashes_of_files;
  const auto hash_of = [&](const std::string& name) -> const std::string& {
    const auto [found, is_new] = hashes_of_files.try_emplace(name);
    if (is_new)
      for (const std::filesystem::path& path : with_named_files(journal, name)) found->second += file_hash(path);
    return found->second;
  };
  std::string last;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    std::string& hashes = by_step_[event.place.step];
    if (event.is_first_frame()) hashes.reserve(event.step->frames() * kDigits);
    if (event.back_to) last = after(*event.back_to);
    const Edit edit = event.edit();
    std::string text = last + name_of(event.step->form()) + std::to_string(event.frame);
    for (const PatchOperation& operation : edit)
      text += Json{static_cast<int>(operation.op), operation.path, operation.from, operation.value}.dump(
          -1, ' ', false, Json::error_handler_t::replace);
    for (const std::string& name : files_of(edit)) text += hash_of(name);
    hashes += last = hash128(bytes_of(text));
  });
}

std::string EditHashes::at(std::uint32_t step, std::size_t frame) const {
  const std::string& hashes = by_step_.at(step);
  return step == 0 ? "" : hashes.substr(frame * kDigits, kDigits);
}

std::string EditHashes::after(std::uint32_t step) const {
  return step == 0 ? "" : at(step, by_step_.at(step).size() / kDigits - 1);
}

std::vector<std::string> files_of(const Edit& edit) {
  std::vector<std::string> names;
  for (const PatchOperation& operation : edit) {
    const bool is_name = operation.path.ends_with("/uri") || operation.path.ends_with("/asset");
    if (is_name && operation.value.is_string()) names.push_back(operation.value.get<std::string>());
    if (operation.value.is_structured()) collect_files(operation.value, names);
  }
  return names;
}

std::vector<std::filesystem::path> files_of(const Journal& journal) {
  std::vector<std::filesystem::path> paths;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    for (const std::string& name : files_of(event.edit()))
      std::ranges::move(with_named_files(journal, name), std::back_inserter(paths));
  });
  std::ranges::sort(paths);
  paths.erase(std::ranges::unique(paths).begin(), paths.end());
  return paths;
}

}  // namespace relook
