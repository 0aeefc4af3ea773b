// A look document and the scene compiled from it, kept in step: after an edit only the entities that it touched, and
// their users, are compiled again, and the result equals a compilation from scratch up to the order of ids. Made when a
// scene or a cache is opened (cli/input/), owned by the Replayer while it replays, changed by edit/ alone.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/look/look.h"
#include "scene/scene.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {

/// One entry of the look document that an edit touched: ("materials", "Gold"), or ("scene", "").
struct TouchedEntity {
  std::string section, name;
  auto operator<=>(const TouchedEntity&) const = default;
};

/// Lengths of the scene's tables, dead slots included.
struct SlotCounts {
  std::size_t materials = 0, objects = 0, lights = 0;
};

class SceneState {
 public:
  /// Compiles the whole document. Throws InputError{document.file, pointer, ...}.
  SceneState(LookDocument document, Camera camera, std::shared_ptr<PyramidStore> pyramids,
             Integrator integrator = Integrator::whitted);
  SceneState(SceneState&&) noexcept = default;
  SceneState& operator=(SceneState&&) noexcept = default;
  SceneState(const SceneState&) = delete;  // two states must not edit one set of assets
  SceneState& operator=(const SceneState&) = delete;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const LookDocument& document() const { return document_; }
  [[nodiscard]] const std::shared_ptr<PyramidStore>& pyramids() const { return pyramids_; }

  /// The node that has `node` among its children, as of the last compilation; "" for roots and unknown nodes.
  [[nodiscard]] std::string parent_of(std::string_view node) const;

  /// For edit/ alone: the document to patch in place before recompile().
  [[nodiscard]] LookDocument& editable_document() { return document_; }

  /// Compiles what was touched. Throws InputError{file, pointer, ...} and leaves the scene as it was (the document is
  /// the caller's to restore). An edit that moves or hides the active camera is an error.
  SceneDelta recompile(const std::vector<TouchedEntity>& touched, std::string_view file);

  [[nodiscard]] SlotCounts slot_counts() const;
  /// After a rehearsal of edits that were undone again: drops the slots that these have added since slot_counts() gave
  /// `counts`. Requires: the slots are dead.
  void drop_slots_after(const SlotCounts& counts);

 private:
  LookDocument document_;
  std::shared_ptr<PyramidStore> pyramids_;
  Scene scene_;
  struct Index;  // the compiler's SceneIndex (compile_scene.h)
  std::shared_ptr<Index> index_;
};

/// Compiles a document that has all its defaults, such as a SceneState's, from scratch and without a copy of it. The
/// result is the scene that a SceneState keeps up, in other slots perhaps. Throws InputError{document.file, pointer,
/// ...}.
[[nodiscard]] Scene compiled_scene(const LookDocument& document, const Camera& camera, PyramidStore& pyramids,
                                   Integrator integrator = Integrator::whitted);

}  // namespace relook
