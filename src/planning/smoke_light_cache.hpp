// Which rays of light through the smoke a frame follows, and which cached ones still hold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/light_change_tracking.hpp"
#include "planning/ray_page_pool.hpp"
#include "planning/update_scheduler.hpp"
#include "shared/light.h"

namespace brume::planning {

/// Work for the device, in lists as shaders/shared/smoke_light.h describes them.
struct SmokeLightPlan {
  std::vector<shared::TexelList> texel_lists;   ///< Bricks whose texels are to be listed.
  std::vector<shared::ShadowRays> shadow_rays;  ///< Rays to be followed.
  std::vector<shared::LightGather> gathers;     ///< Bricks whose light is to be gathered from their rays.
  std::vector<shared::LightChange> changes;     ///< That texel lists refer to.
  std::vector<glm::uvec2> gathered_lights;      ///< That gathers refer to: (light of the frame, page).
  /// What is done in one go. More than one only where the pages of all would not fit.
  struct Part {
    volume::IndexRange texel_lists, shadow_rays, gathers;
    /// How many of these rays and gathers, the last ones, are of no more than `phases` phases.
    std::uint32_t sliced_rays = 0, sliced_gathers = 0, phases = 0;
  };
  std::vector<Part> parts;
  std::uint32_t texel_list_count = 0, page_count = 0;  ///< That the device must have room for.
  void clear();
};

/// Tracks which rays the device holds. A ray is followed again when its light, or anything that may lie on
/// it, changed; a brick's light is gathered again when one of its rays was followed, or the eye, the sky or
/// one of its lights changed. Where noise moves every frame changes all smoke, and all rays with it.
///
/// With an update fraction below 1 that is spread over frames: the texels of all bricks are in kLightPhases
/// phases (shared::light_phase), and a frame updates those of some. 1 / update_fraction frames later, rounded
/// up, all that is in view was updated once. Never late are texels that have no light yet, as smoke grew;
/// texels in holes that open or close; lights that come, go or change. Bricks that come into view are updated
/// four times as fast as the others, those whose smoke changes twice as fast.
class SmokeLightCache {
 public:
  explicit SmokeLightCache(std::uint32_t max_pages = kMaxRayPages) : pages_(max_pages) {}

  /// The work of a frame, valid until the next call. From `commit` on it counts as done; where that does not
  /// come before the next plan, the device may hold anything, and that plan relies on none of it.
  const SmokeLightPlan& plan(const SmokeLightInputs& inputs, Allocator memory = {});
  /// The frame of the last plan was recorded.
  void commit() { is_open_ = false; }
  /// The work of the last planned frame.
  const SmokeLightPlan& last_plan() const { return plan_; }
  /// The device lost what it held.
  void invalidate();

 private:
  using PhaseRange = UpdateScheduler::SliceRange;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  // Of bricks that come into view, and of those whose smoke changes: a growing cloud is several frames of
  // light ahead of its texels' phases, but each frame of it costs more.
  static constexpr std::uint32_t kNewPriority = 4, kChangedPriority = 2;
  static constexpr std::uint32_t kAllPhases = (1u << shared::kLightPhases) - 1;

  /// A brick's rays to one light, or to the sky.
  struct CachedRays {
    std::uint32_t light = kNone;  // into known_lights_
    std::uint32_t page = kNone;
    std::uint64_t list_version = 0;           // of the texel list whose texels all have rays; 0: none
    std::uint32_t dirty_phases = kAllPhases;  // whose rays no longer hold
    std::uint64_t last_frame = 0;             // that had the light
    // Of the light when the rays were followed: texels out of its reach have none.
    float range = 0, intensity = 0;
  };
  struct BrickEntry {
    std::uint32_t slot = 0, number = 0;
    glm::ivec3 brick{0};
    bool is_listed = false, by_phase = false;
    std::uint64_t list_version = 0;           // of its texels, unique; 0: none
    std::uint32_t dirty_phases = kAllPhases;  // that must be gathered
    std::uint64_t gathered_lights = 0;        // hash of the lights that its light was gathered from
    std::uint64_t epoch = 0;                  // of the eye and the sky then
    std::uint64_t last_frame = 0;             // that had it in view
    std::uint32_t priority = 1;               // how much faster it is updated,
    std::uint32_t priority_frames = 0;        // for how many frames
    CachedRays sky;
    std::vector<CachedRays> lights;
  };
  struct KnownLight {
    shared::Light light{};
    std::uint64_t version = 0;       // of `light`, unique
    std::uint64_t last_frame = 0;    // that had it
    std::uint32_t in_frame = kNone;  // its number there
  };
  /// What of a brick's rays or light a frame updates: all texels, the new ones, those of its phases.
  struct Work {
    bool all = false, fresh = false, slice = false;
  };

