// Assets whose geometry counts against the budget of the process (base/import_memory.h).
#pragma once
#include <memory>

#include "scene/look/look.h"

namespace relook {

/// Empty assets that can hold a part of the budget.
[[nodiscard]] std::shared_ptr<Assets> counted_assets();
/// Counts the meshes and instances that a document has now, instead of those counted before. Nothing for assets that
/// are not counted. Throws ResourceError.
void count_geometry(const LookDocument& document);

}  // namespace relook
