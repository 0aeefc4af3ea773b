// relook_bench SCENE JOURNAL|- [WIDTHxHEIGHT [SAMPLES]]: the measures of the project on one scene, as ratios within one
// run, beside the paper's figures (Brière & Poulin 1996, Tables 2 and 3, where a full render takes 640 s).
// relook_bench all [WIDTHxHEIGHT [SAMPLES]] [--json FILE] [--html FILE]: these on spheres and garden, and their growth.
// relook_bench growth SCENE JOURNAL: the price of edits at growing numbers of samples.
// relook_bench budget SCENE JOURNAL [WIDTHxHEIGHT [SAMPLES]]: what edits cost when not everything is kept.
// relook_bench peaks CACHE JOURNAL: the memory of whole replays under five limits.
#include <cstdio>
#include <exception>
#include <string_view>

#include "all.h"
#include "budget.h"
#include "growth.h"
#include "peaks.h"
#include "scene_measures.h"

int main(int count, char** arguments) {
  try {
    if (count > 1 && std::string_view(arguments[1]) == "all")
      relook::print_all({arguments + 2, arguments + count});
    else if (count > 1 && std::string_view(arguments[1]) == "growth")
      relook::print_growth(relook::parse_options(count - 1, arguments + 1));
    else if (count > 1 && std::string_view(arguments[1]) == "budget")
      relook::print_budgets(relook::parse_options(count - 1, arguments + 1));
    else if (count == 4 && std::string_view(arguments[1]) == "peaks")
      relook::print_peaks(arguments[2], arguments[3]);
    else
      relook::print_scene(relook::parse_options(count, arguments));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relook_bench: %s\n", error.what());
    return 2;
  }
}
