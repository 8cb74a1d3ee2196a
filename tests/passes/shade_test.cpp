#include "passes/shade.hpp"

#include <random>

#include "passes/blue_noise.hpp"
#include "passes/display.hpp"
#include "passes/smoke_shadow.hpp"
#include "planning/device_lights.hpp"
#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

constexpr VkFormat kHalf4 = VK_FORMAT_R16G16B16A16_SFLOAT;

/// Lights, spots and a sun over a G-buffer of random surfaces: each tile has near and far ones, and holes to
/// the sky.
class ShadeTest : public gpu::GpuTest {
 protected:
  explicit ShadeTest(glm::uvec2 size = {33, 17}) : size_(size), gbuffer_(context(), {1, 1}) {
    std::uniform_real_distribution<float> share(0, 1), side(-1, 1);
    std::vector<scene::Light> lights(600);
    for (std::size_t i = 0; i < lights.size(); ++i) {
      scene::Light& light = lights[i];
      light.position_world = 12.0f * random_vector() - glm::vec3(0, 0, 8);
      light.intensity = 0.02f * glm::abs(random_vector());
      light.kind = i == 7 ? scene::LightKind::directional
                          : (i % 2 == 0 ? scene::LightKind::point : scene::LightKind::spot);
      light.direction_world = glm::normalize(random_vector());
      light.cos_inner = 0.5f + 0.5f * share(random_);
      light.cos_outer = light.cos_inner - 0.9f * share(random_);
    }
    lights[5].intensity = glm::vec3(0);
    scene_.light_list = planning::device_lights(lights, 12);  // the first two lights and the sun have shadows
    scene_.lights = upload(scene_.light_list);
    scene_.vertices = upload(std::vector<shared::Vertex>(3));  // nothing is drawn of them
    scene_.indices = upload(std::vector<std::uint32_t>(3), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const ShadowPass shadow_pass(context());
    shadows_ = shadow_pass.make_maps(context(), scene_);
    shadow_pass.record(context(), runner(), scene_, {}, shadows_);
    const SmokeShadowPass smoke_shadow_pass(context());
    smoke_shadows_ = smoke_shadow_pass.make_shadows(context(), size_, scene_.light_list.size());
    const std::vector<shared::SmokeShadowFace> no_smoke(scene_.light_list.size() * shared::kFacesPerLight);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.upload(smoke_shadows_.faces, 0, std::as_bytes(std::span(no_smoke)));
    });

