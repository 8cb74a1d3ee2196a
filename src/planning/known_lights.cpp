#include "planning/known_lights.hpp"

#include <algorithm>

#include "core/hash.hpp"
#include "core/same_bytes.hpp"
#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

// Lights that are remembered besides the frame's.
constexpr std::size_t kExtraLights = 32;

/// Whether rays to one light are those to the other, as far as both reach.
bool same_rays(shared::Light a, const shared::Light& b) {
  a.intensity = b.intensity;
  a.range = b.range;
  return same_bytes(a, b);
}

}  // namespace

glm::vec3 brick_middle(const shared::VolumeLayout& layout, glm::ivec3 brick) {
  return layout.origin_world + (glm::vec3(brick) + 0.5f) * float{shared::kBrickVoxels} * layout.voxel_size;
}

std::uint32_t KnownLights::number_for(const shared::Light& light, std::size_t hint, std::size_t most) {
  const auto is_it = [&](const Known& known) {
    return known.last_frame < frame_ && same_rays(known.light, light);
  };
  if (hint < lights_.size() && is_it(lights_[hint])) return static_cast<std::uint32_t>(hint);
  const auto known = std::ranges::find_if(lights_, is_it);
  const auto number = static_cast<std::uint32_t>(known - lights_.begin());
  if (known != lights_.end()) return number;
  if (lights_.size() < most) {
    lights_.emplace_back();
    return number;
  }
  // In the place of the one that no frame had for the longest time.
  const auto oldest = std::ranges::min_element(lights_, {}, &Known::last_frame);
  *oldest = {};
  renumbered_.push_back(static_cast<std::uint32_t>(oldest - lights_.begin()));
  return renumbered_.back();
}

void KnownLights::match(std::span<const shared::Light> lights) {
  ++frame_;
  renumbered_.clear();
  for (Known& known : lights_) known.in_frame = kNone;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Known& known = lights_[number_for(lights[i], i, lights.size() + kExtraLights)];
    if (known.version == 0 || !same_bytes(known.light, lights[i])) known.version = ++versions_;
    known.light = lights[i];
    known.last_frame = frame_;
    known.in_frame = static_cast<std::uint32_t>(i);
  }
}

void KnownLights::find_in_reach(const smoke::SmokeBricks& smoke, const SmokeVisibility& visibility,
                                Allocator memory) {
  FrameVector<std::uint32_t> in_order(memory);
  for (std::uint32_t i = 0; i < lights_.size(); ++i)
    if (lights_[i].in_frame != kNone) in_order.push_back(i);
  std::ranges::sort(in_order, {}, [&](std::uint32_t number) { return lights_[number].in_frame; });
  in_reach_.clear();
  first_in_reach_.assign(1, 0);
  const float reach = kBrickReach * smoke.layout().voxel_size;
  for (std::uint32_t i = 0; i < visibility.visible_count; ++i) {
    const glm::vec3 middle = brick_middle(smoke.layout(), smoke.brick_of(visibility.slots[i]));
    for (const std::uint32_t number : in_order)
      if (reaches(lights_[number].light, middle, reach)) in_reach_.push_back(number);
    first_in_reach_.push_back(static_cast<std::uint32_t>(in_reach_.size()));
  }
}

std::span<const std::uint32_t> KnownLights::reaching(std::size_t visible_index) const {
  const std::uint32_t first = first_in_reach_[visible_index];
  return std::span(in_reach_).subspan(first, first_in_reach_[visible_index + 1] - first);
}

std::uint64_t KnownLights::versions_hash(std::span<const std::uint32_t> numbers) const {
  std::uint64_t hash = 0;
  for (const std::uint32_t number : numbers) hash = hash_values(std::span(&lights_[number].version, 1), hash);
  return hash;
}

}  // namespace brume::planning
