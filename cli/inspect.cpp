// `relook inspect`: what a scene, cache, journal or run holds; with --look the look document of a scene or cache.
#include <cstdio>
#include <filesystem>

#include "base/system/standard_input.h"
#include "cache/cache.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "inspect/inspect_cameras.h"
#include "inspect/inspect_journal.h"
#include "inspect/inspect_paths.h"
#include "light/environment_light.h"
#include "options/outputs.h"
#include "run/step_text.h"
#include "scene/look/look.h"
#include "verbs.h"

namespace relook {
namespace {

enum class Kind : std::uint8_t { scene, cache, journal, run };

/// What the input is, by what it contains.
Kind kind_of(const std::filesystem::path& path) {
  if (path == kStandardInput) return Kind::journal;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    if (std::filesystem::exists(path / "MANIFEST.json", error)) return Kind::cache;
    if (std::filesystem::exists(path / "report.json", error)) return Kind::run;
    if (error) throw IoError(path.string(), "cannot be looked into: " + error.message());
    throw InputError(path.string(), "", "neither a cache nor a run");
  }
  if (path.extension() != ".json") return Kind::scene;
  const Bytes bytes = read_file(path);
  const Json document = parse_json(text_of(bytes), path.string());
  return document.is_object() && document.contains("asset") ? Kind::scene : Kind::journal;
}

std::size_t count(const Json& look, Section section) {
  const std::string key(section_name(section));
  return look.contains(key) ? look[key].size() : 0;
}

/// The document with the lights of --lights. Only these, and --camera itself, need a camera.
LoadedDocument load_lit_document(const Arguments& arguments) {
  const ViewArguments& view = arguments.view;
  LoadedDocument loaded = load_document(arguments.inputs[0], view);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  if (view.auto_lights || !view.camera.empty()) static_cast<void>(set_up_inspection(loaded, view));
  return loaded;
}

/// Of lights that are areas: their sizes, before nodes scale them.
void say_areas(const Json& lights, Json& summary, Console& console) {
  summary["areas"] = Json::array();
  for (const auto& [name, light] : lights.items()) {
    const std::string kind = light.at("type").get<std::string>();
    if (kind != traits_of(LightKind::rect).word && kind != traits_of(LightKind::disk).word) continue;
    const double height = light.value("size", 1.0);
    const double width = height * light.value("rect", Json::object()).value("aspect", 1.0);
    summary["areas"].push_back({{"light", name}, {"kind", kind}, {"size", {width, height}}});
    char size[64];
    std::snprintf(size, sizeof size, "%g x %g m", width, height);
    console.line("light " + printable(name) + ": " + kind + ", " + size);
  }
}

/// How much of an environment's light paths sample as its suns.
void say_suns(LookDocument document, Json& summary, Console& console) {
  Camera any;
  any.width = any.height = 1;
  const SceneState state(std::move(document), any, std::make_shared<PyramidStore>(), Integrator::path);
  const std::shared_ptr<const TexturePyramid>& image = state.scene().environment.image;
  if (image == nullptr) return;
  const double share = EnvironmentLight(image).sun_share();
  summary["sun_share"] = share;
  char percent[32];
  std::snprintf(percent, sizeof percent, "%.1f %%", 100 * share);
  console.line("environment: " + std::string(percent) + " of its image's light are suns");
}

void inspect_scene(const Arguments& arguments, Console& console) {
  LoadedDocument loaded = load_lit_document(arguments);
  console.warn(loaded.warnings);
  const LookDocument& document = loaded.document;
  std::uint64_t triangles = 0;
  for (const Mesh& mesh : document.assets->meshes) triangles += mesh.triangles.size();
  Json cameras = Json::array();
  for (const auto& [name, camera] : document.cameras.items()) cameras.push_back(name);
  Json summary{{"scene", arguments.inputs[0]},
               {"scene_hash", loaded.hash},
               {"triangles", triangles},
               {"cameras", cameras},
               {"warnings", Json::array()}};
  for (const std::string& warning : loaded.warnings) summary["warnings"].push_back(printable(warning));
  std::string line = arguments.inputs[0] + ": " + std::to_string(triangles) + " triangles";
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    summary[std::string(section_name(section))] = count(document.look, section);
    line += ", " + std::to_string(count(document.look, section)) + " " + std::string(section_name(section));
  }
  console.line(line);
  for (const Json& name : cameras) console.line("camera " + name.get<std::string>());
  say_areas(document.look.at("lights"), summary, console);
  if (arguments.view.sampling.integrator == Integrator::path)
    say_suns(std::move(loaded.document), summary, console);
  console.json(summary);
}

