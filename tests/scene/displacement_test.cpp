// Displacement maps: vertices move along normals, no cracks open, and the result is the same every time.
#include "scene/compile/displacement.h"

#include <gtest/gtest.h>

#include <map>

#include "look_fixture.h"
#include "scene/texture/procedural.h"

namespace relook {
namespace {

Displacement constant_displacement(float scale, std::int32_t subdivide) {
  Displacement displacement;  // no texture: height 1
  displacement.scale = scale;
  displacement.midlevel = 0.5F;
  displacement.subdivide = subdivide;
  return displacement;
}

/// Two squares at a right angle that share an edge by position but no vertices: flat-shaded.
Mesh folded_mesh() {
  Mesh mesh = square_mesh();
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}});
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  mesh.uv[0].clear();
  return mesh;
}

TEST(Displacement, moves_along_the_normal_by_scale_times_height_minus_midlevel) {
  const Mesh moved = displaced(square_mesh(), constant_displacement(0.4F, 0));
  for (const Point& position : moved.positions) EXPECT_FLOAT_EQ(position.y, 0.2F);
  EXPECT_EQ(moved.bounds.min.y, moved.positions[0].y);
}

TEST(Displacement, subdivision_makes_four_of_one_and_keeps_columns_together) {
  const Mesh fine = displaced(square_mesh(), constant_displacement(0, 2));
  EXPECT_EQ(fine.triangles.size(), 32U);
  EXPECT_EQ(fine.positions.size(), 25U);
  EXPECT_EQ(fine.uv[0].size(), 25U);
  for (std::size_t i = 0; i < fine.positions.size(); ++i) EXPECT_FLOAT_EQ(fine.uv[0][i].x, fine.positions[i].x);
}

TEST(Displacement, a_flat_shaded_mesh_stays_whole_and_flat) {
  const Mesh moved = displaced(folded_mesh(), constant_displacement(1, 3));
  EXPECT_TRUE(moved.normals.empty());
  // Vertices on the shared edge came in pairs, and still do.
  const Mesh still = displaced(folded_mesh(), constant_displacement(0, 3));
  std::map<std::tuple<float, float, float>, Point> moved_to;
  for (std::size_t i = 0; i < still.positions.size(); ++i) {
    const Point& p = still.positions[i];
    const auto [known, is_new] = moved_to.try_emplace({p.x, p.y, p.z}, moved.positions[i]);
    if (!is_new) {
      EXPECT_EQ(known->second, moved.positions[i]);
    }
  }
  EXPECT_LT(moved_to.size(), still.positions.size());
}

TEST(Displacement, a_texture_lifts_what_is_bright) {
  Mesh mesh = square_mesh();
  mesh.normals.assign(4, Normal(0, 1, 0));
  Displacement displacement = constant_displacement(1, 4);
  displacement.texture.kind = TextureKind::procedural;
  displacement.texture.procedural.kind = ProceduralKind::checker;
  displacement.texture.procedural.scale = 4;
  const Mesh moved = displaced(mesh, displacement);
  float low = 1, high = -1;
  for (const Point& position : moved.positions) {
    low = std::min(low, position.y);
    high = std::max(high, position.y);
  }
  EXPECT_FLOAT_EQ(low, -0.5F);
  EXPECT_FLOAT_EQ(high, 0.5F);
  for (const Normal& normal : moved.normals) EXPECT_NEAR(normal.length(), 1, 1e-5);
  const Mesh again = displaced(mesh, displacement);
  EXPECT_EQ(again.positions, moved.positions);
  EXPECT_EQ(again.normals, moved.normals);
}

/// The square, subdivided four times and displaced by a checker of one unit in uv, transformed by `set`.
template <class Set>
Mesh checked_square(const Set& set) {
  Mesh mesh = square_mesh();
  mesh.normals.assign(4, Normal(0, 1, 0));
  mesh.uv[1] = mesh.uv[0];
  for (Uv& uv : mesh.uv[1]) uv = Uv(uv.y * 3, uv.x);
  Displacement displacement = constant_displacement(1, 4);
  displacement.texture.kind = TextureKind::procedural;
  displacement.texture.procedural.kind = ProceduralKind::checker;
  displacement.texture.procedural.scale = 3;
  set(displacement.texture);
  return displaced(mesh, displacement);
}

TEST(Displacement, a_map_is_offset_scaled_and_turned_as_any_texture_is) {
  const Mesh plain = checked_square([](TextureSlot&) {});
  const auto heights_are = [&](const Mesh& mesh, const auto& uv_of) {
    std::size_t lifted = 0;
    Procedural checker;
    checker.kind = ProceduralKind::checker;
    checker.scale = 3;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Uv uv = uv_of(plain.uv[0][i]);
      const float height = evaluate(checker, Point(uv.x, uv.y, 0)).r - 0.5F;
      EXPECT_FLOAT_EQ(mesh.positions[i].y, height) << i;
      lifted += height > 0 ? 1 : 0;
    }
    EXPECT_GT(lifted, 0U);
    EXPECT_LT(lifted, mesh.positions.size());
  };
  heights_are(plain, [](Uv uv) { return uv; });
  heights_are(checked_square([](TextureSlot& slot) {
                slot.offset = {0.21F, 0.4F};
              }),
              [](Uv uv) { return uv + Uv(0.21F, 0.4F); });
  heights_are(checked_square([](TextureSlot& slot) {
                slot.scale = {2, 0.5F};
              }),
              [](Uv uv) { return Uv(uv.x * 2, uv.y * 0.5F); });
  heights_are(checked_square([](TextureSlot& slot) {
                slot.rotation = 1.5707963F;
                slot.offset = {0.01F, 0.01F};
              }),
              [](Uv uv) { return Uv(uv.y + 0.01F, 0.01F - uv.x); });
  heights_are(checked_square([](TextureSlot& slot) { slot.texcoord = 1; }), [](Uv uv) { return Uv(uv.y * 3, uv.x); });
}

TEST(Displacement, too_much_subdivision_is_refused_with_the_edit) {
  LookDocument document = make_look_document(small_gltf());
  document.assets->meshes[0].triangles.resize(kMostDisplacedTriangles / 4096 + 1, {0, 1, 2});
  SceneState state(std::move(document), Camera(), small_pyramids());
  const auto displace = [&](const char* subdivide) {
    return message_of([&] {
      (void)apply_json(state, std::string(R"([{"op": "add", "path": "/nodes/Sphere/extras", "value": {"relook":
          {"displacement": {"texture": "Marble", "subdivide": )") +
                                  subdivide + "}}}}]");
    });
  };
  EXPECT_EQ(displace("5"), "");
  EXPECT_EQ(displace("6"), "j.json: /edit/0/value/relook/displacement/subdivide: this makes too many triangles");
  EXPECT_EQ(displace("7"), "j.json: /edit/0/value/relook/displacement/subdivide: 7 is above 6");
}

}  // namespace
}  // namespace relook
