#include "sim/cell_block.hpp"

#include <algorithm>
#include <bit>

#include "sim/pack_plane.hpp"

namespace brume::sim {
namespace {

/// Planes of neighbouring cells on a curved surface do not quite meet: they are made this much larger.
constexpr float kOverlap = 0.1f;  // [voxels]

/// Points per axis that stand for a cell: its corners are among them, where slivers of a side end.
constexpr int kSamples = 3;

/// An arc with curvature k and chord L lies at most k L^2 / 12 off the mean plane of its piece; L^2 is at
/// most 2 where a cylinder runs along an axis, so k / 6. The curvature is known from planes alone, whose
/// pieces may lie anywhere in their cells: nearly twice as much makes up for that.
constexpr float kDeviationPerCurvature = 0.3f;  // [voxels^2]
/// Two pieces of a surface are not nearer than this [voxels].
constexpr float kLeastApart = 0.5f;
/// Planes that differ by more are two surfaces, not one that bends.
constexpr float kLeastCosine = 0.5f;

/// For a stretch of an axis, from the cell's centre, the thirds of the 3x3x3 cells that it or a point within
/// kOverlap of it is in: bits 0 to 2.
unsigned thirds(float from, float to) {
  // Without floor(), which is a call on plain x86-64.
  const int low = (from - kOverlap >= -0.5f) + (from - kOverlap >= 0.5f);
  const int high = (to + kOverlap >= -0.5f) + (to + kOverlap >= 0.5f);
  return (2u << high) - (1u << low);
}

/// Cells of the 3x3x3, as Sheet::cells, that are in the given thirds of an axis.
constexpr std::array<std::array<std::uint32_t, 8>, 3> make_cells_in_thirds() {
  std::array<std::array<std::uint32_t, 8>, 3> cells{};
  for (unsigned set = 0; set < 8; ++set)
    for (unsigned i = 0; i < 27; ++i) {
      cells[0][set] |= (set >> i % 3 & 1) << i;
      cells[1][set] |= (set >> i / 3 % 3 & 1) << i;
      cells[2][set] |= (set >> i / 9 & 1) << i;
    }
  return cells;
}
constexpr auto kCellsInThirds = make_cells_in_thirds();

/// The cells that a point lies in or within kOverlap of, as Sheet::cells.
std::uint32_t cells_around(glm::vec3 p) {
  return kCellsInThirds[0][thirds(p.x, p.x)] & kCellsInThirds[1][thirds(p.y, p.y)] &
         kCellsInThirds[2][thirds(p.z, p.z)];
}

/// The voxels of a block with coordinate 0 along each axis, and how far apart in bits the next ones are.
constexpr std::array<Block, 3> kFirstLayer{0x1111111111111111u, 0x000f000f000f000fu, 0xffffu};
constexpr std::array<int, 3> kLayerStride{1, 4, 16};

/// For each of the 3x3x3 cells the voxels to which the way from a point may come through it, axis by axis.
std::array<Block, 27> ways_through_cells(glm::vec3 from) {
  std::array<std::array<Block, 3>, 3> through{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 4; ++i) {
      const float here = from[static_cast<int>(axis)], to = static_cast<float>(i) - 1.5f;
      const unsigned set = thirds(std::min(here, to), std::max(here, to));
      for (std::size_t third = 0; third < 3; ++third)
        if (set >> third & 1) through[axis][third] |= kFirstLayer[axis] << i * kLayerStride[axis];
    }
  std::array<Block, 27> result;
  for (std::size_t i = 0; i < 27; ++i)
    result[i] = through[0][i % 3] & through[1][i / 3 % 3] & through[2][i / 9];
  return result;
}

/// Whether b is a continued within the given bounds, whichever way it faces.
bool continues(glm::vec3 normal_a, float offset_a, glm::vec3 normal_b, float offset_b, float cosine,
               float apart) {
  const float along = glm::dot(normal_a, normal_b);
  return std::abs(along) > cosine && std::abs(offset_b - (along > 0 ? offset_a : -offset_a)) < apart;
}

/// Of the surface that runs from a plane in a cell to another plane `step` cells on [1/voxels]: by how much
/// it turns between the points of the planes nearest to the middles of their cells.
float curvature(const voxel::Plane& a, const voxel::Plane& b, glm::ivec3 step) {
  const float cosine = std::abs(glm::dot(a.normal, b.normal));
  if (cosine < kLeastCosine) return 0;
  const glm::vec3 way = glm::vec3(step) + b.normal * b.offset - a.normal * a.offset;
  return std::sqrt(std::max(0.0f, 2 - 2 * cosine)) / std::max(kLeastApart, glm::length(way));
}

}  // namespace

void CellSight::look_at(glm::ivec3 cell) {
  sheets_.clear();
  read_own_planes(planes_.at(cell));
  flat_ = true;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 step = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (step == glm::ivec3(0)) continue;
    for (const voxel::Plane& plane : planes_.at(cell + step)) read_neighbour(plane, step);
  }
  if (flat_) return;
  measure_voxels();
  find_viewpoints();
}

