#include "passes/smoke_light_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>
#include <tuple>
#include <unordered_set>

#include "core/hash.hpp"
#include "passes/light_reach.hpp"

namespace brume::passes {
namespace {

// Lamps that are remembered beyond those of the frame.
constexpr std::size_t kMoreLamps = 32;
// More questions of a ray and a change than this cost more than following rays does.
constexpr std::size_t kMostQuestions = 1u << 16;
// Around the middle of a brick lie all its texels and points [voxels]: corners of a cube of 11.
constexpr float kBrickReach = 9.53f;

template <typename T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Whether rays to one lamp are those to the other, as far as both reach.
bool same_rays(shared::Light a, const shared::Light& b) {
  a.intensity = b.intensity;
  a.range = b.range;
  return same_bytes(a, b);
}

glm::vec3 world_of(const shared::SmokeVolumeFrame& frame, glm::vec3 voxel) {
  return frame.origin_world + voxel * frame.voxel_size;
}
glm::vec3 middle_of(const shared::SmokeVolumeFrame& frame, glm::ivec3 brick) {
  return world_of(frame, (glm::vec3(brick) + 0.5f) * float{shared::kBrickVoxels});
}

}  // namespace

bool same_cut(const shared::Hole& hole, float time_a, float time_b) {
  constexpr float kSlack = 1e-3f;  // [s]: more than times round by
  const float wide = hole.time_start + hole.time_to_reach_far + std::max(hole.time_to_expand, 1e-6f);
  const float closing = hole.time_start + hole.time_to_expand + hole.time_to_stay_open;
  const float closed = wide + hole.time_to_stay_open + std::max(hole.time_to_fade, 1e-6f);
  const float first = std::min(time_a, time_b), last = std::max(time_a, time_b);
  return first == last || (first > wide + kSlack && last < closing - kSlack) ||
         last < hole.time_start - kSlack || first > closed + kSlack;
}

void KeptSmokeLight::forget_rays() {
  row_count_ = 0;
  std::fill(row_of_slot_.begin(), row_of_slot_.end(), kNone);
  block_end_ = 0;
}

void KeptSmokeLight::forget() {
  forget_rays();
  last_.reset();
}

bool KeptSmokeLight::must_forget(const SmokeLightMoment& moment) const {
  if (!last_ || moment.volume != last_->volume || (!shares() && is_other(moment))) return true;
  const shared::SmokeVolumeFrame& frame = moment.volume->frame();
  if (frame.origin_world != frame_.origin_world || frame.voxel_size != frame_.voxel_size ||
      frame.atlas_bricks != frame_.atlas_bricks)
    return true;
  // What is dirty is only that since the revision before.
  return moment.volume->revision() != revision_ && moment.volume->revision() != revision_ + 1;
}

/// Whether no ray holds, wherever it runs.
bool KeptSmokeLight::is_other(const SmokeLightMoment& moment) const {
  return moment.anew || !same_bytes(moment.look, last_->look);
}

void KeptSmokeLight::remember(const SmokeLightMoment& moment) {
  holes_.assign(moment.holes.begin(), moment.holes.end());
  revision_ = moment.volume->revision();
  frame_ = moment.volume->frame();
  bounds_ = moment.needs->bounds;
  const bool other_volume = !last_ || last_->volume != moment.volume;
  last_ = moment;
  if (!other_volume && generation_ == moment.volume->structure_generation()) return;
  generation_ = moment.volume->structure_generation();
  brick_of_slot_.resize(moment.volume->slot_count());
  for (std::uint32_t slot = 0; slot < moment.volume->slot_count(); ++slot)
    brick_of_slot_[slot] = moment.volume->brick_of(slot);
}

void KeptSmokeLight::add_hole_changes(const SmokeLightMoment& moment,
                                      std::vector<shared::LightChange>& changes) const {
  const float slack = frame_.voxel_size;  // holes are averaged over cells of half a voxel
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
  for (const shared::Hole& hole : moment.holes)
    if (gone.erase(bytes(hole)) == 0 || !same_cut(hole, last_->time, moment.time)) add(hole);
  for (const shared::Hole& hole : holes_)
    if (gone.count(bytes(hole)) > 0) add(hole);
}

/// Lists the changes of holes that a row's texels may be in.
sim::IndexRange KeptSmokeLight::changes_in(const Row& row) {
  const auto first = static_cast<std::uint32_t>(plan_.changes.size());
  // A brick has one texel around it.
  const glm::vec3 low = world_of(frame_, glm::vec3(row.brick) * float{shared::kBrickVoxels} - 1.0f);
  const glm::vec3 high = world_of(frame_, glm::vec3(row.brick + 1) * float{shared::kBrickVoxels} + 1.0f);
  for (const shared::LightChange& cut : cuts_)
    if (meets_box(cut.from_world, cut.to_world, low - cut.radius, high + cut.radius))
      plan_.changes.push_back(cut);
  return {first, static_cast<std::uint32_t>(plan_.changes.size()) - first};
}

void KeptSmokeLight::add_smoke_changes(const SmokeLightMoment& moment,
                                       std::vector<shared::LightChange>& changes) {
  if (moment.volume->revision() == revision_) return;
  // Cubes of four bricks, what changed in each as one.
  std::map<std::tuple<int, int, int>, voxel::IntBox> cubes;
  const auto add = [&](glm::ivec3 brick) {
    const glm::ivec3 cube = brick >> 2;
    const auto [known, added] = cubes.try_emplace({cube.x, cube.y, cube.z}, voxel::IntBox{brick, brick + 1});
    if (!added) known->second = {glm::min(known->second.low, brick), glm::max(known->second.high, brick + 1)};
  };
  const auto add_slot = [&](std::uint32_t slot) {
    add(moment.volume->brick_of(slot));
    if (slot < brick_of_slot_.size()) add(brick_of_slot_[slot]);
    if (slot < row_of_slot_.size() && row_of_slot_[slot] != kNone) rows_[row_of_slot_[slot]].listed = false;
  };
  for (const std::uint32_t slot : moment.volume->dirty_slots()) add_slot(slot);
  for (const std::uint32_t slot : moment.volume->dirty_cell_slots()) add_slot(slot);
  for (const auto& [key, bricks] : cubes) {
    // Corner sets of bricks around follow, too.
    const glm::vec3 low = world_of(frame_, glm::vec3(bricks.low - 1) * float{shared::kBrickVoxels});
    const glm::vec3 high = world_of(frame_, glm::vec3(bricks.high + 1) * float{shared::kBrickVoxels});
    const glm::vec3 middle = 0.5f * (low + high);
    changes.push_back({middle, 0.5f * glm::length(high - low), middle, 0});
  }
}

/// Drops all rays; which texels have any stays known.
void KeptSmokeLight::drop_rays() {
  for (Row& row : std::span(rows_).first(row_count_)) {
    row.sky.stale = kEveryPhase;
    for (Kept& kept : row.lamps) kept.stale = kEveryPhase;
  }
}

/// Drops the rays that changes may lie on; false where there is too much to ask.
bool KeptSmokeLight::drop_crossed(const SmokeLightMoment& moment,
                                  std::span<const shared::LightChange> changes) {
  if (changes.empty()) return true;
  std::size_t rays = 0;
  for (const Row& row : std::span(rows_).first(row_count_)) rays += shared::kSkyRays + row.lamps.size();
  if (changes.size() * rays > kMostQuestions) return false;
  const shared::SmokeVolumeFrame &now = moment.volume->frame(), &then = frame_;
  const float far = frame_.voxel_size * glm::length(glm::max(now.bounds_max, then.bounds_max) -
                                                    glm::min(now.bounds_min, then.bounds_min));
  const float radius = kBrickReach * frame_.voxel_size;
  for (Row& row : std::span(rows_).first(row_count_)) {
    const glm::vec3 from = middle_of(frame_, row.brick);
    const auto crossed = [&](glm::vec3 to) {
      return std::any_of(changes.begin(), changes.end(), [&](const shared::LightChange& change) {
        const float reach = radius + change.radius;
        return distance2(from, to, change.from_world, change.to_world) < reach * reach;
      });
    };
    for (std::uint32_t i = 0; i < shared::kSkyRays && row.sky.stale != kEveryPhase; ++i)
      if (crossed(from + far * shared::sky_ray(i))) row.sky.stale = kEveryPhase;
    for (Kept& kept : row.lamps) {
      const shared::Light& light = lamps_[kept.lamp].light;
      const bool sun = light.kind == shared::kLightDirectional;
      if (kept.stale != kEveryPhase && crossed(sun ? from - far * light.direction : light.position_world))
        kept.stale = kEveryPhase;
    }
  }
  return true;
}

KeptSmokeLight::Lamp& KeptSmokeLight::known_lamp(const shared::Light& light, std::size_t hint,
                                                 std::size_t most) {
  const auto is_it = [&](const Lamp& lamp) {
    return lamp.last_frame < frames_ && same_rays(lamp.light, light);
  };
  if (hint < lamps_.size() && is_it(lamps_[hint])) return lamps_[hint];
  const auto known = std::find_if(lamps_.begin(), lamps_.end(), is_it);
  if (known != lamps_.end()) return *known;
  if (lamps_.size() < most) return lamps_.emplace_back();
  // In the place of the one that was not seen for the longest time.
  const auto oldest = std::min_element(
      lamps_.begin(), lamps_.end(), [](const Lamp& a, const Lamp& b) { return a.last_frame < b.last_frame; });
  const auto number = static_cast<std::uint32_t>(oldest - lamps_.begin());
  for (Row& row : std::span(rows_).first(row_count_))
    for (Kept& kept : row.lamps)
      if (kept.lamp == number) kept.listing = 0;
  *oldest = {};
  return *oldest;
}

void KeptSmokeLight::follow_lamps(std::span<const shared::Light> lights) {
  ++frames_;
  for (Lamp& lamp : lamps_) lamp.in_frame = kNone;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Lamp& lamp = known_lamp(lights[i], i, lights.size() + kMoreLamps);
    if (lamp.version == 0 || !same_bytes(lamp.light, lights[i])) lamp.version = ++versions_;
    lamp.light = lights[i];
    lamp.last_frame = frames_;
    lamp.in_frame = static_cast<std::uint32_t>(i);
  }
}

