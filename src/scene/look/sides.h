// Which sides of a material's surfaces are seen. Glass with a volume shows its back faces through its front ones, so an
// import takes it as double-sided whatever the file says; extras.relook.doubleSided of a file says it for relook alone,
// and exports (scene/export) write it where the other rule would change a look.
#pragma once
#include "base/json.h"

namespace relook {

/// Is a material glass with a volume? Its values need no check before.
[[nodiscard]] bool is_solid(const Json& material);

/// Makes the `doubleSided` of a file's material what its look document is to say; absent: fill_defaults() decides.
void resolve_sides(Json& material);

/// Makes a material to be written such that an import takes it as single- or double-sided.
void write_sides(bool is_double_sided, Json& material);

}  // namespace relook
