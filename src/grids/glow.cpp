#include "grids/glow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>
#include <optional>
#include <span>

#include "core/tasks.hpp"

namespace brume::grids {
namespace {

constexpr volume::ChannelId kChannel{0};

/// Sums over voxels, weighted by GlowBall::power.
struct Moments {
  double weight = 0, values = 0, densities = 0, voxels = 0;
  glm::dvec3 places{0}, squares{0};

  void add(const Moments& other, double part) {
    weight += part * other.weight;
    values += part * other.values;
    densities += part * other.densities;
    places += part * other.places;
    squares += part * other.squares;
  }
  glm::dvec3 middle() const { return places / weight; }
  /// A voxel's own is 1/12.
  glm::dvec3 variance() const { return glm::max(squares / weight - middle() * middle(), 0.0) + 1.0 / 12; }
};

/// The value of the density at a point of its voxel space.
double density_at(const volume::SparseVolume& volume, glm::dvec3 p_voxel) {
  if (!may_hold(p_voxel)) return 0;
  const glm::ivec3 voxel(glm::floor(p_voxel)), brick = voxel >> 3, local = (voxel & 7) + 1;
  if (const auto uniform = volume.uniform_at(brick)) return double{glm::unpackHalf1x16(*uniform)};
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == volume::SparseVolume::kNoSlot) return 0;
  const auto texel = static_cast<std::size_t>(local.x + 10 * (local.y + 10 * local.z));
  return double{glm::unpackHalf1x16(volume.texels<std::uint16_t>(kChannel, slot)[texel])};
}

/// The moments of a brick, whose voxels `value_at` gives by their place in it. Its density is taken in its
/// middle.
template <typename ValueAt>
Moments moments_of(glm::ivec3 brick, const BrickVolume& density, const glm::dmat4& density_from_heat,
                   GlowPower power, ValueAt value_at) {
  Moments sum;
  for (int i = 0; i < int{kBrickVoxels}; ++i) {
    const glm::ivec3 local(i & 7, i >> 3 & 7, i >> 6);
    const double value = value_at(local);
    if (value <= 0) continue;
    const double weight = power == GlowPower::linear ? value : value * value * value * value;
    const glm::dvec3 p = glm::dvec3(8 * brick + local) + 0.5;
    sum.weight += weight;
    sum.voxels += 1;
    sum.values += weight * value;
    sum.places += weight * p;
    sum.squares += weight * p * p;
  }
  if (sum.weight > 0)
    sum.densities =
        sum.weight * density_at(*density.volume, glm::dvec3(density_from_heat * glm::dvec4(sum.middle(), 1)));
  return sum;
}

std::vector<Moments> make_bricks(const BrickVolume& heat, const BrickVolume& density, GlowPower power) {
  const volume::SparseVolume& volume = *heat.volume;
  const glm::dmat4 density_from_heat = glm::inverse(density.world_from_voxel) * heat.world_from_voxel;
  const auto uniform = volume.uniform_bricks();
  std::vector<Moments> bricks(volume.slot_count() + uniform.size());
  parallel_for(bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i >= volume.slot_count()) {
        // One value throughout: no texels.
        const volume::UniformBrick& brick = uniform[i - volume.slot_count()];
        const double value{glm::unpackHalf1x16(brick.texel)};
        bricks[i] =
            moments_of(brick.at, density, density_from_heat, power, [&](glm::ivec3) { return value; });
        continue;
      }
      const auto slot = static_cast<std::uint32_t>(i);
      if (!volume.in_use(slot)) continue;
      const auto texels = volume.texels<std::uint16_t>(kChannel, slot);
      bricks[i] = moments_of(volume.brick_of(slot), density, density_from_heat, power, [&](glm::ivec3 at) {
        // Texels have an apron around the voxels of the brick.
        const auto texel = static_cast<std::size_t>(at.x + 1 + 10 * (at.y + 1 + 10 * (at.z + 1)));
        return double{glm::unpackHalf1x16(texels[texel])};
      });
    }
  });
  std::erase_if(bricks, [](const Moments& brick) { return !(brick.weight > 0); });
  return bricks;
}

/// How glow is divided into halves along each axis: not at a plane, but over a slope, so that nothing jumps
/// where it moves across. Plane and slope are as for two points with the same mean, deviation and
/// skewness: the plane is halfway between them, whatever their weights.
struct Division {
  glm::dvec3 mean, plane, reach;  // reach: half the distance of the points
  glm::dvec3 apart;               // 0: the axis has no halves; 1: they are in their own middles

