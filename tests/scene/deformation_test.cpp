// Morph targets and skins: formulas of glTF 2.0 against a plain evaluation of them, files and caches that are wrong,
// and what edits of joints, weights and skins mean.
#include "scene/compile/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "cache/scene_parts.h"
#include "edit/apply.h"
#include "random_changes.h"
#include "test_scenes.h"

namespace relook {
namespace {

Edit edit_text(const std::string& text) { return parsed_edit(text); }

Point random_point(Dice& dice) {
  return Point(static_cast<float>(dice.between(-2, 2)), static_cast<float>(dice.between(-2, 2)),
               static_cast<float>(dice.between(-2, 2)));
}

/// 40 vertices, three targets, eight influences of five joints.
Mesh random_mesh(Dice& dice) {
  Mesh mesh;
  constexpr std::size_t kVertices = 40, kInfluences = 8, kJoints = 5;
  mesh.targets.resize(3);
  for (std::size_t i = 0; i < kVertices; ++i) {
    mesh.positions.push_back(random_point(dice));
    mesh.normals.push_back((random_point(dice) + Point(0, 5, 0)).normalized());
    const Direction tangent = (random_point(dice) + Point(5, 0, 0)).normalized();
    mesh.tangents.emplace_back(tangent.x, tangent.y, tangent.z, i % 2 == 0 ? 1.0F : -1.0F);
    for (MorphTarget& target : mesh.targets) {
      target.positions.push_back(random_point(dice));
      target.normals.push_back(random_point(dice) * 0.2F);
      target.tangents.push_back(random_point(dice) * 0.2F);
    }
    std::vector<float> weights(kInfluences);
    float sum = 0;
    for (float& weight : weights) sum += weight = static_cast<float>(dice.between(0, 1));
    for (const float weight : weights) {
      mesh.joints.push_back(static_cast<std::uint16_t>(dice.below(kJoints)));
      mesh.joint_weights.push_back(weight / sum);
    }
    if (i >= 2) mesh.triangles.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i - 1), 0});
  }
  mesh.targets[1].normals.clear();
  return mesh;
}

/// Near the identity, or near its mirror image.
Transform random_joint(Dice& dice, bool mirrored) {
  Transform joint;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column) joint[row][column] += static_cast<float>(dice.between(-0.15, 0.15));
  if (mirrored) joint[0][0] -= 2;
  return joint;
}

Deformation random_pose(Dice& dice, bool mirrored) {
  Deformation pose;
  pose.weights = {0.5F, -0.25F, 1.5F};
  for (int i = 0; i < 5; ++i) pose.joints.push_back(random_joint(dice, mirrored));
  return pose;
}

/// Sections 3.7.2.2 and 3.7.3.3, one vertex at a time, with matrices of 16 doubles and a real inverse.
struct Expected {
  Imath::V3d position, normal, tangent;
};
Expected expected_vertex(const Mesh& mesh, const Deformation& pose, std::size_t vertex) {
  Imath::V3d p(mesh.positions[vertex]), n(mesh.normals[vertex]),
      t(Imath::V3f(mesh.tangents[vertex].x, mesh.tangents[vertex].y, mesh.tangents[vertex].z));
  for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
    const auto weight = static_cast<double>(pose.weights[k]);
    p += weight * Imath::V3d(mesh.targets[k].positions[vertex]);
    if (!mesh.targets[k].normals.empty()) n += weight * Imath::V3d(mesh.targets[k].normals[vertex]);
    t += weight * Imath::V3d(mesh.targets[k].tangents[vertex]);
  }
  Imath::M44d sum(0.0);
  const std::size_t influences = mesh.joints.size() / mesh.positions.size();
  for (std::size_t i = vertex * influences; i < (vertex + 1) * influences; ++i)
    sum += Imath::M44d(pose.joints[mesh.joints[i]]) * static_cast<double>(mesh.joint_weights[i]);
  Expected expected;
  sum.multVecMatrix(p, expected.position);
  sum.inverse().transposed().multDirMatrix(n, expected.normal);
  sum.multDirMatrix(t, expected.tangent);
  expected.normal.normalize();
  expected.tangent.normalize();
  return expected;
}

