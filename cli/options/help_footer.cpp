#include "options/help_footer.h"

#include <iterator>
#include <utility>

namespace relook {
namespace {

constexpr std::string_view kExamples[] = {
    "inspect shot.glb --look                              what can be edited, by name",
    "inspect shot.glb --paths roughness                   what can be edited: value, range, class, unit",
    "inspect shot.glb --cameras                           what --camera can name",
    "inspect night.json --scene shot.cache                the class of each step; renders nothing",
    "preprocess shot.glb -o shot.cache --camera Main --resolution 1920x1080 --samples 4",
    "render shot.glb -o fifth.exr --journal night.json --step 5 --aovs",
    "render shot.glb -o cameras.png --camera all --resolution 480x270  a labelled sheet of them",
    "plan shot.cache night.json                           what each step will cost",
    "replay shot.cache night.json -o runs/night --verify  every frame proved by a full render",
    "replay shot.cache night.json -o runs/night --memory 8G --access-log night.log",
    "replay shot.cache night.json -o runs/part2 --steps 51-100 --progress openjd",
    "tune night.log                                       what other budgets would have cost",
    "compare runs/night runs/night2 --failpercent 0.1 --fail 0.001",
    "compare reference.exr frame.exr --json=difference.json --html difference.html",
    "blame runs/night 960,540                             which steps changed this pixel",
    "report runs/night                                    its page anew, from its files",
    "report runs/night --single-file --scale 2 -o night.html  one file to send",
    "report runs/night runs/day -o index.html             a card a run, with links",
    "sheet runs/night -o night.png --columns 4            frames with names and values, one picture",
    "check shot.cache",
    "journal diff v1.glb v2.glb -o changes.json           two exports: what differs, as a step",
    "journal variants lamp.gltf -o looks.json",
    "journal animation shot.glb --fps 12 -o turn.json",
    "journal wedge shot.glb /lights/Key/intensity 5 10 20..60:9 -o key.json",
    "journal turntable shot.glb Watch --frames 36 -o turn.json",
    "journal turntable shot.glb --environment -o sky.json the HDRI turned round",
    "journal aim shot.glb Key Watch --azimuth -45 --elevation 35 -o key.json",
    "journal rig shot.glb --target Watch --style softboxes -o rig.json",
    "schema journal --scene shot.glb > shot.schema.json   for editors: \"$schema\": \"shot.schema.json\" in a journal",
    "export shot.glb --journal night.json --step 5 -o chosen.glb   the scene as the step leaves it",
    "watch shot.glb --cache shot.cache -o runs/live --camera Main  a frame for each new export of the scene",
    "completions bash > /etc/bash_completion.d/relook"};

constexpr ExitMeaning kExitCodes[] = {{"0", "ok"},
                                      {"1", "usage"},
                                      {"2", "bad input"},
                                      {"3", "the cache does not fit"},
                                      {"4", "out of memory or disk"},
                                      {"5", "damaged cache"},
                                      {"6", "I/O error"},
                                      {"10", "a comparison or --verify found a difference"},
                                      {"75", "another command is at the same steps of a run"},
                                      {"128 + N", "ended by signal N"}};

/// All exit codes as a sentence, in lines of at most 116 characters.
std::string exit_codes_text() {
  constexpr std::size_t kWidth = 116;
  std::string text, line = "Exit codes:";
  for (const auto& [code, meaning] : kExitCodes) {
    std::string entry =
        std::string(code) + " " + std::string(meaning) + (&meaning == &std::end(kExitCodes)[-1].meaning ? "." : ",");
    if (line.size() + entry.size() + 1 > kWidth) text += std::exchange(line, "") + "\n";
    line += (line.empty() ? "" : " ") + entry;
  }
  return text + line + "\n";
}

}  // namespace

std::vector<std::string_view> examples_of(std::string_view verb) {
  std::vector<std::string_view> examples;
  for (const std::string_view example : kExamples)
    if (example.starts_with(verb)) examples.push_back(example);
  return examples;
}

std::span<const ExitMeaning> exit_meanings() { return kExitCodes; }

std::string help_footer(std::string_view verb) {
  std::string text = "Examples:\n";
  for (const std::string_view example : examples_of(verb)) text.append("  relook ").append(example).append("\n");
  return text + exit_codes_text() + (verb.empty() ? "relook VERB --help has all options of a verb." : "");
}

}  // namespace relook
