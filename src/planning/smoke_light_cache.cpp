#include "planning/smoke_light_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>
#include <tuple>
#include <unordered_set>

#include "core/hash.hpp"
#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

// Lights that are remembered beyond those of the frame.
constexpr std::size_t kExtraLights = 32;
// More questions of a ray and a change than this cost more than following rays does.
constexpr std::size_t kMaxIntersectionTests = 1u << 16;
// Around the middle of a brick lie all its texels and points [voxels]: corners of a cube of 11.
constexpr float kBrickReach = 9.53f;

template <typename T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

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

bool same_opening(const shared::Hole& hole, float time_a, float time_b) {
  constexpr float kTolerance = 1e-3f;  // [s]: more than times round by
  const float wide = hole.time_start + hole.time_to_reach_far + std::max(hole.time_to_expand, 1e-6f);
  const float closing = hole.time_start + hole.time_to_expand + hole.time_to_stay_open;
  const float closed = wide + hole.time_to_stay_open + std::max(hole.time_to_fade, 1e-6f);
  const float first = std::min(time_a, time_b), last = std::max(time_a, time_b);
  return first == last || (first > wide + kTolerance && last < closing - kTolerance) ||
         last < hole.time_start - kTolerance || first > closed + kTolerance;
}

void SmokeLightCache::drop_all_rays() {
  row_count_ = 0;
  std::fill(row_of_slot_.begin(), row_of_slot_.end(), kNone);
  page_end_ = 0;
}

void SmokeLightCache::forget() {
  drop_all_rays();
  last_.reset();
}

bool SmokeLightCache::must_invalidate(const SmokeLightInputs& inputs) const {
  if (!last_ || inputs.volume != last_->volume || (!shares() && inputs_differ(inputs))) return true;
  const shared::VolumeLayout& layout = inputs.volume->layout();
  if (layout.origin_world != layout_.origin_world || layout.voxel_size != layout_.voxel_size ||
      layout.atlas_bricks != layout_.atlas_bricks)
    return true;
  // What is dirty is only that since the revision before.
  return inputs.volume->revision() != revision_ && inputs.volume->revision() != revision_ + 1;
}

/// Whether no ray holds, wherever it runs.
bool SmokeLightCache::inputs_differ(const SmokeLightInputs& inputs) const {
  return inputs.anew || !same_bytes(inputs.look, last_->look);
}

void SmokeLightCache::remember(const SmokeLightInputs& inputs) {
  holes_.assign(inputs.holes.begin(), inputs.holes.end());
  revision_ = inputs.volume->revision();
  layout_ = inputs.volume->layout();
  bounds_ = inputs.needs->bounds;
  const bool other_volume = !last_ || last_->volume != inputs.volume;
  last_ = inputs;
  if (!other_volume && generation_ == inputs.volume->structure_generation()) return;
  generation_ = inputs.volume->structure_generation();
  brick_of_slot_.resize(inputs.volume->slot_count());
  for (std::uint32_t slot = 0; slot < inputs.volume->slot_count(); ++slot)
    brick_of_slot_[slot] = inputs.volume->brick_of(slot);
}

void SmokeLightCache::add_hole_changes(const SmokeLightInputs& inputs,
                                      std::vector<shared::LightChange>& changes) const {
  const float slack = layout_.voxel_size;  // holes are averaged over cells of half a voxel
  const auto add = [&](const shared::Hole& hole) {
    // A rim moves by a quarter of the radius at most; only boxes and masks have corners.
    const float reach = hole.shape == shared::kHoleCylinder ? 1.25f : shared::kHoleWidest;
    changes.push_back({hole.origin_world, hole.radius * reach + slack,
                       hole.origin_world + hole.distance_to_far * hole.forward, 0});
  };
  const auto bytes = [](const shared::Hole& hole) {
    return std::string_view(reinterpret_cast<const char*>(&hole), sizeof hole);
  };
  std::unordered_set<std::string_view> gone;
  for (const shared::Hole& hole : holes_) gone.insert(bytes(hole));
  for (const shared::Hole& hole : inputs.holes)
    if (gone.erase(bytes(hole)) == 0 || !same_opening(hole, last_->time, inputs.time)) add(hole);
  for (const shared::Hole& hole : holes_)
    if (gone.count(bytes(hole)) > 0) add(hole);
}