void KeptSmokeLight::find_reaching(const SmokeLightMoment& moment) {
  std::vector<std::uint32_t> in_order(moment.lights.size());
  for (std::uint32_t i = 0; i < lamps_.size(); ++i)
    if (lamps_[i].in_frame != kNone) in_order[lamps_[i].in_frame] = i;
  reaching_.clear();
  reaching_first_.assign(1, 0);
  const shared::SmokeVolumeFrame& frame = moment.volume->frame();
  for (std::uint32_t i = 0; i < moment.needs->seen; ++i) {
    const glm::vec3 middle = middle_of(frame, moment.volume->brick_of(moment.needs->slots[i]));
    for (const std::uint32_t lamp : in_order)
      if (reaches(lamps_[lamp].light, middle, kBrickReach * frame.voxel_size)) reaching_.push_back(lamp);
    reaching_first_.push_back(static_cast<std::uint32_t>(reaching_.size()));
  }
}

std::span<const std::uint32_t> KeptSmokeLight::reaching(std::size_t seen_index) const {
  return std::span(reaching_).subspan(reaching_first_[seen_index],
                                      reaching_first_[seen_index + 1] - reaching_first_[seen_index]);
}

const KeptSmokeLight::Row* KeptSmokeLight::known_row(std::uint32_t slot) const {
  return slot < row_of_slot_.size() && row_of_slot_[slot] != kNone ? &rows_[row_of_slot_[slot]] : nullptr;
}

