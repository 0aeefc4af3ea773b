#include "resume.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"
#include "cache/cache.h"
#include "load_cache.h"

namespace relook {
namespace {

constexpr std::size_t kEntityDepth = 2;  // "/materials/Glass"

/// The file names that a value has under a key of journals that brings in a file.
void collect_files(const Json& value, std::vector<std::string>& names) {
  for (const auto& [key, part] : value.items()) {
    if (value.is_object() && (key == "asset" || key == "uri") && part.is_string())
      names.push_back(part.get<std::string>());
    else if (part.is_structured())
      collect_files(part, names);
  }
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

/// Hashes of the files that a journal names; none when such a file may name others, or cannot be read.
std::optional<Json> hashes_of_files(const Journal& journal) {
  Json hashes = Json::object();
  for (const JournalStep& step : journal.steps)
    for (const Edit& edit : frames_of(step))
      for (const std::string& name : files_of(edit)) {
        if (name.ends_with(".gltf")) return std::nullopt;
        try {
          hashes[name] = hash128(read_file(contained_path(journal.path.parent_path(), name, journal.file, step.where)));
        } catch (const InputError&) {  // said by the step itself, or data within the journal
          return std::nullopt;
        }
      }
  return hashes;
}

bool only_replaces_values(const Edit& edit) {
  return files_of(edit).empty() && std::ranges::all_of(edit, [](const PatchOperation& operation) {
           const auto depth = static_cast<std::size_t>(std::ranges::count(operation.path, '/'));
           return operation.op == PatchOp::test || (operation.op == PatchOp::replace && depth > kEntityDepth);
         });
}

}  // namespace

std::optional<std::string> run_hash(const Arguments& arguments, const Journal& journal, const DisplayView* view) {
  const std::optional<Json> files = hashes_of_files(journal);
  if (!files) return std::nullopt;
  Json manifest;
  require_sound(read_manifest(arguments.inputs[0], manifest), arguments.inputs[0]);
  RunReport options;
  options.structures = arguments.structures;
  // Where things are kept shows in no frame: a run that had too little memory goes on with more.
  options.structures.memory_bytes.reset();
  options.structures.disk_bytes.reset();
  options.structures.policy.clear();
  options.float_frames = arguments.float_frames;
  options.layers = arguments.layers;
  options.verify_percent = arguments.verify_percent;
  options.step_range = arguments.steps;
  const Json run{{"program", program_version()},
                 {"cache", manifest["hash"]},
                 {"journal", journal.hash},
                 {"options", options_json(options)},
                 {"overlays", arguments.overlays},
                 {"baseline", arguments.baseline},
                 {"view", view != nullptr ? view->id() : ""}};
  return hash128(bytes_of(run.dump()));
}

std::vector<Edit> edits_to(const Journal& journal, std::size_t steps) {
  std::vector<Edit> edits;
  bool may_append = false;
  for (std::size_t i = 0; i < steps; ++i)
    for (const Edit& edit : frames_of(journal.steps[i])) {
      const bool is_plain = only_replaces_values(edit);
      if (is_plain && may_append)
        edits.back().insert(edits.back().end(), edit.begin(), edit.end());
      else
        edits.push_back(edit);
      may_append = is_plain;
    }
  return edits;
}

}  // namespace relook
