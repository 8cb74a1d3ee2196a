#include "passes/gbuffer.hpp"

#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/boxes.hpp"

namespace brume::passes {
namespace {

constexpr glm::uvec2 kGBufferSize{67, 41};

/// Boxes in front of each other: dull ones, glowing ones, and some that are cut away by their alpha.
scene::Scene boxes() {
  scene::Scene scene;
  scene::Mesh solid;
  render::add_box(solid, glm::vec3(-0.5f), glm::vec3(0.5f));
  scene::Mesh faded = solid;
  for (std::size_t i = 0; i < faded.vertices.size(); ++i) faded.vertices[i].color.a = i % 4 < 2 ? 1.0f : 0.0f;
  scene.meshes = {solid, faded};
  scene.materials.resize(3);
  scene.materials[0].base_color = {0.2f, 0.6f, 0.9f};
  scene.materials[0].emission = {3, 2, 1};
  scene.materials[1].base_color = {0.9f, 0.3f, 0.1f};
  scene.materials[1].roughness = 0.3f;
  scene.materials[2].alpha_cutoff = 0.5f;
  for (std::uint32_t i = 0; i < 36; ++i) {
    const float angle = 1.1f * static_cast<float>(i), depth = static_cast<float>(i * 7 % 36) * 0.21f;
    glm::mat4 world(1);
    world[1] = {0.3f, 0.9f, 0.2f, 0};
    world[3] = {2.2f * std::cos(angle), 1.4f * std::sin(1.7f * angle), -2.5f - depth, 1};
    scene.objects.push_back({"box", i % 3 == 2 ? 1u : 0u, i % 3, world});
  }
  return scene;
}

/// A camera at the origin that looks along -z.
shared::FrameConstants frame_of() {
  shared::FrameConstants frame{};
  frame.size_px = kGBufferSize;
  shared::Camera& camera = frame.camera;
  camera.near_z = 0.05f;
  camera.forward = {0, 0, -1};
  camera.right = {0.9f, 0, 0};
  camera.up = {0, 0.55f, 0};
  glm::mat4 rows(0);
  rows[0] = {1 / 0.9f, 0, 0, 0};
  rows[1] = {0, -1 / 0.55f, 0, 0};
  rows[2] = {0, 0, 0, camera.near_z};
  rows[3] = {0, 0, -1, 0};
  camera.clip_from_world = glm::transpose(rows);
  return frame;
}

class GBufferTest : public gpu::GpuTest {
 protected:
  struct Texels {
    std::vector<std::uint32_t> albedo_roughness;
    std::vector<Half4> normal_metallic, emission;
    std::vector<float> depth;
    bool operator==(const Texels&) const = default;
    /// Without what is undefined.
    Texels of_surfaces() const {
      Texels texels = *this;
      for (std::size_t i = 0; i < depth.size(); ++i) {
        if (depth[i] > 0) continue;
        texels.albedo_roughness[i] = 0;
        texels.normal_metallic[i] = {};
      }
      return texels;
    }
  };
  static Texels draw(bool depth_first) {
    const SceneResources scene = upload_scene(context(), runner(), boxes());
    const GBufferPass pass(context(), depth_first);
    const GBuffer target(context(), kGBufferSize);
    const shared::FrameConstants constants = frame_of();
    const auto frame = upload(std::vector{constants});
    Draw moving = scene.draws.front();
    moving.world_from_mesh[3] = {0.3f, 0.2f, -3, 1};
    runner().run([&](gpu::Recorder& recorder) {
      pass.record(recorder, scene, {&moving, 1}, {}, planning::ViewFrustum(constants.camera), frame, target);
    });
    return {read_back<std::uint32_t>(target.albedo_roughness), read_back<Half4>(target.normal_metallic),
            read_back<Half4>(target.emission), read_back<float>(target.depth)};
  }
};

TEST_F(GBufferTest, DepthFirstDrawsTheSame) {
  const Texels at_once = draw(false), depth_first = draw(true);
  EXPECT_EQ(depth_first.of_surfaces(), at_once.of_surfaces());
  // Every kind of pixel occurs: none, dull and glowing.
  std::size_t empty = 0, glowing = 0;
  for (std::size_t i = 0; i < at_once.depth.size(); ++i) {
    empty += at_once.depth[i] == 0 ? 1 : 0;
    glowing += from_half(at_once.emission[i]).x > 0 ? 1 : 0;
  }
  EXPECT_GT(empty, 100u);
  EXPECT_GT(glowing, 100u);
  EXPECT_GT(at_once.depth.size() - empty - glowing, 100u);
}

}  // namespace
}  // namespace brume::passes
