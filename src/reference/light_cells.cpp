#include "reference/light_cells.hpp"

#include <algorithm>
#include <bit>

#include "core/tasks.hpp"
#include "shared/light.h"

namespace brume::reference {
namespace {

constexpr std::uint32_t kFaces = 6;
constexpr float kUnknownAlbedo = 0.5f;

glm::ivec3 cells_of(glm::ivec3 voxels, int edge) {
  return (voxels + (edge - 1)) / edge;
}

/// Which cells are solid: those with at least half of a wall of one voxel across them.
std::vector<std::uint32_t> solid_cells(const voxel::BitGrid& grid, int edge, glm::ivec3 size) {
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                                    static_cast<std::size_t>(size.z));
  grid.for_each_brick([&](glm::ivec3 brick, const voxel::BitGrid::Brick& words) {
    for (int z = 0; z < voxel::kBrickSize; ++z)
      for (std::uint64_t left = words[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const glm::ivec3 cell = (brick * voxel::kBrickSize + glm::ivec3(bit & 7, bit >> 3, z)) / edge;
        ++counts[static_cast<std::size_t>(cell.x + size.x * (cell.y + size.y * cell.z))];
      }
  });
  const auto half_a_wall = static_cast<std::uint32_t>((edge * edge + 1) / 2);
  for (std::uint32_t& count : counts) count = count >= half_a_wall ? shared::kSolidCell : 0;
  return counts;
}

/// Means of what rays meet.
struct PatchSum {
  shared::SurfacePatch sum{};
  float hits = 0;

  void add(const Surfaces& surfaces, const Ray& ray) {
    const std::optional<SurfaceHit> hit = surfaces.hit(ray);
    if (!hit) return;
    sum.position_world += hit->position;
    sum.normal += hit->geometric_normal;
    sum.albedo += hit->reflection.albedo;
    sum.emission += hit->emission;
    ++hits;
  }
};

/// The piece of surface that a cell sees in a neighbour.
shared::SurfacePatch patch_of(const Surfaces& surfaces, glm::vec3 centre_world, std::uint32_t face,
                              float cell) {
  const glm::vec3 forward = shared::cube_forward(face), up = shared::cube_up(face),
                  right = shared::cube_right(face);
  PatchSum patch;
  // To the far side of the neighbour, first straight, else obliquely.
  for (const float slope : {0.0f, 0.3f}) {
    for (int i = 0; i < 4 && (slope > 0 || i < 4); ++i) {
      const glm::vec3 aside = (i & 1 ? 1.0f : -1.0f) * right + (i & 2 ? 1.0f : -1.0f) * up;
      const glm::vec3 from = centre_world + (0.25f * cell) * aside;
      patch.add(surfaces, {from, glm::normalize(forward + slope * aside), 1.6f * cell});
    }
    if (patch.hits > 0) break;
  }
  if (patch.hits == 0)
    return {centre_world + (0.5f * cell) * forward, -forward, glm::vec3(kUnknownAlbedo), glm::vec3(0)};
  const shared::SurfacePatch& sum = patch.sum;
  const float length = glm::length(sum.normal);
  return {sum.position_world / patch.hits, length > 1e-3f ? sum.normal / length : -forward,
          sum.albedo / patch.hits, sum.emission / patch.hits};
}

/// Finds the patch of a place on a surface.
class PatchFinder {
 public:
  explicit PatchFinder(const LightCells& level) : level_(level), all_{glm::ivec3(0), level.layout.size} {}

  /// The patch that is most like the place: of the free cell before it where that has one, else of the
  /// neighbours. kSkyPatch: there is none nearby.
  std::uint32_t operator()(const Surfaces::Place& place) const {
    const float cell = level_.layout.cell_size;
    const glm::vec3 before = (place.position - level_.layout.origin_world) / cell + 0.5f * place.normal;
    const glm::ivec3 middle(glm::floor(before));
    Best best;
    add_cell(middle, place, best);
    if (best.patch != shared::kSkyPatch) return best.patch;
    for_each_in(Box<int>{middle - 1, middle + 2}, [&](glm::ivec3 c) { add_cell(c, place, best); });
    return best.patch;
  }

 private:
  struct Best {
    std::uint32_t patch = shared::kSkyPatch;
    float unlikeness = 1e30f;
  };

