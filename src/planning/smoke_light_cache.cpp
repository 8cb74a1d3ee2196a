#include "planning/smoke_light_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/hash.hpp"
#include "core/same_bytes.hpp"
#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

// Lights that are known beyond those of the frame.
constexpr std::size_t kExtraLights = 32;
// More tests of a ray and a change than this cost more than following all rays does.
constexpr std::size_t kMaxIntersectionTests = 1u << 16;
// Around the middle of a brick lie all its texels and points [voxels]: corners of a cube of 11.
constexpr float kBrickReach = 9.53f;

/// Whether rays to one light are those to the other, as far as both reach.
bool same_rays(shared::Light a, const shared::Light& b) {
  a.intensity = b.intensity;
  a.range = b.range;
  return same_bytes(a, b);
}

glm::vec3 world_of(const shared::VolumeLayout& layout, glm::vec3 voxel) {
  return layout.origin_world + voxel * layout.voxel_size;
}
glm::vec3 middle_of(const shared::VolumeLayout& layout, glm::ivec3 brick) {
  return world_of(layout, (glm::vec3(brick) + 0.5f) * float{shared::kBrickVoxels});
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

void SmokeLightCache::drop_all_rays() {
  entry_count_ = 0;
  std::fill(entry_of_slot_.begin(), entry_of_slot_.end(), kNone);
  pages_.clear();
}

void SmokeLightCache::invalidate() {
  drop_all_rays();
  tracker_.reset();
}

/// The texels of bricks that changed must be listed again.
void SmokeLightCache::relist_dirty_slots(const smoke::SmokeBricks& volume) {
  const auto relist = [&](std::uint32_t slot) {
    if (slot < entry_of_slot_.size() && entry_of_slot_[slot] != kNone)
      entries_[entry_of_slot_[slot]].is_listed = false;
  };
  for (const std::uint32_t slot : volume.dirty_slots()) relist(slot);
  for (const std::uint32_t slot : volume.dirty_cell_slots()) relist(slot);
}

/// Adds the changes of holes that a brick's texels may be in to the plan.
volume::IndexRange SmokeLightCache::add_changes_in(const BrickEntry& entry) {
  const auto first = static_cast<std::uint32_t>(plan_.changes.size());
  // A brick has one texel around it.
  const glm::vec3 low =
      world_of(tracker_.layout(), glm::vec3(entry.brick) * float{shared::kBrickVoxels} - 1.0f);
  const glm::vec3 high =
      world_of(tracker_.layout(), glm::vec3(entry.brick + 1) * float{shared::kBrickVoxels} + 1.0f);
  for (const shared::LightChange& hole : hole_changes_)
    if (intersects_box(hole.from_world, hole.to_world, low - hole.radius, high + hole.radius))
      plan_.changes.push_back(hole);
  return {first, static_cast<std::uint32_t>(plan_.changes.size()) - first};
}

/// No ray holds; which texels have any stays known.
void SmokeLightCache::invalidate_rays() {
  for (BrickEntry& entry : entries()) {
    entry.sky.dirty_phases = kAllPhases;
    for (CachedRays& rays : entry.lights) rays.dirty_phases = kAllPhases;
  }
}

/// Finds the rays that changes may lie on; false where there is too much to test.
bool SmokeLightCache::invalidate_crossing(const SmokeLightInputs& inputs,
                                          std::span<const shared::LightChange> changes) {
  if (changes.empty()) return true;
  std::size_t ray_count = 0;
  for (const BrickEntry& entry : entries()) ray_count += shared::kSkyRays + entry.lights.size();
  if (changes.size() * ray_count > kMaxIntersectionTests) return false;
  const shared::VolumeLayout &now = inputs.volume->layout(), &then = tracker_.layout();
  const float far = then.voxel_size * glm::length(glm::max(now.bounds_max, then.bounds_max) -
                                                  glm::min(now.bounds_min, then.bounds_min));
  const float radius = kBrickReach * then.voxel_size;
  for (BrickEntry& entry : entries()) {
    const glm::vec3 from = middle_of(then, entry.brick);
    const auto crossed = [&](glm::vec3 to) {
      return std::any_of(changes.begin(), changes.end(), [&](const shared::LightChange& change) {
        const float reach = radius + change.radius;
        return distance2(from, to, change.from_world, change.to_world) < reach * reach;
      });
    };
    for (std::uint32_t i = 0; i < shared::kSkyRays && entry.sky.dirty_phases != kAllPhases; ++i)
      if (crossed(from + far * shared::sky_ray(i))) entry.sky.dirty_phases = kAllPhases;
    for (CachedRays& rays : entry.lights) {
      const shared::Light& light = known_lights_[rays.light].light;
      const bool sun = light.kind == shared::kLightDirectional;
      if (rays.dirty_phases != kAllPhases &&
          crossed(sun ? from - far * light.direction : light.position_world))
        rays.dirty_phases = kAllPhases;
    }
  }
  return true;
}

SmokeLightCache::KnownLight& SmokeLightCache::match_light(const shared::Light& light, std::size_t hint,
                                                          std::size_t most) {
  const auto is_it = [&](const KnownLight& known) {
    return known.last_frame < frames_ && same_rays(known.light, light);
  };
  if (hint < known_lights_.size() && is_it(known_lights_[hint])) return known_lights_[hint];
  const auto known = std::find_if(known_lights_.begin(), known_lights_.end(), is_it);
  if (known != known_lights_.end()) return *known;
  if (known_lights_.size() < most) return known_lights_.emplace_back();
  // In the place of the one that no frame had for the longest time.
  const auto oldest =
      std::min_element(known_lights_.begin(), known_lights_.end(),
                       [](const KnownLight& a, const KnownLight& b) { return a.last_frame < b.last_frame; });
  const auto number = static_cast<std::uint32_t>(oldest - known_lights_.begin());
  for (BrickEntry& entry : entries())
    for (CachedRays& rays : entry.lights)
      if (rays.light == number) rays.list_version = 0;
  *oldest = {};
  return *oldest;
}

void SmokeLightCache::match_lights(std::span<const shared::Light> lights) {
  ++frames_;
  for (KnownLight& known : known_lights_) known.in_frame = kNone;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    KnownLight& known = match_light(lights[i], i, lights.size() + kExtraLights);
    if (known.version == 0 || !same_bytes(known.light, lights[i])) known.version = ++light_versions_;
    known.light = lights[i];
    known.last_frame = frames_;
    known.in_frame = static_cast<std::uint32_t>(i);
  }
}

