// Which particles a frame has, and what is refused.
#include "planning/particle_plan.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "planning/device_camera.hpp"

namespace brume::planning {
namespace {

const ViewFrustum& ahead() {
  static const ViewFrustum frustum(device_camera({{0, 0, 0}, {0, 0, -1}, 0.9f}, {64, 48}));
  return frustum;
}

ParticleInput particles_at(glm::vec3 low, std::uint32_t count) {
  ParticleInput input;
  input.world_from_uvw = glm::translate(glm::mat4(1), low);
  input.count = count;
  return input;
}

std::vector<shared::ParticleSystem> plan(const std::vector<ParticleInput>& inputs, std::size_t volumes = 1) {
  const std::vector<shared::SliceTexture> slices(volumes);
  return plan_particles(inputs, slices, ahead());
}

void expect_refused(const std::vector<ParticleInput>& inputs, const std::string& part) {
  try {
    plan(inputs);
    ADD_FAILURE() << "accepted: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(ParticlePlan, ThoseInViewFollowEachOther) {
  const auto systems =
      plan({particles_at({0, 0, -9}, 10), particles_at({0, 0, 9}, 20), particles_at({0, 0, -4}, 30)});
  ASSERT_EQ(systems.size(), 2u);
  EXPECT_EQ(systems[0].first, 0u);
  EXPECT_EQ(systems[0].count, 10u);
  EXPECT_EQ(systems[1].first, 10u);
  EXPECT_EQ(systems[1].count, 30u);
}

// A unit cube with footprints of 0.4: a region of 1.8^3, and quads of pi 0.4^2 / 3 each.
TEST(ParticlePlan, TheWeightIsTheVolumePerAreaOfQuads) {
  ParticleInput input = particles_at({1, 2, 3}, 50);
  input.radius = 0.4f;
  const shared::ParticleSystem system = particle_system(input, {});
  EXPECT_FLOAT_EQ(system.radius, 0.4f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_FLOAT_EQ(system.margin[axis], 0.4f);
  EXPECT_NEAR(double{system.weight}, 1.8 * 1.8 * 1.8 / (50 * std::numbers::pi * 0.16 / 3), 1e-5);
}

// In a sheared box, planes of a coordinate are closer together than the edge between them is long.
TEST(ParticlePlan, TheMarginHoldsAFootprintAroundEveryPointOfTheBox) {
  ParticleInput input = particles_at({0, 0, 0}, 50);
  input.world_from_uvw[1] = glm::vec4(0.8f, 0.6f, 0, 0);
  const shared::ParticleSystem system = particle_system(input, {});
  for (int i = 0; i < 1000; ++i) {
    const float a = 0.1f * static_cast<float>(i), b = 0.37f * static_cast<float>(i);
    const glm::vec3 away = glm::vec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    const glm::vec3 off = matrix_of(system.uvw_from_world) * glm::vec4(system.radius * away, 0);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(off), system.margin * 1.00001f)));
  }
}

TEST(ParticlePlan, RefusesWhatNoFrameCanHave) {
  expect_refused({particles_at({}, 0)}, "0 particles");
  expect_refused({particles_at({}, 65537)}, "65537 particles");
  ParticleInput input = particles_at({}, 1);
  input.slices = 1;
  expect_refused({input}, "volume 1 of 1");
  input = particles_at({}, 1);
  input.world_from_uvw[2] = glm::vec4(0);
  expect_refused({input}, "no inverse");
  for (const float radius : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    input = particles_at({}, 1);
    input.radius = radius;
    expect_refused({input}, "radius");
  }
  expect_refused(std::vector(33, particles_at({}, 1)), "33 volumes");
  EXPECT_EQ(plan(std::vector(16, particles_at({0, 0, -3}, 65536))).size(), 16u);
}

}  // namespace
}  // namespace brume::planning
