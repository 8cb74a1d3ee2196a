#include "passes/smoke_needs.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "shared/smoke_light.h"

namespace brume::passes {
namespace {

WorldBox join(const WorldBox& a, const WorldBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

bool is_empty(const WorldBox& box) {
  return glm::any(glm::greaterThan(box.low, box.high));
}

constexpr WorldBox kNothing{glm::vec3(1e30f), glm::vec3(-1e30f)};

/// Whether smoke at a place can dim light that is on its way to what is in view.
class LightWays {
 public:
  /// `lit`: a box around all that is lit; `seen_smoke`: around the smoke in view, empty for none; `slack`: so
  /// far from what is in view light counts, too [m].
  LightWays(const ViewVolume& view, std::span<const shared::Light> lights, const WorldBox& lit,
            const WorldBox& seen_smoke, float slack)
      : view_(view), lit_(lit), seen_smoke_(seen_smoke), slack_(slack) {
    for (const shared::Light& light : lights)
      if (light.kind == shared::kLightDirectional)
        suns_.push_back(light.direction);
      else
        lamps_.push_back({light.position_world, light.range});
  }

  bool may_cross(const WorldSphere& smoke) const {
    const auto near_lamp = [&](const WorldSphere& lamp) {
      const float reach = lamp.radius + smoke.radius;
      const glm::vec3 apart = smoke.centre - lamp.centre;
      return glm::dot(apart, apart) < reach * reach;
    };
    const auto under_sun = [&](glm::vec3 direction) { return may_fall(smoke, direction, lit_); };
    if (std::any_of(lamps_.begin(), lamps_.end(), near_lamp) ||
        std::any_of(suns_.begin(), suns_.end(), under_sun))
      return true;
    for (std::uint32_t i = 0; i < shared::kSkyRays && !is_empty(seen_smoke_); ++i)
      if (may_fall(smoke, -shared::sky_ray(i), seen_smoke_)) return true;
    return false;
  }

 private:
  /// Whether a shadow of the smoke along a direction may be seen on something in a box.
  bool may_fall(const WorldSphere& smoke, glm::vec3 direction, const WorldBox& on) const {
    // As far as it stays between the box's lowest and its highest.
    const float down = smoke.centre.y + smoke.radius - on.low.y,
                up = on.high.y - (smoke.centre.y - smoke.radius);
    const float height = direction.y < 0 ? down : up;
    if (height < 0) return false;
    const float across =
        glm::length(glm::max(glm::abs(smoke.centre - on.low), glm::abs(smoke.centre - on.high))) +
        smoke.radius;
    const float length = std::min(across, height / std::max(std::abs(direction.y), 1e-3f));
    return view_.may_see({smoke.centre, smoke.radius + slack_}, length * direction);
  }

  const ViewVolume& view_;
  WorldBox lit_, seen_smoke_;
  float slack_;
  std::vector<WorldSphere> lamps_;  // as far as they reach
  std::vector<glm::vec3> suns_;
};

WorldSphere around(const WorldBox& box) {
  return {0.5f * (box.low + box.high), 0.5f * glm::length(box.high - box.low)};
}

voxel::IntBox brick_range(const sim::SmokeBounds& cloud) {
  return {glm::ivec3(glm::floor(cloud.low)) >> 3, (glm::ivec3(glm::floor(cloud.high)) >> 3) + 1};
}

/// Where a volume's voxels lie in the world.
class Places {
 public:
  explicit Places(const shared::SmokeVolumeFrame& frame) : frame_(frame) {}
  WorldBox box(glm::vec3 low_voxel, glm::vec3 high_voxel) const {
    return {frame_.origin_world + low_voxel * frame_.voxel_size,
            frame_.origin_world + high_voxel * frame_.voxel_size};
  }
  /// Bricks with the texels around them.
  WorldBox bricks(const voxel::IntBox& bricks) const {
    return box(glm::vec3(bricks.low * shared::kBrickVoxels) - 1.0f,
               glm::vec3(bricks.high * shared::kBrickVoxels) + 1.0f);
  }
  WorldBox bricks_of(const sim::SmokeBounds& cloud) const { return bricks(brick_range(cloud)); }
  WorldSphere brick(glm::ivec3 brick) const { return around(bricks({brick, brick + 1})); }

 private:
  const shared::SmokeVolumeFrame& frame_;
};

/// Adds the slots of a cloud that are wanted, and says whether there are any; node by node, so that what is
/// far costs little.
bool take_slots(const sim::SmokeVolume& volume, const sim::SmokeBounds& cloud, const Places& places,
                const auto& wanted, std::vector<std::uint32_t>& slots) {
  const voxel::IntBox all = brick_range(cloud);
  if (!wanted(around(places.bricks(all)))) return false;
  const std::size_t before = slots.size();
  const voxel::IntBox nodes{all.low >> 3, ((all.high - 1) >> 3) + 1};
  voxel::for_each_in(nodes, [&](glm::ivec3 node) {
    const voxel::IntBox bricks =
        voxel::intersection(all, {node * shared::kNodeBricks, (node + 1) * shared::kNodeBricks});
    if (!wanted(around(places.bricks(bricks)))) return;
    voxel::for_each_in(bricks, [&](glm::ivec3 brick) {
      const std::uint32_t slot = volume.slot_at(brick);
      if (slot != sim::SmokeVolume::kNoSlot && wanted(places.brick(brick))) slots.push_back(slot);
    });
  });
  return slots.size() > before;
}

/// Bounds with those of one more cloud.
sim::SmokeBounds with(const sim::SmokeBounds& bounds, const sim::SmokeBounds& cloud) {
  if (bounds.low == bounds.high) return cloud;
  return {glm::min(bounds.low, cloud.low), glm::max(bounds.high, cloud.high)};
}

void sort_once(std::vector<std::uint32_t>& slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

}  // namespace

std::vector<shared::Light> lights_in_view(std::span<const shared::Light> lights, const ViewVolume& view,
                                          float slack) {
  std::vector<shared::Light> seen;
  for (const shared::Light& light : lights)
    if (light.kind == shared::kLightDirectional || view.may_see({light.position_world, light.range + slack}))
      seen.push_back(light);
  return seen;
}

SmokeNeeds smoke_needs(const sim::SmokeVolume& volume, const ViewVolume& view,
                       std::span<const shared::Light> lights, const WorldBox& scene) {
  const Places places(volume.frame());
  const auto in_view = [&](const WorldSphere& smoke) { return view.may_see(smoke); };
  // What may be in view.
  SmokeNeeds needs;
  WorldBox seen_smoke = kNothing;
  for (const sim::SmokeBounds& cloud : volume.cloud_bounds()) {
    if (!take_slots(volume, cloud, places, in_view, needs.slots)) continue;
    needs.seen_bounds = with(needs.seen_bounds, cloud);
    seen_smoke = join(seen_smoke, places.bricks_of(cloud));
  }
  sort_once(needs.slots);
  needs.seen = static_cast<std::uint32_t>(needs.slots.size());

  // What stands between that and the lights.
  const LightWays ways(view, lights, join(scene, seen_smoke), seen_smoke,
                       light_slack(volume.frame().voxel_size));
  const auto in_the_way = [&](const WorldSphere& smoke) { return ways.may_cross(smoke); };
  std::vector<std::uint32_t> shading;
  needs.bounds = needs.seen_bounds;
  for (const sim::SmokeBounds& cloud : volume.cloud_bounds())
    if (take_slots(volume, cloud, places, in_the_way, shading)) needs.bounds = with(needs.bounds, cloud);
  sort_once(shading);
  const std::vector<std::uint32_t> seen = needs.slots;
  std::set_difference(shading.begin(), shading.end(), seen.begin(), seen.end(),
                      std::back_inserter(needs.slots));
  return needs;
}

SmokeNeeds all_of_smoke(const sim::SmokeVolume& volume) {
  SmokeNeeds needs;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.slot_at(volume.brick_of(slot)) == slot) needs.slots.push_back(slot);
  needs.seen = static_cast<std::uint32_t>(needs.slots.size());
  needs.seen_bounds = needs.bounds = {volume.frame().bounds_min, volume.frame().bounds_max};
  return needs;
}

std::vector<WorldBox> smoke_boxes(const sim::SmokeVolume& volume, const SmokeNeeds& needs) {
  const Places places(volume.frame());
  std::map<std::tuple<int, int, int>, WorldBox> nodes;  // in voxels
  for (const std::uint32_t slot : needs.slots) {
    const glm::ivec3 brick = volume.brick_of(slot), node = brick >> 3;
    const WorldBox box{glm::vec3(brick * shared::kBrickVoxels),
                       glm::vec3((brick + 1) * shared::kBrickVoxels)};
    const auto [known, added] = nodes.try_emplace({node.x, node.y, node.z}, box);
    if (!added) known->second = join(known->second, box);
  }
  std::vector<WorldBox> boxes;
  for (const auto& [node, box] : nodes) {
    const WorldBox cut{glm::max(box.low, needs.bounds.low), glm::min(box.high, needs.bounds.high)};
    if (glm::all(glm::lessThan(cut.low, cut.high))) boxes.push_back(places.box(cut.low, cut.high));
  }
  return boxes;
}

}  // namespace brume::passes
