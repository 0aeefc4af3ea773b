// What is said of a journal's steps in lines for people: by inspect and plan.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "edit/journal.h"

namespace relook {

/// Where a step starts, when it is not where the one before it ended: " from base", " from 3 \"studio\""; else "".
[[nodiscard]] std::string origin_text(const Journal& journal, std::uint32_t step);
/// The values of a frame of a wedge, " 0.2 studio"; "" of other steps. `frame`: from 0.
[[nodiscard]] std::string values_text(const Journal& journal, std::uint32_t step, std::size_t frame);

}  // namespace relook
