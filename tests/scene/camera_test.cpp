// The camera: which one --camera chooses, and the rays that it sends.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "look_fixture.h"

namespace relook {
namespace {

LookDocument small_document() { return make_look_document(small_gltf()); }

/// Image position of a world point, in pixels.
std::pair<float, float> projected(const Camera& camera, const Point& point) {
  const Direction d(WidePoint(point) - camera.eye);
  const float depth = d.dot(camera.forward);
  return {(d.dot(camera.right) / depth / camera.half_width + 1) / 2 * static_cast<float>(camera.width),
          (1 - d.dot(camera.up) / depth / camera.half_height) / 2 * static_cast<float>(camera.height)};
}

TEST(Camera, is_found_by_its_own_name_by_its_node_and_without_a_name) {
  for (const char* choice : {"Lens", "Eye", ""}) {
    const Camera camera = choose_camera(small_document(), choice, 64, 32);
    EXPECT_EQ(camera.node, "Eye") << choice;
    EXPECT_EQ(camera.eye, WidePoint(0, 1, 6));
    EXPECT_EQ(camera.forward, Direction(0, 0, -1));
    EXPECT_EQ(camera.right, Direction(1, 0, 0));
    EXPECT_FLOAT_EQ(camera.half_height, std::tan(0.4F));
    EXPECT_FLOAT_EQ(camera.half_width, 2 * std::tan(0.4F));
    EXPECT_FLOAT_EQ(camera.near, 0.1F);
  }
}

TEST(Camera, an_unknown_name_suggests_the_nearest) {
  EXPECT_EQ(message_of([] { (void)choose_camera(small_document(), "Lense", 8, 8); }),
            "small.gltf: no camera \"Lense\"; did you mean \"Lens\"? (--camera auto frames the scene)");
}

TEST(Camera, a_scene_without_one_names_the_flag) {
  LookDocument document = small_document();
  document.look["nodes"]["Eye"].erase("camera");
  document.cameras = Json::object();
  EXPECT_EQ(message_of([&] { (void)choose_camera(document, "", 8, 8); }),
            "small.gltf: the scene has no camera; --camera auto frames the scene");
}

TEST(Camera, eye_target_and_angle) {
  const Camera camera = choose_camera(small_document(), "0,0,5:0,0,0:90", 100, 50);
  EXPECT_EQ(camera.node, "");
  EXPECT_EQ(camera.eye, WidePoint(0, 0, 5));
  EXPECT_EQ(camera.forward, Direction(0, 0, -1));
  EXPECT_FLOAT_EQ(camera.half_height, 1);
  EXPECT_FLOAT_EQ(camera.half_width, 2);
}

TEST(Camera, straight_down_has_an_up) {
  const Camera camera = choose_camera(small_document(), "0,5,0:0,0,0:40", 10, 10);
  EXPECT_EQ(camera.forward, Direction(0, -1, 0));
  EXPECT_EQ(camera.up, Direction(0, 0, -1));
}

TEST(Camera, wrong_eye_target_angle_is_a_usage_error) {
  for (const char* choice : {"1,2:0,0,0:40", "0,0,5:0,0,0:", "0,0,5:0,0,5:40", "0,0,5:0,0,0:180", "a:b:c",
                             "0,0,5:0,0,0:40x", "0,0,1e999:0,0,0:40", "nan,0,0:0,0,1:40"})
    EXPECT_THROW((void)choose_camera(small_document(), choice, 8, 8), UsageError) << choice;
}

TEST(Camera, auto_sees_every_corner_of_the_scene_and_fills_the_frame) {
  for (const auto& [width, height] : {std::pair{64U, 64U}, std::pair{192U, 64U}, std::pair{40U, 160U}}) {
    LookDocument document = small_document();
    const Camera camera = choose_camera(document, "auto", width, height);
    const SceneState state(std::move(document), camera, small_pyramids());
    float reach = 0;
    for (const Object& object : state.scene().objects)
      for (const Point& position : state.scene().mesh(object.mesh).positions) {
        const auto [x, y] = projected(camera, position * object.to_world);
        EXPECT_TRUE(x >= 0 && x <= static_cast<float>(width) && y >= 0 && y <= static_cast<float>(height))
            << object.node << " at " << x << ", " << y;
        reach = std::max(
            {reach, std::abs(x / static_cast<float>(width) - 0.5F), std::abs(y / static_cast<float>(height) - 0.5F)});
      }
    EXPECT_GT(reach, 0.3F);
  }
}

TEST(CameraRay, the_middle_looks_forward_and_the_corners_span_the_angle) {
  const Camera camera = choose_camera(small_document(), "0,0,5:0,0,0:90", 100, 50);
  EXPECT_EQ(camera_ray(camera, 50, 25).direction, Direction(0, 0, -1));
  const CameraRay corner = camera_ray(camera, 0, 0);
  EXPECT_NEAR(corner.direction.x / -corner.direction.z, -2, 1e-6);
  EXPECT_NEAR(corner.direction.y / -corner.direction.z, 1, 1e-6);
  EXPECT_NEAR(corner.direction.length(), 1, 1e-6);
  EXPECT_FLOAT_EQ(corner.spread, 2.0F / 50);
  EXPECT_EQ(corner.width, 0);
}

TEST(CameraRay, orthographic_rays_are_parallel) {
  ImportedGltf imported = small_gltf();
  imported.gltf["cameras"][0] = {{"name", "Lens"},
                                 {"type", "orthographic"},
                                 {"orthographic", {{"xmag", 9}, {"ymag", 2}, {"zfar", 10}, {"znear", 0}}}};
  const Camera camera = choose_camera(make_look_document(std::move(imported)), "Lens", 100, 50);
  const CameraRay left = camera_ray(camera, 0, 25), middle = camera_ray(camera, 50, 25);
  EXPECT_EQ(left.direction, middle.direction);
  EXPECT_EQ(left.origin, Point(-9, 0, 0)) << "from the eye; wide enough for xmag, and so higher than ymag";
  EXPECT_EQ(left.spread, 0);
  EXPECT_FLOAT_EQ(left.width, 9.0F / 50);
  EXPECT_EQ(left.end, 10);
}

}  // namespace
}  // namespace relook
