#include "all.h"

#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "growth.h"
#include "render_error.h"
#include "scene_measures.h"
#include "scratch.h"
#include "tunnels.h"

namespace relook {
namespace {

const std::filesystem::path kSource = RELOOK_SOURCE_DIR;
constexpr const char* kPaperSize = "256x256";

struct Words {
  std::vector<std::string> sizes;
  std::string json, html;
};

Words parse(const std::vector<std::string>& words) {
  Words parsed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_file = words[i] == "--json" || words[i] == "--html";
    if (!is_file)
      parsed.sizes.push_back(words[i]);
    else if (i + 1 == words.size())
      throw UsageError(words[i] + ": a file is missing");
    else
      (words[i] == "--json" ? parsed.json : parsed.html) = words[i + 1], ++i;
  }
  return parsed;
}

BenchOptions options_of(const std::string& scene, const std::string& journal, const Words& words, Record& record) {
  std::vector<std::string> all{scene, journal};
  all.insert(all.end(), words.sizes.begin(), words.sizes.end());
  BenchOptions options = parse_options(all);
  options.record = &record;
  return options;
}

void measure(const std::string& name, const BenchOptions& options, bool has_goals) {
  options.record->begin(name + " " + std::to_string(options.width) + "x" + std::to_string(options.height) + ", " +
                            std::to_string(options.view.samples) + " sample(s) a pixel",
                        has_goals);
  print_scene(options);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

void print_all(const std::vector<std::string>& words) {
  Words parsed = parse(words);
  const ScratchFolder scratch;
  run_program({"python3", (kSource / "scenes/generate.py").string(), "garden", (scratch / "garden").string()});
  const std::string garden = (scratch / "garden" / "garden.gltf").string();
  const std::string spheres = (kSource / "scenes/spheres/spheres.gltf").string();
  const std::string garden_journal = (kSource / "journals/table3.json").string();
  Record record;
  const std::string spheres_journal = (kSource / "tests/bench/spheres.json").string();
  measure("spheres", options_of(spheres, spheres_journal, parsed, record), false);
  const bool has_size = !parsed.sizes.empty();
  if (!has_size) parsed.sizes = {kPaperSize};
  measure("garden", options_of(garden, garden_journal, parsed, record), true);
  if (!has_size) parsed.sizes.clear();
  const BenchOptions options = options_of(garden, garden_journal, parsed, record);
  if (!has_size) measure("garden", options, true);
  print_tunnels(options);
  record.begin("garden, growth", true);
  print_growth(options);
  BenchOptions errors = error_options({});
  errors.record = &record;
  record.begin("small scenes, path", true);
  print_errors(errors);
  record.print_goals();
  if (!parsed.json.empty()) write_file(parsed.json, record.json().dump(2) + "\n");
  if (!parsed.html.empty()) write_file(parsed.html, record.html());
}

}  // namespace relook
