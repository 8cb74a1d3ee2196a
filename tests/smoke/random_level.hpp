// A level of walls, slanted sheets and columns at random, with smokes, blasts and edits.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::smoke {

class RandomLevel {
 public:
  static constexpr voxel::GridLayout kLayout{{40, 14, 36}, 0.5f, {0, 0, 0}};
  static constexpr std::uint32_t kTicks = 240;  // after which nothing is left

  explicit RandomLevel(unsigned seed) : random_(seed), mesh_(make_mesh()) {}

  const voxel::BitGrid& grid() const { return grid_; }
  const voxel::SurfacePlanes& planes() const { return planes_; }

  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  /// In [0, end).
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
  glm::vec3 point() { return {uniform(0, 20), uniform(0, 7), uniform(0, 18)}; }

  sim::World world() {
    sim::World world(grid_);
    const auto tick = [&](int first, int end) {
      return static_cast<std::uint32_t>(first + below(end - first));
    };
    for (int i = 0; i < 9; ++i) {
      const sim::SmokeSettings settings{static_cast<std::uint32_t>(100 + below(1200)), 30, 60, 40};
      world.append(sim::ThrowSmoke{tick(0, 120), place(), place(), settings}).value_or_throw();
    }
    for (int i = 0; i < 5; ++i) {
      const glm::ivec3 low(below(34), below(10), below(30));
      const glm::ivec3 high = low + glm::ivec3(below(6), below(4), below(6));
      world.append(sim::LevelEdit{tick(20, 170), sim::edit_box(kLayout, low, high, i % 2 == 0)})
          .value_or_throw();
      world
          .append(
              sim::Blast{.tick = tick(30, 150), .at = place(), .radius = 2 * 1024, .refill_middle_ms = 800})
          .value_or_throw();
    }
    return world;
  }

 private:
  sim::Position place() {
    return sim::position_from_metres(glm::dvec3(uniform(1, 19), uniform(1, 6), uniform(1, 17)));
  }
  static void add_sheet(std::vector<voxel::Triangle>& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    mesh.push_back({corner, corner + u, corner + u + v});
    mesh.push_back({corner, corner + u + v, corner + v});
  }
  std::vector<voxel::Triangle> make_mesh() {
    std::vector<voxel::Triangle> mesh;
    for (int i = 0; i < 14; ++i) {
      const glm::vec3 corner(uniform(1, 18), uniform(0, 5), uniform(1, 16));
      glm::vec3 u(uniform(-6, 6), 0, 0), v(0, uniform(1, 5), 0);
      if (i % 3 == 1) u = {uniform(-4, 4), uniform(-2, 2), uniform(-4, 4)};
      if (i % 3 == 2) v = {0, 0, uniform(1, 5)};
      add_sheet(mesh, corner, u, v);
      if (i % 2 == 1) add_sheet(mesh, corner + 0.07f, u, v);
    }
    for (int column = 0; column < 2; ++column) {
      const glm::vec3 middle(uniform(4, 14), 0, uniform(4, 12));
      const float radius = uniform(0.7f, 2.5f);
      const auto at = [&](int k) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / 32;
        return middle + radius * glm::vec3(std::cos(angle), 0, std::sin(angle));
      };
      for (int k = 0; k < 32; ++k) add_sheet(mesh, at(k), at(k + 1) - at(k), {0, 6, 0});
    }
    return mesh;
  }

  std::mt19937 random_;
  std::vector<voxel::Triangle> mesh_;
  voxel::BitGrid grid_ = voxel::voxelize(mesh_, kLayout).value_or_throw();
  voxel::SurfacePlanes planes_ = voxel::SurfacePlanes::build(mesh_, grid_);
};

}  // namespace brume::smoke
