#include "reference/volume_medium.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "planning/blackbody.hpp"
#include "planning/media_plan.hpp"
#include "planning/transfer_table.hpp"
#include "shared/volume_detail.h"

namespace brume::reference {
namespace {

constexpr int kBrickVoxels = 8, kPartVoxels = 4;

/// Voxels that parts of both have in common count as cells of the first's majorants.
void raise(Majorants& majorants, const Box<int>& all, const Box<int>& voxels, float bound) {
  const int cell = majorants.cell_voxels();
  const glm::ivec3 low = (voxels.low - all.low) / cell, high = (voxels.high - 1 - all.low) / cell;
  for_each_in(Box<int>{low, high + 1}, [&](glm::ivec3 at) {
    float& stored = majorants.at(at);
    stored = std::max(stored, bound);
  });
}

}  // namespace

TransferCurve::TransferCurve(const planning::TransferInput& transfer, const glm::vec3& albedo)
    : kind_(planning::transfer_kind(transfer)), device_(planning::device_transfer(transfer)) {
  if (empty()) return;
  table_ = planning::transfer_table(transfer, albedo);
  if (!has_opacity()) return;
  // Means over a cell and over two that touch are no larger than the larger of the two.
  const std::uint32_t cells = shared::kTransferCells;
  std::vector<float>& first = largest_.emplace_back();
  first.push_back(table_.front().a);
  for (std::uint32_t cell = 0; cell < cells; ++cell)
    first.push_back((table_[cell + 2].a - table_[cell + 1].a) * static_cast<float>(cells));
  first.push_back(table_.back().a);
  for (std::size_t width = 1; 2 * width <= largest_.front().size(); width *= 2) {
    const std::vector<float>& half = largest_.back();
    std::vector<float> level;
    for (std::size_t i = 0; i + 2 * width <= largest_.front().size(); ++i)
      level.push_back(std::max(half[i], half[i + width]));
    largest_.push_back(std::move(level));
  }
}

glm::vec4 TransferCurve::at(float value) const {
  const float cells = static_cast<float>(shared::kTransferCells);
  const float position = std::clamp(value * device_.per_value + device_.first, -1.0f, 2.0f);
  const auto integral = [&](float at) {
    const float scaled = std::clamp(at, 0.0f, 1.0f) * cells;
    const std::size_t cell =
        std::min(static_cast<std::size_t>(scaled), std::size_t{shared::kTransferCells - 1});
    const glm::vec4 &low = table_[cell + 1], &high = table_[cell + 2];
    return low + (high - low) * (scaled - static_cast<float>(cell));
  };
  const float low = position - 0.5f / cells, high = position + 0.5f / cells;
  glm::vec4 sum = integral(high) - integral(low);
  sum += std::max(std::min(high, 0.0f) - low, 0.0f) * table_.front();
  sum += std::max(high - std::max(low, 1.0f), 0.0f) * table_.back();
  return glm::max(sum * cells, glm::vec4(0));
}

float TransferCurve::largest_opacity(float low, float high) const {
  const auto entry = [&](float value, int off) {
    const float position = std::clamp(value * device_.per_value + device_.first, -1.0f, 2.0f);
    const int cell =
        static_cast<int>(std::floor(position * static_cast<float>(shared::kTransferCells))) + off;
    return static_cast<std::size_t>(std::clamp(cell + 1, 0, static_cast<int>(shared::kTransferCells) + 1));
  };
  // Means reach half a cell to both sides.
  const std::size_t begin = entry(low, -1), count = entry(high, 1) - begin + 1;
  const std::size_t level = static_cast<std::size_t>(std::bit_width(count)) - 1,
                    width = std::size_t{1} << level;
  return std::max(largest_[level][begin], largest_[level][begin + count - width]);
}

VolumeMedium::VolumeMedium(const planning::VolumeInput& volume,
                           const std::function<const smoke::SmokeNoise&()>& noise)
    : Medium(shared::phase_of_hg(volume.look.anisotropy)),
      input_(volume),
      effect_(planning::volume_effect(volume)),
      detail_(planning::volume_detail(volume)),
      values_(*volume.volume),
      transfer_(volume.transfer, volume.look.albedo) {
  if (effect_.amplitude.x > 0 || detail_.strength > 0) noise_ = &noise();
  // Heat, with a table of its radiance by value.
  if (volume.heat.volume && volume.heat.volume->slot_count() > 0) {
    heat_ = BrickField<1>(*volume.heat.volume);
    heat_from_world_ = glm::inverse(volume.heat.world_from_voxel);
    emits_ = true;
    constexpr int kColors = 1024;
    for (int i = 0; i <= kColors; ++i) {
      const float value = volume.heat.high * static_cast<float>(i) / kColors;
      heat_colors_.push_back(volume.look.extinction * volume.heat.emission *
                             planning::blackbody_color(volume.heat.kelvin * value));
    }
  }
  // Colours of what scatters, or masks, which emit; up to two masks have bricks of two channels.
  if (volume.colors) {
    has_masks_ = !volume.tints.empty();
    has_colors_ = !has_masks_;
    is_pair_ = has_masks_ && volume.tints.size() <= 2;
    if (is_pair_)
      mask_pair_ = BrickField<2>(*volume.colors);
    else
      colors_ = BrickField<4>(*volume.colors);
    emits_ = emits_ || has_masks_;
  }
  if (!transfer_.empty() && transfer_.emitted() > 0) emits_ = true;
  find_majorants();
}

float VolumeMedium::density_bound(float low, float high) const {
  if (!(high > 0)) return 0;
  return transfer_.has_opacity() ? transfer_.largest_opacity(std::max(low, 0.0f), high) : high;
}

bool VolumeMedium::glows_in(const Box<int>& voxels) const {
  if (has_masks_) return true;
  if (heat_colors_.empty()) return false;
  // The corners in the heat's voxels.
  const glm::mat4 heat_from_voxel = heat_from_world_ * input_.world_from_voxel;
  glm::vec3 low(1e30f), high(-1e30f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p = glm::mix(glm::vec3(voxels.low), glm::vec3(voxels.high),
                                 glm::bvec3(corner & 1, corner & 2, corner & 4));
    const glm::vec3 in_heat(heat_from_voxel * glm::vec4(p, 1));
    low = glm::min(low, in_heat);
    high = glm::max(high, in_heat);
  }
  const Box<int> all = heat_.voxels();
  return glm::all(glm::lessThan(low, glm::vec3(all.high))) &&
         glm::all(glm::greaterThan(high, glm::vec3(all.low)));
}

void VolumeMedium::lower_least(const Box<int>& part, const Box<int>& all, float low) {
  const int cell = majorants_.cell_voxels();
  // Every cell is a part of one brick, all of whose parts are visited.
  if (cell > kBrickVoxels) return;
  const shared::VolumeLayout& layout = input_.volume->layout();
  const bool is_known = low > 0 && effect_.amplitude.x <= 0 && detail_.strength <= 0 &&
                        !transfer_.has_opacity() &&
                        glm::all(glm::greaterThanEqual(glm::vec3(part.low), layout.bounds_min)) &&
                        glm::all(glm::lessThanEqual(glm::vec3(part.high), layout.bounds_max));
  const float least = is_known ? input_.look.extinction * low / kBoundSlack : 0;
  for_each_in(Box<int>{(part.low - all.low) / cell, (part.high - 1 - all.low) / cell + 1},
              [&](glm::ivec3 at) { majorants_.lower_least(at, least); });
}

/// Bounds are cells as large as bricks where light passes whole ones; else, and where media emit, which cells
/// are sampled for, as the parts of a BrickField.
int VolumeMedium::cell_voxels() const {
  const float edge = kBrickVoxels * std::cbrt(std::abs(glm::determinant(glm::mat3(input_.world_from_voxel))));
  float densest = 0;
  values_.for_each_part([&](const Box<int>&, glm::vec1 low, glm::vec1 high) {
    densest = std::max(densest, density_bound(low.x, high.x));
  });
  return emits_ || input_.look.extinction * densest * edge > 1 ? kPartVoxels : kBrickVoxels;
}

void VolumeMedium::find_majorants() {
  const glm::vec3 amplitude = effect_.amplitude;
  Box<int> all = values_.voxels();
  if (all.empty()) return;
  const glm::ivec3 reach(glm::ceil(amplitude * 0.125f));
  all = {all.low - 8 * reach, all.high + 8 * reach};
  majorants_ = Majorants(input_.world_from_voxel, all, cell_voxels());
  // What glows has possible collisions, about one in each cell.
  const float edge = static_cast<float>(majorants_.cell_voxels()) *
                     std::cbrt(std::abs(glm::determinant(glm::mat3(input_.world_from_voxel))));
  const glm::ivec3 moved(glm::ceil(amplitude));
  values_.for_each_part([&](const Box<int>& part, glm::vec1 low, glm::vec1 high) {
    float bound = kBoundSlack * input_.look.extinction * density_bound(low.x, high.x);
    if (emits_ && glows_in(part)) bound = std::max(bound, 1 / edge);
    lower_least(part, all, low.x);
    if (bound > 0) raise(majorants_, all, {part.low - moved, part.high + moved}, bound);
  });
  if (amplitude.x <= 0) divide_cells(all, edge);
}

void VolumeMedium::divide_cells(const Box<int>& all, float edge) {
  // With fewer possible collisions, dividing saves little; 64 bounds each fit into 64 MiB.
  constexpr float kManyCollisions = 32, kMuchLess = 0.25f;
  constexpr std::uint32_t kMostDivided = 1u << 18;
  const int cell = majorants_.cell_voxels();
  if (cell != kPartVoxels) return;
  std::uint32_t divided = 0;
  std::vector<float> bounds;
  values_.for_each_part([&](const Box<int>& part, glm::vec1 low, glm::vec1 high) {
    const float bound = kBoundSlack * input_.look.extinction * density_bound(0, high.x);
    if (!(bound * edge > kManyCollisions) || low.x > kMuchLess * high.x || divided == kMostDivided) return;
    const float least = emits_ && glows_in(part) ? 1 / edge : 0;
    bounds.clear();
    double sum = 0;
    for_each_in(part, [&](glm::ivec3 voxel) {
      const float highest = values_.range_in({voxel, voxel + 1}).second.x;
      bounds.push_back(std::max(kBoundSlack * input_.look.extinction * density_bound(0, highest), least));
      sum += double{bounds.back()};
    });
    if (bounds.size() != static_cast<std::size_t>(cell * cell * cell)) return;  // a brick of one value
    if (sum > double{kMuchLess} * double{bound} * static_cast<double>(bounds.size())) return;
    majorants_.divide((part.low - all.low) / cell, bounds);
    ++divided;
  });
}

bool VolumeMedium::sample_point(const glm::vec3& p_world, glm::vec3& p_voxel) const {
  p_voxel = majorants_.voxel_from_world(p_world);
  if (effect_.amplitude.x > 0) {
    const glm::vec3 tile = p_voxel * effect_.tiles_per_voxel + effect_.tile_offset;
    const glm::vec4 a = smoke::noise_at(noise_->tile, tile);
    const float b = smoke::noise_at(noise_->tile, tile + glm::vec3(0.37f, 0.71f, 0.13f)).a;
    const float grown =
        std::clamp(glm::dot(glm::vec3(effect_.growth), p_voxel) + effect_.growth.w, 0.0f, 1.0f);
    p_voxel += (2.0f * glm::vec3(a.a, b, a.r) - 1.0f) * effect_.amplitude * grown;
  }
  const shared::VolumeLayout& layout = input_.volume->layout();
  return glm::all(glm::greaterThanEqual(p_voxel, layout.bounds_min)) &&
         glm::all(glm::lessThanEqual(p_voxel, layout.bounds_max));
}

float VolumeMedium::density_at(const glm::vec3& p_voxel) const {
  const float value = values_.at(p_voxel).x;
  if (!(value > 0)) return 0;
  return left_of(transfer_.has_opacity() ? transfer_.at(value).a : value, p_voxel);
}

float VolumeMedium::left_of(float density, const glm::vec3& p_voxel) const {
  if (detail_.strength <= 0) return density;
  const glm::vec3 tile = p_voxel * effect_.detail_per_voxel + effect_.detail_offset;
  const glm::vec2 fine(smoke::noise_at(noise_->detail, shared::volume_detail_point(tile)));
  return density * shared::volume_fraction(detail_, density,
                                           shared::billows_and_wisps(smoke::noise_at(noise_->tile, tile)),
                                           shared::detail_of(fine), 1);
}

float VolumeMedium::extinction(const glm::vec3& p_world) const {
  glm::vec3 p_voxel;
  return sample_point(p_world, p_voxel) ? input_.look.extinction * density_at(p_voxel) : 0;
}

glm::vec3 VolumeMedium::albedo(const glm::vec3& p_world) const {
  glm::vec3 p_voxel, albedo = input_.look.albedo;
  if (!sample_point(p_world, p_voxel)) return glm::vec3(0);
  if (!transfer_.empty()) {
    const glm::vec4 mean = transfer_.at(values_.at(p_voxel).x);
    albedo =
        mean.a > 0 ? transfer_.scattered() * glm::min(glm::vec3(mean) / mean.a, glm::vec3(1)) : glm::vec3(0);
  }
  if (has_colors_) albedo *= glm::vec3(colors_.at(p_voxel));
  return albedo;
}

glm::vec4 VolumeMedium::masks_at(const glm::vec3& p_voxel) const {
  return is_pair_ ? glm::vec4(mask_pair_.at(p_voxel), 0, 0) : colors_.at(p_voxel);
}

glm::vec3 VolumeMedium::emission(const glm::vec3& p_world) const {
  glm::vec3 p_voxel, sum(0);
  if (!sample_point(p_world, p_voxel)) return sum;
  if (!heat_colors_.empty()) {
    const float heat = heat_.at(glm::vec3(heat_from_world_ * glm::vec4(p_world, 1))).x;
    const float last = static_cast<float>(heat_colors_.size() - 1);
    const float at = std::clamp(heat / input_.heat.high, 0.0f, 1.0f) * last;
    const auto i = std::min(static_cast<std::size_t>(at), heat_colors_.size() - 2);
    sum += glm::mix(heat_colors_[i], heat_colors_[i + 1], at - static_cast<float>(i));
  }
  if (has_masks_) sum += matrix_of(effect_.tints) * masks_at(p_voxel);
  if (!transfer_.empty() && transfer_.emitted() > 0) {
    const float value = values_.at(p_voxel).x;
    const glm::vec4 mean = value > 0 ? transfer_.at(value) : glm::vec4(0);
    const float density = left_of(transfer_.has_opacity() ? mean.a : value, p_voxel);
    if (mean.a > 0)
      sum += input_.look.extinction * density * transfer_.emitted() *
             glm::min(glm::vec3(mean) / mean.a, glm::vec3(1));
  }
  return sum;
}

}  // namespace brume::reference
