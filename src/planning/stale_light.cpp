#include "planning/stale_light.hpp"

#include <algorithm>

#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

// More tests of a ray and a change than this cost more than following all rays does.
constexpr std::size_t kMaxIntersectionTests = 1u << 16;

/// The texels of bricks that changed must be listed again.
void relist_dirty_slots(const smoke::SmokeBricks& smoke, SmokeLightPages& pages) {
  const auto relist = [&](std::uint32_t slot) {
    if (LitBrick* brick = pages.find(slot)) brick->is_listed = false;
  };
  for (const std::uint32_t slot : smoke.dirty_slots()) relist(slot);
  for (const std::uint32_t slot : smoke.dirty_cell_slots()) relist(slot);
}

std::size_t ray_count(const SmokeLightPages& pages) {
  std::size_t count = 0;
  for (const LitBrick& brick : pages.bricks()) count += shared::kSkyRays + brick.lights.size();
  return count;
}

}  // namespace

void StaleLight::add_holes_in(glm::ivec3 brick, std::vector<shared::LightChange>& changes) const {
  // A brick has one texel around it.
  const shared::VolumeLayout& layout = tracker_.layout();
  const auto world_from_voxel = [&](glm::vec3 voxel) {
    return layout.origin_world + voxel * layout.voxel_size;
  };
  const glm::vec3 low = world_from_voxel(glm::vec3(brick) * float{shared::kBrickVoxels} - 1.0f);
  const glm::vec3 high = world_from_voxel(glm::vec3(brick + 1) * float{shared::kBrickVoxels} + 1.0f);
  for (const shared::LightChange& hole : holes_)
    if (intersects_box(hole.from_world, hole.to_world, low - hole.radius, high + hole.radius))
      changes.push_back(hole);
}

/// Marks the rays that changes may lie on; false where there is too much to test.
bool StaleLight::mark_crossed(const SmokeLightInputs& inputs, const KnownLights& lights,
                              std::span<const shared::LightChange> changes, SmokeLightPages& pages) const {
  if (changes.empty()) return true;
  if (changes.size() * ray_count(pages) > kMaxIntersectionTests) return false;
  const shared::VolumeLayout &now = inputs.volume->layout(), &then = tracker_.layout();
  const float far = then.voxel_size * glm::length(glm::max(now.bounds_max, then.bounds_max) -
                                                  glm::min(now.bounds_min, then.bounds_min));
  const float radius = kBrickReach * then.voxel_size;
  // Capsules around rays and changes that touch may cross.
  for (LitBrick& brick : pages.bricks()) {
    const glm::vec3 from = brick_middle(then, brick.brick);
    const auto mark = [&](CachedRays& rays, glm::vec3 to) {
      const auto lies_on_ray = [&](const shared::LightChange& change) {
        const float reach = radius + change.radius;
        return distance2(from, to, change.from_world, change.to_world) < reach * reach;
      };
      if (rays.dirty_phases != kAllLightPhases && std::ranges::any_of(changes, lies_on_ray))
        rays.dirty_phases = kAllLightPhases;
    };
    for (std::uint32_t i = 0; i < shared::kSkyRays; ++i) mark(brick.sky, from + far * shared::sky_ray(i));
    for (CachedRays& rays : brick.lights) {
      const shared::Light& light = lights[rays.light].light;
      const bool is_sun = light.kind == shared::kLightDirectional;
      mark(rays, is_sun ? from - far * light.direction : light.position_world);
    }
  }
  return true;
}

void StaleLight::mark(const SmokeLightInputs& inputs, const KnownLights& lights, bool is_sliced,
                      SmokeLightPages& pages, Allocator memory) {
  holes_.clear();
  if (!tracker_.is_continuous(inputs) || (!is_sliced && tracker_.all_rays_changed(inputs))) {
    pages.clear();
    return;
  }

  // Texels that must have light at once: of smoke that changed, and in holes that did and beside them. Rays
  // that only graze holes can wait.
  FrameVector<shared::LightChange> changes(memory), holes(memory);
  if (tracker_.smoke_changed(inputs)) relist_dirty_slots(*inputs.volume, pages);
  if (is_sliced) tracker_.add_hole_changes(inputs, holes);
  holes_.assign(holes.begin(), holes.end());
  for (shared::LightChange& hole : holes_) hole.radius -= 0.5f * tracker_.layout().voxel_size;

  // Rays that cross what changed.
  tracker_.add_smoke_changes(inputs, changes);
  if (!tracker_.noise_moved(inputs)) tracker_.add_hole_changes(inputs, changes);
  if (tracker_.noise_moved(inputs) || tracker_.caster_bounds_changed(inputs) ||
      tracker_.all_rays_changed(inputs) || !mark_crossed(inputs, lights, changes, pages))
    pages.invalidate_rays();
}

}  // namespace brume::planning