void SmokeLightCache::find_lights_in_reach(const SmokeLightInputs& inputs, Allocator memory) {
  FrameVector<std::uint32_t> in_order(inputs.lights.size(), memory);
  for (std::uint32_t i = 0; i < known_lights_.size(); ++i)
    if (known_lights_[i].in_frame != kNone) in_order[known_lights_[i].in_frame] = i;
  lights_in_reach_.clear();
  lights_in_reach_first_.assign(1, 0);
  const shared::VolumeLayout& layout = inputs.volume->layout();
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i) {
    const glm::vec3 middle = middle_of(layout, inputs.volume->brick_of(inputs.visibility->slots[i]));
    for (const std::uint32_t light : in_order)
      if (reaches(known_lights_[light].light, middle, kBrickReach * layout.voxel_size))
        lights_in_reach_.push_back(light);
    lights_in_reach_first_.push_back(static_cast<std::uint32_t>(lights_in_reach_.size()));
  }
}

std::span<const std::uint32_t> SmokeLightCache::lights_reaching(std::size_t visible_index) const {
  return std::span(lights_in_reach_)
      .subspan(lights_in_reach_first_[visible_index],
               lights_in_reach_first_[visible_index + 1] - lights_in_reach_first_[visible_index]);
}

const SmokeLightCache::BrickEntry* SmokeLightCache::find_entry(std::uint32_t slot) const {
  return slot < entry_of_slot_.size() && entry_of_slot_[slot] != kNone ? &entries_[entry_of_slot_[slot]]
                                                                       : nullptr;
}

/// No fewer than the plan allocates: what all that is in view takes, less what it has.
SmokeLightCache::Missing SmokeLightCache::missing(const SmokeLightInputs& inputs) const {
  Missing missing;
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i) {
    const BrickEntry* entry = find_entry(inputs.visibility->slots[i]);
    const auto lights = lights_reaching(i);
    missing.pages += lights.size() + (entry ? 0 : shared::kSkyPages);
    missing.entries += entry ? 0 : 1;
    if (!entry) continue;
    for (const CachedRays& rays : entry->lights)
      missing.pages -= std::find(lights.begin(), lights.end(), rays.light) != lights.end();
  }
  return missing;
}