  // What still holds.
  void drop_changed(const SmokeLightInputs& inputs, Allocator memory);
  void drop_all_rays();
  void invalidate_rays();
  bool invalidate_crossing(const SmokeLightInputs& inputs, std::span<const shared::LightChange> changes);
  void relist_dirty_slots(const smoke::SmokeBricks& volume);

  // The lights of the frame.
  void match_lights(std::span<const shared::Light> lights);
  KnownLight& match_light(const shared::Light& light, std::size_t hint, std::size_t most);
  void find_lights_in_reach(const SmokeLightInputs& inputs, Allocator memory);
  std::span<const std::uint32_t> lights_reaching(std::size_t visible_index) const;
  std::uint64_t light_versions_hash(std::span<const std::uint32_t> lights) const;

  // Bricks and their pages.
  struct Missing {
    std::size_t entries = 0, pages = 0;
  };
  Missing missing(const SmokeLightInputs& inputs) const;
  bool has_room(const SmokeLightInputs& inputs) const;
  const BrickEntry* find_entry(std::uint32_t slot) const;
  BrickEntry& entry_of(const SmokeLightInputs& inputs, std::uint32_t slot);
  CachedRays& cached_rays_of(BrickEntry& entry, std::uint32_t light, std::size_t hint);
  std::span<BrickEntry> entries() { return std::span(entries_).first(entry_count_); }

  // The work of the frame.
  PhaseRange phases_of(const BrickEntry& entry) const;
  volume::IndexRange add_changes_in(const BrickEntry& entry);
  bool update_texel_list(BrickEntry& entry);
  Work work_for(const BrickEntry& entry, const CachedRays& rays, std::uint64_t version_before,
                PhaseRange phases) const;
  template <typename Item>
  void schedule(const Work& work, PhaseRange phases, Item item, std::vector<Item>& list,
                std::vector<Item>& sliced);
  void schedule_rays(const BrickEntry& entry, CachedRays& rays, std::uint32_t light, std::uint32_t page_count,
                     const Work& work, PhaseRange phases);
  void schedule_gather(BrickEntry& entry, std::span<const std::uint32_t> lights, std::uint32_t first_light,
                       Work work, PhaseRange phases);
  void plan_brick(BrickEntry& entry, std::span<const std::uint32_t> lights);
  void plan_incremental(const SmokeLightInputs& inputs);
  void plan_in_parts(const SmokeLightInputs& inputs);

  SmokeLightPlan plan_;
  bool is_open_ = false;  // planned, and not committed
  LightChangeTracker tracker_;
  UpdateScheduler scheduler_{shared::kLightPhases};
  RayPagePool pages_;
  std::vector<BrickEntry> entries_;  // the first entry_count_ are in use
  std::uint32_t entry_count_ = 0;
  std::vector<std::uint32_t> entry_of_slot_;
  std::vector<KnownLight> known_lights_;
  // Of the frame: where holes changed, and lists of what takes no more than most_phases_ phases.
  std::vector<shared::LightChange> hole_changes_;
  std::vector<shared::ShadowRays> sliced_rays_;
  std::vector<shared::LightGather> sliced_gathers_;
  std::uint32_t most_phases_ = 0;
  // The lights that reach each visible slot: their list, and where each slot's begin.
  std::vector<std::uint32_t> lights_in_reach_, lights_in_reach_first_;
  std::uint64_t light_versions_ = 0, list_versions_ = 0, frames_ = 0, epoch_ = 0;  // epoch: of eye and sky
};

}  // namespace brume::planning
