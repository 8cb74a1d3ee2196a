#include "smoke/cell_sight.hpp"

#include <algorithm>
#include <bit>

#include "smoke/pack_plane.hpp"

namespace brume::smoke {
namespace {

/// Planes of neighbouring cells on a curved surface do not quite meet: they are made this much larger.
constexpr float kOverlap = 0.1f;  // [voxels]

/// Points per axis that stand for a cell: its corners are among them, where slivers of a side end.
constexpr int kSamples = 3;

/// An arc with curvature k and chord L lies at most k L^2 / 12 off the mean plane of its piece; L^2 is at
/// most 2 where a cylinder runs along an axis, so k / 6. The curvature is estimated from planes alone, whose
/// pieces may lie anywhere in their cells: nearly twice as much compensates for that.
constexpr float kDeviationPerCurvature = 0.3f;  // [voxels^2]
/// Least distance between two pieces of a surface [voxels].
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

/// The cells of the five stretches of each axis: in the first cell, near the next, in the second and so on.
constexpr std::array<std::uint32_t, 125> make_cells_of_stretches() {
  constexpr std::array<unsigned, 5> kThirds{1, 3, 2, 6, 4};
  std::array<std::uint32_t, 125> cells{};
  for (std::size_t i = 0; i < 125; ++i)
    cells[i] = kCellsInThirds[0][kThirds[i % 5]] & kCellsInThirds[1][kThirds[i / 5 % 5]] &
               kCellsInThirds[2][kThirds[i / 25]];
  return cells;
}
constexpr auto kCellsOfStretches = make_cells_of_stretches();

/// The cells that a point lies in or within kOverlap of, as Sheet::cells.
std::uint32_t cells_around(float x, float y, float z) {
  const auto stretch = [](float c) {
    return static_cast<unsigned>(c >= -0.5f - kOverlap) + static_cast<unsigned>(c >= -0.5f + kOverlap) +
           static_cast<unsigned>(c >= 0.5f - kOverlap) + static_cast<unsigned>(c >= 0.5f + kOverlap);
  };
  return kCellsOfStretches[stretch(x) + 5 * stretch(y) + 25 * stretch(z)];
}

/// The voxels with coordinate 0 along each axis, and the distance in bits to those with 1.
constexpr std::array<Neighbourhood64, 3> kFirstLayer{0x1111111111111111u, 0x000f000f000f000fu, 0xffffu};
constexpr std::array<int, 3> kLayerStride{1, 4, 16};

/// For each of the 3x3x3 cells the voxels to which the path from a point may pass through it, axis by axis.
std::array<Neighbourhood64, 27> paths_through_cells(glm::vec3 from) {
  std::array<std::array<Neighbourhood64, 3>, 3> through{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 4; ++i) {
      const float here = from[static_cast<int>(axis)], to = static_cast<float>(i) - 1.5f;
      const unsigned set = thirds(std::min(here, to), std::max(here, to));
      for (std::size_t third = 0; third < 3; ++third)
        if (set >> third & 1) through[axis][third] |= kFirstLayer[axis] << i * kLayerStride[axis];
    }
  std::array<Neighbourhood64, 27> result;
  for (std::size_t i = 0; i < 27; ++i)
    result[i] = through[0][i % 3] & through[1][i / 3 % 3] & through[2][i / 9];
  return result;
}

constexpr int kSampleCount = kSamples * kSamples * kSamples;
glm::vec3 sample_point(int i) {
  return glm::vec3(i % kSamples, i / kSamples % kSamples, i / (kSamples * kSamples)) / float{kSamples - 1} -
         0.5f;
}
std::array<std::array<Neighbourhood64, 27>, kSampleCount> paths_from_samples() {
  std::array<std::array<Neighbourhood64, 27>, kSampleCount> paths;
  for (int i = 0; i < kSampleCount; ++i)
    paths[static_cast<std::size_t>(i)] = paths_through_cells(sample_point(i));
  return paths;
}

const std::array<std::array<Neighbourhood64, 27>, kSampleCount> kPathsFromSamples = paths_from_samples();

/// The voxels of a neighbourhood in vector order: coordinates axis by axis, and their bits by halves.
struct NeighbourPoints {
  std::array<float, 64> x, y, z;
  std::array<std::uint32_t, 64> bit;
};
constexpr NeighbourPoints make_neighbour_points() {
  NeighbourPoints points{};
  for (unsigned i = 0; i < 64; ++i) {
    points.x[i] = static_cast<float>(i & 3) - 1.5f;
    points.y[i] = static_cast<float>(i >> 2 & 3) - 1.5f;
    points.z[i] = static_cast<float>(i >> 4) - 1.5f;
    points.bit[i] = 1u << (i & 31);
  }
  return points;
}
constexpr NeighbourPoints kPoints = make_neighbour_points();

/// The distance of each voxel from a plane along its normal; returns the voxels on its positive side.
Neighbourhood64 measure(glm::vec3 normal, float offset, std::array<float, 64>& distance) {
  for (std::size_t i = 0; i < 64; ++i)
    distance[i] = normal.x * kPoints.x[i] + normal.y * kPoints.y[i] + normal.z * kPoints.z[i] - offset;
  std::uint32_t low = 0, high = 0;
  for (std::size_t i = 0; i < 32; ++i) low |= distance[i] > 0 ? kPoints.bit[i] : 0;
  for (std::size_t i = 32; i < 64; ++i) high |= distance[i] > 0 ? kPoints.bit[i] : 0;
  return Neighbourhood64{low} | Neighbourhood64{high} << 32;
}

/// The centres of the 3x3x3 cells, and five more to make it a power of two.
struct CellCentres {
  std::array<float, 32> x, y, z;
};
constexpr CellCentres make_cell_centres() {
  CellCentres centres{};
  for (unsigned i = 0; i < 32; ++i) {
    const unsigned x = i % 3, y = i / 3 % 3, z = i / 9;
    centres.x[i] = static_cast<float>(x) - 1;
    centres.y[i] = static_cast<float>(y) - 1;
    centres.z[i] = static_cast<float>(z) - 1;
  }
  return centres;
}
constexpr CellCentres kCentres = make_cell_centres();

/// The 3x3x3 cells, as Sheet::cells, that a plane enters.
std::uint32_t cells_of_plane(glm::vec3 normal, float offset) {
  constexpr float kRounding = 1e-3f;
  const float reach = (0.5f + kRounding) * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  std::uint32_t cells = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    const float distance =
        normal.x * kCentres.x[i] + normal.y * kCentres.y[i] + normal.z * kCentres.z[i] - offset;
    cells |= std::abs(distance) <= reach ? kPoints.bit[i] : 0;
  }
  return cells & ((1u << 27) - 1);
}

/// Whether plane b continues plane a within the given bounds, whichever side is positive.
bool continues(glm::vec3 normal_a, float offset_a, glm::vec3 normal_b, float offset_b, float cosine,
               float apart) {
  const float along = glm::dot(normal_a, normal_b);
  return std::abs(along) > cosine && std::abs(offset_b - (along > 0 ? offset_a : -offset_a)) < apart;
}

/// Curvature of the surface that runs from a plane in a cell to another plane `step` cells on [1/voxels]: how
/// much it bends between the points of the planes nearest to the centres of their cells.
float curvature(const voxel::Plane& a, const voxel::Plane& b, glm::ivec3 step) {
  const float cosine = std::abs(glm::dot(a.normal, b.normal));
  if (cosine < kLeastCosine) return 0;
  const glm::vec3 chord = glm::vec3(step) + b.normal * b.offset - a.normal * a.offset;
  return std::sqrt(std::max(0.0f, 2 - 2 * cosine)) / std::max(kLeastApart, glm::length(chord));
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
    std::array<float, 64> distance;
    positive_[k] = measure(shared::plane_normal(packed[k]), shared::plane_offset(packed[k]), distance);
    add_sheet(own[k], glm::ivec3(0));
  }
  record_ = {packed[0], packed[1], packed[2], 0};
}