  Division(const Moments& all, const std::vector<Moments>& bricks) : mean(all.middle()) {
    glm::dvec3 cubes(0);
    for (const Moments& brick : bricks) {
      const glm::dvec3 off = brick.middle() - mean;
      cubes += brick.weight * (off * off * off + 3.0 * off * brick.variance());
    }
    const glm::dvec3 deviation = glm::sqrt(all.variance());
    const glm::dvec3 skewness = cubes / (all.weight * deviation * deviation * deviation);
    plane = mean + 0.5 * skewness * deviation;
    reach = 0.5 * deviation * glm::sqrt(4.0 + skewness * skewness);
    const double longest = std::max({reach.x, reach.y, reach.z});
    // Neither short axes nor axes of a few voxels.
    apart = glm::smoothstep(glm::dvec3(0.5), glm::dvec3(0.8), reach / longest) *
            glm::smoothstep(glm::dvec3(2), glm::dvec3(4), reach);
  }
  /// The part of a point that an octant has, whose bit is set where it is the high half of an axis.
  double part(glm::dvec3 p, std::size_t octant) const {
    const glm::dvec3 high = glm::clamp(0.5 + (p - plane) / reach, 0.0, 1.0);
    double product = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_high = (octant >> axis & 1) != 0;
      product *= apart[axis] > 0 ? (is_high ? high[axis] : 1 - high[axis]) : (is_high ? 0 : 1);
    }
    return product;
  }
};

using Octants = std::array<Moments, kMostGlowBalls>;

/// The ball of an octant. Halves that are hardly apart are near the middle of both; what they are not apart
/// widens them, so that the spread of both together remains.
GlowBall ball_of(const Octants& octants, std::size_t octant, const Division& division) {
  const Moments& sum = octants[octant];
  glm::dvec3 middle = sum.middle(), squared = sum.variance();
  for (int axis = 0; axis < 3; ++axis) {
    const double apart = division.apart[axis];
    if (apart <= 0) continue;
    Moments both = sum;
    both.add(octants[octant ^ (std::size_t{1} << axis)], 1);
    const double off = middle[axis] - both.middle()[axis];
    middle[axis] -= (1 - apart) * off;
    squared[axis] += (1 - apart * apart) * off * off;
  }
  // A ball's mean squared distance from its middle is 3/5 of its radius squared.
  return {middle, std::sqrt((squared.x + squared.y + squared.z) / 0.6), sum.weight, sum.values / sum.weight,
          sum.densities / sum.weight};
}

}  // namespace

std::vector<GlowBall> find_glow(const BrickVolume& glow, const BrickVolume& density, GlowPower power) {
  const std::vector<Moments> bricks = make_bricks(glow, density, power);
  if (bricks.empty()) return {};
  Moments all;
  for (const Moments& brick : bricks) all.add(brick, 1);
  const Division division(all, bricks);
  Octants octants;
  for (std::size_t octant = 0; octant < octants.size(); ++octant)
    for (const Moments& brick : bricks) octants[octant].add(brick, division.part(brick.middle(), octant));
  std::vector<GlowBall> balls;
  for (std::size_t octant = 0; octant < octants.size(); ++octant)
    if (octants[octant].weight > 1e-9 * all.weight) balls.push_back(ball_of(octants, octant, division));
  return balls;
}

std::vector<GlowColumn> glow_columns(const BrickVolume& heat, const BrickVolume& density) {
  const std::vector<Moments> bricks = make_bricks(heat, density, GlowPower::fourth);
  const double power = std::pow(double{heat.unit}, 4);
  constexpr double kColumn = 64;  // voxels across a brick
  std::vector<GlowColumn> columns;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(glm::dvec3(heat.world_from_voxel[axis])) / kColumn;
    std::map<std::pair<int, int>, GlowColumn> across;
    for (const Moments& brick : bricks) {
      const glm::ivec3 at(glm::floor(brick.middle() / 8.0));
      GlowColumn& column = across[{at[(axis + 1) % 3], at[(axis + 2) % 3]}];
      column.power += power * length * brick.weight;
      column.density += double{density.unit} * length * brick.voxels * brick.densities / brick.weight;
    }
    for (const auto& [at, column] : across) columns.push_back(column);
  }
  return columns;
}

double escape_from_ball(double x) {
  if (x < 0.05) return 1 - 0.75 * x + 0.4 * x * x;
  return 3 / (8 * x * x * x) * (2 * x * x - 1 + (1 + 2 * x) * std::exp(-2 * x));
}

}  // namespace brume::grids
