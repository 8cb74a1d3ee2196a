// Which smoke and which lights a frame requires: what may be in view, and what may cast shadows on it. The
// cost of a frame follows that, not the size of the world.
#pragma once

#include <cstdint>
#include <span>

#include "core/box.hpp"
#include "core/frame_memory.hpp"
#include "planning/view_frustum.hpp"
#include "shared/light.h"
#include "smoke/smoke_volume.hpp"

namespace brume::planning {

struct SmokeVisibility {
  /// Slots in use whose smoke may be in view, then slots whose smoke may dim light on its path to what is in
  /// view; both in rising order.
  FrameVector<std::uint32_t> slots;
  std::uint32_t visible_count = 0;  ///< How many of `slots` may be in view.
  Box<float> visible_bounds{};      ///< Around the clouds that may be in view; no volume: none.
  Box<float> caster_bounds{};       ///< Around these and the clouds that may dim light to what is in view.
};

/// What a frame requires a slot for.
enum class SlotRole : std::uint8_t { none, visible, caster };
/// Sets the slots and their counts by the role of each.
void set_slots(SmokeVisibility& visibility, std::span<const SlotRole> roles);

/// How far from what is in view light in smoke is still looked up, by interpolation and off walls [m].
inline float light_interpolation_margin(float voxel_size) {
  return 4 * voxel_size;
}

/// The lights that reach anything in view, or within `slack` of it [m].
FrameVector<shared::Light> visible_lights(std::span<const shared::Light> lights, const ViewFrustum& view,
                                          float slack, Allocator memory = {});

/// `lights` reach something in view, `scene` is a box around all surfaces. Rays through the
/// smoke run from what is in view to these lights and, through smoke, to the sky (shared/smoke_light.h): all
/// slots that they can meet are required. What one cloud requires does not depend on clouds that are not.
SmokeVisibility cull_smoke(const smoke::SmokeVolume& volume, const ViewFrustum& view,
                           std::span<const shared::Light> lights, const Box<float>& scene,
                           Allocator memory = {});

/// All smoke, as if it were in view.
SmokeVisibility all_smoke_visible(const smoke::SmokeVolume& volume, Allocator memory = {});

/// Boxes around the required smoke: one for each node of the page table that holds some.
FrameVector<Box<float>> smoke_boxes(const smoke::SmokeBricks& volume, const SmokeVisibility& visibility,
                                    Allocator memory = {});

}  // namespace brume::planning
