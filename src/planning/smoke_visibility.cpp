#include "planning/smoke_visibility.hpp"

#include <algorithm>

#include "shared/smoke_light.h"

namespace brume::planning {
namespace {

/// Whether smoke at a place can dim light on its path to what is in view.
class LightPaths {
 public:
  /// `lit`: a box around all that is lit; `visible_smoke`: around the smoke in view, empty for none; `slack`:
  /// so far from what is in view light counts, too [m].
  LightPaths(const ViewFrustum& view, std::span<const shared::Light> lights, const Box<float>& lit,
             const Box<float>& visible_smoke, float slack, Allocator memory)
      : view_(view),
        lit_(lit),
        visible_smoke_(visible_smoke),
        slack_(slack),
        local_lights_(memory),
        suns_(memory) {
    for (const shared::Light& light : lights)
      if (light.kind == shared::kLightDirectional)
        suns_.push_back(light.direction);
      else
        local_lights_.push_back({light.position_world, light.range});
  }

  bool may_cross(const WorldSphere& smoke) const {
    const auto near_light = [&](const WorldSphere& light) {
      const float reach = light.radius + smoke.radius;
      const glm::vec3 apart = smoke.centre - light.centre;
      return glm::dot(apart, apart) < reach * reach;
    };
    const auto under_sun = [&](glm::vec3 direction) { return may_fall(smoke, direction, lit_); };
    if (std::any_of(local_lights_.begin(), local_lights_.end(), near_light) ||
        std::any_of(suns_.begin(), suns_.end(), under_sun))
      return true;
    for (std::uint32_t i = 0; i < shared::kSkyRays && !visible_smoke_.empty(); ++i)
      if (may_fall(smoke, -shared::sky_ray(i), visible_smoke_)) return true;
    return false;
  }

 private:
  /// Whether a shadow of the smoke along a direction may be visible on something in a box.
  bool may_fall(const WorldSphere& smoke, glm::vec3 direction, const Box<float>& on) const {
    // As far as it stays between the box's lowest and its highest.
    const float down = smoke.centre.y + smoke.radius - on.low.y,
                up = on.high.y - (smoke.centre.y - smoke.radius);
    const float height = direction.y < 0 ? down : up;
    if (height < 0) return false;
    const float across =
        glm::length(glm::max(glm::abs(smoke.centre - on.low), glm::abs(smoke.centre - on.high))) +
        smoke.radius;
    const float length = std::min(across, height / std::max(std::abs(direction.y), 1e-3f));
    return view_.may_intersect({smoke.centre, smoke.radius + slack_}, length * direction);
  }

  const ViewFrustum& view_;
  Box<float> lit_, visible_smoke_;
  float slack_;
  FrameVector<WorldSphere> local_lights_;  // as far as they reach
  FrameVector<glm::vec3> suns_;
};

WorldSphere around(const Box<float>& box) {
  return {0.5f * (box.low + box.high), 0.5f * glm::length(box.high - box.low)};
}

Box<int> brick_range(const Box<float>& cloud) {
  return {glm::ivec3(glm::floor(cloud.low)) >> 3, (glm::ivec3(glm::floor(cloud.high)) >> 3) + 1};
}

/// Where a volume's voxels lie in the world.
class VolumeTransform {
 public:
  explicit VolumeTransform(const shared::VolumeLayout& layout) : layout_(layout) {}
  Box<float> box(glm::vec3 low_voxel, glm::vec3 high_voxel) const {
    return {layout_.origin_world + low_voxel * layout_.voxel_size,
            layout_.origin_world + high_voxel * layout_.voxel_size};
  }
  /// Bricks with the texels around them.
  Box<float> bricks(const Box<int>& bricks) const {
    return box(glm::vec3(bricks.low * shared::kBrickVoxels) - 1.0f,
               glm::vec3(bricks.high * shared::kBrickVoxels) + 1.0f);
  }
  Box<float> bricks_of(const Box<float>& cloud) const { return bricks(brick_range(cloud)); }
  WorldSphere brick(glm::ivec3 brick) const { return around(bricks({brick, brick + 1})); }