/// Lists the changes of holes that a row's texels may be in.
volume::IndexRange SmokeLightCache::changes_in(const Row& row) {
  const auto first = static_cast<std::uint32_t>(plan_.changes.size());
  // A brick has one texel around it.
  const glm::vec3 low = world_of(layout_, glm::vec3(row.brick) * float{shared::kBrickVoxels} - 1.0f);
  const glm::vec3 high = world_of(layout_, glm::vec3(row.brick + 1) * float{shared::kBrickVoxels} + 1.0f);
  for (const shared::LightChange& cut : hole_changes_)
    if (intersects_box(cut.from_world, cut.to_world, low - cut.radius, high + cut.radius))
      plan_.changes.push_back(cut);
  return {first, static_cast<std::uint32_t>(plan_.changes.size()) - first};
}

void SmokeLightCache::add_smoke_changes(const SmokeLightInputs& inputs,
                                       std::vector<shared::LightChange>& changes) {
  if (inputs.volume->revision() == revision_) return;
  // Cubes of four bricks, what changed in each as one.
  std::map<std::tuple<int, int, int>, voxel::IntBox> cubes;
  const auto add = [&](glm::ivec3 brick) {
    const glm::ivec3 cube = brick >> 2;
    const auto [known, added] = cubes.try_emplace({cube.x, cube.y, cube.z}, voxel::IntBox{brick, brick + 1});
    if (!added) known->second = {glm::min(known->second.low, brick), glm::max(known->second.high, brick + 1)};
  };
  const auto add_slot = [&](std::uint32_t slot) {
    add(inputs.volume->brick_of(slot));
    if (slot < brick_of_slot_.size()) add(brick_of_slot_[slot]);
    if (slot < row_of_slot_.size() && row_of_slot_[slot] != kNone) rows_[row_of_slot_[slot]].listed = false;
  };
  for (const std::uint32_t slot : inputs.volume->dirty_slots()) add_slot(slot);
  for (const std::uint32_t slot : inputs.volume->dirty_cell_slots()) add_slot(slot);
  for (const auto& [key, bricks] : cubes) {
    // Corner sets of bricks around follow, too.
    const glm::vec3 low = world_of(layout_, glm::vec3(bricks.low - 1) * float{shared::kBrickVoxels});
    const glm::vec3 high = world_of(layout_, glm::vec3(bricks.high + 1) * float{shared::kBrickVoxels});
    const glm::vec3 middle = 0.5f * (low + high);
    changes.push_back({middle, 0.5f * glm::length(high - low), middle, 0});
  }
}

/// Drops all rays; which texels have any stays known.
void SmokeLightCache::invalidate_rays() {
  for (Row& row : std::span(rows_).first(row_count_)) {
    row.sky.stale = kAllPhases;
    for (Kept& kept : row.lights) kept.stale = kAllPhases;
  }
}