    const std::size_t count = std::size_t{size_.x} * size_.y;
    std::vector<glm::u8vec4> albedo(count);
    std::vector<Half4> normal(count), emission(count);
    std::vector<float> depth(count);
    for (std::size_t i = 0; i < count; ++i) {
      albedo[i] = glm::u8vec4(255.0f * glm::vec4(glm::abs(random_vector()), share(random_)));
      normal[i] = to_half(glm::vec4(glm::normalize(random_vector()), share(random_)));
      emission[i] = to_half(glm::vec4(0.1f * glm::abs(random_vector()), 0));
      depth[i] = share(random_) < 0.2f ? 0 : 0.05f / (2 + 15 * share(random_));
    }
    gbuffer_.albedo_roughness = upload_image(context(), runner(), size_, VK_FORMAT_R8G8B8A8_UNORM, albedo);
    gbuffer_.normal_metallic = upload_image(context(), runner(), size_, kHalf4, normal);
    gbuffer_.emission = upload_image(context(), runner(), size_, kHalf4, emission);
    gbuffer_.depth = upload_image(context(), runner(), size_, VK_FORMAT_R32_SFLOAT, depth);
  }

  glm::vec3 random_vector() {
    std::uniform_real_distribution<float> side(-1, 1);
    return {side(random_), side(random_), side(random_)};
  }

  /// `display`: where a pass of its own displays the radiance, which must be what shading displays.
  std::vector<glm::vec4> shade(const std::vector<Half4>& smoke, bool cull_lights, bool voxel_shadows = true,
                               const gpu::Image* display = nullptr) {
    shared::FrameConstants frame{};
    frame.camera.near_z = 0.05f;
    frame.camera.forward = {0, 0, -1};
    frame.camera.right = {1, 0, 0};
    frame.camera.up = {0, 0.5f, 0};
    frame.sky = {glm::vec3(0.1f), 0.3f, glm::vec3(0.2f), 0.0f, glm::vec3(0.05f)};
    frame.solid = solid_.layout();
    frame.size_px = size_;
    frame.exposure = 1;
    frame.light_count = static_cast<std::uint32_t>(scene_.light_list.size());
    const auto frame_buffer = upload(std::vector{frame});
    const auto smoke_image = upload_image(context(), runner(), size_, kHalf4, smoke);
    const auto radiance = test_image(context(), size_, kHalf4);
    const ShadePass::Needs needs{.voxel_shadows = voxel_shadows, .display = display != nullptr};
    ShadePass pass(context(), cull_lights);
    pass.reserve(needs);
    const DisplayPass display_pass(context());
    gpu::Image blue_noise, shown = test_image(context(), size_, VK_FORMAT_R8G8B8A8_UNORM);
    sky_.reserve(solid_);
    runner().run([&](gpu::Recorder& recorder) {
      if (solid_.record(recorder, {})) sky_.record(recorder, frame_buffer, solid_);
      blue_noise = make_blue_noise(context(), recorder);
      pass.record(recorder, needs,
                  {frame_buffer,
                   scene_,
                   shadows_,
                   smoke_shadows_,
                   {solid_, sky_, indirect_cube_},
                   gbuffer_,
                   smoke_image,
                   blue_noise},
                  {radiance, shown});
      if (display) display_pass.record(recorder, frame_buffer, blue_noise, radiance, *display);
    });
    if (display) {
      // The other pass reads half floats, off by 2^-10 of the radiance: that is less than a step of the
      // display.
      const auto a = read_back<glm::u8vec4>(shown), b = read_back<glm::u8vec4>(*display);
      for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[i][c], b[i][c], 1) << i;
    }
    return from_half(read_back<Half4>(radiance));
  }
  std::vector<Half4> no_smoke() const { return {std::size_t{size_.x} * size_.y, to_half({0, 0, 0, 1})}; }

  glm::uvec2 size_;
  std::mt19937 random_{7};
  SceneResources scene_;
  ShadowMaps shadows_;
  SmokeShadows smoke_shadows_;
  SolidVolume solid_{context()};
  SkyLightPass sky_{context()};
  gpu::Image indirect_cube_ = make_indirect_cube(context());
  GBuffer gbuffer_;
};

TEST_F(ShadeTest, LightsThatATileLeavesOutAreThoseThatDoNotReachIt) {
  const auto culled = shade(no_smoke(), true);
  EXPECT_EQ(culled, shade(no_smoke(), false));
  float brightest = 0;
  for (const glm::vec4& pixel : culled) brightest = std::max(brightest, pixel.g);
  EXPECT_GT(brightest, 0.1f) << "some light is visible";
}

TEST_F(ShadeTest, WithoutVoxelShadowsTheImageIsTheSameWhereNoLightHasThem) {
  EXPECT_EQ(shade(no_smoke(), true, false), shade(no_smoke(), true, true));
}

TEST_F(ShadeTest, DisplaysWhatTheDisplayPassDoes) {
  const gpu::Image display = test_image(context(), size_, VK_FORMAT_R8G8B8A8_UNORM);
  shade(no_smoke(), true, true, &display);
}

TEST_F(ShadeTest, SmokeIsOverTheSurfacesAndTheSky) {
  const auto clear = shade(no_smoke(), true);
  std::uniform_real_distribution<float> share(0, 1);
  auto smoke = no_smoke();
  for (std::size_t i = 0; i < smoke.size(); ++i)
    smoke[i] = to_half(glm::vec4(4.0f * glm::abs(random_vector()), i % 3 == 0 ? 0 : share(random_)));
  const auto pixels = shade(smoke, true);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec4 s = from_half(smoke[i]);
    for (int c = 0; c < 3; ++c) {
      // Two roundings to a half float: of the clear image and of this one. Opaque smoke is as it is.
      const float expected = s[c] + s.w * clear[i][c];
      EXPECT_NEAR(pixels[i][c], expected, s.w == 0 ? 0 : expected / 512);
    }
  }
}

class ShadeOnePixelTest : public ShadeTest {
 protected:
  ShadeOnePixelTest() : ShadeTest({1, 1}) {}
};

TEST_F(ShadeOnePixelTest, IsTheSameWithoutCulling) {
  EXPECT_EQ(shade(no_smoke(), true), shade(no_smoke(), false));
}

}  // namespace
}  // namespace brume::passes