/// Whether the device can add what is missing to what it holds.
bool SmokeLightCache::has_room(const SmokeLightInputs& inputs) const {
  const Missing more = missing(inputs);
  return pages_.fits(more.pages) && pages_.used() + more.pages <= inputs.room.pages &&
         entry_count_ + more.entries <= inputs.room.texel_lists;
}

SmokeLightCache::BrickEntry& SmokeLightCache::entry_of(const SmokeLightInputs& inputs, std::uint32_t slot) {
  if (slot >= entry_of_slot_.size()) entry_of_slot_.resize(std::size_t{slot} + 1, kNone);
  const bool is_new = entry_of_slot_[slot] == kNone;
  if (is_new) {
    entry_of_slot_[slot] = entry_count_++;
    if (entries_.size() < entry_count_) entries_.emplace_back();
  }
  BrickEntry& entry = entries_[entry_of_slot_[slot]];
  const glm::ivec3 brick = inputs.volume->brick_of(slot);
  if (is_new) {
    entry.sky = {};
    entry.lights.clear();
  }
  if (is_new || entry.brick != brick) {
    // It keeps its pages.
    entry.slot = slot;
    entry.number = entry_of_slot_[slot];
    entry.brick = brick;
    entry.is_listed = false;
    entry.list_version = entry.sky.list_version = entry.gathered_lights = 0;
    for (CachedRays& rays : entry.lights) rays.list_version = 0;
  }
  return entry;
}

std::uint64_t SmokeLightCache::light_versions_hash(std::span<const std::uint32_t> lights) const {
  std::uint64_t hash = 0;
  for (const std::uint32_t light : lights)
    hash = hash_values(std::span(&known_lights_[light].version, 1), hash);
  return hash;
}

/// The rays of a brick to a light, most likely those at index `hint`.
SmokeLightCache::CachedRays& SmokeLightCache::cached_rays_of(BrickEntry& entry, std::uint32_t light,
                                                             std::size_t hint) {
  if (hint < entry.lights.size() && entry.lights[hint].light == light) return entry.lights[hint];
  const auto known = std::find_if(entry.lights.begin(), entry.lights.end(),
                                  [light](const CachedRays& rays) { return rays.light == light; });
  if (known != entry.lights.end()) return *known;
  entry.lights.emplace_back().light = light;
  return entry.lights.back();
}

SmokeLightCache::PhaseRange SmokeLightCache::phases_of(const BrickEntry& entry) const {
  return scheduler_.slices(entry.priority_frames > 0 ? entry.priority : 1);
}

/// Schedules a brick's texel list where it changed; whether it may have texels without light.
bool SmokeLightCache::update_texel_list(BrickEntry& entry) {
  const bool had_list = scheduler_.is_sliced() && entry.list_version != 0;
  const volume::IndexRange changes = had_list ? add_changes_in(entry) : volume::IndexRange{};
  if (entry.is_listed && (entry.by_phase || !scheduler_.is_sliced()) && changes.count == 0) return false;
  const bool is_fresh = had_list && (!entry.is_listed || changes.count > 0);
  plan_.texel_lists.push_back(
      {entry.slot, entry.number, scheduler_.is_sliced(), had_list, changes.first, changes.count});
  if (!entry.is_listed || is_fresh) entry.list_version = ++list_versions_;
  entry.is_listed = true;
  entry.by_phase = scheduler_.is_sliced();
  return is_fresh;
}

/// The work on a brick's rays; `version_before` is the version of its texel list before this frame.
SmokeLightCache::Work SmokeLightCache::work_for(const BrickEntry& entry, const CachedRays& rays,
                                                std::uint64_t version_before, PhaseRange phases) const {
  const bool fresh = rays.list_version != entry.list_version;
  if (rays.list_version == 0 || rays.list_version != version_before || (fresh && !scheduler_.is_sliced()))
    return {.all = true};
  if (rays.dirty_phases == 0) return {.fresh = fresh};
  // Rays to a light that the brick's last frame did not have are of any age.
  if (!scheduler_.is_sliced() || rays.last_frame != entry.last_frame) return {.all = true};
  return {false, fresh, (rays.dirty_phases & phases.mask()) != 0};
}

