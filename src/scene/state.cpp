#include "scene/state.h"

#include <utility>

#include "base/parallel.h"
#include "scene/compile_scene.h"
#include "scene/look_schema.h"

namespace relook {

struct SceneState::Index : SceneIndex {};

SceneState::SceneState(LookDocument document, Camera camera, std::shared_ptr<PyramidStore> pyramids)
    : document_(std::move(document)), pyramids_(std::move(pyramids)), index_(std::make_shared<Index>()) {
  set_float_mode();
  if (pyramids_ == nullptr) pyramids_ = std::make_shared<PyramidStore>();
  scene_.assets = document_.assets;
  scene_.camera = std::move(camera);
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    for (Json& value : document_.look.at(std::string(section_name(section)))) fill_defaults(section, value);
  }
  fill_from_schema(scene_schema(), document_.look.at("scene"));
  decode_images(document_, *pyramids_);
  // The default material comes after those of the document.
  const std::size_t count = document_.look.at("materials").size();
  index_->default_material = MaterialId(static_cast<std::uint32_t>(count));
  const std::size_t nodes = document_.look.at("nodes").size();
  index_->nodes.reserve(nodes);
  index_->objects.reserve(nodes);
  index_->references.reserve(nodes);
  scene_.objects.reserve(nodes);  // one a node, most often
  std::vector<CompiledEntity> materials, others;
  for (CompiledEntity& entity : all_entities(document_))
    (entity.place.section == "materials" ? materials : others).push_back(std::move(entity));
  Compilation(document_, *pyramids_, scene_, *index_, document_.file).run_first(materials);
  scene_.materials.emplace_back();
  Compilation(document_, *pyramids_, scene_, *index_, document_.file).run_first(others);
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
  for (std::size_t i = counts.lights; i < scene_.lights.size(); ++i) index_->lights.erase(scene_.lights[i].node);
  scene_.materials.resize(counts.materials);
  scene_.objects.resize(counts.objects);
  scene_.lights.resize(counts.lights);
}

SceneDelta SceneState::recompile(const std::vector<TouchedEntity>& touched, std::string_view file) {
  set_float_mode();
  return Compilation(document_, *pyramids_, scene_, *index_, file).run(touched);
}

}  // namespace relook
