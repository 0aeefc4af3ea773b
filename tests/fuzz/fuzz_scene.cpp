// Scene files: imported, made a look document, compiled, small ones rendered; their variants and animations drafted.
#include <cstring>
#include <random>

#include "edit/draft/journal_draft.h"
#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "image/render.h"
#include "libfuzzer_mutate.h"
#include "mutate_json.h"
#include "scene/compile/state.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/import.h"
#include "scene/look/look.h"

namespace relook {
namespace {

constexpr std::size_t kMostObjects = 64, kMostTriangles = 5000;  // of a scene that is rendered

bool is_small(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Object& object : scene.objects) {
    const auto subdivisions = static_cast<std::size_t>(object.displacement ? object.displacement->subdivide : 0);
    triangles += scene.mesh(object.mesh).triangles.size() << (2 * subdivisions);
  }
  return scene.objects.size() <= kMostObjects && triangles <= kMostTriangles;
}

void use(const std::filesystem::path& file) {
  constexpr std::uint32_t kPixels = 4;
  LookDocument document = make_look_document(import_gltf(file));
  const Camera camera = choose_camera(document, document.cameras.empty() ? "auto" : "", kPixels, kPixels);
  (void)add_auto_lights(document, camera);
  const SceneState state(std::move(document), camera, std::make_shared<PyramidStore>());
  const std::initializer_list<ExitCode> codes{ExitCode::bad_input};
  is_answered(codes, [&] { (void)journal_text(draft_variants(state.document())); });
  is_answered(codes, [&] {
    for (const Animation& animation : import_animations(file))
      is_answered(codes, [&] { (void)journal_text(draft_animation(state, animation, {2, 0, 2})); });
  });
  if (!is_small(state.scene())) return;
  RenderStats stats;
  (void)render(state.scene(), {1, 4, 0}, stats);
}

constexpr std::size_t kGlbHeader = 20;  // up to the JSON

std::uint32_t word_at(BytesView bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

/// A .glb of what a scene file consists of.
std::string glb(std::string json, BytesView binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  const auto add_word = [&](std::size_t word) {
    const auto value = static_cast<std::uint32_t>(word);
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add_word(2);
  add_word(kGlbHeader + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
  add_word(json.size());
  file += "JSON" + json;
  if (binary.empty()) return file;
  add_word(binary.size());
  file.append("BIN\0", 4).append(text_of(binary));
  return file;
}

}  // namespace

int fuzz_scene(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  static const FuzzFolder folder("scene");
  const BytesView bytes = fuzz_bytes(data, size);
  const std::filesystem::path file = folder.path() / (text_of(bytes).starts_with("glTF") ? "scene.glb" : "scene.gltf");
  overwrite_file(file, bytes);
  is_answered({ExitCode::bad_input, ExitCode::out_of_resources}, [&] { use(file); });
  return 0;
}

/// The JSON of a .glb as JSON, its binary chunk as bytes, and the lengths mended.
std::size_t mutate_scene(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  const BytesView bytes = fuzz_bytes(data, size);
  if (size < kGlbHeader || !text_of(bytes).starts_with("glTF")) return mutate_json_text(data, size, most, seed);
  const std::size_t json_bytes = word_at(bytes, 12);
  if (seed % 16 == 0 || json_bytes > size - kGlbHeader) return libfuzzer_mutate(data, size, most);
  std::string json(text_of(bytes.subspan(kGlbHeader, json_bytes)));
  const std::size_t start = kGlbHeader + json_bytes + 8;
  Bytes binary;
  if (start < size) binary.assign(bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end());
  if (seed % 4 == 1 && !binary.empty()) {
    binary.resize(libfuzzer_mutate(reinterpret_cast<std::uint8_t*>(binary.data()), binary.size(), binary.size()));
  } else {
    const std::size_t old_bytes = json.size();
    json.resize(most);
    json.resize(mutate_json_text(reinterpret_cast<std::uint8_t*>(json.data()), old_bytes, most, seed));
  }
  const std::string file = glb(std::move(json), binary);
  if (file.size() > most) return libfuzzer_mutate(data, size, most);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}

}  // namespace relook
