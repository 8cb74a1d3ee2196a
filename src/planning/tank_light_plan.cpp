#include "planning/tank_light_plan.hpp"

#include <algorithm>
#include <cmath>

namespace brume::planning {
namespace {

/// Rays through a voxel of the farthest layer, along each axis. With so many, at most 1 in 100 voxels is off
/// by more than 5 %.
constexpr float kRaysPerVoxel = 2.2f;

// The layers of a map along an axis: depths of the first and the last one whose middles are before the light.
struct Layers {
  float first = 0, last = -1;
  bool empty() const { return last < first; }
};

Layers layers_of(float position, float size, float sign) {
  // Depths of the middles of the voxels at both ends, the nearer first.
  const float low = sign > 0 ? 0.5f - position : position - (size - 0.5f);
  const float high = low + size - 1;
  // Layers behind the light belong to the opposite direction; a layer in the plane of the light to neither.
  const float first = low > 0 ? low : low + std::floor(-low) + 1;
  return {first, high};
}

shared::LightMap make_map(const glm::vec3& position, const glm::vec3& size, glm::uint axis, float sign,
                          const Layers& layers, bool whole, std::uint64_t most_texels) {
  shared::LightMap map{};
  map.origin = position;
  map.axis = axis;
  map.sign = sign;
  map.first_depth = layers.first;
  map.layers =
      static_cast<glm::uint>(std::lround(layers.last - layers.first) / std::lround(shared::kMapLayerStep)) +
      1;
  map.whole = whole ? 1 : 0;

  // Slopes to the middles of all voxels, from the nearest and from the farthest layer.
  const glm::vec2 at(shared::to_map_axes(axis, position)), extent(shared::to_map_axes(axis, size));
  glm::vec2 low(1e30f), high(-1e30f);
  for (const float depth : {layers.first, layers.last})
    for (const glm::vec2& side : {glm::vec2(0.5f), extent - 0.5f}) {
      low = glm::min(low, (side - at) / depth);
      high = glm::max(high, (side - at) / depth);
    }
  if (!whole) {
    low = glm::clamp(low, -1.0f, 1.0f);
    high = glm::clamp(high, -1.0f, 1.0f);
  }

  // As many rays as there is room for.
  glm::vec2 rays = (high - low) * (layers.last * kRaysPerVoxel);
  const float most = static_cast<float>(kMostMapRays - 2);
  const double texels = double{rays.x + 2} * double{rays.y + 2} * map.layers;
  const double fit = std::sqrt(std::min(1.0, static_cast<double>(most_texels) / texels));
  rays = glm::min(rays * static_cast<float>(fit), glm::vec2(most));
  map.rays = glm::max(glm::uvec2(glm::ceil(rays)) + 1u, 2u);
  map.first_slope = low;
  map.slope_step = glm::max((high - low) / glm::vec2(map.rays - 1u), 1e-9f);
  return map;
}

}  // namespace

std::vector<shared::LightMap> light_maps(const glm::vec3& position, const glm::ivec3& size,
                                         std::uint64_t most_texels) {
  const glm::vec3 extent(size);
  // Outside: along the axis where the farthest layer is the least times farther than the nearest.
  constexpr float kNearest = 1;  // distance of the first layer: nearer, slopes are too steep
  std::vector<shared::LightMap> maps;
  float least = 1e30f;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      const bool before =
          sign > 0 ? position[axis] < 0.5f - kNearest : position[axis] > extent[axis] - 0.5f + kNearest;
      if (!before) continue;
      const Layers layers = layers_of(position[axis], extent[axis], sign);
      const float spread = layers.last / layers.first;
      if (spread >= least) continue;
      least = spread;
      maps = {make_map(position, extent, static_cast<glm::uint>(axis), sign, layers, true, most_texels)};
    }
  // A map whose rays would have to lie far apart shows less than six with slopes up to 1.
  constexpr float kMostSpread = 4;
  if (least <= kMostSpread) return maps;

  maps.clear();
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      const Layers layers = layers_of(position[axis], extent[axis], sign);
      if (layers.empty()) continue;
      maps.push_back(
          make_map(position, extent, static_cast<glm::uint>(axis), sign, layers, false, most_texels));
    }
  return maps;
}

}  // namespace brume::planning
