#include "planning/volume_light_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/box.hpp"

namespace brume::planning {
namespace {

/// Voxels per cell, and the limit of its edge.
struct Resolution {
  float voxels_per_cell;
  std::uint32_t most;
};
constexpr Resolution kLightCells{4, 128}, kSunCells{2, 256}, kDenseCells{1, 128};
constexpr std::uint32_t kLeastEdge = 32;
/// Texels of 3D images along z.
constexpr std::uint32_t kMostDepth = 2048;
/// Cells of light of all volumes: 256 MiB.
constexpr std::uint64_t kMostCells = 1u << 25;

constexpr std::array<glm::vec3, shared::kSkySweeps> kSkyDirections{glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0),
                                                                   glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                                                   glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)};

InputKey key_of_others(const VolumeLightInputs& in, Allocator memory) {
  InputKey key(memory);
  key.add(in.media->frame.volume_count);
  for (const shared::Light& light : in.lights) key.add(light);
  key.add(in.sky.ambient);
  key.add(in.sky.bounce);
  key.add(in.indirect_version);
  if (in.smoke && in.smoke->slot_count() > 0) {
    key.add(in.smoke->revision());
    key.add(in.smoke_look);
    key.add(in.time);
    if (in.noise && in.smoke_look.erosion > 0) add_motion(key, in.noise->motion);
    if (in.holes) key.add_list(in.holes->holes);
  }
  return key;
}

/// Whether the device keeps the light that it holds.
bool fits(const VolumeLightPlan& plan, const MediaPlan& media, const VolumeLightRoom& room) {
  const auto volumes = volumes_in_view(media);
  const bool glows =
      std::ranges::any_of(volumes, [](const PlacedVolume& volume) { return shared::glows(volume.instance); });
  return room.edge == plan.edge && room.sun_edge == plan.sun_edge && room.volumes >= volumes.size() &&
         (!glows || room.glowing_volumes >= volumes.size());
}

std::uint32_t edge_of(const MediaPlan& media, Resolution resolution, Resolution dense) {
  float cells = 1;
  for (const PlacedVolume& visible : volumes_in_view(media)) {
    const glm::vec3 size = visible.instance.bounds_max - visible.instance.bounds_min;
    const Resolution& own = visible.instance.is_dense != 0 ? dense : resolution;
    cells = std::max(cells, std::max({size.x, size.y, size.z}) / own.voxels_per_cell);
  }
  const auto limited = static_cast<std::uint32_t>(std::min(cells, static_cast<float>(resolution.most)));
  std::uint32_t edge = std::clamp(std::bit_ceil(limited), kLeastEdge, resolution.most);
  const auto too_many = [&] {
    const std::uint64_t count = media.frame.volume_count;
    return std::uint64_t{edge} * edge * edge * count > kMostCells || edge * count > kMostDepth;
  };
  while (edge > kLeastEdge && too_many()) edge /= 2;
  return edge;
}

}  // namespace

shared::VolumeSweep sweep_through(const shared::VolumeInstance& volume, glm::vec3 direction) {
  // Axes across the direction, and the extent of the bounds along all three.
  const glm::vec3 side = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 u = glm::normalize(glm::cross(side, direction)), v = glm::cross(direction, u);
  Box<float> box = kEmptyBox;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    const glm::vec3 p = matrix_of(volume.world_from_voxel) *
                        glm::vec4(glm::mix(volume.bounds_min, volume.bounds_max, high), 1);
    const glm::vec3 at(glm::dot(u, p), glm::dot(v, p), glm::dot(direction, p));
    box = united(box, {at, at});
  }
  const glm::vec3 size = glm::max(box.high - box.low, 1e-6f);

  // Its matrices.
  shared::VolumeSweep sweep{};
  const glm::vec3 origin = u * box.low.x + v * box.low.y + direction * box.low.z;
  sweep.world_from_sweep = shared::affine_of(glm::mat4x3(u * size.x, v * size.y, direction * size.z, origin));
  const glm::mat3 rows = glm::transpose(glm::mat3(u / size.x, v / size.y, direction / size.z));
  sweep.sweep_from_world = shared::affine_of(glm::mat4x3(rows[0], rows[1], rows[2], -(rows * origin)));
  sweep.length_m = size.z;
  return sweep;
}

VolumeLightPlan VolumeLightCache::plan(const VolumeLightInputs& in, Allocator memory) {
  VolumeLightPlan plan{.sweeps = FrameVector<shared::VolumeSweep>(memory)};
  InputKey casters(memory);
  add_casters(casters, *in.media, in.volumes);
  const State& before = state_.now();
  State& next = state_.propose();
  plan.casters_changed = casters != before.casters;
  next.casters = casters;
  next.others.clear();
  if (in.media->frame.volume_count == 0) return plan;

  // Its cubes, and the rays through them.
  plan.edge = edge_of(*in.media, kLightCells, kDenseCells);
  plan.sun_edge = edge_of(*in.media, kSunCells, kSunCells);
  plan.sun = in.media->sun;
  for (const PlacedVolume& visible : volumes_in_view(*in.media)) {
    plan.sweeps.push_back(sweep_through(visible.instance, -in.media->frame.to_sun));
    // Light from the sky in +x travels towards -x.
    for (const glm::vec3 direction : kSkyDirections)
      plan.sweeps.push_back(sweep_through(visible.instance, -direction));
  }
  plan.is_lit = (in.media->media & shared::kMediumLit) != 0;
  if (!plan.is_lit) return plan;

  // Whether the light of the frame before holds.
  plan.is_alone = in.media->caster_count == 1;
  const InputKey key = key_of_others(in, memory);
  plan.update = in.rebuild || plan.casters_changed || key != before.others || !fits(plan, *in.media, in.room);
  next.others = key;
  return plan;
}

}  // namespace brume::planning
