// What makes two scenes one: a cache is of the bytes of its scene file and of all that lies beside it, columns of
// morph targets included, whether a pixel shows them yet or not.
#include <gtest/gtest.h>

#include "base/files.h"
#include "gltf_writer.h"
#include "places.h"
#include "run_program.h"

namespace relook {
namespace {

/// A triangle with a morph target that is not applied yet; its numbers lie in a file of their own.
SceneFile morphed_triangle(float lift) {
  SceneFile file;
  const std::size_t positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::size_t target = file.floats({0, 0, lift, 0, 0, lift, 0, 0, lift}, "VEC3", 3);
  for (const std::size_t accessor : {positions, target}) {
    file.gltf["accessors"][accessor]["min"] = {0, 0, 0};
    file.gltf["accessors"][accessor]["max"] = {1, 1, 1};
  }
  file.gltf["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", target}}}}}}},
       {"weights", {0}}}};
  file.gltf["nodes"] = {{{"name", "Triangle"}, {"mesh", 0}}};
  file.gltf["scenes"] = {{{"nodes", {0}}}};
  file.gltf["scene"] = 0;
  file.gltf["buffers"] = {{{"byteLength", file.binary.size()}, {"uri", "numbers.bin"}}};
  return file;
}

TEST(SceneHash, follows_morph_targets_that_lie_in_another_file) {
  const ScratchFolder folder("scene_hash");
  const auto preprocess = [&] {
    return run_program({RELOOK_PROGRAM, "preprocess", (folder / "scene.gltf").string(), "-o", (folder / "c").string(),
                        "--resolution", "16x16", "--camera", "auto", "--lights", "auto", "--progress", "none"});
  };
  const SceneFile first = morphed_triangle(0.25F), second = morphed_triangle(0.5F);
  ASSERT_EQ(first.gltf, second.gltf);
  write_file(folder / "scene.gltf", first.gltf.dump());
  write_file(folder / "numbers.bin", first.binary);
  const ProgramResult made = preprocess();
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_NE(preprocess().output.find("complete already"), std::string::npos);
  write_file(folder / "numbers.bin", second.binary);
  const ProgramResult other = preprocess();
  EXPECT_EQ(other.exit_code, 1) << other.output;
  EXPECT_NE(other.output.find("another scene"), std::string::npos) << other.output;
}

}  // namespace
}  // namespace relook
