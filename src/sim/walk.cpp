#include "sim/walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "core/error.hpp"

namespace brume::sim {
namespace {

constexpr int kSubvoxelBits = 10;
constexpr double kFrameUnitsPerMetre = 1 << 30;
constexpr std::int64_t kFrameUnitsPerUnit = (std::int64_t{1} << 30) / kUnitsPerMetre;

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && (a % b < 0) != (b < 0));
}

/// Exact a < b: the products need more than 64 bits.
bool less(Fraction a, Fraction b) {
  return static_cast<__int128>(a.num) * b.den < static_cast<__int128>(b.num) * a.den;
}

/// Whether `a` has the lower voxel index.
bool before(glm::ivec3 a, glm::ivec3 b) {
  return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
}

/// The nearest free voxel to `centre`, centre included, that `side` accepts; ties by voxel index.
template <typename Side>
std::optional<glm::ivec3> nearest_free(const voxel::BitGrid& grid, glm::ivec3 centre, Side side) {
  std::optional<glm::ivec3> best;
  int best_square = std::numeric_limits<int>::max();
  for (int r = 0; r <= kLandingSearch && r * r <= best_square; ++r) {
    for (int z = -r; z <= r; ++z)
      for (int y = -r; y <= r; ++y) {
        const bool shell = std::abs(z) == r || std::abs(y) == r;
        for (int x = -r; x <= r; x += shell || r == 0 ? 1 : 2 * r) {
          const int square = x * x + y * y + z * z;
          const glm::ivec3 offset(x, y, z);
          if (square > best_square || !grid.free(centre + offset) || !side(offset)) continue;
          if (square == best_square && !before(centre + offset, *best)) continue;
          best = centre + offset;
          best_square = square;
        }
      }
  }
  return best;
}

}  // namespace

Position position_from_metres(glm::dvec3 metres) {
  constexpr int kOutside = kMaxCoordinate + 1;
  Position position(kOutside);
  for (int axis = 0; axis < 3; ++axis) {
    const double units = std::nearbyint(metres[axis] * kUnitsPerMetre);
    if (!std::isnan(units)) position[axis] = static_cast<int>(std::clamp<double>(units, -kOutside, kOutside));
  }
  return position;
}

glm::dvec3 metres_from_position(Position position) {
  return glm::dvec3(position) / double{kUnitsPerMetre};
}

std::uint64_t ceil_sqrt(std::uint64_t square) {
  std::uint64_t low = 0, high = std::uint64_t{1} << 32;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (middle * middle >= square)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

std::uint64_t ceil_distance(Position from, Position to) {
  const glm::i64vec3 d = glm::i64vec3(to) - glm::i64vec3(from);
  return ceil_sqrt(static_cast<std::uint64_t>(d.x * d.x + d.y * d.y + d.z * d.z));
}

VoxelRuler::VoxelRuler(const voxel::GridLayout& layout)
    : origin_(0), voxel_size_(std::llround(static_cast<double>(layout.voxel_size) * kFrameUnitsPerMetre)) {
  const bool size_ok = layout.voxel_size >= 1.0f / 64 && layout.voxel_size <= 64;
  if (!size_ok)
    throw Error(ErrorCode::bad_input, "voxel size " + std::to_string(layout.voxel_size) +
                                          " m: the simulation accepts 1/64 m to 64 m");
  for (int axis = 0; axis < 3; ++axis) {
    const double metres = layout.origin_world[axis];
    if (!(std::abs(metres) <= double{kMaxCoordinate} / kUnitsPerMetre))
      throw Error(ErrorCode::bad_input,
                  "grid origin " + std::to_string(metres) +
                      " m: the simulation accepts at most 16384 m from the world's origin");
    origin_[axis] = std::llround(metres * kFrameUnitsPerMetre);
  }
}

glm::i64vec3 VoxelRuler::subvoxel(Position position) const {
  glm::i64vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t from_origin = position[axis] * kFrameUnitsPerUnit - origin_[axis];
    result[axis] = floor_div(from_origin * (1 << kSubvoxelBits), voxel_size_);
  }
  return result;
}