void CellSight::read_own_planes(std::span<const voxel::Plane> own) {
  plane_count_ = static_cast<int>(own.size());
  std::array<std::uint32_t, voxel::kMaxPlanes> packed{};
  for (std::size_t k = 0; k < own.size(); ++k) {
    own_[k] = own[k];
    packed[k] = pack_plane(own[k]);
    deviation_[k] = 0;
    const glm::vec3 normal = shared::plane_normal(packed[k]);
    const float offset = shared::plane_offset(packed[k]);
    positive_[k] = 0;
    for (int bit = 0; bit < 64; ++bit)
      positive_[k] |= Block{glm::dot(normal, from_cell_centre(bit)) > offset} << bit;
    add_sheet(own[k], glm::ivec3(0));
  }
  record_ = {packed[0], packed[1], packed[2], 0};
}

void CellSight::read_neighbour(const voxel::Plane& plane, glm::ivec3 step) {
  const float offset = plane.offset + glm::dot(plane.normal, glm::vec3(step));
  bool goes_on = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(plane_count_); ++k) {
    goes_on |= continues(own_[k].normal, own_[k].offset, plane.normal, offset, 0.9995f, 0.02f);
    deviation_[k] = std::max(deviation_[k], kDeviationPerCurvature * curvature(own_[k], plane, step));
  }
  flat_ = flat_ && goes_on;
  add_sheet(plane, step);
}

std::uint32_t CellSight::moved_plane(int k, float distance) const {
  voxel::Plane plane = own_[static_cast<std::size_t>(k)];
  plane.offset += distance;
  return pack_plane(plane);
}

void CellSight::add_sheet(const voxel::Plane& plane, glm::ivec3 step) {
  const float offset = plane.offset + glm::dot(plane.normal, glm::vec3(step));
  const std::uint32_t bit = 1u << (step.x + 3 * step.y + 9 * step.z + 13);
  for (Sheet& sheet : sheets_) {
    if (!continues(sheet.normal, sheet.offset, plane.normal, offset, 0.99999f, 1e-3f)) continue;
    sheet.cells |= bit;
    return;
  }
  Sheet& sheet = sheets_.emplace_back();
  sheet.normal = plane.normal;
  sheet.offset = offset;
  sheet.cells = bit;
}

void CellSight::measure_voxels() {
  for (Sheet& sheet : sheets_) {
    sheet.positive = 0;
    for (int bit = 0; bit < 64; ++bit) {
      const float distance = glm::dot(sheet.normal, from_cell_centre(bit)) - sheet.offset;
      sheet.distance[static_cast<std::size_t>(bit)] = distance;
      sheet.positive |= Block{distance > 0} << bit;
    }
  }
}

void CellSight::find_viewpoints() {
  for (std::vector<glm::vec3>& points : viewpoints_) points.clear();
  for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
    const glm::vec3 p =
        glm::vec3(i % kSamples, i / kSamples % kSamples, i / (kSamples * kSamples)) / float{kSamples - 1} -
        0.5f;
    viewpoints_[shared::boundary_side(record_, p)].push_back(p);
  }
  for (std::vector<glm::vec3>& points : viewpoints_) {
    if (points.empty()) continue;
    glm::vec3 middle(0);
    for (const glm::vec3 p : points) middle += p;
    points.insert(points.begin(), middle / static_cast<float>(points.size()));
  }
}

Block CellSight::on_side(int side, Block among) const {
  for (int k = 0; k < plane_count_; ++k) {
    const Block positive = positive_[static_cast<std::size_t>(k)];
    among &= side >> k & 1 ? positive : ~positive;
  }
  return among;
}

Block CellSight::seen_from(glm::vec3 viewpoint, Block among) const {
  const std::array<Block, 27> ways = ways_through_cells(viewpoint);
  for (const Sheet& sheet : sheets_) {
    const float here = glm::dot(sheet.normal, viewpoint) - sheet.offset;
    // Only voxels beyond the plane can be hidden by it, and only where their way comes through its cells.
    Block beyond = 0;
    for (std::uint32_t cells = sheet.cells; cells != 0; cells &= cells - 1)
      beyond |= ways[static_cast<std::size_t>(std::countr_zero(cells))];
    beyond &= among & (here > 0 ? ~sheet.positive : sheet.positive);
    for (; beyond != 0; beyond &= beyond - 1) {
      const int bit = std::countr_zero(beyond);
      const float there = sheet.distance[static_cast<std::size_t>(bit)];
      const glm::vec3 crossing = viewpoint + (from_cell_centre(bit) - viewpoint) * (here / (here - there));
      if (sheet.cells & cells_around(crossing)) among &= ~(Block{1} << bit);
    }
    if (among == 0) break;
  }
  return among;
}

Block CellSight::seen(int side, Block among) {
  if (flat_) return on_side(side, among);
  // The middle of the side speaks for all of it; where it sees nothing, any other point may.
  for (const glm::vec3 viewpoint : viewpoints_[static_cast<std::size_t>(side)]) {
    const Block result = seen_from(viewpoint, among);
    if (result != 0) return result;
  }
  return 0;
}

}  // namespace brume::sim