/// At most: blocks for all that is in view, less those that it has.
std::size_t KeptSmokeLight::blocks_missing(const SmokeLightMoment& moment) const {
  std::size_t missing = 0;
  for (std::uint32_t i = 0; i < moment.needs->seen; ++i) {
    const Row* row = known_row(moment.needs->slots[i]);
    missing += reaching(i).size() + (row ? 0 : shared::kSkyBlocks);
    if (!row) continue;
    const auto lamps = reaching(i);
    for (const Kept& kept : row->lamps)
      missing -= std::find(lamps.begin(), lamps.end(), kept.lamp) != lamps.end();
  }
  return missing;
}

KeptSmokeLight::Row& KeptSmokeLight::row_of(const SmokeLightMoment& moment, std::uint32_t slot) {
  if (slot >= row_of_slot_.size()) row_of_slot_.resize(std::size_t{slot} + 1, kNone);
  const bool is_new = row_of_slot_[slot] == kNone;
  if (is_new) {
    row_of_slot_[slot] = row_count_++;
    if (rows_.size() < row_count_) rows_.emplace_back();
  }
  Row& row = rows_[row_of_slot_[slot]];
  const glm::ivec3 brick = moment.volume->brick_of(slot);
  if (is_new) {
    row.sky = {};
    row.lamps.clear();
  }
  if (is_new || row.brick != brick) {
    // The blocks stay its own.
    row.slot = slot;
    row.number = row_of_slot_[slot];
    row.brick = brick;
    row.listed = false;
    row.listing = row.sky.listing = row.lamps_made = 0;
    for (Kept& kept : row.lamps) kept.listing = 0;
  }
  return row;
}

