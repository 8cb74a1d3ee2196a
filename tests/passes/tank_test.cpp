#include <algorithm>
#include <cmath>

#include "brume_test_shaders.hpp"
#include "passes/tank_light.hpp"
#include "planning/tank_light_plan.hpp"
#include "tests/passes/probes.h"
#include "tests/passes/tank_fixture.hpp"

namespace brume::passes {
namespace {

class TankTest : public gpu::GpuTest {};

/// All voxels of a tank, by asking every sphere.
template <typename Visit>
void for_each_voxel(const glm::ivec3& size, const Visit& visit) {
  glm::ivec3 voxel;
  for (voxel.z = 0; voxel.z < size.z; ++voxel.z)
    for (voxel.y = 0; voxel.y < size.y; ++voxel.y)
      for (voxel.x = 0; voxel.x < size.x; ++voxel.x) visit(voxel);
}

glm::uvec4 ids_by_brute_force(const spheres::Tank& tank, const glm::ivec3& voxel) {
  shared::NearestIds nearest = shared::nearest_none();
  for (std::size_t i = 0; i < tank.spheres.size(); ++i)
    if (const glm::vec4 sphere = spheres::packed(tank.spheres[i]);
        shared::sphere_touches_voxel(sphere, voxel))
      nearest = shared::nearest_add(nearest, static_cast<glm::uint>(i) + 1,
                                    shared::sphere_power(sphere, shared::voxel_middle(voxel)));
  return shared::ids_to_store(nearest);
}

spheres::Color color_by_brute_force(const spheres::Tank& tank, const glm::ivec3& voxel) {
  for (std::size_t i = 0; i < tank.spheres.size(); ++i)
    if (glm::distance(glm::dvec3(tank.spheres[i].center), glm::dvec3(voxel) + 0.5) <
        double{tank.spheres[i].radius})
      return tank.colors[i];
  return 0;
}

TEST_F(TankTest, FindsTheIdsAndColoursOfAllVoxels) {
  struct Case {
    glm::uvec3 size;
    glm::vec2 radius;
    int tries;
  };
  // Radii below a voxel overflow the four ids of some.
  for (const Case& one : {Case{{1, 1, 1}, {0.1f, 0.4f}, 20}, Case{{7, 7, 7}, {0.3f, 2}, 200},
                          Case{{33, 17, 5}, {0.2f, 2.4f}, 3000}}) {
    const glm::uvec3 size = one.size;
    const spheres::Tank tank = random_tank(size, one.radius, one.tries, 200, 5);
    ASSERT_FALSE(tank.spheres.empty());
    const DeviceTank device(context(), runner(), tank);
    const auto ids = read_back<glm::uvec2>(device.volume.ids);
    const auto colors = read_back<std::uint32_t>(device.volume.colors);
    std::size_t overflows = 0;
    for_each_voxel(glm::ivec3(size), [&](const glm::ivec3& voxel) {
      const std::size_t i = voxel_index(glm::ivec3(size), voxel);
      const glm::uvec4 expected = ids_by_brute_force(tank, voxel);
      overflows += shared::ids_overflow(expected) ? 1 : 0;
      EXPECT_EQ(shared::unpack_short_ids(ids[i]), expected);
      EXPECT_EQ(colors[i], color_by_brute_force(tank, voxel));
    });
    if (size.x == 33) {
      EXPECT_GT(overflows, 0u);
    }
  }
}

struct Ray {
  glm::vec4 origin, direction;
};

std::vector<Ray> random_rays(const glm::vec3& size, std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  std::normal_distribution<float> normal(0, 1);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    // From inside and from outside, some along an axis.
    glm::vec3 origin = size * (3.0f * glm::vec3(unit(random), unit(random), unit(random)) - 1.0f);
    glm::vec3 to = size * glm::vec3(unit(random), unit(random), unit(random));
    if (i % 8 == 0) to = {origin.x, origin.y, to.z};
    if (i % 8 == 1) to = {to.x, origin.y = to.y, origin.z = to.z};
    rays.push_back({glm::vec4(origin, 1e30f), glm::vec4(glm::normalize(to - origin), 0)});
  }
  return rays;
}

/// The nearest surface that a ray enters, and its sphere, in double.
std::pair<double, std::size_t> hit_by_brute_force(const spheres::Tank& tank, const Ray& ray, double* second) {
  const glm::dvec3 origin(ray.origin), direction = glm::normalize(glm::dvec3(ray.direction));
  double best = 1e30;
  std::size_t id = 0;
  *second = 1e30;
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const glm::dvec3 apart = origin - glm::dvec3(tank.spheres[i].center);
    const double along = -glm::dot(apart, direction), radius = double{tank.spheres[i].radius};
    const glm::dvec3 across = apart + along * direction;
    const double rest = radius * radius - glm::dot(across, across);
    if (rest < 0 || along - std::sqrt(rest) < 0) continue;
    const double t = along - std::sqrt(rest);
    *second = t < best ? best : std::min(*second, t);
    if (t < best) {
      best = t;
      id = i + 1;
    }
  }
  return {best, id};
}

