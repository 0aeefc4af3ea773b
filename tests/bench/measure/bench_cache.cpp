#include "bench_cache.h"

#include "base/error.h"

namespace relook {

void write_bench_cache(const BenchOptions& options, const std::filesystem::path& cache,
                       const std::vector<std::string>& extra) {
  std::vector<std::string> command{RELOOK_PROGRAM,
                                   "preprocess",
                                   options.scene,
                                   "--integrator",
                                   "whitted",
                                   "-o",
                                   cache.string(),
                                   "--resolution",
                                   std::to_string(options.width) + "x" + std::to_string(options.height),
                                   "--samples",
                                   std::to_string(options.view.samples),
                                   "--quiet"};
  const SceneChoices choices = scene_choices(options, import_look(options));
  if (!choices.camera.empty()) command.insert(command.end(), {"--camera", choices.camera});
  if (choices.has_auto_lights) command.insert(command.end(), {"--lights", "auto"});
  command.insert(command.end(), extra.begin(), extra.end());
  run_program(command);
}

CacheSize inspect_bench_cache(const std::filesystem::path& cache, const ScratchFolder& scratch) {
  const std::filesystem::path file = scratch / "inspect.json";
  run_program({RELOOK_PROGRAM, "inspect", cache.string(), "--json"}, file);
  const Json manifest = parse_json(text_of(read_file(file)), file.string());
  const Json& content = manifest.at("content");
  const Json& pieces = content.at("pieces");
  CacheSize facts;
  facts.pieces = {pieces.at("ray_paths"), pieces.at("groups"), pieces.at("ray_trees"), pieces.at("tunnels")};
  for (const Json& entry : content.at("files")) {
    const auto name = entry.at("name").get<std::string>();
    const auto bytes = entry.at("bytes").get<std::uint64_t>();
    facts.total += bytes;
    if (name.starts_with("paths")) facts.paths += bytes;
    if (name.starts_with("trees")) facts.trees += bytes;
    if (name.starts_with("tunnels")) facts.tunnels += bytes;
  }
  return facts;
}

OpenedCache open_bench_cache(const std::filesystem::path& cache, Residency* residency) {
  OpenedCache opened;
  const CacheAnswer answer = open_cache(cache, true, opened, residency);
  if (answer.fault != CacheFault::none) throw IoError(cache.string(), explanation(answer));
  return opened;
}

}  // namespace relook
