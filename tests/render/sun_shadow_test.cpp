// The shadow of the sun in a wide scene: sharp, where it should be, and none on what is lit.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/playback.hpp"
#include "passes/shadow.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

class SunShadowTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{64, 32};
  static constexpr float kHalfEdge = 70;                          // of the ground [m]
  static constexpr double kEye = 2, kHalfFov = 0.3;               // above the ground
  static constexpr double kPixel = 2 * kEye * 0.30934 / kSize.y;  // tan(kHalfFov) [m]

  /// A ground, and with `roof` a slab 3 m above it, which ends at x = 0. The sun shines along +x.
  static scenario::Scenario ground(bool roof, double elevation, float middle_x) {
    scene::Scene scene;
    add_box(scene.meshes.emplace_back(), {-kHalfEdge, -0.5f, -kHalfEdge}, {kHalfEdge, 0, kHalfEdge});
    add_box(scene.meshes.emplace_back(), {-4, 3, -4}, {0, 3.1f, 4});
    scene.materials.resize(1);
    scene.materials[0].base_color = glm::vec3(0.5f);
    scene.materials[0].roughness = 1;
    scene.objects = {{"ground", 0, 0, glm::mat4(1)}};
    if (roof) scene.objects.push_back({"roof", 1, 0, glm::mat4(1)});
    set_grenade(scene, 0.02f);
    const glm::vec3 direction(static_cast<float>(std::cos(elevation)),
                              -static_cast<float>(std::sin(elevation)), 0);
    scene.lights = {scene_sun(direction, 2)};
    scene.camera = scene::Camera{
        {middle_x, static_cast<float>(kEye), 0.01f}, {middle_x, 0, 0}, static_cast<float>(2 * kHalfFov)};
    scene::Timeline timeline;
    timeline.sky = plain_sky(0);
    return scenario_of(std::move(scene), std::move(timeline), {{24, 12, 24}, 0.5f, {-6, -1, -6}});
  }
  /// Brightness along x, through the middle of the picture.
  static std::vector<int> along_x(const scenario::Scenario& scenario) {
    film::Playback playback(context(), scenario, kSize);
    const image::Image8 image = playback.draw(0, 0);
    std::vector<int> row;
    for (std::size_t x = 0; x < kSize.x; ++x) row.push_back(image.rgba[4 * (kSize.x * (kSize.y / 2) + x)]);
    return row;
  }
};

TEST_F(SunShadowTest, EndsWhereTheRaysDo) {
  // The slab's upper edge, at 45 degrees.
  constexpr double kEdge = 3.1;
  const std::vector<int> row = along_x(ground(true, std::numbers::pi / 4, static_cast<float>(kEdge)));
  const int lit = row.back();
  ASSERT_GT(lit, 60);
  const auto place = [&](double share) {
    const auto at = std::ranges::find_if(row, [&](int value) { return value > share * lit; });
    return kEdge + (static_cast<double>(at - row.begin()) + 0.5 - kSize.x / 2.0) * kPixel;
  };

  // A texel of the map on the ground. Surfaces look up 7 cm above them (lib/surface_lights.glsl), which moves
  // the edge back by as much.
  const double radius = std::hypot(kHalfEdge, kHalfEdge, 1.8);
  const double texel = 2 * radius / passes::sun_map_size(static_cast<float>(radius)) * std::numbers::sqrt2;
  EXPECT_LT(texel, 0.08);
  EXPECT_NEAR(place(0.5), kEdge - 0.07, texel + kPixel);
  // The comparison blends over two texels; each end is found to a pixel.
  EXPECT_LT(place(0.9) - place(0.1), 2 * texel + 2 * kPixel);
  EXPECT_LT(8 * row.front(), lit);
}

TEST_F(SunShadowTest, GroundThatIsLitHasNone) {
  for (const double degrees : {90.0, 60.0, 30.0, 10.0, 5.0}) {
    const std::vector<int> row = along_x(ground(false, degrees * std::numbers::pi / 180, 0.37f));
    const auto [least, most] = std::ranges::minmax(row);
    EXPECT_GT(least, 8) << degrees;
    EXPECT_LE(most - least, 2) << degrees << ": a step of dither, and one of rounding";
  }
}

TEST(SunMap, HasTexelsOfFiveCentimetresUpTo200Metres) {
  for (const float radius : {1.0f, 12.0f, 25.61f, 40.0f, 51.21f, 100.0f}) {
    const std::uint32_t size = passes::sun_map_size(radius);
    EXPECT_LE(2 * radius / static_cast<float>(size), 0.05f);
    EXPECT_EQ(size & (size - 1), 0u);
  }
  EXPECT_EQ(passes::sun_map_size(1e6f), 4096u) << "67 MB at most";
}

}  // namespace
}  // namespace brume::render