/// Drops the rays that changes may lie on; false where there is too much to ask.
bool SmokeLightCache::invalidate_crossing(const SmokeLightInputs& inputs,
                                  std::span<const shared::LightChange> changes) {
  if (changes.empty()) return true;
  std::size_t rays = 0;
  for (const Row& row : std::span(rows_).first(row_count_)) rays += shared::kSkyRays + row.lights.size();
  if (changes.size() * rays > kMaxIntersectionTests) return false;
  const shared::VolumeLayout &now = inputs.volume->layout(), &then = layout_;
  const float far = layout_.voxel_size * glm::length(glm::max(now.bounds_max, then.bounds_max) -
                                                    glm::min(now.bounds_min, then.bounds_min));
  const float radius = kBrickReach * layout_.voxel_size;
  for (Row& row : std::span(rows_).first(row_count_)) {
    const glm::vec3 from = middle_of(layout_, row.brick);
    const auto crossed = [&](glm::vec3 to) {
      return std::any_of(changes.begin(), changes.end(), [&](const shared::LightChange& change) {
        const float reach = radius + change.radius;
        return distance2(from, to, change.from_world, change.to_world) < reach * reach;
      });
    };
    for (std::uint32_t i = 0; i < shared::kSkyRays && row.sky.stale != kAllPhases; ++i)
      if (crossed(from + far * shared::sky_ray(i))) row.sky.stale = kAllPhases;
    for (Kept& kept : row.lights) {
      const shared::Light& light = known_lights_[kept.light].light;
      const bool sun = light.kind == shared::kLightDirectional;
      if (kept.stale != kAllPhases && crossed(sun ? from - far * light.direction : light.position_world))
        kept.stale = kAllPhases;
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
  // In the place of the one that was not seen for the longest time.
  const auto oldest = std::min_element(
      known_lights_.begin(), known_lights_.end(), [](const KnownLight& a, const KnownLight& b) { return a.last_frame < b.last_frame; });
  const auto number = static_cast<std::uint32_t>(oldest - known_lights_.begin());
  for (Row& row : std::span(rows_).first(row_count_))
    for (Kept& kept : row.lights)
      if (kept.light == number) kept.listing = 0;
  *oldest = {};
  return *oldest;
}

void SmokeLightCache::match_lights(std::span<const shared::Light> lights) {
  ++frames_;
  for (KnownLight& known : known_lights_) known.in_frame = kNone;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    KnownLight& known = match_light(lights[i], i, lights.size() + kExtraLights);
    if (known.version == 0 || !same_bytes(known.light, lights[i])) known.version = ++versions_;
    known.light = lights[i];
    known.last_frame = frames_;
    known.in_frame = static_cast<std::uint32_t>(i);
  }
}

void SmokeLightCache::find_lights_in_reach(const SmokeLightInputs& inputs) {
  std::vector<std::uint32_t> in_order(inputs.lights.size());
  for (std::uint32_t i = 0; i < known_lights_.size(); ++i)
    if (known_lights_[i].in_frame != kNone) in_order[known_lights_[i].in_frame] = i;
  lights_in_reach_.clear();
  lights_in_reach_first_.assign(1, 0);
  const shared::VolumeLayout& layout = inputs.volume->layout();
  for (std::uint32_t i = 0; i < inputs.needs->seen; ++i) {
    const glm::vec3 middle = middle_of(layout, inputs.volume->brick_of(inputs.needs->slots[i]));
    for (const std::uint32_t light : in_order)
      if (reaches(known_lights_[light].light, middle, kBrickReach * layout.voxel_size)) lights_in_reach_.push_back(light);
    lights_in_reach_first_.push_back(static_cast<std::uint32_t>(lights_in_reach_.size()));
  }
}

std::span<const std::uint32_t> SmokeLightCache::reaching(std::size_t seen_index) const {
  return std::span(lights_in_reach_).subspan(lights_in_reach_first_[seen_index],
                                      lights_in_reach_first_[seen_index + 1] - lights_in_reach_first_[seen_index]);
}

const SmokeLightCache::Row* SmokeLightCache::find_entry(std::uint32_t slot) const {
  return slot < row_of_slot_.size() && row_of_slot_[slot] != kNone ? &rows_[row_of_slot_[slot]] : nullptr;
}

/// At most: blocks for all that is in view, less those that it has.
std::size_t SmokeLightCache::pages_missing(const SmokeLightInputs& inputs) const {
  std::size_t missing = 0;
  for (std::uint32_t i = 0; i < inputs.needs->seen; ++i) {
    const Row* row = find_entry(inputs.needs->slots[i]);
    missing += reaching(i).size() + (row ? 0 : shared::kSkyPages);
    if (!row) continue;
    const auto lights = reaching(i);
    for (const Kept& kept : row->lights)
      missing -= std::find(lights.begin(), lights.end(), kept.light) != lights.end();
  }
  return missing;
}

SmokeLightCache::Row& SmokeLightCache::row_of(const SmokeLightInputs& inputs, std::uint32_t slot) {
  if (slot >= row_of_slot_.size()) row_of_slot_.resize(std::size_t{slot} + 1, kNone);
  const bool is_new = row_of_slot_[slot] == kNone;
  if (is_new) {
    row_of_slot_[slot] = row_count_++;
    if (rows_.size() < row_count_) rows_.emplace_back();
  }
  Row& row = rows_[row_of_slot_[slot]];
  const glm::ivec3 brick = inputs.volume->brick_of(slot);
  if (is_new) {
    row.sky = {};
    row.lights.clear();
  }
  if (is_new || row.brick != brick) {
    // The blocks stay its own.
    row.slot = slot;
    row.number = row_of_slot_[slot];
    row.brick = brick;
    row.listed = false;
    row.listing = row.sky.listing = row.gathered_lights = 0;
    for (Kept& kept : row.lights) kept.listing = 0;
  }
  return row;
}

void SmokeLightCache::allocate_pages(Kept& kept, std::uint32_t count) {
  if (kept.block != kNone) return;
  kept.block = page_end_;
  page_end_ += count;
}

std::uint64_t SmokeLightCache::light_versions_hash(std::span<const std::uint32_t> lights) const {
  std::uint64_t made = 0;
  for (const std::uint32_t light : lights) made = hash_values(std::span(&known_lights_[light].version, 1), made);
  return made;
}

/// What is kept of a light in a row, most likely at a place.
SmokeLightCache::Kept& SmokeLightCache::cached_rays_of(Row& row, std::uint32_t light, std::size_t hint) {
  if (hint < row.lights.size() && row.lights[hint].light == light) return row.lights[hint];
  const auto known = std::find_if(row.lights.begin(), row.lights.end(),
                                  [light](const Kept& kept) { return kept.light == light; });
  if (known != row.lights.end()) return *known;
  row.lights.emplace_back().light = light;
  return row.lights.back();
}

void SmokeLightCache::choose_slice(float share) {
  phases_ = shared::kLightPhases;
  while (phases_ > 1 && static_cast<float>(phases_ / 2) >= share * float{shared::kLightPhases}) phases_ /= 2;
  // The bits of the turn from behind, so that turns one after the other are in different halves, quarters,
  // ...
  first_phase_ = 0;
  for (std::uint32_t bit = shared::kLightPhases / 2, turn = turns_++ % shared::kLightPhases; bit >= phases_;
       bit /= 2, turn /= 2)
    first_phase_ += turn % 2 * bit;
}

SmokeLightCache::Run SmokeLightCache::phase_range_of(const Row& row) const {
  const std::uint32_t count = row.priority > 0 ? priority_phases() : phases_;
  const std::uint32_t first = first_phase_ / count * count;
  return {first, first + count};
}

/// Lists a row's texels where the list is not what it must be; whether it may have texels without light.
bool SmokeLightCache::update_texel_list(Row& row) {
  const bool had_list = shares() && row.listing != 0;
  const volume::IndexRange changes = had_list ? changes_in(row) : volume::IndexRange{};
  if (row.listed && (row.by_phase || !shares()) && changes.count == 0) return false;
  const bool is_fresh = had_list && (!row.listed || changes.count > 0);
  plan_.rows.push_back({row.slot, row.number, shares(), had_list, changes.first, changes.count});
  if (!row.listed || is_fresh) row.listing = ++listings_;
  row.listed = true;
  row.by_phase = shares();
  return is_fresh;
}

/// What is to be done of rays that a row has; `before` is the listing that it had.
SmokeLightCache::Task SmokeLightCache::work_for(const Row& row, const Kept& kept, std::uint64_t before,
                                             Run run) const {
  const bool fresh = kept.listing != row.listing;
  if (kept.listing == 0 || kept.listing != before || (fresh && !shares())) return {.all = true};
  if (kept.stale == 0) return {.fresh = fresh};
  // Rays to a light that the brick's last frame did not have are of any age.
  if (!shares() || kept.planned != row.planned) return {.all = true};
  return {false, fresh, (kept.stale & run.mask()) != 0};
}

template <typename Item>
void SmokeLightCache::ask(const Task& task, Run run, Item item, std::vector<Item>& list,
                         std::vector<Item>& few) {
  item.texels = task.all ? shared::kAllTexels : shared::kNewTexels;
  if (task.all || task.fresh) list.push_back(item);
  if (task.all || !task.run) return;
  item.texels = run.texels();
  few.push_back(item);
  most_phases_ = std::max(most_phases_, run.end - run.first);
}

/// Asks for `blocks` blocks of rays, `light` of the first.
void SmokeLightCache::follow(const Row& row, Kept& kept, std::uint32_t light, std::uint32_t blocks,
                            const Task& task, Run run) {
  for (std::uint32_t i = 0; i < blocks; ++i)
    ask(task, run, shared::ShadowRays{row.slot, row.number, light + i, kept.block + i, 0}, plan_.pairs,
        few_pairs_);
  kept.stale &= ~(task.all ? kAllPhases : task.run ? run.mask() : 0);
  kept.listing = row.listing;
  kept.planned = frames_;
}

void SmokeLightCache::plan_brick(Row& row, std::span<const std::uint32_t> lights) {
  const std::uint64_t before = row.listing;
  Task put{.fresh = update_texel_list(row)};
  if (row.planned + 1 != frames_) row.priority = shared::kLightPhases / priority_phases();
  const Run run = phase_range_of(row);
  const auto follow_kept = [&](Kept& kept, std::uint32_t light, std::uint32_t blocks, const Task& task) {
    allocate_pages(kept, blocks);
    follow(row, kept, light, blocks, task, run);
    put.all |= task.all;
    put.run |= task.run;
  };
  follow_kept(row.sky, shared::kSkyTarget, shared::kSkyPages, work_for(row, row.sky, before, run));
  const auto first = static_cast<std::uint32_t>(plan_.lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const KnownLight& light = known_lights_[lights[i]];
    Kept& kept = cached_rays_of(row, lights[i], i);
    const bool beyond = light.light.range > kept.range || brightest(light.light) > kept.intensity;
    const Task task = beyond ? Task{.all = true} : work_for(row, kept, before, run);
    follow_kept(kept, light.in_frame, 1, task);
    if (task.all) {
      kept.range = light.light.range;
      kept.intensity = brightest(light.light);
    }
    plan_.lights.push_back({light.in_frame, kept.block});
  }
  schedule_gather(row, lights, first, put, run);
  row.planned = frames_;
  row.priority -= row.priority > 0;
}

/// Asks for the light of a row: what `put` says, and what else of it is not as it was.
void SmokeLightCache::schedule_gather(Row& row, std::span<const std::uint32_t> lights, std::uint32_t first_light,
                                  Task put, Run run) {
  if (row.epoch != epoch_) row.stale = kAllPhases;
  row.epoch = epoch_;
  const std::uint64_t made = light_versions_hash(lights);
  put.all |= row.gathered_lights != made || (!shares() && row.stale != 0);
  put.run |= (row.stale & run.mask()) != 0;
  row.gathered_lights = made;
  row.stale &= ~(put.all ? kAllPhases : put.run ? run.mask() : 0);
  if (!put.all && !put.fresh && !put.run) plan_.lights.resize(first_light);
  ask(put, run,
      shared::LightGather{row.slot, row.number, row.sky.block, first_light,
                         static_cast<std::uint32_t>(lights.size()), 0},
      plan_.bricks, few_bricks_);
}

void SmokeLightCache::plan_incremental(const SmokeLightInputs& inputs) {
  few_pairs_.clear();
  few_bricks_.clear();
  most_phases_ = 0;
  for (std::uint32_t i = 0; i < inputs.needs->seen; ++i)
    plan_brick(row_of(inputs, inputs.needs->slots[i]), reaching(i));
  plan_.row_count = row_count_;
  plan_.page_count = page_end_;
  plan_.pairs.insert(plan_.pairs.end(), few_pairs_.begin(), few_pairs_.end());
  plan_.bricks.insert(plan_.bricks.end(), few_bricks_.begin(), few_bricks_.end());
  if (plan_.rows.empty() && plan_.bricks.empty()) return;
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  plan_.parts = {{{0, count(plan_.rows)},
                  {0, count(plan_.pairs)},
                  {0, count(plan_.bricks)},
                  count(few_pairs_),
                  count(few_bricks_),
                  most_phases_}};
}

/// As many bricks at a time as their blocks fit, nothing kept.
void SmokeLightCache::plan_in_parts(const SmokeLightInputs& inputs) {
  const auto sizes = [&] { return std::array{plan_.rows.size(), plan_.pairs.size(), plan_.bricks.size()}; };
  auto begin = sizes();
  const auto end_part = [&] {
    const auto end = sizes();
    const auto range = [&](std::size_t i) {
      return volume::IndexRange{static_cast<std::uint32_t>(begin[i]),
                             static_cast<std::uint32_t>(end[i] - begin[i])};
    };
    plan_.parts.push_back({range(0), range(1), range(2), 0, 0, 0});
    plan_.row_count = std::max(plan_.row_count, row_count_);
    plan_.page_count = std::max(plan_.page_count, page_end_);
    begin = end;
    drop_all_rays();
  };
  for (std::uint32_t i = 0; i < inputs.needs->seen; ++i) {
    const auto lights = reaching(i);
    if (page_end_ > 0 && page_end_ + lights.size() + shared::kSkyPages > max_pages_) end_part();
    plan_brick(row_of(inputs, inputs.needs->slots[i]), lights);
  }
  end_part();
}

const SmokeLightPlan& SmokeLightCache::plan(const SmokeLightInputs& inputs) {
  plan_ = {};
  if (!inputs.volume || inputs.volume->slot_count() == 0) {
    forget();
    return plan_;
  }
  choose_slice(inputs.share);
  hole_changes_.clear();
  if (must_invalidate(inputs)) {
    drop_all_rays();
  } else {
    std::vector<shared::LightChange> changes;
    add_smoke_changes(inputs, changes);
    // Rays end where the box around the smoke does.
    const bool other_box =
        bounds_.low != inputs.needs->bounds.low || bounds_.high != inputs.needs->bounds.high;
    const bool noise_drifts = inputs.look.erosion > 0 && (inputs.time != last_->time || inputs.noise_changed);
    if (shares()) add_hole_changes(inputs, hole_changes_);
    // Texels in them and beside them, not rays that graze them.
    for (shared::LightChange& cut : hole_changes_) cut.radius -= 0.5f * layout_.voxel_size;
    if (!noise_drifts) add_hole_changes(inputs, changes);
    if (noise_drifts || other_box || inputs_differ(inputs) || !invalidate_crossing(inputs, changes)) invalidate_rays();
  }
  if (!last_ || last_->eye_world != inputs.eye_world || !same_bytes(last_->sky, inputs.sky)) ++epoch_;
  match_lights(inputs.lights);
  find_lights_in_reach(inputs);
  if (page_end_ + pages_missing(inputs) > max_pages_) drop_all_rays();
  if (page_end_ == 0 && pages_missing(inputs) > max_pages_) {
    choose_slice(1);
    plan_in_parts(inputs);
    last_.reset();
  } else {
    plan_incremental(inputs);
    remember(inputs);
  }
  return plan_;
}

}  // namespace brume::planning