  void add_cell(glm::ivec3 cell, const Surfaces::Place& place, Best& best) const {
    if (!all_.contains(cell)) return;
    const glm::ivec3 size = level_.layout.size;
    const std::uint32_t word =
        level_.cells[static_cast<std::size_t>(cell.x + size.x * (cell.y + size.y * cell.z))];
    if (word == shared::kSolidCell) return;
    const std::uint32_t first = word >> shared::kPatchShift;
    const auto count = static_cast<std::uint32_t>(std::popcount(word & shared::kPatchFaces));
    for (std::uint32_t i = first; i < first + count; ++i) {
      const shared::SurfacePatch& patch = level_.patches[i];
      const float facing = glm::dot(patch.normal, place.normal);
      if (facing <= 0.1f) continue;
      const glm::vec3 apart = (patch.position_world - place.position) / level_.layout.cell_size;
      const float unlikeness = glm::dot(apart, apart) + 2 * (1 - facing);
      if (unlikeness < best.unlikeness) best = {i, unlikeness};
    }
  }

  const LightCells& level_;
  Box<int> all_;
};

/// What the rays of each probe meet.
std::vector<std::uint32_t> trace_probes(const LightCells& level, const Surfaces& surfaces) {
  const std::size_t probes = level.probes.size();
  std::vector<std::uint32_t> hits(probes * shared::kProbeRays);
  const PatchFinder patch_at(level);
  const float cell_size = level.layout.cell_size;
  parallel_for(probes, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::ivec3 cell = shared::cell_at(level.layout, level.probes[i]);
      const glm::vec3 centre = level.layout.origin_world + (glm::vec3(cell) + 0.5f) * cell_size;
      for (std::uint32_t r = 0; r < shared::kProbeRays; ++r) {
        const Ray ray{centre, shared::probe_direction(r, shared::probe_phase(cell))};
        const std::optional<Surfaces::Place> place = surfaces.place(ray);
        hits[r * probes + i] =
            place ? shared::pack_hit(patch_at(*place), glm::distance(place->position, centre) / cell_size)
                  : shared::pack_hit(shared::kSkyPatch, 512);
      }
    }
  });
  return hits;
}

}  // namespace

int voxels_per_light_cell(glm::ivec3 voxels) {
  for (int edge = 1;; ++edge) {
    const glm::u64vec3 cells(cells_of(voxels, edge));
    if (cells.x * cells.y * cells.z <= kMaxLightCells) return edge;
  }
}

LightCells make_light_cells(const voxel::BitGrid& grid, const Surfaces& surfaces) {
  const int edge = voxels_per_light_cell(grid.size());
  LightCells level;
  level.layout.origin_world = grid.layout().origin_world;
  level.layout.cell_size = grid.layout().voxel_size * static_cast<float>(edge);
  level.layout.size = cells_of(grid.size(), edge);
  level.cells = solid_cells(grid, edge, level.layout.size);

  // Free cells, and which of their neighbours are solid.
  const glm::ivec3 size = level.layout.size;
  const auto index = [&](glm::ivec3 c) {
    return static_cast<std::size_t>(c.x + size.x * (c.y + size.y * c.z));
  };
  const Box<int> all{glm::ivec3(0), size};
  std::vector<std::pair<glm::ivec3, std::uint32_t>> faces;
  for_each_in(all, [&](glm::ivec3 cell) {
    std::uint32_t& word = level.cells[index(cell)];
    if (word == shared::kSolidCell) return;
    level.probes.push_back(static_cast<std::uint32_t>(index(cell)));
    word = static_cast<std::uint32_t>(faces.size()) << shared::kPatchShift;
    for (std::uint32_t face = 0; face < kFaces; ++face) {
      const glm::ivec3 next = cell + glm::ivec3(shared::cube_forward(face));
      if (!all.contains(next) || level.cells[index(next)] != shared::kSolidCell) continue;
      word |= 1u << face;
      faces.emplace_back(cell, face);
    }
  });
  std::ranges::sort(level.probes);

  level.patches.resize(faces.size());
  parallel_for(faces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 centre =
          level.layout.origin_world + (glm::vec3(faces[i].first) + 0.5f) * level.layout.cell_size;
      level.patches[i] = patch_of(surfaces, centre, faces[i].second, level.layout.cell_size);
    }
  });
  level.hits = trace_probes(level, surfaces);
  return level;
}

}  // namespace brume::reference
