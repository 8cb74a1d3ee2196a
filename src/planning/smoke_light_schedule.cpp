#include "planning/smoke_light_schedule.hpp"

#include <algorithm>

#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

// Priorities of bricks that come into view, and whose smoke changes: a growing cloud is several frames of
// light ahead of its texels' phases, but each frame of it costs more.
constexpr std::uint32_t kNewPriority = 4, kChangedPriority = 2;

std::uint32_t count_of(const auto& list) {
  return static_cast<std::uint32_t>(list.size());
}

}  // namespace

void SmokeLightPlan::clear() {
  texel_lists.clear();
  shadow_rays.clear();
  gathers.clear();
  changes.clear();
  gathered_lights.clear();
  parts.clear();
  texel_list_count = page_count = 0;
}

void SmokeLightSchedule::begin(float update_fraction) {
  ++frame_;
  plan_.clear();
  sliced_rays_.clear();
  sliced_gathers_.clear();
  first_list_ = first_ray_ = first_gather_ = most_phases_ = 0;
  phases_.next_slice(update_fraction);
}

/// Schedules a brick's texel list where it changed; whether it may have texels without light.
bool SmokeLightSchedule::update_texel_list(LitBrick& brick, const StaleLight& stale) {
  const bool had_list = is_sliced() && brick.list_version != 0;
  volume::IndexRange changes{};
  if (had_list) {
    changes.first = count_of(plan_.changes);
    stale.add_holes_in(brick.brick, plan_.changes);
    changes.count = count_of(plan_.changes) - changes.first;
  }
  if (brick.is_listed && (brick.by_phase || !is_sliced()) && changes.count == 0) return false;
  const bool is_fresh = had_list && (!brick.is_listed || changes.count > 0);
  plan_.texel_lists.push_back(
      {brick.slot, brick.number, is_sliced(), had_list, changes.first, changes.count});
  if (!brick.is_listed || is_fresh) brick.list_version = ++list_versions_;
  brick.is_listed = true;
  brick.by_phase = is_sliced();
  return is_fresh;
}

/// The phases of a brick that the frame updates. A brick that came into view or changes takes more of them,
/// until it was updated once.
SmokeLightSchedule::PhaseRange SmokeLightSchedule::prioritize(LitBrick& brick, bool is_fresh) const {
  const bool came_into_view = brick.last_frame + 1 != frame_;
  const bool may_change = brick.priority_frames == 0 || brick.priority == kChangedPriority;
  if (came_into_view || (is_fresh && may_change)) {
    brick.priority = came_into_view ? kNewPriority : kChangedPriority;
    brick.priority_frames = shared::kLightPhases / phases_.slices_per_frame(brick.priority);
  }
  return phases_.slices(brick.priority_frames > 0 ? brick.priority : 1);
}

/// The work on a brick's rays; `version_before` is the version of its texel list before this frame.
SmokeLightSchedule::Work SmokeLightSchedule::work_for(const LitBrick& brick, const CachedRays& rays,
                                                      std::uint64_t version_before, PhaseRange phases) const {
  const bool fresh = rays.list_version != brick.list_version;
  if (rays.list_version == 0 || rays.list_version != version_before || (fresh && !is_sliced()))
    return {.all = true};
  if (rays.dirty_phases == 0) return {.fresh = fresh};
  // Rays to a light that the brick's last frame did not have are of any age.
  if (!is_sliced() || rays.last_frame != brick.last_frame) return {.all = true};
  return {false, fresh, (rays.dirty_phases & phases.mask()) != 0};
}

template <typename Item>
void SmokeLightSchedule::schedule(const Work& work, PhaseRange phases, Item item, std::vector<Item>& list,
                                  std::vector<Item>& sliced) {
  item.texels = work.all ? shared::kAllTexels : shared::kNewTexels;
  if (work.all || work.fresh) list.push_back(item);
  if (work.all || !work.slice) return;
  item.texels = shared::phase_range(phases.first, phases.end);
  sliced.push_back(item);
  most_phases_ = std::max(most_phases_, phases.end - phases.first);
}

/// Schedules `page_count` pages of rays, the first of them to `light` of the frame.
void SmokeLightSchedule::schedule_rays(const LitBrick& brick, CachedRays& rays, std::uint32_t light,
                                       std::uint32_t page_count, const Work& work, PhaseRange phases) {
  for (std::uint32_t i = 0; i < page_count; ++i)
    schedule(work, phases, shared::ShadowRays{brick.slot, brick.number, light + i, rays.page + i, 0},
             plan_.shadow_rays, sliced_rays_);
  rays.dirty_phases &= ~work.done(phases);
  rays.list_version = brick.list_version;
  rays.last_frame = frame_;
}

