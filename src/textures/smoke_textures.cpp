#include "textures/smoke_textures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/tasks.hpp"
#include "shared/erosion.h"
#include "shared/hole_reach.h"
#include "smoke/noise_tile.hpp"

namespace brume::textures {
namespace {

using smoke::SmokeVolume;

glm::ivec3 place_in_atlas(glm::ivec3 atlas_bricks, std::uint32_t slot) {
  const int s = static_cast<int>(slot), x = atlas_bricks.x, y = atlas_bricks.y;
  return {s % x, s / x % y, s / (x * y)};
}

glm::ivec3 cube(int edge) {
  return glm::ivec3(edge);
}

/// Bricks per axis of the window around `low` and `high`, in multiples of this: a cloud that grows leaves it
/// as it is for a while.
constexpr int kWindowStep = 8;

/// Rows of a 2D texture of `across` items a row that hold `count` items, with room to grow.
int rows_for(std::size_t count, int across, int now) {
  const auto needed =
      static_cast<int>((count + static_cast<std::size_t>(across) - 1) / static_cast<std::size_t>(across));
  if (needed <= now) return std::max(now, 1);
  return std::max(needed + needed / 2, 4);
}

/// Six texels of the hole texture.
std::array<glm::vec4, 6> hole_row(const shared::Hole& hole, double seconds) {
  const auto age = static_cast<float>(seconds - double{hole.time_start});
  return {glm::vec4(hole.origin_world, hole.radius),
          glm::vec4(hole.forward, hole.distance_to_far),
          glm::vec4(hole.right, age),
          glm::vec4(hole.up, hole.time_to_reach_far),
          glm::vec4(hole.time_to_expand, hole.time_to_stay_open, hole.time_to_fade,
                    static_cast<float>(hole.shape)),
          glm::vec4(hole.uv_min, hole.uv_max)};
}

/// The part of a number that a tile of noise, which repeats, depends on.
float wrapped(double tiles) {
  return static_cast<float>(tiles - std::floor(tiles));
}

}  // namespace

SmokeTextures::SmokeTextures(const SmokeTexturesSettings& settings,
                             std::shared_ptr<const smoke::MaskAtlas> masks)
    : settings_(settings),
      masks_(std::move(masks)),
      set_(kSmokeTextures),
      points_(settings.noise_spacing),
      light_(settings.light_count, settings.sky) {
  smoke::set_noise(look_, settings.noise);
  smoke::smoke_noise();  // the first time is long: here rather than in a frame
}

void SmokeTextures::update(const smoke::Field& field, const Frame& frame) {
  const SmokeVolume& volume = field.volume();
  if (volume.slot_count() > kMostBricks)
    throw Error(ErrorCode::resource_limit,
                "the smoke fills " + std::to_string(volume.slot_count()) + " bricks, more than 65534");
  // If this update fails, its regions are lost: the next one writes everything.
  const bool all = std::exchange(incomplete_, true);
  set_.begin_update();
  if (all) write_static();
  update_bricks(volume, all);
  points_.update(volume, field.state(), look_, settings_.swirl_period, frame.seconds);
  update_displacements();
  update_holes(field.holes(), frame.seconds);
  update_light(field, frame);
  write_constants(volume, frame);
  incomplete_ = false;
}

/// What never changes.
void SmokeTextures::write_static() {
  const smoke::SmokeNoise& noise = smoke::smoke_noise();
  const int tile = static_cast<int>(noise.tile.size), detail = static_cast<int>(noise.detail.size);
  set_.resize(kNoise, Format::rgba8, cube(tile));
  set_.write(kNoise, cube(0), cube(tile), std::as_bytes(std::span(noise.tile.texels)));
  set_.resize(kDetail, Format::rg8, cube(detail));
  const std::span<std::byte> to = set_.texels(set_.add(kDetail, cube(0), cube(detail)));
  for (std::size_t i = 0; i < noise.detail.texels.size(); ++i) {
    to[2 * i] = std::byte{noise.detail.texels[i].x};
    to[2 * i + 1] = std::byte{noise.detail.texels[i].y};
  }
  static const smoke::MaskAtlas kNoMasks;
  const smoke::MaskAtlas& masks = masks_ ? *masks_ : kNoMasks;
  const glm::ivec3 size(static_cast<int>(masks.width()), static_cast<int>(masks.height()), 1);
  set_.resize(kMasks, Format::r8, size);
  set_.write(kMasks, cube(0), size, std::as_bytes(masks.texels()));
}

void SmokeTextures::update_bricks(const SmokeVolume& volume, bool all) {
  const std::uint64_t revision = volume.revision();
  const bool same_volume = volume_id_ == volume.id();
  if (same_volume && revision_ == revision && !all) return;
  // All bricks where an update was missed or the textures are new, else those that changed.
  all = all || !same_volume || revision != revision_ + 1;
  volume_id_ = volume.id();
  revision_ = revision;
  atlas_bricks_ = glm::max(volume.volume().layout().bricks.atlas_bricks, 1);
  all = set_.resize(kDensity, Format::rg8, atlas_bricks_ * shared::kBrickTexels) || all;
  all = set_.resize(kCells, Format::r32ui, atlas_bricks_ * shared::kBrickCells) || all;
  set_.resize(kDisplacement, Format::rgba16f, atlas_bricks_ * points_.per_axis());
  write_bricks(volume, all);
  update_walls(volume, all);
  smoky_.clear();
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    const smoke::TexelSet texels = find_smoke(volume, slot);
    if (texels.any()) smoky_.push_back({slot, texels, {}});
  }
  update_pages(volume, all);
}

