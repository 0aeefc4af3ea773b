// Operations of an RFC 6902 patch, as journals have them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

enum class PatchOp : std::uint8_t { add, remove, replace, move, copy, test };

struct PatchOperation {
  PatchOp op = PatchOp::replace;
  std::string path;         // as written; of a replace its second segment may have "*" for any characters
  std::string from;         // move, copy
  Json value;               // add, replace, test
  std::string where;        // pointer into the journal: "/steps/3/edit/0"; its path is below it
  std::string value_where;  // pointer to the value: "/steps/3/edit/0/value"
  bool may_create = false;  // of a wedge: a replace that adds a member which is known and absent
};
using Edit = std::vector<PatchOperation>;

/// Operations as JSON writes them: [{"op": "replace", "path": ..., "value": ...}, ...].
[[nodiscard]] Json patch_json(const Edit& edit);

}  // namespace relook
