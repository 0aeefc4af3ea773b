// Other people's files, good and bad, and the hostile ones of ../shared/hostile/gen.py: each gives a scene or one line.
// They lie beside the project, in ../shared; without that folder the tests skip and say so.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <ostream>
#include <set>

#include "base/error.h"
#include "base/system/sanitizers.h"
#include "run_program.h"
#include "scene/gltf/import.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = fs::path(RELOOK_SOURCE_DIR) / ".." / "shared";
const fs::path kAssets = kShared / "assets";

class Corpus : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kAssets)) GTEST_SKIP() << "no ../shared/assets beside the project: real glTF files are NOT tested";
  }
};

/// All .gltf and .glb files below a folder, in order.
std::vector<fs::path> scenes_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// Imports and decodes every image that a texture names. Empty, or the error's line.
std::string import_fault(const fs::path& path) {
  try {
    const ImportedGltf imported = import_gltf(path);
    std::set<std::size_t> used;
    for (const Json& texture : imported.gltf.value("textures", Json::array()))
      if (texture.contains("source")) used.insert(texture["source"].get<std::size_t>());
    for (const std::size_t i : used) {
      const std::string where = "/images/" + std::to_string(i);
      if (!imported.images[i].bytes) throw InputError(imported.file, where, "has no data");
      (void)decode_pyramid(*imported.images[i].bytes, true, imported.file, where);
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

struct Usage {
  double cpu_seconds = 0;
  long peak_megabytes = 0;
};

/// Of all finished child processes together.
Usage children_usage() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), usage.ru_maxrss / 1024};
}

/// The program renders the file, or exits with 2 and one line, within 2 s and 512 MB. Returns whether it refused.
bool expect_picture_or_one_line(const fs::path& scene, const ScratchFolder& folder) {
  constexpr double kMostSeconds = 2;
  constexpr long kMostMegabytes = 512;
  const Usage before = children_usage();
  const ProgramResult result = run_program({"timeout", "60", RELOOK_PROGRAM, "render", scene.string(), "--integrator",
                                            "whitted", "-o", (folder / "frame.exr").string(), "--camera", "auto",
                                            "--lights", "auto", "--resolution", "8x8", "--quiet", "--threads", "1"});
  const Usage after = children_usage();
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2)
      << scene << " exits with " << result.exit_code << ": " << result.output;
  if (result.exit_code == 2) {
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << scene << ": " << result.output;
    EXPECT_TRUE(result.output.starts_with("relook: ")) << scene << ": " << result.output;
  }
  if (!kIsInstrumented) {
    EXPECT_LT(after.cpu_seconds - before.cpu_seconds, kMostSeconds) << scene;
    const bool is_new_peak = after.peak_megabytes > before.peak_megabytes;
    EXPECT_FALSE(is_new_peak && after.peak_megabytes >= kMostMegabytes)
        << scene << " took " << after.peak_megabytes << " MB";
  }
  return result.exit_code == 2;
}

/// About half of the files that lie there, and of those that give a picture: fewer mean that the test lost its subject.
struct FolderCase {
  const char* folder;
  std::ptrdiff_t least_files, least_pictures;
};

void PrintTo(const FolderCase& row, std::ostream* stream) { *stream << row.folder; }

class CorpusFolder : public Corpus, public testing::WithParamInterface<FolderCase> {};

TEST_P(CorpusFolder, gives_pictures_or_one_line) {
  const ScratchFolder folder("corpus");
  const std::vector<fs::path> scenes = scenes_below(kAssets / GetParam().folder);
  ASSERT_GE(std::ssize(scenes), GetParam().least_files);
  const auto pictures =
      std::ranges::count_if(scenes, [&](const fs::path& scene) { return !expect_picture_or_one_line(scene, folder); });
  EXPECT_GE(pictures, GetParam().least_pictures);
}

// Each file of bad-input-validator/ext is refused: it is wrong, or has no object to frame.
INSTANTIATE_TEST_SUITE_P(Corpus, CorpusFolder,
                         testing::Values(FolderCase{"bad-input-assimp", 9, 1},
                                         FolderCase{"bad-input-validator/base", 130, 4},
                                         FolderCase{"bad-input-validator/ext", 54, 0},
                                         FolderCase{"tinygltf-models", 8, 5},
                                         FolderCase{"khronos-asset-generator-0.6", 60, 55}));

TEST_F(Corpus, hostile_files_are_refused_and_read_nothing_outside) {
  const ScratchFolder folder("hostile");
  const fs::path made = folder / "made";
  const ProgramResult generated = run_program({"python3", (kShared / "hostile" / "gen.py").string(), made.string()});
  ASSERT_EQ(generated.exit_code, 0) << generated.output;
  const auto scenes = scenes_below(made);
  ASSERT_GE(scenes.size(), 17U);
  for (const fs::path& scene : scenes) {
    const bool is_refused = expect_picture_or_one_line(scene, folder);
    EXPECT_TRUE(is_refused) << scene << " was accepted";
  }
}

