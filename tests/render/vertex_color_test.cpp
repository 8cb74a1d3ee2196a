// Vertex colours reach the image.
#include "render/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/boxes.hpp"

namespace brume::render {
namespace {

class VertexColorTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{32, 32};

  /// A wall that fills the view, with one colour at all its vertices.
  static scenario::Scenario wall(glm::vec4 color, float alpha_cutoff) {
    scene::Scene scene;
    scene::Mesh mesh, ball;
    add_box(mesh, {-9, -9, -1}, {9, 9, 0});
    for (scene::Vertex& vertex : mesh.vertices) vertex.color = color;
    add_box(ball, glm::vec3(-0.05f), glm::vec3(0.05f));
    scene.meshes = {mesh, ball};
    scene.materials.resize(1);
    scene.materials[0].base_color = {1, 0.5f, 1};
    scene.materials[0].alpha_cutoff = alpha_cutoff;
    scene.objects.push_back({"wall", 0, 0, glm::mat4(1)});
    scene.grenade = {"grenade", 1, 0, glm::mat4(1), Role::ghost};
    auto voxels =
        scenario::load_or_voxelize(scene, {{40, 40, 12}, 0.5f, {-10, -10, -3}}, {}).value_or_throw();
    return {{}, std::move(scene), {{0.1f, 0.2f, 4}, {0, 0, 0}, 0.9f}, std::move(voxels)};
  }

  static glm::ivec3 albedo_of(const scenario::Scenario& scenario) {
    Playback playback(context(), scenario, kSize);
    playback.set_view(passes::DebugView::albedo, {});
    const image::Image8 image = playback.draw(0, 0);
    const std::size_t middle = 4 * (kSize.x * kSize.y / 2 + kSize.x / 2);
    return {image.rgba[middle], image.rgba[middle + 1], image.rgba[middle + 2]};
  }
};

TEST_F(VertexColorTest, MultipliesTheBaseColour) {
  // 0.2140 is 128 / 255 in sRGB; so is its double times the base colour of 0.5.
  const glm::ivec3 albedo = albedo_of(wall({0.2140f, 0.4280f, 0, 1}, 0));
  EXPECT_NEAR(albedo.r, 128, 1);
  EXPECT_NEAR(albedo.g, 128, 1);
  EXPECT_EQ(albedo.b, 0);
}

TEST_F(VertexColorTest, AlphaIsCutOut) {
  const glm::ivec3 solid = albedo_of(wall({1, 1, 1, 1}, 1)), cut = albedo_of(wall({1, 1, 1, 0.4f}, 0.5f));
  EXPECT_EQ(solid.r, 255) << "white keeps the highest cutoff";
  EXPECT_NE(cut, solid);
}

}  // namespace
}  // namespace brume::render
