// What glows inside of dense smoke, beside the path tracer.
#include "grids/glow.hpp"
#include "grids/generate.hpp"
#include "planning/blackbody.hpp"
#include "planning/volume_inputs.hpp"
#include "reference/scene.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

class GlowTest : public VolumeFixture {
 protected:
  static grids::BrickVolume ball(double radius) {
    grids::CloudSettings settings;
    settings.kind = grids::CloudKind::sphere;
    settings.edge = 40;
    settings.voxel_size = 0.06;
    settings.radius = radius;
    settings.edge_width = 0.12;
    return grids::make_brick_volume(grids::generate_cloud(settings)).value_or_throw();
  }
  /// A ball of smoke of 1 m, and in its middle one of 0.3 m that glows.
  static scenario::VolumeAt glowing_smoke() {
    auto frame = std::make_shared<scenario::VolumeFrame>();
    frame->density = ball(1);
    frame->heat = ball(0.3);
    frame->glow = grids::find_glow(*frame->heat, frame->density);
    scenario::VolumeAt at;
    at.frame = frame;
    at.world_from_density = glm::mat4(frame->density.world_from_voxel);
    at.world_from_heat = glm::mat4(frame->heat->world_from_voxel);
    return at;
  }
};

TEST_F(GlowTest, IsAsBrightInDenseSmokeAsItsPathsOfLight) {
  const scene::Scene scene = far_floor();
  const scenario::VolumeAt smoke = glowing_smoke();
  constexpr glm::uvec2 kSize{33, 33};
  for (const float albedo : {0.6f, 0.9f}) {
    scene::VolumeOptions options;
    options.extinction = 4;
    options.albedo = glm::vec3(albedo);
    options.anisotropy = 0;
    options.kelvin = planning::kUnitGlow;
    input_.volumes.clear();
    input_.environment = {};
    input_.view.camera = {{0, 0, 6}, {0, 0, 0}, 0.4f};
    planning::add_volume(options, smoke, *smoke.frame, 0, input_);
    ASSERT_FALSE(input_.environment.glow.empty());
    Renderer renderer(context(), runner(), scene, {.size_px = kSize});
    renderer.draw(input_);
    const std::vector<glm::vec4> drawn = media_of(renderer);

    const auto traced = reference::make_scene(scene, input_, nullptr);
    for (const std::uint32_t x : {16u, 20u, 24u}) {
      // Of the pixel's middle: 6 m before a picture of 2 tan(0.2) of that.
      const float across = 2 * std::tan(0.2f) * ((static_cast<float>(x) + 0.5f) / kSize.x - 0.5f);
      const reference::Ray ray{{0, 0, 6}, glm::normalize(glm::vec3(across, 0, -1))};
      const reference::Mean expected = reference::radiance(*traced, ray, 1u << 14);
      const double found{drawn[kSize.x * (kSize.y / 2) + x].r};
      // kSpreadInside fits cases as different as these within a quarter; without it halos have half of that
      // light.
      EXPECT_NEAR(found / expected.value(), 1, 0.25 + 4 * expected.error() / expected.value())
          << "albedo " << albedo << ", pixel " << x;
    }
  }
}

}  // namespace
}  // namespace brume::render
