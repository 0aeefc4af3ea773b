// The entries of a run's report, in the order of their frames, one at a time: a run of 10,000 steps has more of them
// than should be in memory. ReportFile makes them, the run's page (cli/page/run_page.h) goes through them.
#pragma once
#include <cstddef>
#include <functional>

#include "base/json.h"

namespace relook {

struct ReportEntries {
  std::size_t count = 0;
  /// Entry i as step_json() makes it. Throws IoError, InputError.
  std::function<Json(std::size_t i)> at;
};

}  // namespace relook
