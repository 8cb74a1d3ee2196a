// What a texture's alpha cuts out of a surface lets light through.
#include <algorithm>
#include <cmath>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

class CutoutTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{64, 32};

  /// A floor seen from above, and over its right half, out of view, a plate in the light: of a texture whose
  /// texels have alternately an alpha of 0 and of 255 along x, in squares of 1 m.
  static scenario::Scenario floor(bool is_sunny, float alpha_cutoff, scene::Wraps wraps = {},
                                  float first_u = 0) {
    scene::Scene scene;
    add_box(scene.meshes.emplace_back(), {-4, -0.1f, -4}, {4, 0, 4});
    scene::Mesh& plate = scene.meshes.emplace_back();
    for (const glm::vec2 corner : {glm::vec2(0, -2), glm::vec2(4, -2), glm::vec2(4, 2), glm::vec2(0, 2)}) {
      scene::Vertex vertex;
      vertex.position = {corner.x, 2, corner.y};
      vertex.normal = {0, 1, 0};
      vertex.uv = {first_u + corner.x / 4, (corner.y + 2) / 4};
      plate.vertices.push_back(vertex);
    }
    plate.indices = {0, 2, 1, 0, 3, 2};
    // Of 16 x 16 texels, so that filtering blurs an eighth of each square.
    image::Image8 image{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 255)};
    for (std::size_t i = 0; i < 16 * 16; ++i) image.rgba[4 * i + 3] = (i % 16 / 4) % 2 == 0 ? 255 : 0;
    scene.images.push_back({"squares", image, wraps});
    scene.materials.resize(2);
    scene.materials[0].base_color = glm::vec3(0.5f);
    scene.materials[0].roughness = 1;
    scene.materials[1].base_color_image = 0;
    scene.materials[1].alpha_cutoff = alpha_cutoff;
    scene.objects = {{"floor", 0, 0, glm::mat4(1)}, {"plate", 1, 1, glm::mat4(1), Role::ghost}};
    set_grenade(scene, 0.02f);
    scene.lights = {is_sunny ? scene_sun({0, -1, 0}, 1) : scene_light({2, 3.9f, 0}, glm::vec3(30))};
    // Below the plate.
    scene.camera = scene::Camera{{2, 1.8f, 0.01f}, {2, 0, 0}, 1.6f};
    scene::Timeline timeline;
    timeline.sky = plain_sky(0);
    return scenario_of(std::move(scene), std::move(timeline), {{20, 12, 20}, 0.5f, {-5, -1, -5}});
  }

  /// Brightness of the floor at a place along x.
  static std::vector<int> along_x(const scenario::Scenario& scenario) {
    film::Playback playback(context(), scenario, kSize);
    const image::Image8 image = playback.draw(0, 0);
    std::vector<int> row;
    // From 1.8 m above, half of the image's height is tan(0.8) of that.
    for (const float x : {0.5f, 1.5f, 2.5f, 3.5f}) {
      const double per_pixel = 2 * 1.8 * std::tan(0.8) / kSize.y;
      const auto px = static_cast<std::size_t>(kSize.x / 2.0 + (x - 2) / per_pixel);
      row.push_back(image.rgba[4 * (kSize.x * (kSize.y / 2) + px)]);
    }
    return row;
  }
};

TEST_F(CutoutTest, CastsNoShadowWhereItIsCutOut) {
  const std::vector<int> solid = along_x(floor(true, 0)), cut = along_x(floor(true, 0.5f));
  for (const int value : solid) EXPECT_LT(value, 8);
  EXPECT_LT(cut[0], 8);
  EXPECT_GT(cut[1], 60);
  EXPECT_LT(cut[2], 8);
  EXPECT_GT(cut[3], 60);
}

// From the third square on: as far as the image goes, and then what its wrap says.
TEST_F(CutoutTest, ShadowsFollowTheWrap) {
  const auto is_lit = [&](scene::Wrap wrap) {
    std::vector<bool> lit;
    for (const int value : along_x(floor(true, 0.5f, {wrap, scene::Wrap::clamp}, 0.5f)))
      lit.push_back(value > 60);
    return lit;
  };
  EXPECT_EQ(is_lit(scene::Wrap::repeat), (std::vector{false, true, false, true}));
  EXPECT_EQ(is_lit(scene::Wrap::mirror), (std::vector{false, true, true, false}));
  EXPECT_EQ(is_lit(scene::Wrap::clamp), (std::vector{false, true, true, true}));
}

// Its shadows are twice as wide, and begin at the light's place along x.
TEST_F(CutoutTest, LightsOfALevelShineThroughToo) {
  const std::vector<int> solid = along_x(floor(false, 0)), cut = along_x(floor(false, 0.5f));
  EXPECT_LT(*std::ranges::max_element(solid), 8);
  EXPECT_GT(*std::ranges::max_element(cut), 60);
  EXPECT_LT(*std::ranges::min_element(cut), 8);
}

}  // namespace
}  // namespace brume::render