std::int64_t VoxelRuler::subvoxels(std::int64_t length) const {
  return floor_div(length * kFrameUnitsPerUnit * (1 << kSubvoxelBits), voxel_size_);
}

Position VoxelRuler::centre(glm::ivec3 voxel) const {
  Position result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = static_cast<int>(
        floor_div(origin_[axis] + (2 * voxel[axis] + 1) * (voxel_size_ / 2), kFrameUnitsPerUnit));
  return result;
}

void walk_ray(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from, Position to,
              const std::function<bool(const WalkStep&)>& visit) {
  const glm::i64vec3 start = ruler.subvoxel(from);
  const glm::i64vec3 direction = ruler.subvoxel(to) - start;
  const glm::i64vec3 size(grid.size());
  glm::i64vec3 voxel = start >> std::int64_t{kSubvoxelBits};
  if (direction == glm::i64vec3(0)) {
    if (grid.contains(glm::ivec3(voxel))) visit({glm::ivec3(voxel), {1, 1}});
    return;
  }

  for (;;) {
    // The next face on each axis, and the nearest of them.
    int nearest = -1;
    Fraction exit;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) {
        if (voxel[axis] < 0 || voxel[axis] >= size[axis]) return;
        continue;
      }
      const bool up = direction[axis] > 0;
      if (up ? voxel[axis] >= size[axis] : voxel[axis] < 0) return;
      const std::int64_t face = (voxel[axis] + up) * (1 << kSubvoxelBits);
      const Fraction here{up ? face - start[axis] : start[axis] - face, std::abs(direction[axis])};
      if (nearest < 0 || less(here, exit)) {
        nearest = axis;
        exit = here;
      }
    }

    // Visit the voxel, then step through that face.
    const bool inside =
        glm::all(glm::greaterThanEqual(voxel, glm::i64vec3(0))) && glm::all(glm::lessThan(voxel, size));
    if (inside && !visit({glm::ivec3(voxel), exit})) return;
    voxel[nearest] += direction[nearest] > 0 ? 1 : -1;
  }
}

std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from,
                                        Position at) {
  // Walk to the first solid voxel.
  std::optional<glm::ivec3> last_free, first_solid;
  walk_ray(grid, ruler, from, at, [&](const WalkStep& step) {
    if (grid.solid(step.voxel)) {
      first_solid = step.voxel;
      return false;
    }
    last_free = step.voxel;
    return true;
  });

  if (!first_solid) {
    const glm::ivec3 aim(ruler.subvoxel(at) >> std::int64_t{kSubvoxelBits});
    return grid.free(aim) ? aim : last_free;
  }
  if (last_free) return last_free;

  // The ray starts in a wall: prefer free voxels ahead.
  const glm::i64vec3 direction = glm::i64vec3(at) - glm::i64vec3(from);
  const auto ahead = [&](glm::ivec3 offset) {
    const glm::i64vec3 o(offset);
    return o.x * direction.x + o.y * direction.y + o.z * direction.z >= 0;
  };
  const auto on_side = nearest_free(grid, *first_solid, ahead);
  return on_side ? on_side : nearest_free_voxel(grid, *first_solid);
}

std::optional<glm::ivec3> nearest_free_voxel(const voxel::BitGrid& grid, glm::ivec3 voxel) {
  return nearest_free(grid, voxel, [](glm::ivec3) { return true; });
}

std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, glm::vec3 from_world,
                                        glm::vec3 at_world) {
  return landing_voxel(grid, VoxelRuler(grid.layout()), position_from_metres(glm::dvec3(from_world)),
                       position_from_metres(glm::dvec3(at_world)));
}

}  // namespace brume::sim
