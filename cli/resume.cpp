#include "resume.h"

#include <algorithm>
#include <utility>

#include "base/hash.h"
#include "cache/cache.h"
#include "load_cache.h"

namespace relook {
namespace {

constexpr std::size_t kEntityDepth = 2;  // "/materials/Glass"

bool mentions_file(const Json& value) {
  if (value.is_object() && (value.contains("asset") || value.contains("uri"))) return true;
  return value.is_structured() &&
         std::any_of(value.begin(), value.end(), [](const Json& part) { return mentions_file(part); });
}

bool names_files(const Edit& edit) {
  return std::ranges::any_of(edit, [](const PatchOperation& operation) {
    return mentions_file(operation.value) || operation.path.ends_with("/uri") || operation.path.ends_with("/asset");
  });
}

bool only_replaces_values(const Edit& edit) {
  return std::ranges::all_of(edit, [](const PatchOperation& operation) {
    const auto depth = static_cast<std::size_t>(std::ranges::count(operation.path, '/'));
    return operation.op == PatchOp::test || (operation.op == PatchOp::replace && depth > kEntityDepth);
  });
}

}  // namespace

std::optional<std::string> run_hash(const Arguments& arguments, const Journal& journal) {
  for (const JournalStep& step : journal.steps)
    for (const Edit& edit : frames_of(step))
      if (names_files(edit)) return std::nullopt;
  Json manifest;
  require_sound(read_manifest(arguments.inputs[0], manifest), arguments.inputs[0]);
  RunReport options;
  options.structures = arguments.structures;
  options.float_frames = arguments.float_frames;
  options.verify_percent = arguments.verify_percent;
  const Json run{{"program", program_version()},   {"cache", manifest["hash"]},
                 {"journal", journal.hash},        {"options", options_json(options)},
                 {"overlays", arguments.overlays}, {"baseline", arguments.baseline}};
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