template <typename Item>
void SmokeLightCache::schedule(const Work& work, PhaseRange phases, Item item, std::vector<Item>& list,
                               std::vector<Item>& sliced) {
  item.texels = work.all ? shared::kAllTexels : shared::kNewTexels;
  if (work.all || work.fresh) list.push_back(item);
  if (work.all || !work.slice) return;
  item.texels = shared::phase_range(phases.first, phases.end);
  sliced.push_back(item);
  most_phases_ = std::max(most_phases_, phases.end - phases.first);
}

/// Schedules `page_count` pages of rays, the first of them to `light`.
void SmokeLightCache::schedule_rays(const BrickEntry& entry, CachedRays& rays, std::uint32_t light,
                                    std::uint32_t page_count, const Work& work, PhaseRange phases) {
  for (std::uint32_t i = 0; i < page_count; ++i)
    schedule(work, phases, shared::ShadowRays{entry.slot, entry.number, light + i, rays.page + i, 0},
             plan_.shadow_rays, sliced_rays_);
  rays.dirty_phases &= ~(work.all ? kAllPhases : work.slice ? phases.mask() : 0);
  rays.list_version = entry.list_version;
  rays.last_frame = frames_;
}

void SmokeLightCache::plan_brick(BrickEntry& entry, std::span<const std::uint32_t> lights) {
  // Its texels, and which of them the frame updates.
  const std::uint64_t version_before = entry.list_version;
  Work gather{.fresh = update_texel_list(entry)};
  const auto prioritize = [&](std::uint32_t priority) {
    entry.priority = priority;
    entry.priority_frames = shared::kLightPhases / scheduler_.slices_per_frame(priority);
  };
  if (entry.last_frame + 1 != frames_) {
    prioritize(kNewPriority);
  } else if (gather.fresh && (entry.priority_frames == 0 || entry.priority == kChangedPriority)) {
    prioritize(kChangedPriority);
  }
  const PhaseRange phases = phases_of(entry);

  // Its rays: to the sky, and to each light that reaches it.
  const auto plan_rays = [&](CachedRays& rays, std::uint32_t light, std::uint32_t page_count,
                             const Work& work) {
    if (rays.page == kNone) rays.page = pages_.allocate(page_count);
    schedule_rays(entry, rays, light, page_count, work, phases);
    gather.all |= work.all;
    gather.slice |= work.slice;
  };
  plan_rays(entry.sky, shared::kSkyTarget, shared::kSkyPages,
            work_for(entry, entry.sky, version_before, phases));
  const auto first_light = static_cast<std::uint32_t>(plan_.gathered_lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const KnownLight& light = known_lights_[lights[i]];
    CachedRays& rays = cached_rays_of(entry, lights[i], i);
    const bool beyond = light.light.range > rays.range || brightest(light.light) > rays.intensity;
    const Work work = beyond ? Work{.all = true} : work_for(entry, rays, version_before, phases);
    plan_rays(rays, light.in_frame, 1, work);
    if (work.all) {
      rays.range = light.light.range;
      rays.intensity = brightest(light.light);
    }
    plan_.gathered_lights.push_back({light.in_frame, rays.page});
  }

  // Its light.
  schedule_gather(entry, lights, first_light, gather, phases);
  entry.last_frame = frames_;
  entry.priority_frames -= entry.priority_frames > 0;
}

/// Schedules the gather of a brick: `work`, and what eye, sky and lights change of it.
void SmokeLightCache::schedule_gather(BrickEntry& entry, std::span<const std::uint32_t> lights,
                                      std::uint32_t first_light, Work work, PhaseRange phases) {
  if (entry.epoch != epoch_) entry.dirty_phases = kAllPhases;
  entry.epoch = epoch_;
  const std::uint64_t versions = light_versions_hash(lights);
  work.all |= entry.gathered_lights != versions || (!scheduler_.is_sliced() && entry.dirty_phases != 0);
  work.slice |= (entry.dirty_phases & phases.mask()) != 0;
  entry.gathered_lights = versions;
  entry.dirty_phases &= ~(work.all ? kAllPhases : work.slice ? phases.mask() : 0);
  if (!work.all && !work.fresh && !work.slice) plan_.gathered_lights.resize(first_light);
  schedule(work, phases,
           shared::LightGather{entry.slot, entry.number, entry.sky.page, first_light,
                               static_cast<std::uint32_t>(lights.size()), 0},
           plan_.gathers, sliced_gathers_);
}