TEST_F(TankTest, RaysHitTheNearestSphereExactly) {
  const spheres::Tank tank = random_tank({70, 50, 33}, {0.5f, 6}, 20000, 255, 9);
  const DeviceTank device(context(), runner(), tank);
  const std::vector<Ray> rays = random_rays(glm::vec3(tank.size), 20000);
  shared::TankConstants constants{};
  constants.size = glm::ivec3(tank.size);
  constants.bricks = device.volume.bricks;
  const gpu::Buffer stored = upload(std::vector{constants}), in = upload(rays);
  const gpu::Buffer out = upload(std::vector<glm::vec2>(rays.size()));
  const gpu::Sampler nearest(context(), {VK_FILTER_NEAREST});

  for (const std::uint32_t has_ids : {0u, 1u}) {
    const gpu::ComputePipeline pipeline(context(), shaders::sphere_probe_comp, {1u, 0u, has_ids});
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(pipeline, {{shared::kBindTank, gpu::read(stored)},
                               {shared::kBindSpheres, gpu::read(device.volume.spheres)},
                               {shared::kBindSphereColors, gpu::read(device.volume.sphere_colors)},
                               {shared::kBindSphereBricks, gpu::read(device.volume.brick_ranges)},
                               {shared::kBindSphereList, gpu::read(device.volume.brick_spheres)},
                               {shared::kBindVoxelIds, gpu::sampled(device.volume.ids, nearest)},
                               {shared::kBindProbeIn, gpu::read(in)},
                               {shared::kBindProbeOut, gpu::write(out)}});
      recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(rays.size()));
    });
    const auto hits = read_back<glm::vec2>(out, rays.size());
    std::size_t hit = 0, other = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      double second = 0;
      const auto [t, id] = hit_by_brute_force(tank, rays[i], &second);
      // Rounding of positions e moves the surface along a ray that grazes it by up to sqrt(2 e r).
      const double e = 4 * 0x1p-24 * 3 * 70 * 2, graze = std::sqrt(2 * e * 6) + e;
      if (static_cast<std::size_t>(hits[i].y) == id) {
        if (id != 0) {
          EXPECT_NEAR(double{hits[i].x}, t, graze) << i;
        }
        hit += id != 0 ? 1 : 0;
      } else {
        ++other;  // Grazed by less than the rounding: the next one is hit, or the one before.
      }
    }
    EXPECT_GT(hit, rays.size() / 4);
    // The share of rays that pass within e of a silhouette: 2 e / r of those that meet a sphere's
    // surroundings, with radii of 0.5 at least and some ten silhouettes along a ray.
    EXPECT_LE(static_cast<double>(other),
              1 + static_cast<double>(rays.size()) * 10 * (4 * 0x1p-24 * 3 * 70 * 2) / 0.5 * 2);
  }
}

/// Transmittance from the middle of a voxel to a light over painted voxels: the traversal of the source, in
/// double.
double light_by_brute_force(const std::vector<std::uint32_t>& colors, const glm::ivec3& size,
                            const glm::ivec3& voxel, const glm::dvec3& light) {
  const glm::dvec3 origin = glm::dvec3(voxel) + 0.5, direction = light - origin;
  // All planes of voxels that are crossed, in order.
  std::vector<double> crossings{0, 1};
  for (int axis = 0; axis < 3; ++axis)
    for (int plane = 0; plane <= size[axis]; ++plane)
      if (const double t = (plane - origin[axis]) / direction[axis]; t > 0 && t < 1) crossings.push_back(t);
  std::ranges::sort(crossings);
  double depth = 0;
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    const glm::dvec3 middle = origin + direction * (0.5 * (crossings[i - 1] + crossings[i]));
    const glm::ivec3 at(glm::floor(middle));
    if (at == voxel || glm::any(glm::lessThan(at, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(at, size)))
      continue;
    const double length = (crossings[i] - crossings[i - 1]) * glm::length(direction);
    const std::uint32_t opacity = colors[voxel_index(size, at)] >> 24;
    depth += opacity == 255 ? (length > 1e-5 ? 1e6 : 0) : -std::log(1 - opacity / 255.0) * length;
  }
  return std::exp(-depth);
}

