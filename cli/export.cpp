// `relook export`: a scene or a cache, as a journal leaves it, as glTF. What was written is imported again and held
// against what it was made of, so that a difference never goes unsaid.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/hash.h"
#include "edit/draft/draft_diff.h"
#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "options/named_files.h"
#include "options/outputs.h"
#include "report/edit_hashes.h"
#include "scene/compile/compile_material.h"
#include "scene/export/export_gltf.h"
#include "scene/light.h"
#include "verbs.h"

namespace relook {
namespace {

struct Edited {
  std::unique_ptr<SceneState> state;
  std::optional<ExportSource> source;  // of a scene; a cache has none
};

Edited open_scene(const Arguments& arguments, Console& console) {
  LoadedDocument loaded = load_document(arguments.inputs[0], arguments.view);
  const Camera camera = set_up_inspection(loaded, arguments.view);
  console.warn(loaded.warnings);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  Edited edited;
  edited.source = read_export_source(arguments.inputs[0]);
  edited.state = std::make_unique<SceneState>(std::move(loaded.document), camera, std::make_shared<PyramidStore>(),
                                              arguments.view.sampling.integrator);
  return edited;
}

Edited open_scene_of_cache(const Arguments& arguments) {
  const ViewArguments& view = arguments.view;
  const char* const given = !view.look_patch.empty() ? "--look"
                            : view.auto_lights       ? "--lights"
                            : !view.camera.empty()   ? "--camera"
                                                     : nullptr;
  if (given != nullptr)
    throw UsageError(std::string("export ") + given + ": " + arguments.inputs[0] +
                     " is a cache, whose look and view are fixed");
  OpenedCache opened = open_cache(arguments.inputs[0], true, nullptr);
  return {std::move(opened.state), std::nullopt};
}

void apply_steps(SceneState& state, const Arguments& arguments, Console& console) {
  if (arguments.journal.empty()) return;
  const Journal journal = read_journal(arguments.journal, [&] { console.check_interrupt(); });
  require_not_outputs(arguments, files_of(journal), "a file of the journal");
  const auto all = static_cast<std::uint32_t>(journal.steps.size());
  const std::uint32_t last = arguments.step.value_or(state_after(journal, all));
  if (last > all)
    throw UsageError("--step: " + std::to_string(last) + " is beyond the " + std::to_string(all) + " steps of " +
                     journal.file);
  console.warn(check_journal(state, journal));
  SceneHistory history(journal);
  follow_edits(JournalWalk(journal, 1, last),
               [&](const JournalEvent& event) { (void)apply_event(state, journal, event, history); });
}

/// A document without what an import says in other words: what a light's type has no use for, its place in the order of
/// many, how the triangles of a mesh were listed, where nothing depends on them.
LookDocument comparable(LookDocument document) {
  for (Json& light : document.look["lights"]) {
    const auto& word = light["type"].get_ref<const std::string&>();
    const LightTraits& traits = *std::ranges::find(kLightTraits, word, &LightTraits::word);
    if (!traits.has_size) light.erase("size");
    if (word != "rect") light.erase("rect");
    if (!traits.has_cone) light.erase("spot");
    if (traits.has_size) light.erase("range");
    if (light.contains("spot") && light["spot"]["innerConeAngle"] >= light["spot"]["outerConeAngle"])
      light["spot"]["innerConeAngle"] = std::nextafter(light["spot"]["outerConeAngle"].get<double>(), 0.0);
    if (!light.contains("extras") || !light["extras"].contains("relook")) continue;
    Json& relook = light["extras"]["relook"];
    if (relook.value("sum", "-").empty()) relook.erase("sum");
    if (relook.value("rate", 0.0) == 1) relook.erase("rate");
    if (relook.empty()) light.erase("extras");
  }
  for (Json& mesh : document.look["meshes"]) {
    mesh.erase("weights");
    if (mesh.contains("primitives"))
      for (Json& primitive : mesh["primitives"]) primitive.erase("mode");
  }
  for (Json& node : document.look["nodes"]) {
    if (const Json* light = light_name_of(node)) {
      const Json name = *light;
      for (const char* extension : {"KHR_lights_punctual", "EXT_lights_area"}) node["extensions"].erase(extension);
      node["extensions"]["KHR_lights_punctual"]["light"] = name;
    }
    if (node.contains("weights") && !node.contains("mesh")) node.erase("weights");
  }
  document.look["scene"].erase("name");
  return document;
}

/// What an import of the written file says otherwise than the document, as places; empty: nothing.
std::vector<std::string> differences(const LookDocument& document, const std::string& written) {
  LookDocument again = make_look_document(import_gltf(written));
  LookDocument before = document;
  const DiffDraft diff = draft_diff(comparable(std::move(before)), comparable(std::move(again)), "files");
  std::vector<std::string> places;
  for (const Json& step : diff.draft.steps)
    for (const Json& operation : step.at("edit")) {
      const auto& path = operation.at("path").get_ref<const std::string&>();
      const bool is_empty_image = operation.at("op") == "remove" && path.starts_with("/images/");  // is said already
      if (!is_empty_image) places.push_back(path);
    }
  return places;
}

/// A sentence about them, or "".
std::string difference_sentence(const LookDocument& document, const std::string& written) {
  std::vector<std::string> places;
  try {
    places = differences(document, written);
  } catch (const InputError& error) {
    return written + ": imported again it is another scene: " + error.what();
  }
  if (places.empty()) return "";
  constexpr std::size_t kMostSaid = 5;
  std::string text = written + ": imported again it differs in ";
  for (std::size_t i = 0; i < std::min(places.size(), kMostSaid); ++i) text += (i == 0 ? "" : ", ") + places[i];
  if (places.size() > kMostSaid) text += " and " + std::to_string(places.size() - kMostSaid) + " more places";
  return text;
}

/// Files are named after their bytes: what is there under such a name is the same, and stays.
void write_beside(const std::vector<ExportedFile>& files, const std::filesystem::path& folder) {
  for (const ExportedFile& file : files) {
    const std::filesystem::path path = folder / file.name;
    make_folders(path.parent_path());
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
      write_file(path, *file.bytes);
    } else if (hash128(read_file(path)) != hash128(*file.bytes)) {
      throw UsageError(path.string(), "-o: is there and has other bytes than its name says");
    }
  }
}

}  // namespace

