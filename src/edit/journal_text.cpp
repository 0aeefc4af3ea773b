#include "edit/journal_text.h"

#include "base/error.h"
#include "edit/journal_walk.h"

namespace relook {

std::string origin_text(const Journal& journal, std::uint32_t step) {
  const std::uint32_t start = state_before(journal, step);
  if (start + 1 == step) return "";
  return " from " + (start == 0 ? "base" : std::to_string(start) + " \"" + printable(step_name(journal, start)) + "\"");
}

std::string values_text(const Journal& journal, std::uint32_t step, std::size_t frame) {
  const Wedge& wedge = journal.steps[step - 1].wedge;
  std::string text;
  for (std::size_t axis = 0; axis < wedge.axes.size(); ++axis)
    text += " " + printable(wedge.axes[axis].text(wedge.place(frame, axis)));
  return text;
}

}  // namespace relook
