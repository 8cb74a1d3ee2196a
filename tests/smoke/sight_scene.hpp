// Levels of random boxes with smokes that overlap, a blast, and holes through them.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/voxelize.hpp"

namespace brume::smoke {

class SightScene {
 public:
  static constexpr float kVoxel = 0.5f;
  static constexpr voxel::GridLayout kFrame{{33, 17, 29}, kVoxel, {-3.3f, 1.1f, 7.7f}};

  /// The same for the same seed. Odd ones are without walls.
  SightScene(std::uint32_t seed, int shots, std::uint32_t tick = 150)
      : random_(seed),
        triangles_(seed % 2 ? std::vector<voxel::Triangle>() : boxes()),
        grid_(voxel::voxelize(triangles_, kFrame).value_or_throw()),
        planes_(voxel::SurfacePlanes::build(triangles_, grid_)),
        masks_(MaskAtlas::pack(random_masks()).value_or_throw()),
        world_(grid_, {.masks = masks_.key()}),
        volume_(grid_, planes_) {
    for (const std::uint32_t at : {0u, 20u, 60u}) {
      sim::ThrowSmoke thrown;
      thrown.tick = at;
      thrown.from = thrown.at = sim::position_from_metres(point());
      thrown.smoke.voxels = 400 + static_cast<std::uint32_t>(random_() % 500);
      world_.append(thrown).value_or_throw();
    }
    sim::Blast blast;
    blast.tick = 120;
    blast.at = sim::position_from_metres(point());
    blast.radius = 2 * sim::kUnitsPerMetre;
    world_.append(blast).value_or_throw();
    for (int i = 0; i < shots; ++i) {
      sim::Shot shot;
      shot.tick = 70 + static_cast<std::uint32_t>(random_() % 78);
      shot.origin = sim::position_from_metres(point());
      shot.toward = sim::position_from_metres(point());
      shot.radius = 60 + static_cast<std::uint32_t>(random_() % 500);
      shot.timing.stay_open = static_cast<std::uint32_t>(random_() % 1000);
      shot.shape = static_cast<sim::HoleShape>(i % 3);
      shot.roll = static_cast<std::uint32_t>(i) * 4999 % sim::kFullTurn;
      if (shot.shape == sim::HoleShape::mask) shot.mask = static_cast<std::uint32_t>(i) % masks_.count();
      world_.append(shot).value_or_throw();
    }
    advance_to(tick);
  }
  SightScene(const SightScene&) = delete;
  SightScene& operator=(const SightScene&) = delete;

  void advance_to(std::uint32_t tick) {
    world_.advance_to(tick);
    volume_.update(world_);
    holes_ = make_holes(world_.state(), &masks_);
  }
  float time() const { return world_.state().seconds(world_.tick()); }
  const sim::State& state() const { return world_.state(); }
  const voxel::BitGrid& grid() const { return grid_; }
  const SmokeVolume& volume() const { return volume_; }
  std::span<const shared::Hole> holes() const { return holes_; }
  const MaskAtlas& masks() const { return masks_; }
  Sight sight(SightSettings settings = {}) const {
    settings.masks = &masks_;
    return {volume_, grid_, holes_, time(), settings};
  }

  /// Ends anywhere in the grid and a little beyond it.
  static Segment segment(std::mt19937& random) {
    std::uniform_real_distribution<float> share(-0.1f, 1.1f);
    const auto end = [&] {
      const float x = share(random), y = share(random), z = share(random);
      return kFrame.origin_world + kVoxel * glm::vec3(kFrame.size) * glm::vec3(x, y, z);
    };
    const glm::vec3 a = end(), b = end();
    return {a, b};
  }

 private:
  glm::dvec3 point() {
    std::uniform_real_distribution<double> share(0.1, 0.9);
    const double x = share(random_), y = share(random_), z = share(random_);
    return glm::dvec3(kFrame.origin_world) + double{kVoxel} * glm::dvec3(kFrame.size) * glm::dvec3(x, y, z);
  }
  /// With edges as hard as those of letters, and soft ones.
  static std::vector<Mask> random_masks() {
    std::mt19937 random(99);
    std::vector<Mask> masks;
    for (const std::uint32_t side : {5u, 16u, 40u}) {
      Mask mask{side, side, {}};
      for (std::uint32_t i = 0; i < side * side; ++i) {
        const bool hard = i / side % 8 < 4;
        const int value = static_cast<int>(random() % (hard ? 3 : 256)) * (hard ? 255 : 1);
        mask.texels.push_back(static_cast<std::uint8_t>(std::min(value, 255)));
      }
      masks.push_back(std::move(mask));
    }
    return masks;
  }
  glm::vec3 edge(int axis) {
    std::uniform_real_distribution<float> length(0.05f, 2.5f), tilt(-0.3f, 0.3f);
    glm::vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = i == axis ? length(random_) : tilt(random_);
    return v;
  }
  /// Thin and thick boxes, turned a little.
  std::vector<voxel::Triangle> boxes() {
    std::vector<voxel::Triangle> out;
    const auto face = [&](glm::vec3 at, glm::vec3 a, glm::vec3 b) {
      out.push_back({at, at + a, at + a + b});
      out.push_back({at, at + a + b, at + b});
    };
    for (int i = 0; i < 14; ++i) {
      const glm::vec3 low(point()), u = edge(0), v = edge(1), w = edge(2);
      face(low, u, v), face(low + w, u, v);
      face(low, v, w), face(low + u, v, w);
      face(low, w, u), face(low + v, w, u);
    }
    return out;
  }

  std::mt19937 random_;
  std::vector<voxel::Triangle> triangles_;
  voxel::BitGrid grid_;
  voxel::SurfacePlanes planes_;
  MaskAtlas masks_;
  sim::World world_;
  SmokeVolume volume_;
  std::vector<shared::Hole> holes_;
};

}  // namespace brume::smoke