ExitCode run_export(const Arguments& arguments, Console& console) {
  const std::filesystem::path output(arguments.output);
  const bool is_binary = is_binary_scene_name(output);
  std::error_code none;
  const bool is_cache = std::filesystem::is_directory(arguments.inputs[0], none);
  const Edited edited = is_cache ? open_scene_of_cache(arguments) : open_scene(arguments, console);
  apply_steps(*edited.state, arguments, console);
  const LookDocument& document = edited.state->document();
  const std::string folder = is_binary ? "" : output.stem().string() + ".files";
  ExportedScene scene = export_gltf(document, edited.source ? &*edited.source : nullptr, folder);
  if (is_cache)
    scene.remarks.emplace_back("a cache has no animations, other scenes, foreign extras and extensions of its scene");
  make_folders(std::filesystem::absolute(output).parent_path());
  Bytes binary;
  std::string text;
  if (is_binary)
    binary = glb_of(scene);
  else
    text = gltf_text(scene, folder);
  console.check_interrupt();
  write_beside(scene.files, output.parent_path());
  const BytesView bytes = is_binary ? BytesView(binary) : bytes_of(text);
  write_file(output, bytes);
  if (std::string said = difference_sentence(document, arguments.output); !said.empty())
    scene.remarks.push_back(std::move(said));
  console.warn(scene.remarks);
  Json files = Json::array(), remarks = Json::array();
  for (const ExportedFile& file : scene.files) files.push_back(printable(file.name));
  for (const std::string& remark : scene.remarks) remarks.push_back(printable(remark));
  console.line(arguments.output + ": " + std::to_string(scene.gltf.value("nodes", Json::array()).size()) + " nodes, " +
               std::to_string(bytes.size()) + " bytes" +
               (scene.files.empty() ? "" : ", " + std::to_string(scene.files.size()) + " files in " + folder));
  console.json({{"scene", arguments.output},
                {"hash", hash128(bytes)},
                {"bytes", bytes.size()},
                {"files", std::move(files)},
                {"warnings", std::move(remarks)}});
  return ExitCode::ok;
}

}  // namespace relook
