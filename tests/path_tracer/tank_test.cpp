// The path tracer of tanks against closed forms and numeric integrals.
#include "core/tasks.hpp"
#include "tests/path_tracer/tank_fixture.hpp"

namespace brume::reference {
namespace {

/// Rays from around a tank to points in it.
Ray random_ray(std::mt19937& random, const spheres::Tank& tank) {
  std::uniform_real_distribution<float> share(-0.5f, 0.5f);
  const auto point = [&](float scale) {
    return scale * tank.voxel * glm::vec3(tank.size) * glm::vec3(share(random), share(random), share(random));
  };
  const glm::vec3 from = point(4);
  return ray_between(from, point(1));
}

TEST(TankModelTest, FindsTheSphereThatAllTriedFind) {
  spheres::Tank tank = tank_of({90, 60, 40});
  pack_at_random(tank, 20000, {0.5f, 9}, 200, 255, 1);
  ASSERT_GT(tank.spheres.size(), 200u);
  const scene::TankScene scene = dark_scene();
  const TankModel model(tank, scene);
  std::mt19937 random(2);
  int hits = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const Ray world = random_ray(random, tank);
    const TankRay ray{model.voxel_from_world(world.origin), glm::normalize(glm::dvec3(world.direction))};
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t expected = TankRay::kNone;
    for (std::uint32_t s = 0; s < tank.spheres.size(); ++s) {
      // Of the quadratic's two solutions, the first.
      const glm::dvec3 o = ray.origin - glm::dvec3(tank.spheres[s].center);
      const double b = glm::dot(o, ray.direction), r = double{tank.spheres[s].radius};
      const double rest = b * b - glm::dot(o, o) + r * r;
      if (rest < 0) continue;
      const double t = -b - std::sqrt(rest);
      if (t < 0 || t >= nearest) continue;
      nearest = t;
      expected = s;
    }
    Sampler sampler = path_sampler(i);
    const TankEvent found = model.next_event(ray, std::numeric_limits<double>::infinity(), sampler);
    EXPECT_EQ(found.sphere, expected) << i;
    if (expected == TankRay::kNone) continue;
    ++hits;
    EXPECT_NEAR(found.t, nearest, 1e-9);
    EXPECT_EQ(model.transmittance(ray, nearest + 1e-6), 0);
    EXPECT_EQ(model.transmittance(ray, nearest - 1e-6), 1);
  }
  EXPECT_GT(hits, 1000);
}

TEST(TankFurnace, WhateverIsInItIsAsBrightAsAllAround) {
  // Nothing absorbs, and light of radiance 1 comes from everywhere: each path finds it.
  for (const bool has_glass : {false, true}) {
    spheres::Tank tank = tank_of({60, 60, 40});
    pack_at_random(tank, 5000, {2, 10}, 255, 30, 3);
    scene::TankScene scene = dark_scene();
    scene.sky.zenith = scene.sky.horizon = scene.sky.ambient = glm::vec3(1);
    scene.bounces = 1u << 20;
    // It overlaps the tank.
    if (has_glass) scene.glass = scene::TankGlass{{0.1f, 0, 0.2f}, {0.3f, 0.2f, 0.25f}, 1.5f};
    const TankModel model(tank, scene);
    std::mt19937 random(4);
    Mean brightness;
    double multiple = 0;
    for (std::uint32_t i = 0; i < 20000 / kFewer; ++i) {
      Sampler sampler = path_sampler(i);
      const PathSample found = trace_tank_path(model, random_ray(random, tank), sampler);
      brightness.add(double{all_of(found).g});
      multiple += double{found.multiple.g};
    }
    // Only what total reflection keeps inside of the glass is lost: no path in most runs.
    EXPECT_NEAR(brightness.value(), 1, 1e-3);
    if (!has_glass) {
      EXPECT_NEAR(brightness.value(), 1, 1e-6);
    }
    EXPECT_GT(multiple, 20000 / kFewer / 20);
  }
}

TEST(TankSurfaces, ABallIsAsBrightAsLambertSays) {
  spheres::Tank tank = tank_of({40, 40, 40});
  put(tank, {20, 20, 20}, 15, grey(188));
  scene::TankScene scene = dark_scene();
  scene.lights = {{{30, 0, 0}, glm::vec3(1, 0.5f, 0.25f), 500, 0}};
  const TankModel model(tank, scene);
  const double albedo = model.albedo(0).x;
  // Every path finds the same: albedo / pi times I cos / d^2.
  for (const glm::vec3 at :
       {glm::vec3(0.15f, 0, 0), glm::vec3(0.09f, 0.12f, 0), glm::vec3(0.05f, 0.1f, 0.1f)}) {
    Sampler sampler = path_sampler(1);
    const PathSample found = trace_tank_path(model, ray_between(at + glm::vec3(2, 1, 1), at), sampler);
    const glm::dvec3 apart = glm::dvec3(30, 0, 0) - glm::dvec3(at), normal = glm::normalize(glm::dvec3(at));
    const double irradiance = 500 * glm::dot(normal, glm::normalize(apart)) / glm::dot(apart, apart);
    EXPECT_NEAR(double{found.single.r}, albedo / kPi * irradiance, 1e-5 * irradiance);
    EXPECT_NEAR(double{found.single.b}, albedo / kPi * irradiance / 4, 1e-5 * irradiance);
    EXPECT_NEAR(double{found.distance}, std::sqrt(6.0), 1e-5);
    EXPECT_LT(glm::distance(glm::dvec3(found.normal), normal), 1e-5);
    EXPECT_NEAR(double{found.albedo.g}, albedo, 1e-6);
  }

  // Of the whole disk that it shows to one side: 2 / 3 albedo E / pi (sin g + (pi - g) cos g) / pi for light
  // at the phase angle g (Lambert's sphere; e.g. van de Hulst 1980, "Multiple Light Scattering"). The light's
  // rays are parallel but for 0.15 / 30, the square of which is 2.5e-5.
  for (const double phase : {kPi / 2, kPi / 3}) {
    const glm::dvec3 view(std::cos(phase), std::sin(phase), 0), side(-view.y, view.x, 0), up(0, 0, 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    Mean mean;
    for (std::uint32_t i = 0; i < 200000 / kFewer; ++i) {
      const double out = 0.15 * std::sqrt(share(random)), angle = 2 * kPi * share(random);
      const glm::dvec3 origin = 2.0 * view + out * std::cos(angle) * side + out * std::sin(angle) * up;
      Sampler sampler = path_sampler(i);
      mean.add(double{trace_tank_path(model, {glm::vec3(origin), glm::vec3(-view)}, sampler).single.r});
    }
    const double irradiance = 500.0 / 900;
    expect_mean(
        mean, 2.0 / 3 * albedo * irradiance / kPi * (std::sin(phase) + (kPi - phase) * std::cos(phase)) / kPi,
        0.005);
  }
}

TEST(TankSurfaces, LightsOfAnySizeGiveTheSameIrradianceWhereAllOfThemIsVisible) {
  // A ball of constant radiance: pi L sin^2 times the cosine of its middle, as from a point.
  spheres::Tank tank = tank_of({40, 40, 40});
  put(tank, {20, 20, 20}, 15, kWhite);
  scene::TankScene scene = dark_scene();
  for (const float radius : {0.0f, 0.1f, 0.5f}) {
    scene.lights = {{{1.0f, 0, 0}, glm::vec3(1), 2, radius}};
    const TankModel model(tank, scene);
    Mean mean;
    for (std::uint32_t i = 0; i < 40000 / kFewer; ++i) {
      Sampler sampler = path_sampler(i);
      const glm::vec3 at = 0.15f * glm::vec3(0.96f, 0.28f, 0);
      mean.add(double{trace_tank_path(model, ray_between(at + glm::vec3(1, 1, 1), at), sampler).single.g});
    }
    const glm::dvec3 apart(1 - 0.15 * 0.96, -0.15 * 0.28, 0);
    const double cosine = (apart.x * 0.96 + apart.y * 0.28) / glm::length(apart);
    // 1e-5: the ray's direction is of floats.
    EXPECT_NEAR(mean.value(), 2 * cosine / glm::dot(apart, apart) / kPi, 4 * mean.error() + 1e-5);
    EXPECT_LT(mean.error(), 0.002 * kLooser);
  }
}

/// A ball of medium in the middle of a tank.
constexpr std::uint32_t kOpacity = 10;
const double kExtinction = -std::log(1 - kOpacity / 255.0);  // per voxel

TEST(TankMedia, ABallPassesLightByBeersLaw) {
  spheres::Tank tank = tank_of({60, 60, 60});
  put(tank, {30, 30, 30}, 25, grey(255, kOpacity));
  scene::TankScene scene = dark_scene();
  scene.sky.zenith = scene.sky.horizon = glm::vec3(1);
  const TankModel model(tank, scene);
  for (const float off : {0.0f, 0.15f, 0.24f}) {
    const double chord = 2 * std::sqrt(25.0 * 25 - 100.0 * double{off} * 100 * double{off});
    const double expected = std::exp(-kExtinction * chord);
    const Ray ray{{off, 0, 3}, {0, 0, -1}};
    EXPECT_NEAR(model.transmittance({model.voxel_from_world(ray.origin), {0, 0, -1}}, 1e9), expected, 1e-5);
    Mean passed, clear;
    for (std::uint32_t i = 0; i < 100000 / kFewer; ++i) {
      Sampler sampler = path_sampler(i);
      const PathSample found = trace_tank_path(model, ray, sampler);
      passed.add(double{found.seen.g});
      clear.add(found.through_media ? 1 : 0);
      EXPECT_TRUE(std::isinf(found.distance));
    }
    expect_mean(passed, expected, 0.02);
    expect_mean(clear, expected, 0.02);
  }
}

TEST(TankMedia, ABallScattersOnceAsTheIntegralSays) {
  spheres::Tank tank = tank_of({60, 60, 60});
  put(tank, {30, 30, 30}, 25, grey(188, kOpacity));
  scene::TankScene scene = dark_scene();
  scene.lights = {{{0.5f, 0.6f, 0.2f}, glm::vec3(1), 3, 0}};
  const TankModel model(tank, scene);
  const double off = 8;  // voxels from the middle
  Mean mean;
  for (std::uint32_t i = 0; i < 200000 / kFewer; ++i) {
    Sampler sampler = path_sampler(i);
    mean.add(double{trace_tank_path(model, {{0.08f, 0, 3}, {0, 0, -1}}, sampler).single.g});
  }
  // Along the ray, by the midpoint rule. From the middle of the ball, in voxels.
  const glm::dvec3 light(50, 60, 20);
  const double half = std::sqrt(25.0 * 25 - off * off);
  constexpr int kSteps = 20000;
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = 2 * half * (i + 0.5) / kSteps;
    const glm::dvec3 at(off, 0, half - s), to_light = glm::normalize(light - at);
    const double b = glm::dot(at, to_light);
    const double inside = -b + std::sqrt(b * b - glm::dot(at, at) + 25.0 * 25);
    const double squared = glm::dot(light - at, light - at) * 1e-4;
    expected += kExtinction * std::exp(-kExtinction * (s + inside)) / squared;
  }
  expected *= 3 * model.albedo(0).g / (4 * kPi) * 2 * half / kSteps;
  expect_mean(mean, expected, 0.005);
}

TEST(TankAir, FogIsAsLongAsTheRayIsInTheTank) {
  const spheres::Tank tank = tank_of({50, 60, 70});
  scene::TankScene scene = dark_scene();
  scene.sky.zenith = scene.sky.horizon = glm::vec3(0.8f);
  scene.fog = {2, {0.1f, 0.2f, 0.3f}};
  Sampler sampler = path_sampler(1);
  const auto blue = [&](const Ray& ray) {
    return double{trace_tank_path(TankModel(tank, scene), ray, sampler).seen.b};
  };
  const auto expected = [](double length) {
    return 0.8 * std::exp(-2 * length) + 0.3 * (1 - std::exp(-2 * length));
  };
  EXPECT_NEAR(blue({{0, 0, 3}, {0, 0, -1}}), expected(0.7), 1e-5);
  EXPECT_NEAR(blue({{3, 0.29f, 0}, {-1, 0, 0}}), expected(0.5), 1e-5);
  EXPECT_NEAR(blue({{3, 0.31f, 0}, {-1, 0, 0}}), 0.8, 1e-5);
  EXPECT_NEAR(blue({{0, 0, 0}, {0, 1, 0}}), expected(0.3), 1e-5);
  // Not in the glass, of an index that bends and reflects nothing: only in the 0.2 m behind it.
  scene.glass = scene::TankGlass{{0, 0, 0.25f}, {0.4f, 0.4f, 0.4f}, 1.0f};
  EXPECT_NEAR(blue({{0, 0, 3}, {0, 0, -1}}), expected(0.2), 1e-5);
}

TEST(TankRender, PicturesAreTheSameForAnyNumberOfThreads) {
  spheres::Tank tank = tank_of({60, 60, 40});
  pack_at_random(tank, 3000, {2, 10}, 200, 60, 6);
  scene::TankScene scene = dark_scene();
  scene.sky.ambient = glm::vec3(0.3f);
  scene.lights = {{{0.5f, 1, 0.5f}, glm::vec3(1), 2, 0.1f}};
  scene.glass = scene::TankGlass{{0, 0, 0.5f}, {0.2f, 0.15f, 0.1f}, 1.5f};
  scene.bounces = 3;
  const TankModel model(tank, scene);
  RenderSettings settings;
  settings.size_px = {37, 21};
  scene::Camera camera{{0.2f, 0.1f, 1.5f}, {0, 0, 0}, 0.6f};
  camera.lens = {.aperture = 0.02f, .blades = 6};
  settings.eyes = {make_eye(camera, settings.size_px)};
  settings.blades = 6;
  settings.samples = 4;
  std::vector<std::vector<glm::vec4>> pictures;
  for (const unsigned threads : {1u, 2u, 7u}) {
    set_thread_count(threads);
    Render render(tank_trace(model), settings);
    while (!render.advance(10, [] { return false; })) {
    }
    pictures.push_back(render.radiance());
  }
  set_thread_count(0);
  EXPECT_EQ(pictures[1], pictures[0]);
  EXPECT_EQ(pictures[2], pictures[0]);
  double sum = 0;
  for (const glm::vec4& pixel : pictures[0]) sum += double{pixel.g};
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace brume::reference