void SmokeLightCache::plan_incremental(const SmokeLightInputs& inputs) {
  sliced_rays_.clear();
  sliced_gathers_.clear();
  most_phases_ = 0;
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i)
    plan_brick(entry_of(inputs, inputs.visibility->slots[i]), lights_reaching(i));
  plan_.texel_list_count = entry_count_;
  plan_.page_count = pages_.used();
  plan_.shadow_rays.insert(plan_.shadow_rays.end(), sliced_rays_.begin(), sliced_rays_.end());
  plan_.gathers.insert(plan_.gathers.end(), sliced_gathers_.begin(), sliced_gathers_.end());
  if (plan_.texel_lists.empty() && plan_.gathers.empty()) return;
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  plan_.parts.push_back({{0, count(plan_.texel_lists)},
                         {0, count(plan_.shadow_rays)},
                         {0, count(plan_.gathers)},
                         count(sliced_rays_),
                         count(sliced_gathers_),
                         most_phases_});
}

/// As many bricks at a time as their pages fit; nothing is cached.
void SmokeLightCache::plan_in_parts(const SmokeLightInputs& inputs) {
  const auto sizes = [&] {
    return std::array{plan_.texel_lists.size(), plan_.shadow_rays.size(), plan_.gathers.size()};
  };
  auto begin = sizes();
  const auto end_part = [&] {
    const auto end = sizes();
    const auto range = [&](std::size_t i) {
      return volume::IndexRange{static_cast<std::uint32_t>(begin[i]),
                                static_cast<std::uint32_t>(end[i] - begin[i])};
    };
    plan_.parts.push_back({range(0), range(1), range(2), 0, 0, 0});
    plan_.texel_list_count = std::max(plan_.texel_list_count, entry_count_);
    plan_.page_count = std::max(plan_.page_count, pages_.used());
    begin = end;
    drop_all_rays();
  };
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i) {
    const auto lights = lights_reaching(i);
    if (pages_.used() > 0 && !pages_.fits(lights.size() + shared::kSkyPages)) end_part();
    plan_brick(entry_of(inputs, inputs.visibility->slots[i]), lights);
  }
  end_part();
}

/// Finds the cached rays and texel lists that no longer hold.
void SmokeLightCache::drop_changed(const SmokeLightInputs& inputs, Allocator memory) {
  hole_changes_.clear();
  if (!tracker_.is_continuous(inputs) || (!scheduler_.is_sliced() && tracker_.all_rays_changed(inputs))) {
    drop_all_rays();
    return;
  }

  // Texels that must have light at once: of smoke that changed, and in holes that did and beside them. Rays
  // that only graze holes can wait.
  FrameVector<shared::LightChange> changes(memory), holes(memory);
  if (tracker_.smoke_changed(inputs)) relist_dirty_slots(*inputs.volume);
  if (scheduler_.is_sliced()) tracker_.add_hole_changes(inputs, holes);
  hole_changes_.assign(holes.begin(), holes.end());
  for (shared::LightChange& hole : hole_changes_) hole.radius -= 0.5f * tracker_.layout().voxel_size;

  // Rays that cross what changed.
  tracker_.add_smoke_changes(inputs, changes);
  if (!tracker_.noise_moved(inputs)) tracker_.add_hole_changes(inputs, changes);
  if (tracker_.noise_moved(inputs) || tracker_.caster_bounds_changed(inputs) ||
      tracker_.all_rays_changed(inputs) || !invalidate_crossing(inputs, changes))
    invalidate_rays();
}

const SmokeLightPlan& SmokeLightCache::plan(const SmokeLightInputs& inputs, Allocator memory) {
  if (is_open_) invalidate();
  is_open_ = true;
  plan_.clear();
  if (!inputs.volume || inputs.volume->slot_count() == 0) {
    invalidate();
    return plan_;
  }

  // What changed since the frame before.
  scheduler_.next_slice(inputs.update_fraction);
  drop_changed(inputs, memory);
  if (tracker_.gather_inputs_changed(inputs)) ++epoch_;
  match_lights(inputs.lights);
  find_lights_in_reach(inputs, memory);

  // What the frame updates.
  if (!has_room(inputs)) drop_all_rays();
  if (pages_.used() == 0 && !pages_.fits(missing(inputs).pages)) {
    scheduler_.next_slice(1);
    plan_in_parts(inputs);
    tracker_.reset();
  } else {
    plan_incremental(inputs);
    tracker_.store_inputs(inputs);
  }
  return plan_;
}

}  // namespace brume::planning
