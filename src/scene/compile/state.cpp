#include "scene/compile/state.h"

#include <utility>

#include "base/parallel.h"
#include "scene/compile/compile_scene.h"
#include "scene/look/look_check.h"
#include "scene/look/look_schema.h"

namespace relook {

namespace {

/// All entities of the document, checked before any is compiled, since materials read textures, and textures images.
std::vector<CompiledEntity> checked_entities(const LookDocument& document) {
  std::vector<CompiledEntity> entities = all_entities(document);
  for (const CompiledEntity& entity : entities) {
    check_entity_name(entity.place, document.file);
    check_entity(document, entity.place, *entity.value, document.file);
  }
  return entities;
}

/// Compiles a whole document. `scene` has its integrator, its assets and its camera, and nothing else; `index` is
/// empty.
void compile_all(const LookDocument& document, PyramidStore& pyramids, Scene& scene, SceneIndex& index) {
  const std::vector<CompiledEntity> entities = checked_entities(document);
  decode_images(document, pyramids);
  // The default material comes after those of the document.
  const std::size_t count = document.look.at("materials").size();
  index.default_material = MaterialId(static_cast<std::uint32_t>(count));
  const std::size_t nodes = document.look.at("nodes").size();
  index.nodes.reserve(nodes);
  index.objects.reserve(nodes);
  index.references.reserve(nodes);
  scene.objects.reserve(nodes);  // one a node, most often
  std::vector<CompiledEntity> materials, others;
  for (const CompiledEntity& entity : entities)
    (entity.place.section == "materials" ? materials : others).push_back(entity);
  Compilation(document, pyramids, scene, index, document.file).run_first(materials);
  scene.materials.emplace_back();
  Compilation(document, pyramids, scene, index, document.file).run_first(others);
  index.first_objects = scene.objects.size();
}

}  // namespace

struct SceneState::Index : SceneIndex {};

SceneState::SceneState(LookDocument document, Camera camera, std::shared_ptr<PyramidStore> pyramids,
                       Integrator integrator)
    : document_(std::move(document)), pyramids_(std::move(pyramids)), index_(std::make_shared<Index>()) {
  set_float_mode();
  if (pyramids_ == nullptr) pyramids_ = std::make_shared<PyramidStore>();
  scene_.integrator = integrator;
  scene_.assets = document_.assets;
  scene_.camera = std::move(camera);
  check_sections(document_, document_.file);
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    for (Json& value : document_.look.at(std::string(section_name(section)))) fill_defaults(section, value);
  }
  fill_from_schema(scene_schema(), document_.look.at("scene"));
  compile_all(document_, *pyramids_, scene_, *index_);
}

std::string SceneState::parent_of(std::string_view node) const {
  const auto found = index_->nodes.find(std::string(node));
  return found == index_->nodes.end() ? "" : found->second.parent;
}

SlotCounts SceneState::slot_counts() const {
  return {scene_.materials.size(), scene_.objects.size(), scene_.lights.size()};
}

void SceneState::drop_slots_after(const SlotCounts& counts) {
  for (std::size_t i = counts.materials; i < scene_.materials.size(); ++i)
    index_->materials.erase(scene_.materials[i].name);
  for (std::size_t i = counts.objects; i < scene_.objects.size(); ++i) index_->objects.erase(scene_.objects[i].key);
  for (std::size_t i = counts.lights; i < scene_.lights.size(); ++i) index_->forget(scene_.lights[i]);
  scene_.materials.resize(counts.materials);
  scene_.objects.resize(counts.objects);
  scene_.lights.resize(counts.lights);
}

SceneDelta SceneState::recompile(const std::vector<TouchedEntity>& touched, std::string_view file) {
  set_float_mode();
  return Compilation(document_, *pyramids_, scene_, *index_, file).run(touched);
}

Scene compiled_scene(const LookDocument& document, const Camera& camera, PyramidStore& pyramids,
                     Integrator integrator) {
  set_float_mode();
  Scene scene;
  scene.integrator = integrator;
  scene.assets = document.assets;
  scene.camera = camera;
  SceneIndex index;
  compile_all(document, pyramids, scene, index);
  return scene;
}

}  // namespace relook