/// Schedules the gather of a brick: `work`, and what surroundings and lights change of it.
void SmokeLightSchedule::schedule_gather(LitBrick& brick, std::uint64_t light_versions,
                                         std::uint32_t first_light, Work work, PhaseRange phases) {
  if (brick.surroundings != surroundings_) brick.dirty_phases = kAllLightPhases;
  brick.surroundings = surroundings_;
  work.all |= brick.gathered_lights != light_versions || (!is_sliced() && brick.dirty_phases != 0);
  work.slice |= (brick.dirty_phases & phases.mask()) != 0;
  brick.gathered_lights = light_versions;
  brick.dirty_phases &= ~work.done(phases);
  const std::uint32_t light_count = count_of(plan_.gathered_lights) - first_light;
  if (!work.all && !work.fresh && !work.slice) plan_.gathered_lights.resize(first_light);
  schedule(work, phases,
           shared::LightGather{brick.slot, brick.number, brick.sky.page, first_light, light_count, 0},
           plan_.gathers, sliced_gathers_);
}

void SmokeLightSchedule::add(LitBrick& brick, std::span<const std::uint32_t> reaching,
                             const KnownLights& lights, const StaleLight& stale, SmokeLightPages& pages) {
  // Its texels, and which of them the frame updates.
  const std::uint64_t version_before = brick.list_version;
  Work gather{.fresh = update_texel_list(brick, stale)};
  const PhaseRange phases = prioritize(brick, gather.fresh);

  // Its rays: to the sky, and to each light that reaches it.
  const auto add_rays = [&](CachedRays& rays, std::uint32_t light, std::uint32_t page_count,
                            const Work& work) {
    pages.allocate(rays, page_count);
    schedule_rays(brick, rays, light, page_count, work, phases);
    gather.all |= work.all;
    gather.slice |= work.slice;
  };
  add_rays(brick.sky, shared::kSkyTarget, shared::kSkyPages,
           work_for(brick, brick.sky, version_before, phases));
  const std::uint32_t first_light = count_of(plan_.gathered_lights);
  for (std::size_t i = 0; i < reaching.size(); ++i) {
    const KnownLights::Known& light = lights[reaching[i]];
    CachedRays& rays = SmokeLightPages::rays_to(brick, reaching[i], i);
    const bool reaches_farther = light.light.range > rays.range || brightest(light.light) > rays.intensity;
    const Work work = reaches_farther ? Work{.all = true} : work_for(brick, rays, version_before, phases);
    add_rays(rays, light.in_frame, 1, work);
    if (work.all) {
      rays.range = light.light.range;
      rays.intensity = brightest(light.light);
    }
    plan_.gathered_lights.push_back({light.in_frame, rays.page});
  }

  // Its light.
  schedule_gather(brick, lights.versions_hash(reaching), first_light, gather, phases);
  brick.last_frame = frame_;
  brick.priority_frames -= brick.priority_frames > 0;
}

void SmokeLightSchedule::end_part(const SmokeLightPages& pages) {
  // What is sliced comes last, so that its dispatch is of fewer threads.
  plan_.shadow_rays.insert(plan_.shadow_rays.end(), sliced_rays_.begin(), sliced_rays_.end());
  plan_.gathers.insert(plan_.gathers.end(), sliced_gathers_.begin(), sliced_gathers_.end());
  plan_.texel_list_count = std::max(plan_.texel_list_count, pages.brick_count());
  plan_.page_count = std::max(plan_.page_count, pages.page_count());
  const auto added = [](std::uint32_t& first, const auto& list) {
    const volume::IndexRange range{first, count_of(list) - first};
    first = count_of(list);
    return range;
  };
  const SmokeLightPlan::Part part{added(first_list_, plan_.texel_lists),
                                  added(first_ray_, plan_.shadow_rays),
                                  added(first_gather_, plan_.gathers),
                                  count_of(sliced_rays_),
                                  count_of(sliced_gathers_),
                                  most_phases_};
  if (part.texel_lists.count > 0 || part.gathers.count > 0) plan_.parts.push_back(part);
  sliced_rays_.clear();
  sliced_gathers_.clear();
  most_phases_ = 0;
}

}  // namespace brume::planning