void KeptSmokeLight::take_blocks(Kept& kept, std::uint32_t count) {
  if (kept.block != kNone) return;
  kept.block = block_end_;
  block_end_ += count;
}

std::uint64_t KeptSmokeLight::made_of(std::span<const std::uint32_t> lamps) const {
  std::uint64_t made = 0;
  for (const std::uint32_t lamp : lamps) made = hash_values(std::span(&lamps_[lamp].version, 1), made);
  return made;
}

/// What is kept of a lamp in a row, most likely at a place.
KeptSmokeLight::Kept& KeptSmokeLight::kept_of(Row& row, std::uint32_t lamp, std::size_t hint) {
  if (hint < row.lamps.size() && row.lamps[hint].lamp == lamp) return row.lamps[hint];
  const auto known = std::find_if(row.lamps.begin(), row.lamps.end(),
                                  [lamp](const Kept& kept) { return kept.lamp == lamp; });
  if (known != row.lamps.end()) return *known;
  row.lamps.emplace_back().lamp = lamp;
  return row.lamps.back();
}

void KeptSmokeLight::choose_phases(float share) {
  phases_ = shared::kLightPhases;
  while (phases_ > 1 && static_cast<float>(phases_ / 2) >= share * float{shared::kLightPhases}) phases_ /= 2;
  // The bits of the turn from behind, so that turns one after the other are in different halves, quarters,
  // ...
  first_phase_ = 0;
  for (std::uint32_t bit = shared::kLightPhases / 2, turn = turns_++ % shared::kLightPhases; bit >= phases_;
       bit /= 2, turn /= 2)
    first_phase_ += turn % 2 * bit;
}

KeptSmokeLight::Run KeptSmokeLight::run_of(const Row& row) const {
  const std::uint32_t count = row.hurry > 0 ? hurried() : phases_;
  const std::uint32_t first = first_phase_ / count * count;
  return {first, first + count};
}