void inspect_cache(const Arguments& arguments, Console& console) {
  Json manifest;
  require_sound(read_manifest(arguments.inputs[0], manifest), arguments.inputs[0]);
  const Json& content = manifest["content"];
  const CacheSizes sizes = cache_sizes(manifest);
  const bool is_path = integrator_of(manifest) == Integrator::path;
  const std::string depths = is_path ? " (diffuse " + content["diffuse_depth"].dump() + ", glossy " +
                                           content["glossy_depth"].dump() + ", transmission " +
                                           content["transmission_depth"].dump() + ")"
                                     : "";
  char lens[64] = "";
  if (content.contains("lens"))
    std::snprintf(lens, sizeof lens, ", lens %g:%g", content["lens"][0].get<double>(),
                  content["lens"][1].get<double>());
  console.line(arguments.inputs[0] + ": scene " + content["scene"].get<std::string>() + ", camera " +
               content["camera"]["name"].get<std::string>() + ", " + content["camera"]["width"].dump() + "x" +
               content["camera"]["height"].dump() + ", " + content["samples"].dump() + " samples a pixel, " +
               content["integrator"].get<std::string>() + ", depth " + content["max_depth"].dump() + depths + lens +
               ", " + content["objects"].dump() + " objects, " + content["lights"].dump() + " lights, " +
               std::to_string(content["files"].size()) + " files, " + std::to_string(sizes.total_bytes) + " bytes" +
               noise_text(noise_of(manifest)));
  // The rows of the paper's Table 2 that are kept on disk; groups follow from the paths of the samples.
  const Json& pieces = content["pieces"];
  const auto count = [&](const char* kind) { return std::to_string(pieces[kind].get<std::uint64_t>()); };
  const auto bytes_of = [&](const char* part) {
    const auto found = sizes.bytes_by_part.find(part);
    return std::to_string(found == sizes.bytes_by_part.end() ? 0 : found->second) + " bytes";
  };
  console.line("pieces: " + count("ray_paths") + " ray paths in " + bytes_of("paths") + ", " + count("groups") +
               " groups of one path, " + count("ray_trees") + " ray trees in " + bytes_of("trees") + ", " +
               count("tunnels") + " tunnels in " + bytes_of("tunnels"));
  for (const auto& [part, share] : sizes.per_sample()) {
    const auto bytes = part == "total" ? sizes.total_bytes : sizes.bytes_by_part.at(part);
    console.line(part + ": " + std::to_string(bytes) + " bytes, " + std::to_string(share) + " a sample");
  }
  manifest["bytes_per_sample"] = sizes.per_sample();
  console.json(manifest);
}

void inspect_run(const Arguments& arguments, Console& console) {
  const std::filesystem::path path = std::filesystem::path(arguments.inputs[0]) / "report.json";
  const Bytes bytes = read_file(path);
  const std::string file = path.string();
  const Json report = parse_json(text_of(bytes), file);
  const JsonView view(report, file);
  if (view.at("relook").text() != "report/1") view.at("relook").fail("not a report that this program reads");
  const JsonView steps = view.at("steps");
  steps.require_array();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const JsonView step = steps.at(i);
    std::string line = printable(step.at("frame").text()) + ": " + printable(step.at("class").text()) + " \"" +
                       printable(step.at("name").text()) + "\", ";
    line += std::to_string(step.at("pixels_changed").integer(0, INT64_MAX)) + " pixels changed, " +
            std::to_string(step.at("seconds").at("total").number(0, 1e12)) + " s";
    const JsonView verify = step.at("verify");
    if (verify.value().is_object())
      line += ", " + std::to_string(verify.at("pixels_different").integer(0, INT64_MAX)) + " of " +
              std::to_string(verify.at("pixels_compared").integer(0, INT64_MAX)) + " pixels differ";
    console.line(line);
  }
  console.json(report);
}

/// Prints the look document itself to stdout, whatever --json and --quiet say.
void print_look(const Arguments& arguments, Kind kind, Console& console) {
  const std::string& input = arguments.inputs[0];
  if (kind != Kind::scene && kind != Kind::cache)
    throw UsageError("--look: " + input + " is neither a scene nor a cache");
  if (kind == Kind::cache && !arguments.view.look_patch.empty())
    throw UsageError("--look: the look document of a cache is fixed; patch the scene");
  Json look;
  if (kind == Kind::scene) {
    LoadedDocument loaded = load_lit_document(arguments);
    console.warn(loaded.warnings);
    look = std::move(loaded.document.look);
  } else {
    look = load_cache(input).document.look;
  }
  console.print(json_text(look, 2) + "\n");
}

/// Throws UsageError for options of a view, or a patch, beside an input that is no scene.
void require_view_of_scene(const Arguments& arguments, Kind kind) {
  const bool has_scene = !arguments.scene.empty();
  const std::string& seen = has_scene ? arguments.scene : arguments.inputs[0];
  std::error_code error;
  const bool is_fixed = has_scene ? std::filesystem::is_directory(seen, error) : kind != Kind::scene;
  if (!is_fixed) return;
  std::vector<std::string> options = arguments.view_options;
  if (has_scene && !arguments.view.look_patch.empty()) options.emplace_back("--look");
  if (options.empty()) return;
  const char* const reason = has_scene || kind == Kind::cache ? " is a cache, whose look and view are fixed"
                             : kind == Kind::run              ? " is a run, whose look and view are fixed"
                                                              : " is a journal, whose scene is given with --scene";
  throw UsageError("inspect " + options.front() + ": " + seen + reason);
}

}  // namespace

ExitCode run_inspect(const Arguments& arguments, Console& console) {
  const Kind kind = kind_of(arguments.inputs[0]);
  if (!arguments.scene.empty() && kind != Kind::journal)
    throw UsageError("--scene: " + arguments.inputs[0] + " is no journal");
  require_view_of_scene(arguments, kind);
  if (arguments.print_look) {
    print_look(arguments, kind, console);
    return ExitCode::ok;
  }
  if (arguments.lists_paths || arguments.lists_cameras) {
    if (kind != Kind::scene && kind != Kind::cache)
      throw UsageError(std::string(arguments.lists_paths ? "--paths: " : "--cameras: ") + arguments.inputs[0] +
                       " is neither a scene nor a cache");
    if (arguments.lists_paths)
      inspect_paths(arguments, console);
    else
      inspect_cameras(arguments, console);
    return ExitCode::ok;
  }
  switch (kind) {
    case Kind::scene:
      inspect_scene(arguments, console);
      break;
    case Kind::cache:
      inspect_cache(arguments, console);
      break;
    case Kind::journal:
      inspect_journal(arguments, console);
      break;
    case Kind::run:
      inspect_run(arguments, console);
      break;
  }
  return ExitCode::ok;
}

}  // namespace relook
