#include "planning/smoke_shadow_plan.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

constexpr glm::uvec2 kAtlas{1024, 256};

shared::Light light(glm::vec3 position_world, float intensity) {
  return point_light(position_world, glm::vec3(intensity), 0);
}

/// An eye at z = 20 that looks along -z, 90 degrees wide.
shared::Camera camera() {
  shared::Camera camera{};
  camera.eye_world = {0, 0, 20};
  camera.forward = {0, 0, -1};
  camera.right = {1, 0, 0};
  camera.up = {0, 1, 0};
  return camera;
}

SmokeShadowPlan plan_for(const std::vector<shared::Light>& lights, const std::vector<Box<float>>& smoke,
                         glm::uvec2 atlas = kAtlas) {
  return plan_smoke_shadows({lights, glm::mat4(1), camera()}, smoke, atlas);
}

bool has_face(const SmokeShadowPlan& plan, std::size_t light) {
  for (std::size_t i = 0; i < shared::kFacesPerLight; ++i)
    if (plan.faces[shared::kFacesPerLight * light + i].size.x > 0) return true;
  return false;
}

/// Face and texel of the atlas of a point as a light sees it.
std::pair<std::uint32_t, glm::vec2> texel_of(const SmokeShadowPlan& plan, const shared::Light& light,
                                             std::size_t index, glm::vec3 p) {
  const glm::vec3 d = p - light.position_world;
  std::uint32_t best = 0;
  for (std::uint32_t face = 1; face < 6; ++face)
    if (glm::dot(d, shared::cube_forward(face)) > glm::dot(d, shared::cube_forward(best))) best = face;
  const glm::vec2 uv =
      0.5f + 0.5f * glm::vec2(glm::dot(d, shared::cube_right(best)), -glm::dot(d, shared::cube_up(best))) /
                 glm::dot(d, shared::cube_forward(best));
  const shared::SmokeShadowFace& face = plan.faces[shared::kFacesPerLight * index + best];
  return {best, uv * face.scale + face.offset};
}

// Media that are hundreds of metres apart have coarse shadows of the sun, not none.
TEST(SmokeShadowPlan, TheSunHasAShadowHoweverFarApartMediaAre) {
  const shared::Light sun = sun_light({0, -1, 0}, 5, 0);
  const std::vector<shared::Light> lights{light({0, 1, 4}, 10), sun, light({3, 1, 0}, 10)};
  for (const float far : {10.0f, 220.0f, 5000.0f, 1e6f}) {
    const std::vector<Box<float>> media{{{-1, 0, -1}, {1, 2, 1}}, {{far, 0, far}, {far + 2, 2, far + 2}}};
    // As large as the media: uv is x and z.
    glm::mat4 view(0);
    view[0].x = view[2].y = 1 / (far + 2);
    view[3].w = 1;
    const SmokeShadowPlan plan = plan_smoke_shadows({lights, view, camera()}, media, {256, 256});
    EXPECT_TRUE(has_face(plan, 1)) << far;
    EXPECT_GE(plan.faces[shared::kFacesPerLight].size.x, 8u) << far;
  }
}

TEST(SmokeShadowPlan, LightsThatReachNoSmokeOrNothingInViewHaveNoRays) {
  const std::vector<Box<float>> smoke{{{-1, 0, -1}, {1, 2, 1}}};
  shared::Light away = light({0, 1, 4}, 10);
  away.kind = shared::kLightSpot;
  away.direction = {0, 0, 1};
  away.cos_outer = 0.9f;
  shared::Light toward = away;
  toward.direction = {0, 0, -1};
  shared::Light dark = light({0, 1, 4}, 10), shadowless = dark;
  dark.intensity = glm::vec3(0);
  shadowless.shadow_layer = shared::kNoShadow;
  const std::vector<shared::Light> lights{
      light({0, 1, 4}, 10),    light({0, 1, 4}, 0.05f), away, toward, dark, shadowless,
      light({0, 1, 29}, 0.6f), light({0, 1, 0}, 1)};
  const SmokeShadowPlan plan = plan_for(lights, smoke);
  const bool expected[] = {true, false, false, true, false, false, false, true};
  for (std::size_t i = 0; i < lights.size(); ++i) EXPECT_EQ(has_face(plan, i), expected[i]) << i;
  EXPECT_GT(plan.blocks, 0u);
  EXPECT_EQ(plan_for(lights, {}).blocks, 0u);
  EXPECT_EQ(plan_for({}, smoke).faces.size(), 0u);
  // A light before the smoke looks in one direction, one in the smoke all around.
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(plan.faces[i].size.x > 0, i == 5);
    EXPECT_GT(plan.faces[7 * 6 + i].size.x, 0u);
  }
}

