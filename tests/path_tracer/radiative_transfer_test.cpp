// Light that media scatter many times, where it is known.
#include <numbers>

#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/chandrasekhar.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {
namespace {

Ray towards(const glm::vec3& from, const glm::vec3& to) {
  return {from, glm::normalize(to - from)};
}

shared::Light sun_along(const glm::vec3& direction, float irradiance) {
  shared::Light sun{};
  sun.kind = shared::kLightDirectional;
  sun.direction = glm::normalize(direction);
  sun.intensity = glm::vec3(irradiance);
  return sun;
}

// What neither absorbs nor emits is as bright as what surrounds it, in every direction and at every depth.
TEST(RadiativeTransferTest, InAFurnaceNothingIsSeen) {
  const scene::Scene nothing;
  for (const shared::Phase& phase :
       {shared::phase_of_hg(0), shared::phase_of_hg(0.7f), shared::phase_of_droplet(1)})
    for (const float extinction : {0.1f, 1.0f, 6.0f}) {
      auto scene = scene_of(
          nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-1), glm::vec3(1)},
                                                        constant(extinction, 1), phase, glm::ivec3(3))));
      scene->environment = uniform_sky(1);
      for (const glm::vec3 target : {glm::vec3(0), glm::vec3(0.9f, 0.4f, -0.5f)}) {
        const Mean mean = radiance(*scene, towards({3, 1, 4}, target), 1u << 14);
        // Roulette takes part only where paths are long; without it each path is exact.
        EXPECT_NEAR(mean.value(), 1, 3 * mean.error() + 1e-5);
        EXPECT_NEAR(mean.value(), 1, 1e-3);
      }
    }
}

// The same with a ragged medium far below its bounds, which null collisions alone fill.
TEST(RadiativeTransferTest, InAFurnaceARaggedMediumIsNotSeen) {
  const scene::Scene nothing;
  const BoxMedium::Matter ragged{
      [](const glm::vec3& p) {
        return std::max(0.0f, 3 * std::sin(9 * p.x) * std::sin(7 * p.y + 1) * std::sin(8 * p.z));
      },
      4};
  auto scene =
      scene_of(nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-1), glm::vec3(1)}, ragged,
                                                             shared::phase_of_hg(-0.4f), glm::ivec3(5))));
  scene->environment = uniform_sky(2);
  const Mean mean = radiance(*scene, towards({3, 1, 4}, {0.1f, 0, 0}), 1u << 14);
  EXPECT_NEAR(mean.value(), 2, 2e-3);
}

// What emits as much as it absorbs, in surroundings of its own temperature, is not seen either (Kirchhoff).
// Emission that rays find and emission that is sampled share this.
TEST(RadiativeTransferTest, InEquilibriumNothingIsSeen) {
  const scene::Scene nothing;
  for (const float albedo : {0.0f, 0.6f, 0.95f}) {
    const auto extinction = [](const glm::vec3& p) {
      return std::max(0.0f, 2 * std::sin(5 * p.x) * std::sin(4 * p.y + 1));
    };
    const BoxMedium::Matter matter{extinction, 3, glm::vec3(albedo), [=](const glm::vec3& p) {
                                     return glm::vec3(2 * (1 - albedo) * extinction(p));
                                   }};
    auto scene = scene_of(
        nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-1), glm::vec3(1)}, matter,
                                                      shared::phase_of_hg(0.5f), glm::ivec3(6))));
    scene->environment = uniform_sky(2);
    for (const glm::vec3 target : {glm::vec3(0.2f), glm::vec3(0.7f, 0.4f, -0.5f)})
      expect_mean(radiance(*scene, towards({3, 1, 4}, target), 1u << 17), 2, 0.01);
  }
}

TEST(RadiativeTransferTest, HalfSpacesReflectAsChandrasekharSays) {
  const scene::Scene nothing;
  for (const float albedo : {0.5f, 0.9f, 0.99f}) {
    // 40 mean free paths deep and very wide: what goes farther than that is less than a millionth.
    auto scene = scene_of(nothing, media_of(std::make_unique<BoxMedium>(
                                       Box<float>{{-1e4f, -1e4f, -40}, {1e4f, 1e4f, 0}}, constant(1, albedo),
                                       shared::phase_of_hg(0), glm::ivec3(1, 1, 20))));
    for (const auto& [mu, mu0] : {std::pair(0.8, 0.6), std::pair(0.3, 0.9)}) {
      scene->lights = {sun_along({std::sqrt(1 - mu0 * mu0), 0, -mu0}, 1)};
      const glm::vec3 to_eye(0, static_cast<float>(std::sqrt(1 - mu * mu)), static_cast<float>(mu));
      expect_mean(radiance(*scene, towards(5.0f * to_eye, glm::vec3(0)), 1u << 15),
                  half_space_light(double{albedo}, mu, mu0), 0.01);
    }
  }
}

