// A busy match for the tests of the C interface, in its terms and in those of the libraries below it.
#pragma once

#include <brume/brume.hpp>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "sim/world.hpp"
#include "smoke/mask_atlas.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::api {

/// 24 x 6 x 20 m in voxels of half a metre: a floor, four walls, a wall with a door and a slope.
struct Match {
  static constexpr std::uint32_t kTicks = 420;
  static constexpr std::uint32_t kMasks = 2;

  explicit Match(unsigned seed = 1);

  brume_layout layout() const;
  voxel::GridLayout grid_layout() const;
  std::vector<voxel::Triangle> triangles() const;
  std::vector<smoke::Mask> sim_masks() const;
  /// The simulation of the match, below the interface, in its level.
  sim::World sim_world(const voxel::BitGrid& level) const;

  brume_triangles_params triangle_params() const;
  Level level(const Context& context) const { return {context, triangle_params()}; }
  Masks masks(const Context& context) const;
  /// Lines within the level and a little beyond it.
  std::vector<brume_segment> segments(std::size_t count, unsigned seed) const;

  std::vector<brume_point> points;
  std::vector<std::uint32_t> indices;
  std::vector<brume_event> events;  ///< By tick.
  std::array<std::vector<std::uint8_t>, kMasks> texels;

 private:
  void add_quad(brume_point a, brume_point b, brume_point c, brume_point d);
  brume_position place();
  void add_shot(std::uint32_t tick, std::uint32_t number);
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  std::mt19937 random_;
};

}  // namespace brume::api
