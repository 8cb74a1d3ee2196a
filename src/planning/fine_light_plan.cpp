#include "planning/fine_light_plan.hpp"

#include <algorithm>
#include <utility>

namespace brume::planning {

FineLightPlan plan_fine_light(const smoke::SmokeBricks& smoke, const SmokeVisibility& visibility,
                              const glm::vec3& eye_world, PixelWidth width, Allocator memory) {
  const shared::VolumeLayout& layout = smoke.layout();
  constexpr float kBrick{shared::kBrickVoxels};
  const float texel = layout.voxel_size / float{shared::kFineTexels};
  FrameVector<std::pair<float, std::uint32_t>> near(memory);  // distance and slot
  for (std::uint32_t i = 0; i < visibility.visible_count; ++i) {
    const std::uint32_t slot = visibility.slots[i];
    const glm::vec3 low = layout.origin_world + layout.voxel_size * kBrick * glm::vec3(smoke.brick_of(slot));
    const glm::vec3 nearest = glm::clamp(eye_world, low, low + layout.voxel_size * kBrick);
    const float distance = glm::distance(eye_world, nearest);
    if (texel > 2 * width.at(distance)) near.emplace_back(distance, slot);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min<std::size_t>(near.size(), kMostFinePages));
  FineLightPlan plan{.slots = FrameVector<std::uint32_t>(memory),
                     .pages = FrameVector<std::uint32_t>(smoke.slot_count(), 0u, memory)};
  for (const auto& [distance, slot] : near) {
    plan.slots.push_back(slot);
    plan.pages[slot] = static_cast<std::uint32_t>(plan.slots.size());
  }
  return plan;
}

void keep_pages(FineLightPlan& plan, std::uint32_t count) {
  for (std::size_t page = count; page < plan.slots.size(); ++page) plan.pages[plan.slots[page]] = 0;
  plan.slots.resize(std::min<std::size_t>(plan.slots.size(), count));
}

}  // namespace brume::planning