void CellSight::read_neighbour(const voxel::Plane& plane, glm::ivec3 step) {
  const float offset = plane.offset + glm::dot(plane.normal, glm::vec3(step));
  bool continued = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(plane_count_); ++k) {
    continued |= continues(own_[k].normal, own_[k].offset, plane.normal, offset, 0.9995f, 0.02f);
    deviation_[k] = std::max(deviation_[k], kDeviationPerCurvature * curvature(own_[k], plane, step));
  }
  flat_ = flat_ && continued;
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
    sheet.open_cells = cells_of_plane(sheet.normal, sheet.offset) & ~sheet.cells;
    sheet.positive = measure(sheet.normal, sheet.offset, sheet.distance);
  }
}

void CellSight::find_viewpoints() {
  const std::array<std::uint32_t, voxel::kMaxPlanes> packed{record_.plane0, record_.plane1, record_.plane2};
  std::array<glm::vec3, voxel::kMaxPlanes> normals;
  std::array<float, voxel::kMaxPlanes> offsets;
  for (std::size_t k = 0; k < static_cast<std::size_t>(plane_count_); ++k) {
    normals[k] = shared::plane_normal(packed[k]);
    offsets[k] = shared::plane_offset(packed[k]);
  }
  samples_ = {};
  std::array<glm::vec3, 8> sums{};
  for (int i = 0; i < kSampleCount; ++i) {
    const glm::vec3 p = sample_point(i);
    std::size_t side = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(plane_count_); ++k)
      side |= std::size_t{glm::dot(normals[k], p) > offsets[k]} << k;
    samples_[side] |= 1u << i;
    sums[side] += p;
  }
  for (std::size_t side = 0; side < 8; ++side)
    if (samples_[side] != 0) middles_[side] = sums[side] / static_cast<float>(std::popcount(samples_[side]));
}

