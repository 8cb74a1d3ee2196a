// Vertex colours reach the image.
#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

class VertexColorTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{32, 32};

  /// A wall that fills the view, with one colour at all its vertices.
  static scenario::Scenario wall(glm::vec4 color, float alpha_cutoff) {
    scene::Scene scene = scene_of({{{-9, -9, -1}, {9, 9, 0}}}, {}, 0.1f);
    for (scene::Vertex& vertex : scene.meshes[0].vertices) vertex.color = color;
    scene.materials[0].base_color = {1, 0.5f, 1};
    scene.materials[0].alpha_cutoff = alpha_cutoff;
    scene.camera = {{0.1f, 0.2f, 4}, {0, 0, 0}, 0.9f};
    return scenario_of(std::move(scene), {}, {{40, 40, 12}, 0.5f, {-10, -10, -3}});
  }

  static glm::ivec3 albedo_of(const scenario::Scenario& scenario) {
    film::Playback playback(context(), scenario, kSize);
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
