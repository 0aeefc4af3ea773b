// `relook export`: what it writes, imported again, is the scene as the journal leaves it, to the last bit of its frame,
// and valid glTF. The second is Khronos glTF-Validator's word: RELOOK_GLTF_VALIDATOR names a folder where
// `npm install gltf-validator` was run.
#include <cstdlib>

#include "base/hash.h"
#include "cli_fixture.h"
#include "compare/compare.h"
#include "edit/apply.h"
#include "edit/journal_walk.h"
#include "image/render.h"
#include "scene/export/export_gltf.h"
#include "scene/gltf/import.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kAssets = fs::path(RELOOK_SOURCE_DIR) / "../shared/assets";

ViewOptions view_of(Integrator integrator) {
  ViewOptions view;
  view.integrator = integrator;
  view.samples = 1;
  view.diffuse_depth = 1;
  return view;
}

SceneState state_of(LookDocument document, const Camera& camera, Integrator integrator) {
  return {std::move(document), camera, std::make_shared<PyramidStore>(), integrator};
}

Camera camera_of(const LookDocument& document, const std::string& choice) {
  constexpr std::uint32_t kWidth = 48, kHeight = 27;
  return choose_camera(document, choice, kWidth, kHeight);
}

Frame frame_of(const SceneState& state) {
  RenderStats ignored;
  return render(state.scene(), view_of(state.scene().integrator), ignored);
}

SceneState opened(const fs::path& scene, const std::string& camera, Integrator integrator) {
  LookDocument document = make_look_document(import_gltf(scene));
  const Camera chosen = camera_of(document, camera);
  return state_of(std::move(document), chosen, integrator);
}

/// A scene whose exports, after each step of a journal, are held against the scene itself.
class ExportCase {
 public:
  ExportCase(const fs::path& scene, Integrator integrator, std::string camera = "")
      : scene_(scene),
        source_(read_export_source(scene)),
        camera_choice_(std::move(camera)),
        state_(opened(scene, camera_choice_, integrator)) {}

  void check(const std::string& name) {
    const SceneState again = import_again(name);
    const Frame frame = frame_of(state_), exported = frame_of(again);
    EXPECT_EQ(compare_frames(frame, exported, 100, 0).pixels_different, 0U) << scene_ << " " << name;
  }

  void check_each_step(const Journal& journal) {
    check("base");
    for (std::uint32_t step = 1; step <= journal.steps.size(); ++step) {
      follow_edits(JournalWalk(journal, step, step), [&](const JournalEvent& event) {
        (void)apply_edit(state_, event.edit(), journal.file, journal.path.parent_path());
      });
      check(step_name(journal, step));
    }
  }

 private:
  /// By turns a .glb and a .gltf, of the scene file and as if there were only a cache.
  SceneState import_again(const std::string& name) {
    const bool is_binary = exports_ % 2 == 0, has_source = exports_ % 4 < 2;
    ++exports_;
    const std::string folder = is_binary ? "" : "it is.files";
    ExportedScene scene = export_gltf(state_.document(), has_source ? &source_ : nullptr, folder);
    const fs::path file = folder_ / (is_binary ? "out.glb" : "out.gltf");
    if (is_binary)
      write_file(file, glb_of(scene));
    else
      write_file(file, gltf_text(scene, folder));
    for (const ExportedFile& beside : scene.files) {
      fs::create_directories((folder_ / beside.name).parent_path());
      write_file(folder_ / beside.name, *beside.bytes);
    }
    EXPECT_TRUE(is_exported_scene(read_file(file))) << name;
    LookDocument document = make_look_document(import_gltf(file));
    Camera camera = camera_choice_ == "auto" ? state_.scene().camera : camera_of(document, camera_choice_);
    return state_of(std::move(document), camera, state_.scene().integrator);
  }

  fs::path scene_;
  ScratchFolder folder_{"export"};
  ExportSource source_;
  std::string camera_choice_;
  SceneState state_;
  int exports_ = 0;
};

Journal edits(const std::string& steps) {
  return parse_journal("{\"relook\": \"journal/1\", \"steps\": [" + steps + "]}", "edits.json");
}

TEST(Export, each_step_of_table_1_comes_back_to_the_bit) {
  const Journal journal = read_journal(fs::path(RELOOK_SOURCE_DIR) / "journals/table1.json");
  for (const Integrator integrator : {Integrator::whitted, Integrator::path})
    ExportCase(kScene, integrator).check_each_step(journal);
}

TEST(Export, each_step_of_journals_of_real_scenes_comes_back_to_the_bit) {
  if (!fs::exists(kAssets)) GTEST_SKIP() << kAssets << " is not there";
  for (const char* name : {"playcanvas-lights", "lights-punctual-lamp"}) {
    const fs::path folder = kAssets / name;
    fs::path scene;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") scene = entry.path();
    const fs::path journals = fs::path(RELOOK_SOURCE_DIR) / "journals/assets";
    ExportCase(scene, Integrator::path, "auto").check_each_step(read_journal(journals / (std::string(name) + ".json")));
  }
}