TEST(Deformation, is_what_the_formulas_of_the_specification_give) {
  Dice dice(7);
  for (const bool mirrored : {false, true}) {
    const Mesh mesh = random_mesh(dice);
    const Deformation pose = random_pose(dice, mirrored);
    const Mesh result = deformed(mesh, pose);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Expected expected = expected_vertex(mesh, pose, i);
      const Imath::V4f& tangent = result.tangents[i];
      EXPECT_LT((Imath::V3d(result.positions[i]) - expected.position).length(), 2e-6) << i;
      EXPECT_LT((Imath::V3d(result.normals[i]) - expected.normal).length(), 1e-6) << i;
      EXPECT_LT((Imath::V3d(Imath::V3f(tangent.x, tangent.y, tangent.z)) - expected.tangent).length(), 1e-6) << i;
      EXPECT_EQ(tangent.w, mirrored ? -mesh.tangents[i].w : mesh.tangents[i].w);
      EXPECT_TRUE(result.bounds.intersects(result.positions[i]));
    }
    // What a mirror turns inside out is wound the other way: the outside stays outside.
    EXPECT_EQ(result.triangles[3][1], mesh.triangles[3][mirrored ? 2 : 1]);
    EXPECT_TRUE(result.targets.empty() && result.joints.empty());
  }
}

TEST(Deformation, of_nothing_is_none) {
  Dice dice(3);
  const Mesh mesh = random_mesh(dice);
  EXPECT_FALSE(deformation_of(mesh, nullptr, {}));
  const Json zeros = {0, 0, 0}, beyond = {0, 0, 0, 5}, one = {0, 2};
  EXPECT_FALSE(deformation_of(mesh, &zeros, {}));
  EXPECT_FALSE(deformation_of(mesh, &beyond, {}));
  EXPECT_EQ((*deformation_of(mesh, &one, {})).weights, (std::vector<float>{0, 2}));
  EXPECT_TRUE(deformation_of(mesh, &one, {}) == deformation_of(mesh, &one, {}));
}

/// Geometry as a cache keeps it, spoilt before it is written.
std::string damage_of(const std::function<void(LookDocument&)>& spoil) {
  const SceneState state = puppet_scene(16, 16);
  LookDocument document = state.document();
  document.assets = std::make_shared<Assets>(*state.document().assets);
  spoil(document);
  const CacheIdentity identity{std::string(32, '0'), std::string(32, '0')};
  LookDocument read;
  read.assets = std::make_shared<Assets>();
  try {
    decode_geometry(encode_geometry(document, identity), identity, read, *read.assets);
  } catch (const CacheDamage& damage) {
    return damage.what();
  }
  const Mesh &before = document.assets->meshes[1], &after = read.assets->meshes[1];
  EXPECT_EQ(before.targets, after.targets);
  EXPECT_EQ(before.joints, after.joints);
  EXPECT_EQ(before.joint_weights, after.joint_weights);
  EXPECT_EQ(document.inverse_binds, read.inverse_binds);
  return "sound";
}

TEST(DeformingCaches, come_back_as_written_and_are_checked) {
  EXPECT_EQ(damage_of([](LookDocument&) {}), "sound");
  const auto expect = [](const std::string& part, const std::function<void(Mesh&)>& spoil) {
    const std::string found = damage_of([&](LookDocument& document) { spoil(document.assets->meshes[1]); });
    EXPECT_NE(found.find(part), std::string::npos) << found;
  };
  expect("a morph target that is not as long as mesh Ball", [](Mesh& mesh) { mesh.targets[0].positions.pop_back(); });
  expect("joints that do not fit mesh Ball", [](Mesh& mesh) { mesh.joints.pop_back(), mesh.joint_weights.pop_back(); });
  expect("not finite in section joint_weights", [](Mesh& mesh) { mesh.joint_weights[3] = NAN; });
  expect("a weight of a joint that is out of range", [](Mesh& mesh) { mesh.joint_weights[3] = -1; });
  expect("section joint_weights is too short", [](Mesh& mesh) { mesh.joint_weights.pop_back(); });
  expect("not finite in section target_normals", [](Mesh& mesh) { mesh.targets[0].normals[2].y = INFINITY; });
}

