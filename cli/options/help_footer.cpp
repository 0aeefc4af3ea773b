#include "options/help_footer.h"

namespace relook {
namespace {

constexpr std::string_view kExamples[] = {
    "inspect shot.glb --look                              what can be edited, by name",
    "inspect night.json --scene shot.cache                the class of each step; renders nothing",
    "preprocess shot.glb -o shot.cache --camera Main --resolution 1920x1080 --samples 4",
    "render shot.glb -o fifth.exr --journal night.json --step 5 --aovs",
    "plan shot.cache night.json                           what each step will cost",
    "replay shot.cache night.json -o runs/night --verify  every frame proved by a full render",
    "replay shot.cache night.json -o runs/night --memory 8G --access-log night.log",
    "replay shot.cache night.json -o runs/part2 --steps 51-100 --progress openjd",
    "tune night.log                                       what other budgets would have cost",
    "compare runs/night runs/night2 --failpercent 0.1 --fail 0.001",
    "compare reference.exr frame.exr --json=difference.json --html difference.html",
    "blame runs/night 960,540                             which steps changed this pixel",
    "check shot.cache",
    "journal diff v1.glb v2.glb -o changes.json           two exports: what differs, as a step",
    "journal variants lamp.gltf -o looks.json",
    "journal animation shot.glb --fps 12 -o turn.json",
    "journal wedge shot.glb /lights/Key/intensity 5 10 20..60:9 -o key.json",
    "completions bash > /etc/bash_completion.d/relook"};

constexpr std::string_view kExitCodes =
    "Exit codes: 0 ok, 1 usage, 2 bad input, 3 the cache does not fit, 4 out of memory or disk, 5 damaged cache,\n"
    "6 I/O error, 10 a comparison or --verify found a difference, 75 another command is at the same steps of a run,\n"
    "128 + N ended by signal N.\n";

}  // namespace

std::string help_footer(std::string_view verb) {
  std::string text = "Examples:\n";
  for (const std::string_view example : kExamples)
    if (example.starts_with(verb)) text.append("  relook ").append(example).append("\n");
  return text.append(kExitCodes) + (verb.empty() ? "relook VERB --help has all options of a verb." : "");
}

}  // namespace relook