TEST(SmokeShadowPlan, EveryDirectionToSmokeHasATexelOfItsOwn) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-8, 8), size(0.5f, 4), share(0, 1);
  std::vector<Box<float>> smoke;
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 low{place(random), place(random), place(random)};
    smoke.push_back({low, low + glm::vec3(size(random), size(random), size(random))});
  }
  std::vector<shared::Light> lights;
  for (int i = 0; i < 40; ++i)
    lights.push_back(light({place(random), place(random), place(random)}, 0.1f + 5 * share(random)));
  const SmokeShadowPlan plan = plan_for(lights, smoke);

  for (std::size_t i = 0; i < lights.size(); ++i)
    for (int k = 0; k < 200; ++k) {
      const Box<float>& box = smoke[random() % smoke.size()];
      const glm::vec3 p = glm::mix(box.low, box.high, glm::vec3(share(random), share(random), share(random)));
      if (glm::length(p - lights[i].position_world) >= lights[i].range) continue;
      const auto [face, texel] = texel_of(plan, lights[i], i, p);
      const shared::SmokeShadowFace& f = plan.faces[6 * i + face];
      // One texel within the rectangle, so that what is interpolated is the face's own.
      EXPECT_TRUE(glm::all(glm::greaterThan(texel, glm::vec2(f.first_texel) + 0.99f)) &&
                  glm::all(glm::lessThan(texel, glm::vec2(f.first_texel + f.size) - 0.99f)));
    }

  for (const std::uint32_t spread : {1u, 2u}) {
    const SmokeShadowPlan spread_plan = plan.spread_by(spread);
    std::uint32_t blocks = 0;
    for (const shared::SmokeShadowFace& face : spread_plan.faces) {
      EXPECT_EQ(face.first_block, blocks);
      const glm::uvec2 count = shared::smoke_shadow_blocks(face.size, spread);
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(8 * spread * count, face.size)));
      blocks += count.x * count.y;
    }
    EXPECT_EQ(spread_plan.blocks, blocks);
  }
  EXPECT_EQ(plan.spread_by(1), plan);

  std::vector<int> owners(kAtlas.x * kAtlas.y);
  for (const shared::SmokeShadowFace& face : plan.faces) {
    ASSERT_TRUE(glm::all(glm::lessThanEqual(face.first_texel + face.size, kAtlas)));
    for (std::uint32_t y = 0; y < face.size.y; ++y)
      for (std::uint32_t x = 0; x < face.size.x; ++x)
        EXPECT_EQ(owners[face.first_texel.x + x + kAtlas.x * (face.first_texel.y + y)]++, 0);
  }
}

TEST(SmokeShadowPlan, TexelsAreAsFineAsTheAtlasAllows) {
  const std::vector<Box<float>> smoke{{{-1, 0, -1}, {1, 2, 1}}};
  const std::vector<shared::Light> one{light({0, 1, 4}, 10)};
  // The whole face spans 2 * 5 m at the far end of the smoke.
  EXPECT_NEAR(plan_for(one, smoke).faces[5].scale, 10 / kFinestSmokeShadow, 0.1f);
  EXPECT_LT(plan_for(one, smoke, {64, 64}).faces[5].scale, 10 / kFinestSmokeShadow);
  // Sixteen times as bright: the dark one is half as fine.
  const auto two = plan_for({light({0, 1, 4}, 160), light({0, 1, 4}, 10)}, smoke);
  EXPECT_NEAR(two.faces[5].scale, 2 * two.faces[11].scale, 0.1f);
  // Too many for the least atlas: those that fit.
  const SmokeShadowPlan crowded =
      plan_for(std::vector<shared::Light>(100, light({0, 1, 0}, 10)), smoke, {64, 64});
  EXPECT_TRUE(has_face(crowded, 0));
  EXPECT_FALSE(has_face(crowded, 99));
}

}  // namespace
}  // namespace brume::planning
