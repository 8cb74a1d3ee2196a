// Which bricks of the smoke have fine light in a frame (shared/fine_light.h).
#pragma once

#include <cstdint>

#include "core/frame_memory.hpp"
#include "planning/device_camera.hpp"
#include "planning/smoke_visibility.hpp"
#include "shared/fine_light.h"
#include "smoke/smoke_bricks.hpp"

namespace brume::planning {

/// The most pages: 48 MiB of the device's memory.
inline constexpr std::uint32_t kMostFinePages = 160;

struct FineLightPlan {
  FrameVector<std::uint32_t> slots;  ///< Slot of each page.
  FrameVector<std::uint32_t> pages;  ///< By slot, its page + 1; 0: none.
};

/// The visible bricks of which a fine texel is wider than two pixels, the nearest first. `width`: of
/// a pixel.
FineLightPlan plan_fine_light(const smoke::SmokeBricks& smoke, const SmokeVisibility& visibility,
                              const glm::vec3& eye_world, PixelWidth width, Allocator memory = {});
/// Leaves only the first pages of a plan, which are the nearest.
void keep_pages(FineLightPlan& plan, std::uint32_t count);

}  // namespace brume::planning
