#include "options/named_files.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/error.h"

namespace relook {
namespace {

std::string suffix_of(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  std::ranges::transform(suffix, suffix.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return suffix;
}

}  // namespace

std::filesystem::path journal_beside(const std::filesystem::path& run) {
  std::filesystem::path journal = run.has_filename() ? run : run.parent_path();
  return journal += ".json";
}

bool is_binary_scene_name(const std::filesystem::path& output) {
  const std::string suffix = suffix_of(output);
  if (suffix != ".glb" && suffix != ".gltf")
    throw UsageError(output.string(), "-o: a scene is called .glb, or .gltf for one with files beside it");
  return suffix == ".glb";
}

bool is_preview_name(const std::filesystem::path& output) {
  const std::string suffix = suffix_of(output);
  if (suffix != ".exr" && suffix != ".png")
    throw UsageError(output.string(), "-o: a frame is called .exr, or .png for a preview");
  return suffix == ".png";
}

std::vector<NamedOutput> outputs_of(const Arguments& arguments) {
  std::vector<NamedOutput> outputs;
  const auto add = [&](const std::filesystem::path& path, std::string_view option, std::optional<OwnKind> kind) {
    if (!path.empty()) outputs.push_back({path, option, kind});
  };
  switch (arguments.verb) {
    case Verb::render:
      add(arguments.output, "-o", is_preview_name(arguments.output) ? OwnKind::preview : OwnKind::frame);
      break;
    case Verb::sheet:
      add(arguments.output, "-o", is_preview_name(arguments.output) ? OwnKind::preview : OwnKind::frame);
      break;
    case Verb::report:
      add(arguments.output, "-o", OwnKind::page);
      break;
    case Verb::journal:
      add(arguments.output, "-o", OwnKind::journal);
      break;
    case Verb::export_scene:
      (void)is_binary_scene_name(arguments.output);
      add(arguments.output, "-o", OwnKind::scene);
      break;
    case Verb::compare:
      add(arguments.output, "-o", std::nullopt);
      if (!arguments.output.empty()) {
        add(std::filesystem::path(arguments.output) / "compare.json", "-o", OwnKind::comparison);
        add(std::filesystem::path(arguments.output) / "compare.html", "-o", OwnKind::page);
      }
      add(arguments.json_file, "--json", OwnKind::comparison);
      add(arguments.html, "--html", OwnKind::page);
      break;
    case Verb::plan:
      add(arguments.json_file, "--json", OwnKind::plan);
      break;
    case Verb::watch:
      add(arguments.output, "-o", std::nullopt);
      add(journal_beside(arguments.output), "-o", OwnKind::journal);
      break;
    case Verb::replay:
      add(arguments.output, "-o", std::nullopt);
      add(arguments.access_log, "--access-log", OwnKind::access_log);
      break;
    default:
      add(arguments.output, "-o", std::nullopt);
  }
  add(arguments.trace, "--trace", OwnKind::trace);
  return outputs;
}

std::vector<NamedInput> inputs_of(const Arguments& arguments) {
  std::vector<NamedInput> inputs;
  const auto add = [&](const std::string& path, std::string_view what) {
    if (!path.empty() && path != "-") inputs.push_back({path, what});
  };
  const bool has_one = arguments.verb == Verb::blame ||
                       (arguments.verb == Verb::journal && arguments.journal_source != JournalSource::diff);
  const bool has_none = arguments.verb == Verb::schema || arguments.verb == Verb::completions ||
                        arguments.verb == Verb::complete;  // words, of which scene and journal are below
  const std::size_t count = has_none ? 0 : has_one ? 1 : arguments.verb == Verb::plan ? 2 : arguments.inputs.size();
  for (std::size_t i = 0; i < std::min(count, arguments.inputs.size()); ++i) add(arguments.inputs[i], "an input");
  add(arguments.journal, "the journal");
  add(arguments.view.look_patch, "the patch of --look");
  add(arguments.scene, "the scene");
  add(arguments.cache, "the cache");
  if (const char* config = std::getenv("OCIO")) add(config, "the config of $OCIO");
  return inputs;
}

}  // namespace relook