TEST(RadiativeTransferTest, SlabsReflectAndTransmitAsChandrasekharSays) {
  const scene::Scene nothing;
  for (const double depth : {0.3, 2.0})
    for (const float albedo : {0.6f, 1.0f}) {
      auto scene =
          scene_of(nothing, media_of(std::make_unique<BoxMedium>(
                                Box<float>{{-1e4f, -1e4f, -1}, {1e4f, 1e4f, 0}},
                                constant(static_cast<float>(depth), albedo), shared::phase_of_hg(0))));
      const double mu = 0.7, mu0 = 0.45;
      scene->lights = {sun_along({std::sqrt(1 - mu0 * mu0), 0, -mu0}, 1)};
      const SlabLight expected = slab_light(double{albedo}, depth, mu, mu0);
      const glm::vec3 to_eye(0, static_cast<float>(std::sqrt(1 - mu * mu)), static_cast<float>(mu));
      expect_mean(radiance(*scene, towards(5.0f * to_eye, glm::vec3(0)), 1u << 16), expected.reflected, 0.01);
      const glm::vec3 below(to_eye.x, to_eye.y, -to_eye.z);
      expect_mean(
          radiance(*scene, towards(glm::vec3(0, 0, -1) + 5.0f * below, glm::vec3(0, 0, -1)), 1u << 16),
          expected.transmitted, 0.015);
    }
}

TEST(RadiativeTransferTest, SlabsAndHalfSpacesAgreeInDoublePrecision) {
  for (const double albedo : {0.5, 0.9})
    EXPECT_NEAR(slab_light(albedo, 30, 0.8, 0.6).reflected, half_space_light(albedo, 0.8, 0.6), 1e-6);
}

// Light that is scattered once, in a sphere lit from the side: by numerical integration.
TEST(RadiativeTransferTest, SingleScatteringInASphereIsExact) {
  const scene::Scene nothing;
  const float radius = 1.2f, extinction = 0.9f;
  const BoxMedium::Matter sphere{
      [=](const glm::vec3& p) { return glm::length(p) < radius ? extinction : 0.0f; }, extinction,
      glm::vec3(0.8f)};
  auto scene = scene_of(
      nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-radius), glm::vec3(radius)}, sphere,
                                                    shared::phase_of_hg(0.4f), glm::ivec3(6))));
  scene->lights = {sun_along({-1, -0.5f, 0}, 3)};
  const PathLimits once{.max_bounces = 1};
  for (const float height : {0.0f, 0.5f, 1.0f}) {
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(1, 0.5, 0));
    const double half = std::sqrt(double{radius} * double{radius} - double{height} * double{height}),
                 cosine = 0;
    double expected = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = 2 * half * (i + 0.5) / kSteps;
      const glm::dvec3 p(0, double{height}, half - t);
      const double b = glm::dot(p, to_sun),
                   exit = -b + std::sqrt(b * b - glm::dot(p, p) + double{radius} * double{radius});
      expected += std::exp(-double{extinction} * (t + exit)) * 2 * half / kSteps;
    }
    expected *=
        3 * 0.8 * double{extinction} * double{shared::henyey_greenstein(0.4f, static_cast<float>(cosine))};
    expect_mean(radiance(*scene, {{0, height, 5}, {0, 0, -1}}, 1u << 16, once), expected, 0.01);
  }
}

// A point light inside of a medium, which nearest collisions see strongest.
TEST(RadiativeTransferTest, ALightInsideAMediumIsScatteredOnceAsIntegrated) {
  const scene::Scene nothing;
  auto scene =
      scene_of(nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-2), glm::vec3(2)},
                                                             constant(0.4f, 0.9f), shared::phase_of_hg(0))));
  shared::Light source{};
  source.kind = shared::kLightPoint;
  source.position_world = {0.6f, 0, 0};
  source.intensity = glm::vec3(5);
  scene->lights = {source};
  double expected = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 4 * (i + 0.5) / kSteps, z = 2 - t, d2 = 0.36 + z * z;
    expected += std::exp(-0.4 * (t + std::sqrt(d2))) / d2 * 4 / kSteps;
  }
  expected *= 5 * 0.4 * 0.9 / (4 * std::numbers::pi);
  expect_mean(radiance(*scene, {{0, 0, 5}, {0, 0, -1}}, 1u << 16, {.max_bounces = 1}), expected, 0.01);
}

// Long paths end by roulette; the mean does not change.
TEST(RadiativeTransferTest, RouletteLeavesMeansUnchanged) {
  const scene::Scene nothing;
  auto scene =
      scene_of(nothing, media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-1), glm::vec3(1)},
                                                             constant(8, 0.7f), shared::phase_of_hg(0))));
  scene->environment = uniform_sky(1);
  // A slab as wide as it is thick; by paths that carry their weight to the end.
  Mean plain;
  for (std::uint32_t i = 0; i < 1u << 16; ++i) {
    Sampler sampler({i & 255u, i >> 8u}, 1);
    Ray ray = towards({3, 1, 4}, {0, 0.2f, 0});
    double weight = 1;
    glm::vec3 none(0);
    while (weight > 1e-9) {
      const auto collision = scene->media.collide(ray, 0, sampler, none);
      if (!collision) break;
      weight *= 0.7;
      const float z = 2 * sampler.random() - 1, turn = 2 * std::numbers::pi_v<float> * sampler.random(),
                  s = std::sqrt(1 - z * z);
      ray = {ray.at(collision->t), {s * std::cos(turn), s * std::sin(turn), z}};
    }
    plain.add(weight);
  }
  const Mean traced = radiance(*scene, towards({3, 1, 4}, {0, 0.2f, 0}), 1u << 16);
  EXPECT_NEAR(traced.value(), plain.value(), 4 * std::hypot(traced.error(), plain.error()));
  EXPECT_LT(std::hypot(traced.error(), plain.error()), 0.01 * plain.value());
}

}  // namespace
}  // namespace brume::reference
