#include "textures/noise_points.hpp"

#include <glm/gtc/packing.hpp>

#include "smoke/noise_displacement.hpp"

namespace brume::textures {

void NoisePoints::update(const smoke::SmokeVolume& volume, const sim::State& state,
                         const shared::SmokeLook& look, double swirl_period, double seconds) {
  volume_ = &volume;
  swirl_ = look.swirl;
  swirl_width_ = look.swirl_width;
  motion_ = smoke::noise_motion(state, seconds, swirl_period);
  if (growth_.update(state, volume) || parts_ == 0) ++parts_;
  growth_.clear_new_parts();
  points_.resize(volume.slot_count());
}

glm::ivec3 NoisePoints::place_of(std::size_t index) const {
  const int i = static_cast<int>(index);
  return {i % per_axis_, i / per_axis_ % per_axis_, i / (per_axis_ * per_axis_)};
}

glm::vec3 NoisePoints::position(std::uint32_t slot, std::size_t index) const {
  const glm::ivec3 texel = shared::kBrickVoxels * volume_->brick_of(slot) + spacing_ * place_of(index);
  const shared::VolumeLayout& layout = volume_->layout();
  return layout.origin_world + (glm::vec3(texel) - 0.5f) * layout.voxel_size;
}

/// Points that are two voxels apart are few, and each takes from those around it.
smoke::TexelSet NoisePoints::points_read(const SmokyBrick& smoky) const {
  return spacing_ == 1 ? smoke::dilated(smoky.smoke)
                       : ~smoke::TexelSet() >> (shared::kTexelsPerBrick - per_brick());
}

const NoisePoints::Points& NoisePoints::points_of(std::uint32_t slot, const smoke::TexelSet& read,
                                                  std::span<const glm::uvec2> parts) {
  std::unique_ptr<Points>& points = points_[slot];
  const glm::ivec3 brick = volume_->brick_of(slot);
  if (!points || points->brick != brick) {
    points = std::make_unique<Points>();
    points->brick = brick;
    points->first.resize(per_brick());
    points->second.resize(per_brick());
  }
  if (points->parts != parts_) {
    points->parts = parts_;
    points->has_growth.reset();
    points->growth.resize(parts.size() * per_brick());
  }
  // Points whose rolls or growth is missing.
  const smoke::TexelSet rolls = read & ~points->has_rolls, growing = read & ~points->has_growth;
  points->has_rolls |= rolls;
  points->has_growth |= growing;
  for (std::size_t i = 0; i < per_brick(); ++i) {
    if (rolls[i]) {
      const glm::vec3 p_world = position(slot, i);
      points->first[i] = shared::first_swirl(p_world, swirl_width_);
      points->second[i] = shared::second_swirl(p_world, swirl_width_);
    }
    if (!growing[i]) continue;
    for (std::size_t k = 0; k < parts.size(); ++k)
      points->growth[k * per_brick() + i] =
          smoke::growth_at(growth_.displacements(parts[k].x), spacing_ * place_of(i));
  }
  return *points;
}

/// Adds displacement times weight, and in w the weight.
void NoisePoints::add_clouds(std::uint32_t slot, const smoke::TexelSet& read, std::span<glm::vec4> sums) {
  const glm::uvec2 range = growth_.parts()[slot];
  const auto parts = growth_.parts().subspan(volume_->slot_count() + range.x, range.y);
  const Points& points = points_of(slot, read, parts);
  const glm::vec4* growth = points.growth.data();
  for (const glm::uvec2 part : parts) {
    const shared::CloudMotion& motion = motion_.clouds[part.y];
    for (std::size_t i = 0; i < sums.size(); ++i, ++growth) {
      if (!read[i] || !(growth->w > 0)) continue;
      const glm::vec3 swirl =
          swirl_ * (motion.swirl_cos * points.first[i] + motion.swirl_sin * points.second[i]);
      sums[i] += shared::cloud_displacement(motion, *growth, swirl, volume_->layout().voxel_size);
    }
  }
}

/// Points that no cloud reaches take the mean of those beside them that one does: what is interpolated at a
/// cloud's rim must not fall to 0 a voxel beyond it.
void NoisePoints::extend(std::span<glm::vec4> points) const {
  const std::vector<glm::vec4> before(points.begin(), points.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (before[i].w > 0) continue;
    const glm::ivec3 at = place_of(i), low = glm::max(at - 1, 0), high = glm::min(at + 1, per_axis_ - 1);
    glm::vec4 sum(0);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const glm::vec4& near = before[static_cast<std::size_t>(x + per_axis_ * (y + per_axis_ * z))];
          if (near.w > 0) sum += glm::vec4(glm::vec3(near), 1);
        }
    if (sum.w > 0) points[i] = glm::vec4(glm::vec3(sum) / sum.w, 0);
  }
}

void NoisePoints::write(const SmokyBrick& smoky, std::span<glm::u16vec4> out) {
  const smoke::TexelSet read = points_read(smoky);
  std::vector<glm::vec4> points(per_brick());
  add_clouds(smoky.slot, read, points);
  for (glm::vec4& p : points) p = glm::vec4(glm::vec3(p) / std::max(p.w, 1e-12f), p.w);
  if (spacing_ > 1) extend(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    glm::vec3 displacement(points[i]);
    if (read[i]) displacement += motion_.by_impulses(position(smoky.slot, i));
    out[i] = glm::packHalf(glm::vec4(displacement, 0));
  }
}

}  // namespace brume::textures
