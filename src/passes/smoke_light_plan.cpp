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

float brightest(const shared::Light& light) {
  return std::max({light.intensity.r, light.intensity.g, light.intensity.b});
}

/// Whether rays to one lamp are those to the other, as far as both reach.
bool same_rays(shared::Light a, const shared::Light& b) {
  a.intensity = b.intensity;
  a.range = b.range;
  return same_bytes(a, b);
}

/// Whether a lamp reaches anything within a sphere. Spots: Wronski 2017, "Cull that cone!".
bool reaches(const shared::Light& light, glm::vec3 centre, float radius) {
  if (brightest(light) <= 0) return false;
  if (light.kind == shared::kLightDirectional) return true;
  const glm::vec3 way = centre - light.position_world;
  const float far = light.range + radius, d2 = glm::dot(way, way);
  if (d2 >= far * far) return false;
  if (light.kind == shared::kLightPoint || light.cos_outer <= 0) return true;
  const float along = glm::dot(way, light.direction), aside = std::sqrt(std::max(d2 - along * along, 0.0f));
  const float sin_outer = std::sqrt(1 - light.cos_outer * light.cos_outer);
  return light.cos_outer * aside - sin_outer * along <= 1.001f * radius && along >= -1.001f * radius;
}

/// Square of the least distance between two stretches (Ericson 2005, "Real-Time Collision Detection", 5.1.9).
float distance2(glm::vec3 a, glm::vec3 to_a, glm::vec3 b, glm::vec3 to_b) {
  const glm::vec3 along_a = to_a - a, along_b = to_b - b, apart = a - b;
  const float aa = glm::dot(along_a, along_a), bb = glm::dot(along_b, along_b);
  const float ab = glm::dot(along_a, along_b), at_a = glm::dot(along_a, apart),
              at_b = glm::dot(along_b, apart);
  const float slanted = aa * bb - ab * ab;
  float s = slanted > 1e-6f * aa * bb ? std::clamp((ab * at_b - at_a * bb) / slanted, 0.0f, 1.0f) : 0.0f;
  const float t = bb > 0 ? std::clamp((ab * s + at_b) / bb, 0.0f, 1.0f) : 0.0f;
  s = aa > 0 ? std::clamp((ab * t - at_a) / aa, 0.0f, 1.0f) : 0.0f;
  const glm::vec3 between = apart + s * along_a - t * along_b;
  return glm::dot(between, between);
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
  if (!last_ || moment.anew || moment.volume != last_->volume) return true;
  const shared::SmokeVolumeFrame& frame = moment.volume->frame();
  if (frame.origin_world != frame_.origin_world || frame.voxel_size != frame_.voxel_size ||
      frame.atlas_bricks != frame_.atlas_bricks || !same_bytes(moment.look, last_->look))
    return true;
  // What is dirty is only that since the revision before.
  return moment.volume->revision() != revision_ && moment.volume->revision() != revision_ + 1;
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

void KeptSmokeLight::add_hole_changes(const SmokeLightMoment& moment, std::vector<Capsule>& changes) const {
  const float slack = frame_.voxel_size;  // holes are averaged over cells of half a voxel
  const auto add = [&](const shared::Hole& hole) {
    changes.push_back({hole.origin_world, hole.origin_world + hole.distance_to_far * hole.forward,
                       hole.radius * shared::kHoleWidest + slack});
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

void KeptSmokeLight::add_smoke_changes(const SmokeLightMoment& moment, std::vector<Capsule>& changes) {
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
    changes.push_back({middle, middle, 0.5f * glm::length(high - low)});
  }
}

/// Drops all rays; which texels have any stays known.
void KeptSmokeLight::drop_rays() {
  for (Row& row : std::span(rows_).first(row_count_)) {
    row.sky.valid = false;
    for (Kept& kept : row.lamps) kept.valid = false;
  }
}

/// Drops the rays that changes may lie on; false where there is too much to ask.
bool KeptSmokeLight::drop_crossed(const SmokeLightMoment& moment, std::span<const Capsule> changes) {
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
      return std::any_of(changes.begin(), changes.end(), [&](const Capsule& change) {
        const float reach = radius + change.radius;
        return distance2(from, to, change.from, change.to) < reach * reach;
      });
    };
    for (std::uint32_t i = 0; i < shared::kSkyRays && row.sky.valid; ++i)
      row.sky.valid = !crossed(from + far * shared::sky_ray(i));
    for (Kept& kept : row.lamps) {
      const shared::Light& light = lamps_[kept.lamp].light;
      const bool sun = light.kind == shared::kLightDirectional;
      if (kept.valid) kept.valid = !crossed(sun ? from - far * light.direction : light.position_world);
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
      if (kept.lamp == number) kept.valid = false;
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
    row.listed = row.sky.valid = false;
    row.put_together = 0;
    for (Kept& kept : row.lamps) kept.valid = false;
  }
  return row;
}

void KeptSmokeLight::take_blocks(Kept& kept, std::uint32_t count) {
  if (kept.block != kNone) return;
  kept.block = block_end_;
  block_end_ += count;
}

std::uint64_t KeptSmokeLight::made_of(std::span<const std::uint32_t> lamps) const {
  std::uint64_t made = hash_values(std::span(&epoch_, 1));
  for (const std::uint32_t lamp : lamps) made = hash_values(std::span(&lamps_[lamp].version, 1), made);
  return std::max<std::uint64_t>(made, 1);
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

void KeptSmokeLight::plan_row(Row& row, std::span<const std::uint32_t> lamps) {
  const std::size_t pairs_before = plan_.pairs.size();
  if (!row.listed) plan_.rows.push_back({row.slot, row.number});
  row.listed = true;
  take_blocks(row.sky, shared::kSkyBlocks);
  for (std::uint32_t i = 0; i < shared::kSkyBlocks && !row.sky.valid; ++i)
    plan_.pairs.push_back({row.slot, row.number, shared::kTowardSky + i, row.sky.block + i});
  row.sky.valid = true;
  const auto first = static_cast<std::uint32_t>(plan_.lamps.size());
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const Lamp& lamp = lamps_[lamps[i]];
    Kept& kept = kept_of(row, lamps[i], i);
    take_blocks(kept, 1);
    plan_.lamps.push_back({lamp.in_frame, kept.block});
    if (kept.valid && lamp.light.range <= kept.range && brightest(lamp.light) <= kept.intensity) continue;
    plan_.pairs.push_back({row.slot, row.number, lamp.in_frame, kept.block});
    kept = {kept.lamp, kept.block, true, lamp.light.range, brightest(lamp.light)};
  }
  const std::uint64_t made = made_of(lamps);
  if (row.put_together == made && plan_.pairs.size() == pairs_before) {
    plan_.lamps.resize(first);
    return;
  }
  row.put_together = made;
  plan_.bricks.push_back(
      {row.slot, row.number, row.sky.block, first, static_cast<std::uint32_t>(lamps.size())});
}

void KeptSmokeLight::plan_kept(const SmokeLightMoment& moment) {
  for (std::uint32_t i = 0; i < moment.needs->seen; ++i)
    plan_row(row_of(moment, moment.needs->slots[i]), reaching(i));
  plan_.row_count = row_count_;
  plan_.block_count = block_end_;
  const auto all = [](const auto& list) {
    return sim::IndexRange{0, static_cast<std::uint32_t>(list.size())};
  };
  if (!plan_.bricks.empty()) plan_.parts = {{all(plan_.rows), all(plan_.pairs), all(plan_.bricks)}};
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
    plan_.parts.push_back({range(0), range(1), range(2)});
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
  if (must_forget(moment)) {
    forget_rays();
  } else {
    std::vector<Capsule> changes;
    add_smoke_changes(moment, changes);
    // Rays end where the box around the smoke does.
    const bool other_box =
        bounds_.low != moment.needs->bounds.low || bounds_.high != moment.needs->bounds.high;
    const bool noise_drifts = moment.look.erosion > 0 && moment.time != last_->time;
    if (!noise_drifts) add_hole_changes(moment, changes);
    if (noise_drifts || other_box || !drop_crossed(moment, changes)) drop_rays();
  }
  if (!last_ || last_->eye_world != moment.eye_world || !same_bytes(last_->sky, moment.sky)) ++epoch_;
  follow_lamps(moment.lights);
  find_reaching(moment);
  if (block_end_ + blocks_missing(moment) > most_blocks_) forget_rays();
  if (block_end_ == 0 && blocks_missing(moment) > most_blocks_) {
    plan_parts(moment);
    last_.reset();
  } else {
    plan_kept(moment);
    remember(moment);
  }
  return plan_;
}

}  // namespace brume::passes