/// The light of one source of intensity 1 in each voxel, as transmittance.
class VoxelLight {
 public:
  VoxelLight(gpu::Context& context, gpu::CommandRunner& runner, const DeviceTank& tank,
             const glm::vec3& light, scene::TankLighting lighting)
      : image(make_voxel_light(context, glm::uvec3(tank.volume.size))) {
    TankLightPass pass(context);
    const std::vector<shared::TankLight> lights{{light, 0, glm::vec3(1e5f)}};
    pass.reserve(tank.volume, lights, lighting);
    runner.run([&](gpu::Recorder& recorder) { pass.record(recorder, tank.volume, image, glm::vec3(0)); });
  }
  gpu::Image image;
};

double transmittance_of(std::uint32_t packed, std::uint32_t color, const glm::ivec3& voxel,
                        const glm::vec3& light) {
  const glm::dvec3 apart = glm::dvec3(light) - glm::dvec3(voxel) - 0.5;
  const double phase = (color >> 24 == 255 ? 0.5 : 0.25) / 3.14159265358979;
  return double{shared::unpack_rgb9e5(packed).x} * std::max(glm::dot(apart, apart), 0.25) / (1e5 * phase);
}

TEST_F(TankTest, ExactLightIsThatOfTheTraversal) {
  const spheres::Tank tank = random_tank({33, 17, 15}, {1, 5}, 2000, 60, 11);
  const DeviceTank device(context(), runner(), tank);
  const auto colors = read_back<std::uint32_t>(device.volume.colors);
  for (const glm::vec3& light : {glm::vec3(-20.3f, 40.1f, 30.7f), glm::vec3(16.2f, 8.4f, 7.9f)}) {
    const VoxelLight exact(context(), runner(), device, light, scene::TankLighting::exact);
    const auto found = read_back<std::uint32_t>(exact.image);
    for_each_voxel(glm::ivec3(tank.size), [&](const glm::ivec3& voxel) {
      const std::size_t i = voxel_index(glm::ivec3(tank.size), voxel);
      if (colors[i] == 0) {
        EXPECT_EQ(found[i], 0u);
        return;
      }
      const double expected = light_by_brute_force(colors, glm::ivec3(tank.size), voxel, glm::dvec3(light));
      // Nine bits; floats over up to 65 voxels; and what lies below the smallest positive value.
      EXPECT_NEAR(transmittance_of(found[i], colors[i], voxel, light), expected,
                  expected * (0x1p-9 + 1e-4) + 2e-5);
    });
  }
}

TEST_F(TankTest, MappedLightIsNearlyExact) {
  // Outside before one side, outside beyond a corner, inside.
  const std::vector<glm::vec3> lights{{40, 160, 30}, {-60, 120, 90}, {41.3f, 33.8f, 27.1f}};
  for (const std::uint32_t opacity : {12u, 255u}) {
    const spheres::Tank tank = random_tank({80, 72, 56}, {2, 9}, 6000, opacity, 17);
    const DeviceTank device(context(), runner(), tank);
    const auto colors = read_back<std::uint32_t>(device.volume.colors);
    for (const glm::vec3& light : lights) {
      const VoxelLight mapped(context(), runner(), device, light, scene::TankLighting::maps);
      const VoxelLight exact(context(), runner(), device, light, scene::TankLighting::exact);
      const auto of_maps = read_back<std::uint32_t>(mapped.image),
                 of_all = read_back<std::uint32_t>(exact.image);
      std::vector<double> errors;
      for_each_voxel(glm::ivec3(tank.size), [&](const glm::ivec3& voxel) {
        const std::size_t i = voxel_index(glm::ivec3(tank.size), voxel);
        if (colors[i] == 0) return;
        errors.push_back(std::abs(transmittance_of(of_maps[i], colors[i], voxel, light) -
                                  transmittance_of(of_all[i], colors[i], voxel, light)));
      });
      std::ranges::sort(errors);
      double mean = 0;
      for (const double error : errors) mean += error / static_cast<double>(errors.size());
      const double most = errors[errors.size() * 99 / 100];
      EXPECT_LE(mean, 0.02);
      EXPECT_LE(most, 0.05);
    }
  }
}

}  // namespace
}  // namespace brume::passes
