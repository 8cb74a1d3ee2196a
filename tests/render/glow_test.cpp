// What glows inside of dense smoke, beside the path tracer, and its light in cells.
#include <numbers>
#include <optional>

#include "grids/generate.hpp"
#include "grids/glow.hpp"
#include "planning/blackbody.hpp"
#include "planning/volume_inputs.hpp"
#include "reference/scene.hpp"
#include "shared/glow_field.h"
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
  static volumes::VolumeAt glowing_smoke() {
    auto frame = std::make_shared<volumes::VolumeFrame>();
    frame->density = ball(1);
    frame->heat = ball(0.3);
    frame->glow = grids::find_glow(*frame->heat, frame->density);
    volumes::VolumeAt at;
    at.frame = frame;
    at.world_from_density = glm::mat4(frame->density.world_from_voxel);
    at.world_from_heat = glm::mat4(frame->heat->world_from_voxel);
    return at;
  }
};

TEST_F(GlowTest, IsAsBrightInDenseSmokeAsItsPathsOfLight) {
  const scene::Scene scene = far_floor();
  const volumes::VolumeAt smoke = glowing_smoke();
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
      std::printf("glow: albedo %.1f, pixel %u: %.3f of the path tracer\n", double{albedo}, x,
                  found / expected.value());
      // Diffusion is an approximation: docs/guides/volumes.md has what it was off by in more cases.
      EXPECT_NEAR(found / expected.value(), 1, 0.2 + 4 * expected.error() / expected.value())
          << "albedo " << albedo << ", pixel " << x;
    }
  }
}

/// The field of a volume of 32^3 voxels of 10 cm, which are its cells, around the world's origin.
class GlowFieldTest : public VolumeFixture {
 protected:
  static constexpr int kEdge = shared::kGlowEdge;
  static constexpr float kVoxel = 0.1f;

  void find(const volume::SparseVolume& density, const shared::VolumeLook& look) {
    const glm::mat4 placed =
        glm::scale(glm::mat4(1), glm::vec3(kVoxel)) * glm::translate(glm::mat4(1), glm::vec3(-0.5f * kEdge));
    input_.volumes = {{&density, placed, look}};
    input_.view.camera = {{0, 0, 6}, {0, 0, 0}, 0.6f};
    renderer_.emplace(context(), runner(), scene_, RendererOptions{.size_px = {8, 8}});
    renderer_->draw(input_);
    texels_ = read_back<passes::Half4>(renderer_->volumes().glow_field());
  }
  /// Green.
  double at(glm::ivec3 cell, std::uint32_t part) const {
    const glm::ivec3 texel = cell + glm::ivec3(static_cast<int>(part) * kEdge, 0, 0);
    return double{passes::from_half(
                      texels_[static_cast<std::size_t>(texel.x + 2 * kEdge * (texel.y + kEdge * texel.z))])
                      .g};
  }

 private:
  const scene::Scene scene_ = far_floor();
  std::optional<Renderer> renderer_;
  std::vector<passes::Half4> texels_;
};

// In matter without an end the light that arrives straight is what an opaque part emits, and all light is
// that divided by what is absorbed of it.
TEST_F(GlowFieldTest, DeepInsideIsInEquilibrium) {
  const volume::SparseVolume density = block({4, 4, 4});
  for (const float albedo : {0.0f, 0.5f, 0.9f}) {
    find(density, {glm::vec3(albedo), 30, glm::vec3(0.7f), 0.3f, 1});
    const double straight = at(glm::ivec3(16), shared::kGlowStraight);
    const double all = straight + at(glm::ivec3(16), shared::kGlowScattered);
    // 48 and more optical depths from the border. Sums of 32 half floats.
    EXPECT_NEAR(straight, 0.7, 0.7 * 0.002) << albedo;
    EXPECT_NEAR(all, 0.7 / (1 - double{albedo}), 0.01 * all) << albedo;
  }
}

// In matter that absorbs next to nothing, light arrives as the inverse square law says.
TEST_F(GlowFieldTest, ThinGlowFallsOffWithTheSquareOfTheDistance) {
  const auto glow = [](glm::vec3 p) {
    return std::clamp(5.5f - glm::distance(p, glm::vec3(16)), 0.0f, 1.0f);
  };
  const volume::SparseVolume density = values({4, 4, 4}, glow);
  // A metre of the densest emits a radiance of 1, and absorbs a thousandth.
  find(density, {glm::vec3(0), 0.001f, glm::vec3(1000), 0, 1});
  for (const double radius : {8.0, 11.0, 14.0}) {
    double found = 0, expected = 0;
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(kEdge)}, [&](glm::ivec3 cell) {
      const glm::dvec3 p = glm::dvec3(cell) + 0.5;
      if (std::abs(glm::distance(p, glm::dvec3(16)) - radius) > 1) return;
      found += at(cell, shared::kGlowStraight);
      for_each_in(Box<int>{glm::ivec3(10), glm::ivec3(22)}, [&](glm::ivec3 other) {
        const glm::dvec3 q = glm::dvec3(other) + 0.5, way = p - q;
        if (glow(glm::vec3(q)) <= 0) return;
        expected += double{glow(glm::vec3(q)) * kVoxel} / (4 * std::numbers::pi * glm::dot(way, way));
      });
    });
    // A single cell may lie between two of the 32 directions; a shell of cells has them all.
    EXPECT_NEAR(found / expected, 1, 0.005) << radius;
  }
}

}  // namespace
}  // namespace brume::render
