// The measures of the project, as ratios within one run, beside the paper's figures (Brière & Poulin 1996, Tables 2 and
// 3, where a full render takes 640 s). README.md beside this file has all commands.
#include <array>
#include <cstdio>
#include <exception>
#include <string_view>

#include "all.h"
#include "base/error.h"
#include "budget.h"
#include "growth.h"
#include "light.h"
#include "peaks.h"
#include "render_error.h"
#include "scene_measures.h"
#include "tunnels.h"

namespace relook {
namespace {

struct Measure {
  std::string_view name;
  void (*print)(const BenchOptions&);
  std::uint32_t width = 1920, height = 1080;  // unless the command line has others
};
constexpr std::array<Measure, 5> kMeasures{Measure{"tables", print_tables, 256, 256},
                                           {"tunnels", print_tunnels},
                                           {"growth", print_growth},
                                           {"budget", print_budgets},
                                           {"light", print_light, 960, 540}};

void run(int count, char** arguments) {
  const std::string_view name = count > 1 ? arguments[1] : "";
  if (name == "all") return print_all({arguments + 2, arguments + count});
  if (name == "error") return print_errors(error_options({arguments + 2, arguments + count}));
  if (name == "peaks") {
    if (count != 4) throw UsageError("relook_bench peaks CACHE JOURNAL");
    return print_peaks(arguments[2], arguments[3]);
  }
  for (const Measure& measure : kMeasures)
    if (name == measure.name)
      return measure.print(parse_options({arguments + 2, arguments + count}, measure.width, measure.height));
  print_scene(parse_options({arguments + 1, arguments + count}));
}

}  // namespace
}  // namespace relook

int main(int count, char** arguments) {
  try {
    relook::run(count, arguments);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relook_bench: %s\n", error.what());
    return 2;
  }
}
