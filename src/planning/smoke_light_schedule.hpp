// The work of a frame on the light in the smoke: which texels are listed, which rays are followed, which
// bricks gather.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/known_lights.hpp"
#include "planning/smoke_light_pages.hpp"
#include "planning/stale_light.hpp"
#include "planning/update_scheduler.hpp"
#include "volume/range_arena.hpp"

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

/// Spreads updates over frames. The texels of all bricks are in kLightPhases phases (shared::light_phase),
/// and a frame updates those of some: 1 / update_fraction frames later, rounded up, all that is in view was
/// updated once. Never late are texels that have no light yet, as smoke grew; texels in holes that open or
/// close; lights that come, go or change. Bricks that come into view are updated four times as fast as the
/// others, those whose smoke changes twice as fast.
class SmokeLightSchedule {
 public:
  /// Begins a frame, without work.
  void begin(float update_fraction);
  /// Whether the frame updates less than all.
  bool is_sliced() const { return phases_.is_sliced(); }
  /// The frame updates all, whatever `begin` was told.
  void update_all() { phases_.next_slice(1); }
  /// The eye, the sky or the surroundings changed: all light is gathered again.
  void change_surroundings() { ++surroundings_; }

  /// Adds the work on a brick of `pages`, which must have room for it, and marks it as done there.
  /// `reaching`: the numbers of the lights that reach it.
  void add(LitBrick& brick, std::span<const std::uint32_t> reaching, const KnownLights& lights,
           const StaleLight& stale, SmokeLightPages& pages);
  /// Ends a part: what was added since the one before is done in one go.
  void end_part(const SmokeLightPages& pages);

  /// The work of the frame, valid until the next `begin`.
  const SmokeLightPlan& plan() const { return plan_; }
  /// No work in this frame.
  void clear() { plan_.clear(); }

 private:
  using PhaseRange = UpdateScheduler::SliceRange;
  /// What of a brick's rays or light a frame updates: all texels, the new ones, those of its phases.
  struct Work {
    bool all = false, fresh = false, slice = false;
    std::uint32_t done(PhaseRange phases) const { return all ? kAllLightPhases : slice ? phases.mask() : 0; }
  };

  bool update_texel_list(LitBrick& brick, const StaleLight& stale);
  PhaseRange prioritize(LitBrick& brick, bool is_fresh) const;
  Work work_for(const LitBrick& brick, const CachedRays& rays, std::uint64_t version_before,
                PhaseRange phases) const;
  template <typename Item>
  void schedule(const Work& work, PhaseRange phases, Item item, std::vector<Item>& list,
                std::vector<Item>& sliced);
  void schedule_rays(const LitBrick& brick, CachedRays& rays, std::uint32_t light, std::uint32_t page_count,
                     const Work& work, PhaseRange phases);
  void schedule_gather(LitBrick& brick, std::uint64_t light_versions, std::uint32_t first_light, Work work,
                       PhaseRange phases);

  SmokeLightPlan plan_;
  UpdateScheduler phases_{shared::kLightPhases};
  // The part so far: where its lists begin, and lists of what takes no more than most_phases_ phases.
  std::uint32_t first_list_ = 0, first_ray_ = 0, first_gather_ = 0, most_phases_ = 0;
  std::vector<shared::ShadowRays> sliced_rays_;
  std::vector<shared::LightGather> sliced_gathers_;
  std::uint64_t frame_ = 0, list_versions_ = 0, surroundings_ = 0;
};

}  // namespace brume::planning