/// A look document of a cache is compiled: what its geometry does not bear out is found there.
TEST(DeformingCaches, whose_skins_and_joints_disagree_are_refused) {
  const SceneState state = puppet_scene(16, 16);
  const auto message = [&](const std::function<void(LookDocument&)>& spoil) {
    LookDocument document = state.document();
    document.assets = std::make_shared<Assets>(*state.document().assets);
    spoil(document);
    try {
      SceneState(std::move(document), state.scene().camera, state.pyramids());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](LookDocument& d) { d.assets->meshes[1].joints[0] = 2; }).find("the mesh names joint 2"),
            std::string::npos);
  EXPECT_NE(message([](LookDocument& d) {
              d.inverse_binds.begin()->second.pop_back();
            }).find("/skins/Puppet/joints: there are 2 joints for 1 inverse bind matrices"),
            std::string::npos);
  EXPECT_NE(message([](LookDocument& d) { d.inverse_binds.clear(); }).find("no inverse bind matrices"),
            std::string::npos);
}

TEST(DeformingEdits, say_what_they_do) {
  SceneState state = puppet_scene(16, 16);
  const auto reasons = [&](const std::string& text) {
    const SceneDelta delta = apply_edit(state, edit_text(text), "j.json", ".");
    const Classification found = classify(state.scene(), delta);
    EXPECT_EQ(found.change, ChangeClass::geometric);
    return found.reasons;
  };
  EXPECT_EQ(reasons(R"([{"op": "replace", "path": "/nodes/Ball/weights/1", "value": 1}])"),
            std::vector<std::string>{"node Ball: morph weights changed"});
  EXPECT_EQ(reasons(R"([{"op": "replace", "path": "/nodes/Hip/scale", "value": [1, 2, 1]}])"),
            std::vector<std::string>{"node Ball: its joints are transformed"});
  // The transform of a skinned node counts for nothing.
  EXPECT_TRUE(apply_edit(state, edit_text(R"([{"op": "replace", "path": "/nodes/Ball/scale", "value": [1, 2, 1]}])"),
                         "j.json", ".")
                  .empty());
}

TEST(DeformingEdits, keep_skins_and_joints_together) {
  SceneState state = puppet_scene(16, 16);
  const auto refusal = [&](const std::string& text) {
    try {
      (void)apply_edit(state, edit_text(text), "j.json", ".");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(
      refusal(R"([{"op": "remove", "path": "/nodes/Chest"}])").find("node \"Chest\" is still used by skin \"Puppet\""),
      std::string::npos);
  EXPECT_NE(refusal(R"([{"op": "remove", "path": "/nodes/Rig"}])"), "");
  EXPECT_NE(refusal(R"([{"op": "replace", "path": "/skins/Puppet/joints", "value": ["Hip"]}])")
                .find("there are 1 joints for 2 inverse bind matrices"),
            std::string::npos);
  const Json look = state.document().look;
  EXPECT_EQ(refusal(R"([{"op": "move", "from": "/nodes/Chest", "path": "/nodes/Thorax"}])"), "");
  EXPECT_EQ(state.document().look["skins"]["Puppet"]["joints"], Json::array({"Hip", "Thorax"}));
  EXPECT_EQ(refusal(R"([{"op": "move", "from": "/nodes/Thorax", "path": "/nodes/Chest"}])"), "");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/nodes/Ball"}, {"op": "remove", "path": "/nodes/Rig"}])"), "");
  EXPECT_TRUE(state.document().look["skins"].empty());
}

}  // namespace
}  // namespace relook