/// Files that a reader without the named extension or version must refuse, by the part of their path.
const std::map<std::string, std::string> kMustFail = {
    {"Compatibility_04", "glTF version \"2.1\" is required"},
    {"Compatibility_05", "required extension FAKE_materials_quantumRendering is not supported"},
    {"duck-ktx2/glTF-KTX", "KTX2 images (KHR_texture_basisu) are not supported"},
};

TEST_F(Corpus, all_else_loads) {
  std::size_t loaded = 0;
  for (const auto& entry : fs::directory_iterator(kAssets)) {
    const std::string name = entry.path().filename();
    const bool is_large = name.starts_with("stress");
    if (!entry.is_directory() || name.starts_with("bad-input") || name == "tinygltf-models" || is_large) continue;
    for (const fs::path& scene : scenes_below(entry.path())) {
      const std::string fault = import_fault(scene);
      const auto must_fail = std::ranges::find_if(
          kMustFail, [&](const auto& rule) { return scene.string().find(rule.first) != std::string::npos; });
      if (must_fail == kMustFail.end())
        EXPECT_EQ(fault, "");
      else
        EXPECT_NE(fault.find(must_fail->second), std::string::npos) << scene << ": " << fault;
      ++loaded;
    }
  }
  EXPECT_GT(loaded, 150U);
}