 private:
  const shared::VolumeLayout& layout_;
};

/// Marks the slots of a cloud that are not required yet and that a test accepts, and returns whether any is
/// required; node by node, so that clouds out of view cost little.
bool mark_slots(const smoke::SmokeVolume& volume, const Box<float>& cloud, const VolumeTransform& places,
                const auto& accepts, SlotRole role, std::span<SlotRole> slots) {
  const Box<int> all = brick_range(cloud);
  if (!accepts(around(places.bricks(all)))) return false;
  bool any = false;
  const Box<int> nodes{all.low >> 3, ((all.high - 1) >> 3) + 1};
  for_each_in(nodes, [&](glm::ivec3 node) {
    const Box<int> bricks = intersection(all, {node * shared::kNodeBricks, (node + 1) * shared::kNodeBricks});
    if (!accepts(around(places.bricks(bricks)))) return;
    for_each_in(bricks, [&](glm::ivec3 brick) {
      const std::uint32_t slot = volume.slot_at(brick);
      if (slot == smoke::SmokeVolume::kNoSlot) return;
      if (slots[slot] == SlotRole::none && accepts(places.brick(brick))) slots[slot] = role;
      any |= slots[slot] != SlotRole::none;
    });
  });
  return any;
}

/// Bounds that hold one more cloud.
Box<float> with(const Box<float>& bounds, const Box<float>& cloud) {
  if (bounds.low == bounds.high) return cloud;
  return {glm::min(bounds.low, cloud.low), glm::max(bounds.high, cloud.high)};
}

}  // namespace

void set_slots(SmokeVisibility& visibility, std::span<const SlotRole> roles) {
  visibility.slots.clear();
  visibility.slots.reserve(roles.size());
  for (const SlotRole role : {SlotRole::visible, SlotRole::caster}) {
    for (std::uint32_t slot = 0; slot < roles.size(); ++slot)
      if (roles[slot] == role) visibility.slots.push_back(slot);
    if (role == SlotRole::visible)
      visibility.visible_count = static_cast<std::uint32_t>(visibility.slots.size());
  }
}

FrameVector<shared::Light> visible_lights(std::span<const shared::Light> lights, const ViewFrustum& view,
                                          float slack, Allocator memory) {
  FrameVector<shared::Light> visible(memory);
  for (const shared::Light& light : lights)
    if (light.kind == shared::kLightDirectional ||
        view.may_intersect({light.position_world, light.range + slack}))
      visible.push_back(light);
  return visible;
}

SmokeVisibility cull_smoke(const smoke::SmokeVolume& volume, const ViewFrustum& view,
                           std::span<const shared::Light> lights, const Box<float>& scene, Allocator memory) {
  const VolumeTransform places(volume.layout());
  const auto in_view = [&](const WorldSphere& smoke) { return view.may_intersect(smoke); };
  // What may be in view.
  SmokeVisibility visibility{.slots = FrameVector<std::uint32_t>(memory)};
  FrameVector<SlotRole> roles(volume.slot_count(), SlotRole::none, memory);
  Box<float> visible_smoke = kEmptyBox;
  for (const Box<float>& cloud : volume.cloud_bounds()) {
    if (!mark_slots(volume, cloud, places, in_view, SlotRole::visible, roles)) continue;
    visibility.visible_bounds = with(visibility.visible_bounds, cloud);
    visible_smoke = united(visible_smoke, places.bricks_of(cloud));
  }

  // What stands between that and the lights.
  const LightPaths paths(view, lights, united(scene, visible_smoke), visible_smoke,
                         light_interpolation_margin(volume.layout().voxel_size), memory);
  const auto may_cast = [&](const WorldSphere& smoke) { return paths.may_cross(smoke); };
  visibility.caster_bounds = visibility.visible_bounds;
  for (const Box<float>& cloud : volume.cloud_bounds())
    if (mark_slots(volume, cloud, places, may_cast, SlotRole::caster, roles))
      visibility.caster_bounds = with(visibility.caster_bounds, cloud);
  set_slots(visibility, roles);
  return visibility;
}

SmokeVisibility all_smoke_visible(const smoke::SmokeVolume& volume, Allocator memory) {
  SmokeVisibility visibility{.slots = FrameVector<std::uint32_t>(memory)};
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.slot_at(volume.brick_of(slot)) == slot) visibility.slots.push_back(slot);
  visibility.visible_count = static_cast<std::uint32_t>(visibility.slots.size());
  visibility.visible_bounds =
      visibility.caster_bounds = {volume.layout().bounds_min, volume.layout().bounds_max};
  return visibility;
}

FrameVector<Box<float>> smoke_boxes(const smoke::SmokeBricks& volume, const SmokeVisibility& visibility,
                                    Allocator memory) {
  const VolumeTransform places(volume.layout());
  const volume::PageTable& pages = volume.pages();
  FrameVector<Box<float>> nodes(pages.root().size(), kEmptyBox, memory);  // in voxels
  for (const std::uint32_t slot : visibility.slots) {
    const glm::ivec3 brick = volume.brick_of(slot), node = (brick >> 3) - pages.origin(), size = pages.size();
    Box<float>& box = nodes[static_cast<std::size_t>(node.x + size.x * (node.y + size.y * node.z))];
    box = united(box, Box<float>{glm::vec3(brick * shared::kBrickVoxels),
                                 glm::vec3((brick + 1) * shared::kBrickVoxels)});
  }
  FrameVector<Box<float>> boxes(memory);
  for (const Box<float>& box : nodes) {
    const Box<float> cut{glm::max(box.low, visibility.caster_bounds.low),
                         glm::min(box.high, visibility.caster_bounds.high)};
    if (glm::all(glm::lessThan(cut.low, cut.high))) boxes.push_back(places.box(cut.low, cut.high));
  }
  return boxes;
}

}  // namespace brume::planning
