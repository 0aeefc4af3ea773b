// Names for the entities of a look document: unique, and put where glTF has indices. Used when a document is made
// (look.cpp), by --lights auto and by edits that add entities.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "scene/look/look.h"
#include "scene/look/look_schema.h"

namespace relook {

/// `wanted` if it is free, else with the first free of "_2", "_3", ...
[[nodiscard]] std::string unique_name(std::string wanted, const std::function<bool(const std::string&)>& is_taken);

/// Gives many names: each `wanted` if it is free, else as unique_name() would. A search goes on where the last one for
/// the same name ended, so that any number of equal names takes linear time; what is taken must stay taken.
class UniqueNames {
 public:
  /// `is_taken`: besides the names given so far.
  explicit UniqueNames(std::function<bool(const std::string&)> is_taken = {}) : is_taken_(std::move(is_taken)) {}
  [[nodiscard]] std::string give(std::string wanted);
  [[nodiscard]] std::size_t probes() const { return probes_; }  // names looked up so far

 private:
  bool take(const std::string& name);  // false if it is taken

  std::function<bool(const std::string&)> is_taken_;
  std::unordered_set<std::string> given_;
  std::unordered_map<std::string, std::size_t> next_suffix_;  // of names wanted more than once
  std::size_t probes_ = 0;
};

/// The section called `name`, if there is one.
[[nodiscard]] std::optional<Section> section_of(std::string_view name);

/// The name that a token of a JSON pointer means in a section: itself if there is such an entity or the token is no
/// glTF index of the scene file (which has no leading zeros), else the name of the entity with that index.
[[nodiscard]] std::string resolve_token(const LookDocument& document, Section section, const std::string& token);

/// Turns the tokens of a pointer to a light in glTF, which stands in KHR_lights_punctual or EXT_lights_area of the
/// root, into those of the look document, where both stand in /lights. Others stay.
void resolve_light_place(const LookDocument& document, std::vector<std::string>& tokens);

/// Puts names where an entity `value` of a section has indices of the scene file; unknown indices stay.
void name_indices(const LookDocument& document, Section section, Json& value);

}  // namespace relook