/// Densities, and the numbers of cells at walls.
void SmokeTextures::write_bricks(const SmokeVolume& volume, bool all) {
  const auto write = [&](std::uint32_t texture, std::uint32_t slot, int edge,
                         std::span<const std::byte> texels) {
    if (!volume.in_use(slot)) return;
    set_.write(texture, edge * place_in_atlas(atlas_bricks_, slot), cube(edge), texels);
  };
  const auto density = [&](std::uint32_t slot) {
    write(kDensity, slot, shared::kBrickTexels, std::as_bytes(volume.texels(slot)));
  };
  const auto cells = [&](std::uint32_t slot) {
    write(kCells, slot, shared::kBrickCells, std::as_bytes(volume.cells(slot)));
  };
  if (all) {
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) density(slot), cells(slot);
  } else {
    for (const std::uint32_t slot : volume.dirty_slots()) density(slot);
    for (const std::uint32_t slot : volume.dirty_cell_slots()) cells(slot);
  }
}

void SmokeTextures::update_walls(const SmokeVolume& volume, bool all) {
  const auto follow = [&](std::uint32_t texture, Format format, int across, std::span<const std::byte> items,
                          std::span<const volume::IndexRange> dirty) {
    const std::size_t item = bytes_per_texel(format), row = item * static_cast<std::size_t>(across);
    const int rows = rows_for(items.size() / item, across, set_.texture(texture).size.y);
    const bool whole = set_.resize(texture, format, {across, rows, 1}) || all;
    const auto write = [&](std::size_t first, std::size_t end) {  // rows
      const std::size_t count = end - first;
      const std::size_t region =
          set_.add(texture, {0, static_cast<int>(first), 0}, {across, static_cast<int>(count), 1});
      const std::span<const std::byte> from = items.subspan(first * row);
      std::copy_n(from.begin(), std::min(from.size(), count * row), set_.texels(region).begin());
    };
    const std::size_t used = (items.size() + row - 1) / row;
    if (whole) {
      if (used > 0) write(0, used);
      return;
    }
    std::size_t written = 0;  // the rows before
    for (const volume::IndexRange& range : dirty) {
      const std::size_t first =
          std::max<std::size_t>(written, range.first / static_cast<std::size_t>(across));
      const std::size_t end =
          (std::size_t{range.first} + range.count + static_cast<std::size_t>(across) - 1) /
          static_cast<std::size_t>(across);
      if (first < end) write(first, end);
      written = std::max(written, end);
    }
  };
  follow(kBoundary, Format::rgba32ui, kBoundaryAcross, std::as_bytes(volume.boundary_cells()),
         volume.dirty_boundary_cells());
  follow(kCorners, Format::rg32ui, kCornersAcross, std::as_bytes(volume.corner_sets()),
         volume.dirty_corner_sets());
}

void SmokeTextures::update_pages(const SmokeVolume& volume, bool all) {
  glm::ivec3 low(0), high(0);
  bool any = false;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    const glm::ivec3 brick = volume.brick_of(slot);
    low = any ? glm::min(low, brick) : brick;
    high = any ? glm::max(high, brick + 1) : brick + 1;
    any = true;
  }
  const bool inside = glm::all(glm::greaterThanEqual(low, window_low_)) &&
                      glm::all(glm::lessThanEqual(high, window_low_ + window_size_));
  if (!inside || window_size_.x == 0) {
    const glm::ivec3 step = glm::min(cube(kWindowStep), glm::max(high - low, 1));
    window_low_ = low - step / 2;
    window_size_ = (high - low) + step;
  }
  const auto across = static_cast<std::size_t>(window_size_.x),
             layer = across * static_cast<std::size_t>(window_size_.y);
  std::vector<std::uint16_t> pages(layer * static_cast<std::size_t>(window_size_.z));
  for (const SmokyBrick& brick : smoky_) {
    const glm::u64vec3 at(volume.brick_of(brick.slot) - window_low_);
    pages[at.x + across * at.y + layer * at.z] = static_cast<std::uint16_t>(brick.slot + 1);
  }
  // The slices that changed.
  const bool whole = set_.resize(kPages, Format::r16ui, window_size_) || all;
  for (int z = 0; z < window_size_.z; ++z) {
    const std::span<const std::uint16_t> now =
        std::span(pages).subspan(layer * static_cast<std::size_t>(z), layer);
    if (!whole && std::equal(now.begin(), now.end(), pages_.begin() + static_cast<std::ptrdiff_t>(layer) * z))
      continue;
    set_.write(kPages, {0, 0, z}, {window_size_.x, window_size_.y, 1}, std::as_bytes(now));
  }
  pages_ = std::move(pages);
}

