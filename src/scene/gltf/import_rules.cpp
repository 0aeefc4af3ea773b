#include "scene/gltf/import_rules.h"

#include <utility>

#include "base/error.h"
#include "base/files.h"

namespace relook {
namespace {

ImportRules& rules_of_process() {
  static ImportRules rules;
  return rules;
}

}  // namespace

void set_import_rules(ImportRules rules) { rules_of_process() = std::move(rules); }
const ImportRules& import_rules() { return rules_of_process(); }

std::filesystem::path allowed_path(const std::filesystem::path& folder, std::string_view uri, std::string_view file,
                                   std::string_view where) {
  return contained_path(folder, import_rules().roots, uri, file, where);
}

void tolerate(std::string_view file, std::string_view where, std::string_view what,
              std::vector<std::string>& warnings) {
  constexpr std::size_t kMostWarnings = 200;  // a file can be wrong in a million places
  if (import_rules().is_strict) throw InputError(file, where, what);
  if (warnings.size() > kMostWarnings) return;
  if (warnings.size() == kMostWarnings) return warnings.emplace_back("there is more of this kind"), void();
  warnings.push_back(std::string(where) + (where.empty() ? "" : ": ") + std::string(what));
}

}  // namespace relook