/// Why an error of Khronos glTF-Validator does not make relook refuse a file. The first row that fits counts; "" fits
/// all.
struct Reason {
  std::string_view code, pointer, words;
};
constexpr std::array kReasons = {
    Reason{"", "/animations", "animations are not read"},
    Reason{"KHR_ANIMATION_POINTER", "", "animations are not read"},
    Reason{"", "/skins", "a skin's root is of no consequence, and a skin without a mesh shows nothing"},
    Reason{"NODE_SKIN", "", "a mesh without joints keeps its shape, one without a skin its bind pose"},
    Reason{"UNSATISFIED_DEPENDENCY", "/skin", "a skin without a mesh shows nothing"},
    Reason{"", "/JOINTS_", "joints are added up in any order; those of no weight are not looked at"},
    Reason{"", "/WEIGHTS_", "weights are normalized"},
    Reason{"MESH_PRIMITIVE_JOINTS_WEIGHTS", "", "joints without weights are left out"},
    Reason{"", "/targets", "columns of targets that the mesh lacks are left out, as are weights without a target"},
    Reason{"MESH_PRIMITIVES_UNEQUAL_TARGETS", "",
           "columns of targets that the mesh lacks are left out, as are weights without a target"},
    Reason{"", "/weights", "columns of targets that the mesh lacks are left out, as are weights without a target"},
    Reason{"EMPTY_ENTITY", "", "an empty array means the same as none, and exporters write them"},
    Reason{"UNEXPECTED_EXTENSION_OBJECT", "",
           "an extension in a place where it means nothing is ignored like an unknown one"},
    Reason{"ACCESSOR_INVALID_FLOAT", "/accessors", "no mesh reads this accessor"},
    Reason{"ACCESSOR_ELEMENT_OUT_OF", "", "min and max are not read: bounds are computed from the data"},
    Reason{"ACCESSOR_MIN_MISMATCH", "", "min and max are not read: bounds are computed from the data"},
    Reason{"ACCESSOR_MAX_MISMATCH", "", "min and max are not read: bounds are computed from the data"},
    Reason{"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "",
           "min and max are not read: bounds are computed from the data"},
    Reason{"BUFFER_DATA_URI_MIME_TYPE_INVALID", "", "the media type of a buffer changes nothing about its bytes"},
    Reason{"BUFFER_VIEW_INVALID_BYTE_STRIDE", "",
           "`target` is a hint for graphics hardware; no accessor uses the view"},
    Reason{"INVALID_URI", "/images", "images are recognised by their content; nothing draws this one"},
    Reason{"IMAGE_MIME_TYPE_INVALID", "", "images are recognised by their content"},
    Reason{"ONE_OF_MISMATCH", "/images", "an image without data that no texture names; refused where one does"},
    Reason{"IMAGE_DATA_INVALID", "", "no texture names the image; refused where one does"},
    Reason{"IMAGE_UNEXPECTED_EOS", "", "no texture names the image; refused where one does"},
    Reason{"IMAGE_NON_ENABLED_MIME_TYPE", "", "no texture names the image; refused where one does"},
    Reason{"MESH_PRIMITIVE_INVALID_ATTRIBUTE", "", "unknown attributes are ignored"},
    Reason{"MESH_PRIMITIVE_INDEXED_SEMANTIC", "", "the sets that relook reads (0 and 1) are found by name"},
    Reason{"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", "", "application-specific attributes are ignored"},
    Reason{"ACCESSOR_INDEX_PRIMITIVE_RESTART", "", "a restart value begins a new strip, with a warning"},
    Reason{"ACCESSOR_INVALID_SIGN", "/TANGENT", "tangents follow from the texture coordinates then, with a warning"},
    Reason{"ACCESSOR_VECTOR3_NON_UNIT", "", "normals and tangents are made unit vectors"},
    Reason{"ACCESSOR_NON_CLAMPED", "/COLOR_0", "vertex colours are clamped to 0..1"},
    Reason{"ROTATION_NON_UNIT", "", "rotations are normalised; only zero is refused"},
    Reason{"DUPLICATE_ELEMENTS", "/extensions", "naming an extension twice says nothing new"},
    Reason{"TYPE_MISMATCH", "/extensions/", "extensions that relook does not know are ignored"},
    Reason{"UNDECLARED_EXTENSION", "", "extensions that relook does not know are ignored, declared or not"},
    Reason{"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "", "a mesh without that uv set is mapped by position instead"},
    Reason{"MESH_PRIMITIVE_NO_TANGENT_SPACE", "", "tangents are derived from uv, or from the normal without uv"},
    Reason{"UNDEFINED_PROPERTY", "/extensions/KHR_lights_punctual",
           "no list of lights means no lights; a node that names one is refused"},
    Reason{"UNDEFINED_PROPERTY", "/extensions/KHR_materials_variants",
           "no list of variants means none; a mapping that names one is refused"},
    Reason{"IO_ERROR", "/buffers", "no buffer view names the missing file; refused where one does"},
    Reason{"IO_ERROR", "/images", "nothing shows the missing image; refused where something does"},
    Reason{"", "/cameras", "no node of the scene holds the camera; refused where one does"},
    Reason{"INVALID_JSON", "", "a byte order mark before the text changes nothing, with a warning"},
    Reason{"MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "", "the mesh is not shown; refused where it is"},
    Reason{"MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", "", "the mesh is not shown; refused where it is"},
    Reason{"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "", "the mesh is not shown; refused where it is"},
    Reason{"SCENE_NON_ROOT_NODE", "", "a root that is a child stands below its parent, with a warning"},
    Reason{"TEXTURE_INVALID_IMAGE_MIME_TYPE", "", "images are recognised by their content"},
    Reason{"", "/extensions/KHR_lights_punctual", "no node of the scene has the light; refused where one does"},
    Reason{"VALUE_NOT_IN_RANGE", "/materials", "nothing of the scene has the material; refused where something does"},
    Reason{"NON_REQUIRED_EXTENSION", "", "quantized attributes are read whether or not the extension is required"},
};

/// What the validator calls errors: one sentence each, code and reason, without repetition.
std::pair<std::string, std::string> codes_and_reasons(const Json& report, const fs::path& file) {
  std::set<std::string> codes, reasons;
  for (const Json& message : report.at("issues").at("messages")) {
    if (message.at("severity") != 0) continue;
    const std::string code = message.at("code"), pointer = message.value("pointer", "");
    const auto reason = std::ranges::find_if(kReasons, [&](const Reason& row) {
      return code.starts_with(row.code) && pointer.find(row.pointer) != std::string::npos;
    });
    EXPECT_NE(reason, kReasons.end()) << file << " is accepted, but nothing says why " << code << " at " << pointer
                                      << " is fine";
    codes.insert(code);
    if (reason != kReasons.end()) reasons.insert(std::string(reason->words));
  }
  const auto joined = [](const std::set<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
    return text;
  };
  return {joined(codes), joined(reasons)};
}

TEST_F(Corpus, accepted_errors_of_the_validator_are_listed_with_reasons) {
  const fs::path root = kAssets / "bad-input-validator";
  std::string table =
      "# Files that Khronos glTF-Validator calls wrong and relook accepts\n\n"
      "Below `../shared/assets/bad-input-validator`. Checked by `tests/scene/corpus_test.cpp`, which prints the right table "
      "when "
      "this one is not.\n\n"
      "| file | what the validator says | why relook accepts it |\n|---|---|---|\n";
  std::size_t accepted = 0, refused = 0;
  for (const fs::path& scene : scenes_below(root)) {
    const Bytes bytes = read_file(scene.string() + ".report.json");
    const Json report = parse_json(text_of(bytes), "report");
    if (report.at("issues").at("numErrors") == 0) continue;
    if (!import_fault(scene).empty()) {
      ++refused;
      continue;
    }
    ++accepted;
    const auto [codes, reasons] = codes_and_reasons(report, scene);
    table += "| " + scene.lexically_relative(root).string() + " | " + codes + " | " + reasons + " |\n";
  }
  table += "\n" + std::to_string(accepted) + " accepted, " + std::to_string(refused) + " refused.\n";
  const fs::path listed = fs::path(RELOOK_SOURCE_DIR) / "tests" / "bad-input-accepted.md";
  const Bytes written = fs::exists(listed) ? read_file(listed) : Bytes();
  if (text_of(written) == table) return;
  const fs::path right = fs::path(testing::TempDir()) / "bad-input-accepted.md";
  write_file(right, table);
  ADD_FAILURE() << listed << " is out of date; the right table is in " << right;
}

}  // namespace
}  // namespace relook