void SmokeTextures::update_displacements() {
  displaced_.clear();
  if (look_.erosion <= 0 && look_.hole_rim <= 0) return;
  const int edge = points_.per_axis();
  for (const SmokyBrick& brick : smoky_)
    displaced_.push_back(
        set_.add(kDisplacement, edge * place_in_atlas(atlas_bricks_, brick.slot), cube(edge)));
  constexpr std::size_t kGrain = 4;
  parallel_for(smoky_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points_.write(smoky_[i], displacements(i));
  });
}

/// The points of a smoky brick; valid until more regions are written.
std::span<glm::u16vec4> SmokeTextures::displacements(std::size_t brick) {
  return {reinterpret_cast<glm::u16vec4*>(set_.texels(displaced_[brick]).data()), points_.per_brick()};
}

/// The open holes, as the renderer selects them.
void SmokeTextures::update_holes(std::span<const shared::Hole> holes, double seconds) {
  holes_.clear();
  std::vector<std::array<glm::vec4, 6>> rows;
  for (std::size_t i = holes.size(); i-- > 0 && rows.size() < kMostHoles;) {
    const shared::HoleReach reach = shared::hole_reach(holes[i], static_cast<float>(seconds), look_.hole_rim);
    if (reach.length_m < 0) continue;
    rows.push_back(hole_row(holes[i], seconds));
    holes_.push_back(holes[i]);
  }
  set_.resize(kHoles, Format::rgba32f, {6, static_cast<int>(kMostHoles), 1});
  if (!rows.empty())
    set_.write(kHoles, cube(0), {6, static_cast<int>(rows.size()), 1}, std::as_bytes(std::span(rows)));
}

void SmokeTextures::update_light(const smoke::Field& field, const Frame& frame) {
  if (light_.groups() == 0) return;
  const auto sight = field.sight({frame.extinction});
  LitSmoke smoke{&field.volume(),
                 sight.get(),
                 field.state().edits,
                 holes_,
                 masks_.get(),
                 look_,
                 static_cast<float>(frame.seconds),
                 frame.lights};
  smoke.look.extinction = frame.extinction;
  // Regions that are written later move the displacements: they are passed on in a copy of the list.
  std::vector<SmokyBrick> bricks = smoky_;
  for (std::size_t i = 0; i < displaced_.size(); ++i) bricks[i].displacements = displacements(i);
  light_.update(smoke, bricks, frame.light_update_fraction);

  // Each group is a copy of the atlas, one behind the other.
  const int groups = static_cast<int>(light_.groups()), edge = shared::kBrickTexels;
  set_.resize(kLight, Format::rgba8, atlas_bricks_ * edge * glm::ivec3(1, 1, groups));
  for (const SmokyBrick& brick : smoky_)
    for (int group = 0; group < groups; ++group) {
      const glm::ivec3 place =
          place_in_atlas(atlas_bricks_, brick.slot) + glm::ivec3(0, 0, group * atlas_bricks_.z);
      set_.write(kLight, edge * place, cube(edge),
                 std::as_bytes(light_.texels(brick.slot, static_cast<std::uint32_t>(group))));
    }
}

void SmokeTextures::write_constants(const SmokeVolume& volume, const Frame& frame) {
  const float extinction = frame.extinction;
  const double seconds = frame.seconds;
  const shared::VolumeLayout& layout = volume.volume().layout();
  const double per_metre = double{look_.noise_frequency}, risen = double{look_.rise} * seconds * per_metre;
  const double detail = double{shared::kDetailRatio};
  const auto world = [&](glm::vec3 voxel) { return layout.origin_world + voxel * layout.voxel_size; };
  constants_ = {
      glm::vec4(layout.origin_world, layout.voxels_per_metre),
      glm::vec4(glm::vec3(window_low_), layout.voxel_size),
      glm::vec4(glm::vec3(window_size_), static_cast<float>(holes_.size())),
      glm::vec4(glm::vec3(atlas_bricks_), extinction),
      glm::vec4(world(layout.bounds_min), 0.4f * layout.voxel_size),
      glm::vec4(world(layout.bounds_max), look_.erosion),
      glm::vec4(0, wrapped(-risen), 0, look_.noise_frequency),
      glm::vec4(0.31f, wrapped(0.17 - 1.25 * detail * risen), 0.73f,
                look_.noise_frequency * shared::kDetailRatio),
      glm::vec4(look_.detail, look_.hole_rim, static_cast<float>(points_.per_axis()),
                1 / static_cast<float>(settings_.noise_spacing)),
      glm::vec4(static_cast<float>(std::max(light_.groups(), 1u)), static_cast<float>(settings_.light_count),
                settings_.sky ? 1.0f : 0.0f, 0),
  };
}

}  // namespace brume::textures