/// Lists a row's texels where the list is not what it must be; whether it may have texels without light.
bool KeptSmokeLight::list_texels(Row& row) {
  const bool had_list = shares() && row.listing != 0;
  const sim::IndexRange changes = had_list ? changes_in(row) : sim::IndexRange{};
  if (row.listed && (row.by_phase || !shares()) && changes.count == 0) return false;
  const bool is_fresh = had_list && (!row.listed || changes.count > 0);
  plan_.rows.push_back({row.slot, row.number, shares(), had_list, changes.first, changes.count});
  if (!row.listed || is_fresh) row.listing = ++listings_;
  row.listed = true;
  row.by_phase = shares();
  return is_fresh;
}

/// What is to be done of rays that a row has; `before` is the listing that it had.
KeptSmokeLight::Task KeptSmokeLight::task_of(const Row& row, const Kept& kept, std::uint64_t before,
                                             Run run) const {
  const bool fresh = kept.listing != row.listing;
  if (kept.listing == 0 || kept.listing != before || (fresh && !shares())) return {.all = true};
  if (kept.stale == 0) return {.fresh = fresh};
  // Rays to a lamp that the brick's last frame did not have are of any age.
  if (!shares() || kept.planned != row.planned) return {.all = true};
  return {false, fresh, (kept.stale & run.mask()) != 0};
}

template <typename Item>
void KeptSmokeLight::ask(const Task& task, Run run, Item item, std::vector<Item>& list,
                         std::vector<Item>& few) {
  item.texels = task.all ? shared::kAllTexels : shared::kNewTexels;
  if (task.all || task.fresh) list.push_back(item);
  if (task.all || !task.run) return;
  item.texels = run.texels();
  few.push_back(item);
  most_phases_ = std::max(most_phases_, run.end - run.first);
}

/// Asks for `blocks` blocks of rays, `lamp` of the first.
void KeptSmokeLight::follow(const Row& row, Kept& kept, std::uint32_t lamp, std::uint32_t blocks,
                            const Task& task, Run run) {
  for (std::uint32_t i = 0; i < blocks; ++i)
    ask(task, run, shared::LightPair{row.slot, row.number, lamp + i, kept.block + i, 0}, plan_.pairs,
        few_pairs_);
  kept.stale &= ~(task.all ? kEveryPhase : task.run ? run.mask() : 0);
  kept.listing = row.listing;
  kept.planned = frames_;
}

void KeptSmokeLight::plan_row(Row& row, std::span<const std::uint32_t> lamps) {
  const std::uint64_t before = row.listing;
  Task put{.fresh = list_texels(row)};
  if (row.planned + 1 != frames_) row.hurry = shared::kLightPhases / hurried();
  const Run run = run_of(row);
  const auto follow_kept = [&](Kept& kept, std::uint32_t lamp, std::uint32_t blocks, const Task& task) {
    take_blocks(kept, blocks);
    follow(row, kept, lamp, blocks, task, run);
    put.all |= task.all;
    put.run |= task.run;
  };
  follow_kept(row.sky, shared::kTowardSky, shared::kSkyBlocks, task_of(row, row.sky, before, run));
  const auto first = static_cast<std::uint32_t>(plan_.lamps.size());
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const Lamp& lamp = lamps_[lamps[i]];
    Kept& kept = kept_of(row, lamps[i], i);
    const bool beyond = lamp.light.range > kept.range || brightest(lamp.light) > kept.intensity;
    const Task task = beyond ? Task{.all = true} : task_of(row, kept, before, run);
    follow_kept(kept, lamp.in_frame, 1, task);
    if (task.all) {
      kept.range = lamp.light.range;
      kept.intensity = brightest(lamp.light);
    }
    plan_.lamps.push_back({lamp.in_frame, kept.block});
  }
  put_together(row, lamps, first, put, run);
  row.planned = frames_;
  row.hurry -= row.hurry > 0;
}