Neighbourhood64 CellSight::on_side(int side, Neighbourhood64 among) const {
  for (int k = 0; k < plane_count_; ++k) {
    const Neighbourhood64 positive = positive_[static_cast<std::size_t>(k)];
    among &= side >> k & 1 ? positive : ~positive;
  }
  return among;
}

Neighbourhood64 CellSight::visible_from(glm::vec3 viewpoint, const std::array<Neighbourhood64, 27>& paths,
                                        Neighbourhood64 among) const {
  for (const Sheet& sheet : sheets_) {
    const float here = glm::dot(sheet.normal, viewpoint) - sheet.offset;
    // It hides only voxels beyond the plane, and only where the path to them passes through its cells.
    const Neighbourhood64 across = among & (here > 0 ? ~sheet.positive : sheet.positive);
    if (across == 0) continue;
    Neighbourhood64 beyond = 0, past = 0;
    for (std::uint32_t cells = sheet.cells; cells != 0; cells &= cells - 1)
      beyond |= paths[static_cast<std::size_t>(std::countr_zero(cells))];
    for (std::uint32_t cells = sheet.open_cells; cells != 0; cells &= cells - 1)
      past |= paths[static_cast<std::size_t>(std::countr_zero(cells))];
    // Where the path passes through no other cell of the plane, the voxel is hidden.
    among &= ~(across & ~past);
    // Elsewhere it depends on the cell in which the path crosses the plane.
    for (Neighbourhood64 undecided = across & beyond & past; undecided != 0; undecided &= undecided - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(undecided));
      const float fraction = here / (here - sheet.distance[bit]);
      const Neighbourhood64 hidden =
          sheet.cells & cells_around(viewpoint.x + (kPoints.x[bit] - viewpoint.x) * fraction,
                                     viewpoint.y + (kPoints.y[bit] - viewpoint.y) * fraction,
                                     viewpoint.z + (kPoints.z[bit] - viewpoint.z) * fraction);
      among &= ~(Neighbourhood64{hidden != 0} << bit);
    }
    if (among == 0) break;
  }
  return among;
}

/// The voxels of `among` without those that one sheet alone hides from all points of a side.
Neighbourhood64 CellSight::possibly_visible(std::uint32_t samples, Neighbourhood64 among) const {
  // The cells that a path from any of the samples may pass through.
  std::array<Neighbourhood64, 27> paths{};
  for (std::uint32_t bits = samples; bits != 0; bits &= bits - 1) {
    const std::array<Neighbourhood64, 27>& of_sample =
        kPathsFromSamples[static_cast<std::size_t>(std::countr_zero(bits))];
    for (std::size_t i = 0; i < 27; ++i) paths[i] |= of_sample[i];
  }

  // A sheet hides nothing from samples on both of its sides.
  for (const Sheet& sheet : sheets_) {
    bool any_positive = false, any_negative = false;
    for (std::uint32_t bits = samples; bits != 0; bits &= bits - 1) {
      const bool positive = glm::dot(sheet.normal, sample_point(std::countr_zero(bits))) - sheet.offset > 0;
      any_positive |= positive;
      any_negative |= !positive;
    }
    if (any_positive && any_negative) continue;
    Neighbourhood64 past = 0;
    for (std::uint32_t cells = sheet.open_cells; cells != 0; cells &= cells - 1)
      past |= paths[static_cast<std::size_t>(std::countr_zero(cells))];
    among &= past | (any_positive ? sheet.positive : ~sheet.positive);
    if (among == 0) break;
  }
  return among;
}

Neighbourhood64 CellSight::visible(int side, Neighbourhood64 among) {
  if (flat_) return on_side(side, among);
  // The middle of the side stands for all of it; where nothing is visible from there, the samples decide.
  std::uint32_t samples = samples_[static_cast<std::size_t>(side)];
  if (samples == 0) return 0;
  const glm::vec3 middle = middles_[static_cast<std::size_t>(side)];
  if (const Neighbourhood64 result = visible_from(middle, paths_through_cells(middle), among); result != 0)
    return result;
  among = possibly_visible(samples, among);
  for (; samples != 0 && among != 0; samples &= samples - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(samples));
    const Neighbourhood64 result =
        visible_from(sample_point(static_cast<int>(i)), kPathsFromSamples[i], among);
    if (result != 0) return result;
  }
  return 0;
}

}  // namespace brume::smoke
