// Which rays of light through the smoke the device holds, and in which pages.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/smoke_light.h"

namespace brume::planning {

/// Most pages at a time; of shared::kTexelsPerBrick words: 128 MB.
constexpr std::uint32_t kMaxRayPages = 1u << 15;
/// A set of phases of texels (shared::light_phase), one bit each: all of them.
constexpr std::uint32_t kAllLightPhases = (1u << shared::kLightPhases) - 1;

/// A brick's rays to one light, or to the sky.
struct CachedRays {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t light = kNone;                   ///< Its number in KnownLights; kNone: the sky.
  std::uint32_t page = kNone;                    ///< The first of its pages; kNone: it has none.
  std::uint64_t list_version = 0;                ///< The texel list whose texels all have rays; 0: none has.
  std::uint32_t dirty_phases = kAllLightPhases;  ///< Whose rays no longer hold.
  std::uint64_t last_frame = 0;                  ///< That scheduled them.
  /// The light's when the rays were followed: texels out of its reach have none.
  float range = 0, intensity = 0;
};

/// A brick of smoke whose light the device holds.
struct LitBrick {
  std::uint32_t slot = 0;
  std::uint32_t number = 0;  ///< Its texel list on the device.
  glm::ivec3 brick{0};
  bool is_listed = false;          ///< Its texel list still holds.
  bool by_phase = false;           ///< The list is sorted by phases.
  std::uint64_t list_version = 0;  ///< Unique: another one where its texel list changed; 0: it has none.
  std::uint32_t dirty_phases = kAllLightPhases;  ///< Whose light must be gathered.
  std::uint64_t gathered_lights = 0;             ///< Hash of the lights that its light was gathered from.
  std::uint64_t surroundings = 0;                ///< Version of the eye and the sky then.
  std::uint64_t last_frame = 0;                  ///< That had it in view.
  /// How much faster than others it is updated, and for how many frames.
  std::uint32_t priority = 1, priority_frames = 0;
  CachedRays sky;
  std::vector<CachedRays> lights;
};

/// Hands out texel lists and pages one after the other, and takes them back all at once.
class SmokeLightPages {
 public:
  explicit SmokeLightPages(std::uint32_t max_pages) : capacity_(max_pages) {}

  /// Null: the device holds nothing of the slot.
  LitBrick* find(std::uint32_t slot);
  const LitBrick* find(std::uint32_t slot) const;
  /// The brick in a slot, made where there is none. Where the slot held another brick, that one's pages are
  /// kept, and nothing in them holds.
  LitBrick& acquire(std::uint32_t slot, glm::ivec3 brick);
  /// The rays of a brick to a light, made where there are none; most likely those at index `hint`.
  static CachedRays& rays_to(LitBrick& brick, std::uint32_t light, std::size_t hint);
  /// Gives rays `count` pages that follow each other where they have none. The caller checks `fits` before.
  void allocate(CachedRays& rays, std::uint32_t count);

  /// No ray holds; which texels have any stays known.
  void invalidate_rays();
  /// No ray to a light holds, nor which texels have any: its number is another light's from now on.
  void forget_light(std::uint32_t light);
  /// The device holds nothing.
  void clear();

  std::span<LitBrick> bricks() { return std::span(bricks_).first(brick_count_); }
  std::span<const LitBrick> bricks() const { return std::span(bricks_).first(brick_count_); }
  bool fits(std::size_t page_count) const { return page_count_ + page_count <= capacity_; }
  std::uint32_t page_count() const { return page_count_; }
  std::uint32_t brick_count() const { return brick_count_; }

 private:
  static constexpr std::uint32_t kNone = CachedRays::kNone;
  std::uint32_t capacity_, page_count_ = 0, brick_count_ = 0;
  std::vector<LitBrick> bricks_;  // the first brick_count_ are in use; the others keep their memory
  std::vector<std::uint32_t> brick_in_slot_;
};

}  // namespace brume::planning