/// Asks for the light of a row: what `put` says, and what else of it is not as it was.
void KeptSmokeLight::put_together(Row& row, std::span<const std::uint32_t> lamps, std::uint32_t first_lamp,
                                  Task put, Run run) {
  if (row.epoch != epoch_) row.stale = kEveryPhase;
  row.epoch = epoch_;
  const std::uint64_t made = made_of(lamps);
  put.all |= row.lamps_made != made || (!shares() && row.stale != 0);
  put.run |= (row.stale & run.mask()) != 0;
  row.lamps_made = made;
  row.stale &= ~(put.all ? kEveryPhase : put.run ? run.mask() : 0);
  if (!put.all && !put.fresh && !put.run) plan_.lamps.resize(first_lamp);
  ask(put, run,
      shared::LightBrick{row.slot, row.number, row.sky.block, first_lamp,
                         static_cast<std::uint32_t>(lamps.size()), 0},
      plan_.bricks, few_bricks_);
}

void KeptSmokeLight::plan_kept(const SmokeLightMoment& moment) {
  few_pairs_.clear();
  few_bricks_.clear();
  most_phases_ = 0;
  for (std::uint32_t i = 0; i < moment.needs->seen; ++i)
    plan_row(row_of(moment, moment.needs->slots[i]), reaching(i));
  plan_.row_count = row_count_;
  plan_.block_count = block_end_;
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
void KeptSmokeLight::plan_parts(const SmokeLightMoment& moment) {
  const auto sizes = [&] { return std::array{plan_.rows.size(), plan_.pairs.size(), plan_.bricks.size()}; };
  auto begin = sizes();
  const auto end_part = [&] {
    const auto end = sizes();
    const auto range = [&](std::size_t i) {
      return sim::IndexRange{static_cast<std::uint32_t>(begin[i]),
                             static_cast<std::uint32_t>(end[i] - begin[i])};
    };
    plan_.parts.push_back({range(0), range(1), range(2), 0, 0, 0});
    plan_.row_count = std::max(plan_.row_count, row_count_);
    plan_.block_count = std::max(plan_.block_count, block_end_);
    begin = end;
    forget_rays();
  };
  for (std::uint32_t i = 0; i < moment.needs->seen; ++i) {
    const auto lamps = reaching(i);
    if (block_end_ > 0 && block_end_ + lamps.size() + shared::kSkyBlocks > most_blocks_) end_part();
    plan_row(row_of(moment, moment.needs->slots[i]), lamps);
  }
  end_part();
}

const SmokeLightPlan& KeptSmokeLight::plan(const SmokeLightMoment& moment) {
  plan_ = {};
  if (!moment.volume || moment.volume->slot_count() == 0) {
    forget();
    return plan_;
  }
  choose_phases(moment.share);
  cuts_.clear();
  if (must_forget(moment)) {
    forget_rays();
  } else {
    std::vector<shared::LightChange> changes;
    add_smoke_changes(moment, changes);
    // Rays end where the box around the smoke does.
    const bool other_box =
        bounds_.low != moment.needs->bounds.low || bounds_.high != moment.needs->bounds.high;
    const bool noise_drifts = moment.look.erosion > 0 && (moment.time != last_->time || moment.noise_moved);
    if (shares()) add_hole_changes(moment, cuts_);
    // Texels in them and beside them, not rays that graze them.
    for (shared::LightChange& cut : cuts_) cut.radius -= 0.5f * frame_.voxel_size;
    if (!noise_drifts) add_hole_changes(moment, changes);
    if (noise_drifts || other_box || is_other(moment) || !drop_crossed(moment, changes)) drop_rays();
  }
  if (!last_ || last_->eye_world != moment.eye_world || !same_bytes(last_->sky, moment.sky)) ++epoch_;
  follow_lamps(moment.lights);
  find_reaching(moment);
  if (block_end_ + blocks_missing(moment) > most_blocks_) forget_rays();
  if (block_end_ == 0 && blocks_missing(moment) > most_blocks_) {
    choose_phases(1);
    plan_parts(moment);
    last_.reset();
  } else {
    plan_kept(moment);
    remember(moment);
  }
  return plan_;
}

}  // namespace brume::passes