TEST(Export, skins_morphs_instances_and_compressed_meshes_come_back_to_the_bit) {
  if (!fs::exists(kAssets)) GTEST_SKIP() << kAssets << " is not there";
  for (const char* name :
       {"khronos-small/SimpleInstancing/glTF-Binary/SimpleInstancing.glb",
        "khronos-small/SimpleSkin/glTF/SimpleSkin.gltf", "khronos-small/SimpleMorph/glTF/SimpleMorph.gltf",
        "khronos-small/MultipleScenes/glTF/MultipleScenes.gltf",
        "khronos-small/RiggedSimple/glTF-Binary/RiggedSimple.glb",
        "khronos-small/SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf",
        "khronos-more/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf",
        "khronos-small/Box With Spaces/glTF/Box With Spaces.gltf"}) {
    if (!fs::exists(kAssets / name)) {
      ADD_FAILURE() << name;
      continue;
    }
    ExportCase scene(kAssets / name, Integrator::path, "auto");
    for (int form = 0; form < 4; ++form) scene.check(name);
  }
}

TEST(Export, what_an_import_would_read_otherwise_is_written_so_that_it_does_not) {
  // Single-sided glass with a volume; a rotation that is no unit quaternion; a spot without a soft rim; a lamp that
  // becomes an area of one nit; an unlit material that is lit; a node with the name of a removed one; a copy.
  ExportCase scene(kScene, Integrator::path);
  scene.check_each_step(edits(R"(
    {"name": "sides", "edit": [
      {"op": "replace", "path": "/materials/Paint/extensions/KHR_materials_transmission/transmissionFactor", "value": 1},
      {"op": "replace", "path": "/materials/Paint/extensions/KHR_materials_volume/thicknessFactor", "value": 0.5}]},
    {"name": "sides again", "edit": [
      {"op": "replace", "path": "/materials/Paint/extensions/KHR_materials_transmission/transmissionFactor", "value": 0}]},
    {"name": "turn", "edit": [
      {"op": "replace", "path": "/nodes/CentralSphere/rotation", "value": [0.3, 0.5, 0.1, 3]}]},
    {"name": "spot", "edit": [
      {"op": "add", "path": "/lights/Rimless", "value": {"type": "spot", "intensity": 90,
        "spot": {"innerConeAngle": 0.4, "outerConeAngle": 0.4}}},
      {"op": "add", "path": "/nodes/Rimless", "value": {"translation": [0, 5, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
        "extensions": {"KHR_lights_punctual": {"light": "Rimless"}}}}]},
    {"name": "area", "edit": [
      {"op": "replace", "path": "/lights/Rimless", "value": {"type": "rect", "intensity": 1, "size": 2}}]},
    {"name": "unlit", "edit": [
      {"op": "add", "path": "/materials/Flat", "value": {"extensions": {"KHR_materials_unlit": {}},
        "extras": {"relook": {"model": "metallic-roughness"}}}}]},
    {"name": "gone and back", "edit": [
      {"op": "copy", "from": "/nodes/CentralSphere", "path": "/nodes/Copy"},
      {"op": "remove", "path": "/nodes/CentralSphere"},
      {"op": "move", "from": "/nodes/Copy", "path": "/nodes/CentralSphere"},
      {"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.5, 1.2, 0]}]})"));
}

class ExportVerb : public Cli {
 protected:
  void SetUp() override { write_text(at("j.json"), kJournal); }

  /// Renders `scene` in floats and returns the frame's file.
  [[nodiscard]] std::string rendered(const std::string& scene, const std::string& name,
                                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"render", scene,          "-o",      at(name),  "--resolution",
                                     "48x27",  "--integrator", "whitted", "--float", "--quiet"};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = relook(command);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return at(name);
  }
  static void expect_same(const std::string& a, const std::string& b) {
    const ProgramResult result = relook({"compare", a, b, "--exact"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }
};

TEST_F(ExportVerb, scenes_and_caches_export_a_step_that_renders_to_its_frame) {
  ASSERT_EQ(preprocess("cache").exit_code, 0);
  const std::string wanted = rendered(kScene, "wanted.exr", {"--journal", at("j.json"), "--step", "2"});
  for (const std::string& input : {kScene, at("cache")})
    for (const char* name : {"out.glb", "out.gltf"}) {
      const ProgramResult result = relook({"export", input, "--journal", at("j.json"), "--step", "2", "-o", at(name)});
      ASSERT_EQ(result.exit_code, 0) << result.output;
      EXPECT_EQ(result.output.find("imported again"), std::string::npos) << result.output;
      expect_same(wanted, rendered(at(name), "again.exr"));
    }
  EXPECT_TRUE(fs::is_directory(at("out.files")));
}

TEST_F(ExportVerb, refuses_in_one_line_what_it_cannot_write) {
  expect_error(relook({"export", kScene, "-o", at("out.obj")}), 1, "a scene is called .glb, or .gltf");
  write_text(at("foreign.gltf"), "{\"asset\": {\"version\": \"2.0\"}}");
  expect_error(relook({"export", kScene, "-o", at("foreign.gltf")}), 1, "not an export of relook");
  expect_error(relook({"export", kScene, "-o", at("out.glb"), "--journal", at("j.json"), "--step", "9"}), 1,
               "--step: 9 is beyond the 2 steps");
  expect_error(relook({"export", at("none.glb"), "-o", at("out.glb")}), 2, "none.glb");
  EXPECT_FALSE(fs::exists(at("out.glb")));
  // An input is never replaced, whatever the spelling and the options.
  ASSERT_EQ(relook({"export", kScene, "-o", at("own.glb"), "--quiet"}).exit_code, 0);
  expect_error(relook({"export", at("own.glb"), "-o", at(".") + "/own.glb", "--overwrite"}), 1,
               "an input is never replaced");
  ASSERT_EQ(preprocess("cache").exit_code, 0);
  expect_error(relook({"export", at("cache"), "-o", at("out.glb"), "--lights", "auto"}), 1,
               "whose look and view are fixed");
}

TEST_F(ExportVerb, replaces_what_it_wrote_until_somebody_changes_it) {
  ASSERT_EQ(relook({"export", kScene, "-o", at("out.gltf"), "--quiet"}).exit_code, 0);
  ASSERT_EQ(relook({"export", kScene, "-o", at("out.gltf"), "--quiet"}).exit_code, 0);
  Json gltf = read_json(at("out.gltf"));
  gltf["nodes"][0]["extras"]["by hand"] = true;
  write_text(at("out.gltf"), gltf.dump());
  expect_error(relook({"export", kScene, "-o", at("out.gltf"), "--quiet"}), 1, "not an export of relook");
}

TEST_F(ExportVerb, keeps_what_no_edit_touched_and_what_relook_does_not_know) {
  Json gltf = read_json(kScene);
  const fs::path folder = fs::path(kScene).parent_path();
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() != ".gltf")
      fs::copy(entry.path(), at(entry.path().filename().string()), fs::copy_options::recursive);
  gltf["extensionsUsed"].push_back("VENDOR_thing");
  gltf["nodes"][0]["extensions"]["VENDOR_thing"] = {{"strength", 3}};
  gltf["materials"][0]["extras"]["owner"] = "somebody";
  gltf["nodes"].push_back({{"name", "Elsewhere"}});
  gltf["scenes"].push_back({{"name", "other"}, {"nodes", {gltf["nodes"].size() - 1}}});
  write_text(at("scene.gltf"), gltf.dump());
  ASSERT_EQ(relook({"export", at("scene.gltf"), "-o", at("out.gltf"), "--journal", at("j.json"), "--quiet"}).exit_code,
            0);
  const Json out = read_json(at("out.gltf"));
  EXPECT_EQ(out["nodes"][0]["extensions"]["VENDOR_thing"]["strength"], 3);
  EXPECT_EQ(out["materials"][0]["extras"]["owner"], "somebody");
  EXPECT_NE(std::ranges::find(out["extensionsUsed"], Json("VENDOR_thing")), out["extensionsUsed"].end());
  EXPECT_EQ(out["scenes"].back()["name"], "other");
  EXPECT_EQ(out["nodes"][out["scenes"].back()["nodes"][0].get<std::size_t>()]["name"], "Elsewhere");
  EXPECT_EQ(out["accessors"], gltf["accessors"]);
}

TEST_F(ExportVerb, is_valid_by_the_validator_of_khronos) {
  const char* validator = std::getenv("RELOOK_GLTF_VALIDATOR");
  if (validator == nullptr)
    GTEST_SKIP() << "RELOOK_GLTF_VALIDATOR names no folder with node_modules/gltf-validator: exports are not validated";
  write_text(at("validate.js"), R"(
const v = require(process.argv[2] + "/node_modules/gltf-validator"), fs = require("fs"), path = require("path");
const read = (name) => new Uint8Array(fs.readFileSync(name)), folder = path.dirname(process.argv[3]);
v.validateBytes(read(process.argv[3]), {externalResourceFunction: async (uri) => read(path.join(folder, decodeURIComponent(uri)))})
  .then((report) => {
    for (const m of report.issues.messages) if (m.severity === 0) console.log(m.code, m.pointer, m.message);
    process.exit(report.issues.numErrors > 0 ? 1 : 0);
  });
)");
  const std::string journal = (fs::path(RELOOK_SOURCE_DIR) / "journals/table1.json").string();
  const std::size_t steps = read_journal(journal).steps.size();
  ASSERT_EQ(preprocess("cache").exit_code, 0);
  constexpr std::size_t kEach = 7;
  for (std::size_t step = 0; step <= steps; step += kEach) {
    const std::string file = at(step % 2 == 0 ? "out.glb" : "out.gltf"), input = step % 3 == 0 ? at("cache") : kScene;
    const ProgramResult result =
        relook({"export", input, "-o", file, "--journal", journal, "--step", std::to_string(step), "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const ProgramResult report = run_program({"node", at("validate.js"), validator, file});
    EXPECT_EQ(report.exit_code, 0) << "step " << step << ": " << report.output;
  }
}

}  // namespace
}  // namespace relook
