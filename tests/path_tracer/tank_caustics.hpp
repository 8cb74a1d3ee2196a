// Light through glass onto three tanks, by photons and by the paths of the reference.
#pragma once

#include <string>

#include "core/tasks.hpp"
#include "spheres/brick_lists.hpp"
#include "tests/path_tracer/tank_fixture.hpp"

namespace brume::reference {

enum class CausticTank { large_balls, media, packed };

/// Behind a ball of glass, so that no light comes to most of it but through the glass.
inline spheres::Tank caustic_tank(CausticTank kind) {
  spheres::Tank tank = tank_of({100, 100, 40});
  if (kind == CausticTank::packed) {
    pack_at_random(tank, 4000, {2, 9}, 210, 70, 11);
    return tank;
  }
  for (const float x : {25.0f, 75.0f})
    for (const float y : {25.0f, 75.0f})
      put(tank, {x, y, 20}, 19.5f, kind == CausticTank::media ? grey(230, 12) : grey(210));
  return tank;
}

/// Two lights, a large one and one in an other place with another colour. Three bounces: light that comes
/// through the glass is scattered on.
inline scene::TankScene caustic_scene() {
  scene::TankScene scene = dark_scene();
  scene.bounces = 3;
  scene.glass = scene::TankGlass{{0, 0, 1.2f}, {0.6f, 0.6f, 0.5f}, 1.5f};
  scene.lights = {{{0.1f, 0.2f, 3.0f}, glm::vec3(1), 5, 0.4f},
                  {{-0.9f, 0.3f, 2.6f}, glm::vec3(0.2f, 1, 1), 4, 0.3f}};
  return scene;
}

/// Mean radiance of a picture by both.
struct CausticMeans {
  Mean traced, gathered;
  Mean difference;    ///< Of the means of rounds, each with photons of its own.
  double direct = 0;  ///< What no glass has a part in.
};

inline CausticMeans caustic_means(CausticTank kind, std::uint32_t rounds, std::uint32_t paths,
                                  std::uint32_t photons) {
  const spheres::Tank tank = caustic_tank(kind);
  const spheres::BrickLists bricks = list_bricks(tank);
  const TankModel model(tank, caustic_scene());
  const spheres::LightPaths none;
  CausticMeans means;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const spheres::LightPaths found =
        spheres::trace_light_paths(tank, bricks, light_path_scene(model), {.count = photons, .seed = round});
    std::vector<glm::dvec3> sums(std::size_t{paths} / 1000);
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        for (std::uint32_t i = 0; i < 1000; ++i) {
          const std::uint32_t path = round * paths + static_cast<std::uint32_t>(part) * 1000 + i;
          // A camera beside the glass that shows the tank's front.
          const glm::vec3 target((shared::hash3({path, 1, 2}) - 0.5f) * glm::vec3(1, 1, 0.4f));
          const Ray ray = ray_between({1.1f, 0.7f, 1.6f}, target);
          const std::array<const spheres::LightPaths*, 3> sources{nullptr, &found, &none};
          for (int k = 0; k < 3; ++k) {
            Sampler sampler = path_sampler(path);
            const glm::vec3 all =
                all_of(trace_tank_path(model, ray, sampler, sources[static_cast<std::size_t>(k)]));
            sums[part][k] += double{all.r + all.g + all.b} / 3000;
          }
        }
    });
    glm::dvec3 sum(0);
    for (const glm::dvec3& part : sums) sum += part / static_cast<double>(sums.size());
    means.traced.add(sum.x);
    means.gathered.add(sum.y);
    means.difference.add(sum.y - sum.x);
    means.direct += sum.z / rounds;
  }
  return means;
}

/// The rounds are independent: the standard error of the mean of their differences is to be below `known`,
/// and the mean below `allowed`. Both relative to what comes through the glass, which is most of the light.
inline void expect_caustic(CausticTank kind, std::uint32_t rounds, std::uint32_t paths, std::uint32_t photons,
                           double known, double allowed) {
  const CausticMeans means = caustic_means(kind, rounds, paths, photons);
  const double through = means.traced.value() - means.direct;
  const double off = means.difference.value() / through, error = means.difference.error() / through;
  std::printf("traced %.5f, gathered %.5f, direct alone %.5f: off by %.2f %% +- %.2f %%\n",
              means.traced.value(), means.gathered.value(), means.direct, 100 * off, 100 * error);
  EXPECT_GT(through, means.direct);
  EXPECT_LT(std::abs(off), allowed);
  EXPECT_LT(error, known * kLooser);
}

}  // namespace brume::reference
