// An edit written as JSON goes in; its refusal comes out, and a test fails where a refused edit has left a trace.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "edit/apply.h"
#include "look_fixture.h"

namespace relook {

/// What the look document says at a pointer.
inline Json look_at(const SceneState& state, const std::string& pointer) {
  return state.document().look.at(Json::json_pointer(pointer));
}

/// The message of a refused edit; the state must be exactly as before.
inline std::string refusal(SceneState& state, const std::string& edit) {
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  const SlotCounts counts = state.slot_counts();
  const std::size_t meshes = state.document().assets->meshes.size();
  std::string message = message_of([&] { (void)apply_json(state, edit); });
  EXPECT_NE(message, "") << edit;
  EXPECT_EQ(state.document().look, look) << edit;
  EXPECT_EQ(scene_text(state.scene()), scene) << edit;
  EXPECT_EQ(state.slot_counts().objects, counts.objects);
  EXPECT_EQ(state.slot_counts().materials, counts.materials);
  EXPECT_EQ(state.slot_counts().lights, counts.lights);
  EXPECT_EQ(state.document().assets->meshes.size(), meshes);
  const std::string prefix = "j.json: ";
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}
/// Of the small scene.
inline std::string refusal(const std::string& edit) {
  SceneState state = small_state();
  return refusal(state, edit);
}

}  // namespace relook
