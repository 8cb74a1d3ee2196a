#include "grids/glow.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <span>

#include "core/tasks.hpp"

namespace brume::grids {
namespace {

constexpr volume::ChannelId kChannel{0};

/// Sums over voxels, weighted by v^4.
struct Moments {
  double weight = 0, values = 0, densities = 0;
  glm::dvec3 places{0}, squares{0};

  void add(const Moments& other) {
    weight += other.weight;
    values += other.values;
    densities += other.densities;
    places += other.places;
    squares += other.squares;
  }
  glm::dvec3 middle() const { return places / weight; }
  glm::dvec3 variance() const { return glm::max(squares / weight - middle() * middle(), 0.0); }
};

int longest_axis(glm::dvec3 v) {
  return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2;
}

/// Bricks that are next to each other in a list, and the sums over them.
struct Part {
  std::span<Moments> bricks;
  Moments sum;

  explicit Part(std::span<Moments> of) : bricks(of) {
    for (const Moments& brick : bricks) sum.add(brick);
  }
  /// How much there is to gain from a division; 0: it is as small as a brick.
  double spread() const {
    const glm::dvec3 variance = sum.variance();
    const double most = variance[longest_axis(variance)];
    return bricks.size() > 1 && most > 0.25 * kBrickEdge * kBrickEdge ? sum.weight * most : 0;
  }
};

/// The value of the density at a point of its voxel space.
double density_at(const volume::SparseVolume& volume, glm::dvec3 p_voxel) {
  const glm::ivec3 voxel(glm::floor(p_voxel)), brick = voxel >> 3, local = (voxel & 7) + 1;
  if (const auto uniform = volume.uniform_at(brick)) return double{glm::unpackHalf1x16(*uniform)};
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == volume::SparseVolume::kNoSlot) return 0;
  const auto texel = static_cast<std::size_t>(local.x + 10 * (local.y + 10 * local.z));
  return double{glm::unpackHalf1x16(volume.texels<std::uint16_t>(kChannel, slot)[texel])};
}

/// Of a brick of heat, whose voxels `value_at` gives by their place in it. The density is that in its middle.
template <typename ValueAt>
Moments moments_of(glm::ivec3 brick, const BrickVolume& density, const glm::dmat4& density_from_heat,
                   ValueAt value_at) {
  Moments sum;
  for (int i = 0; i < int{kBrickVoxels}; ++i) {
    const glm::ivec3 local(i & 7, i >> 3 & 7, i >> 6);
    const double value = value_at(local);
    if (value <= 0) continue;
    const double fourth = value * value * value * value;
    const glm::dvec3 p = glm::dvec3(8 * brick + local) + 0.5;
    sum.weight += fourth;
    sum.values += fourth * value;
    sum.places += fourth * p;
    sum.squares += fourth * p * p;
  }
  if (sum.weight > 0)
    sum.densities =
        sum.weight * density_at(*density.volume, glm::dvec3(density_from_heat * glm::dvec4(sum.middle(), 1)));
  return sum;
}

std::vector<Moments> bricks_of(const BrickVolume& heat, const BrickVolume& density) {
  const volume::SparseVolume& volume = *heat.volume;
  const glm::dmat4 density_from_heat = glm::inverse(density.world_from_voxel) * heat.world_from_voxel;
  const auto uniform = volume.uniform_bricks();
  std::vector<Moments> bricks(volume.slot_count() + uniform.size());
  parallel_for(bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i >= volume.slot_count()) {
        const volume::UniformBrick& brick = uniform[i - volume.slot_count()];
        const double value{glm::unpackHalf1x16(brick.texel)};
        bricks[i] = moments_of(brick.at, density, density_from_heat, [&](glm::ivec3) { return value; });
        continue;
      }
      const auto slot = static_cast<std::uint32_t>(i);
      if (!volume.in_use(slot)) continue;
      const auto texels = volume.texels<std::uint16_t>(kChannel, slot);
      bricks[i] = moments_of(volume.brick_of(slot), density, density_from_heat, [&](glm::ivec3 at) {
        const auto texel = static_cast<std::size_t>(at.x + 1 + 10 * (at.y + 1 + 10 * (at.z + 1)));
        return double{glm::unpackHalf1x16(texels[texel])};
      });
    }
  });
  std::erase_if(bricks, [](const Moments& brick) { return !(brick.weight > 0); });
  return bricks;
}

GlowBall ball_of(const Moments& sum) {
  const glm::dvec3 variance = sum.variance();
  // A ball's mean squared distance from its middle is 3/5 of its radius squared; a voxel's is 1/4.
  const double squared = variance.x + variance.y + variance.z + 0.25;
  return {sum.middle(), std::sqrt(squared / 0.6), sum.weight, sum.values / sum.weight,
          sum.densities / sum.weight};
}

}  // namespace

std::vector<GlowBall> find_glow(const BrickVolume& heat, const BrickVolume& density) {
  std::vector<Moments> bricks = bricks_of(heat, density);
  if (bricks.empty()) return {};
  std::vector<Part> parts{Part(bricks)};
  while (parts.size() < kMostGlowBalls) {
    const auto widest = std::ranges::max_element(parts, {}, &Part::spread);
    if (widest->spread() <= 0) break;
    const int axis = longest_axis(widest->sum.variance());
    const double middle = widest->sum.middle()[axis];
    const std::span<Moments> all = widest->bricks;
    const auto above =
        std::ranges::partition(all, [&](const Moments& brick) { return brick.middle()[axis] < middle; });
    if (above.empty() || above.size() == all.size()) break;
    *widest = Part(all.first(all.size() - above.size()));
    parts.emplace_back(all.last(above.size()));
  }
  std::vector<GlowBall> balls;
  for (const Part& part : parts) balls.push_back(ball_of(part.sum));
  return balls;
}

double escape_from_ball(double x) {
  if (x < 0.05) return 1 - 0.75 * x + 0.4 * x * x;
  return 3 / (8 * x * x * x) * (2 * x * x - 1 + (1 + 2 * x) * std::exp(-2 * x));
}

}  // namespace brume::grids
