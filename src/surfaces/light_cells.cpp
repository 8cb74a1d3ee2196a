#include "surfaces/light_cells.hpp"

#include <algorithm>
#include <array>

#include "core/tasks.hpp"
#include "shared/light.h"
#include "surfaces/small_emitters.hpp"
#include "voxel/coarse_solid.hpp"

namespace brume::surfaces {
namespace {

constexpr std::uint32_t kFaces = 6;
constexpr float kUnknownAlbedo = 0.5f;
constexpr std::uint32_t kNoPatch = shared::kSkyPatch;

/// The patches on the faces of a cell.
using CellPatches = std::array<std::uint32_t, kFaces>;

/// Which cells are free, and where they are.
class CellGrid {
 public:
  CellGrid(const voxel::BitGrid& grid, const shared::IndirectLayout& layout, int edge)
      : layout_(layout), all_{glm::ivec3(0), layout.size}, solid_(voxel::coarse_solid(grid, edge, all_)) {}

  std::uint32_t count() const { return static_cast<std::uint32_t>(solid_.size()); }
  bool is_free(glm::ivec3 cell) const { return all_.contains(cell) && !solid_[index(cell)]; }
  bool is_solid(glm::ivec3 cell) const { return all_.contains(cell) && solid_[index(cell)]; }
  bool is_at_border(glm::ivec3 cell) const {
    return glm::any(glm::equal(cell, all_.low)) || glm::any(glm::equal(cell, all_.high - 1));
  }
  void make_solid(std::uint32_t cell) { solid_[cell] = true; }
  std::uint32_t index(glm::ivec3 cell) const {
    return static_cast<std::uint32_t>(cell.x + layout_.size.x * (cell.y + layout_.size.y * cell.z));
  }
  glm::ivec3 at(std::uint32_t index) const { return shared::cell_at(layout_, index); }
  glm::vec3 centre(std::uint32_t index) const {
    return layout_.origin_world + (glm::vec3(at(index)) + 0.5f) * layout_.cell_size;
  }
  const shared::IndirectLayout& layout() const { return layout_; }

 private:
  shared::IndirectLayout layout_;
  Box<int> all_;
  std::vector<bool> solid_;
};

/// The free cells that faces connect to a cell.
std::vector<std::uint32_t> connected_cells(const CellGrid& grid, std::uint32_t first,
                                           std::vector<bool>& found) {
  std::vector<std::uint32_t> cells{first};
  found[first] = true;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::uint32_t face = 0; face < kFaces; ++face) {
      const glm::ivec3 next = grid.at(cells[i]) + glm::ivec3(shared::cube_forward(face));
      if (!grid.is_free(next) || found[grid.index(next)]) continue;
      found[grid.index(next)] = true;
      cells.push_back(grid.index(next));
    }
  return cells;
}

/// Whether most rays from some cells meet surfaces from behind.
bool are_inside_of_objects(const CellGrid& grid, std::span<const std::uint32_t> cells,
                           const Surfaces& surfaces) {
  std::size_t rays = 0, backs = 0;
  for (const std::uint32_t cell : cells)
    for (std::uint32_t r = 0; r < shared::kProbeRays; ++r, ++rays) {
      const glm::vec3 direction = shared::probe_direction(r, shared::probe_phase(grid.at(cell)));
      const std::optional<Surfaces::Place> place = surfaces.place({grid.centre(cell), direction});
      backs += place && !place->is_front;
    }
  return 2 * backs > rays;
}

/// Makes the hollows of closed objects solid: of thick walls, for instance, beside which they would count as
/// dark air.
void close_hollows(CellGrid& grid, const Surfaces& surfaces) {
  std::vector<bool> found(grid.count());
  for (std::uint32_t cell = 0; cell < grid.count(); ++cell) {
    if (found[cell] || !grid.is_free(grid.at(cell))) continue;
    const std::vector<std::uint32_t> cells = connected_cells(grid, cell, found);
    if (std::ranges::any_of(cells, [&](std::uint32_t each) { return grid.is_at_border(grid.at(each)); }))
      continue;
    if (!are_inside_of_objects(grid, cells, surfaces)) continue;
    for (const std::uint32_t each : cells) grid.make_solid(each);
  }
}

/// Means of what rays meet.
struct PatchSum {
  shared::SurfacePatch sum{};
  float hits = 0;

  void add(const Surfaces& surfaces, const SmallEmitters& small, const Ray& ray) {
    const std::optional<SurfaceHit> hit = surfaces.hit(ray);
    if (!hit) return;
    sum.position_world += hit->position;
    sum.normal += hit->geometric_normal;
    sum.albedo += hit->reflection.albedo;
    if (!small.contains(*hit)) sum.emission += hit->emission;
    ++hits;
  }
};

/// The piece of surface that a cell sees in a neighbour.
shared::SurfacePatch patch_of(const Surfaces& surfaces, const SmallEmitters& small, glm::vec3 centre_world,
                              std::uint32_t face, float cell) {
  const glm::vec3 forward = shared::cube_forward(face), up = shared::cube_up(face),
                  right = shared::cube_right(face);
  PatchSum patch;
  const auto add_rays = [&](float slope) {
    for (int i = 0; i < 4; ++i) {
      const glm::vec3 aside = (i & 1 ? 1.0f : -1.0f) * right + (i & 2 ? 1.0f : -1.0f) * up;
      const glm::vec3 from = centre_world + (0.25f * cell) * aside;
      // To the far side of the neighbour.
      patch.add(surfaces, small, {from, glm::normalize(forward + slope * aside), 1.6f * cell});
    }
  };
  add_rays(0);
  if (patch.hits == 0) add_rays(0.3f);
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
  PatchFinder(const CellGrid& grid, const std::vector<CellPatches>& cells,
              const std::vector<shared::SurfacePatch>& patches)
      : grid_(grid), cells_(cells), patches_(patches) {}

  /// The patch that is most like the place: of the free cell before it where that has one, else of the
  /// neighbours. kNoPatch: there is none nearby.
  std::uint32_t operator()(const Surfaces::Place& place) const {
    const shared::IndirectLayout& layout = grid_.layout();
    const glm::vec3 before = (place.position - layout.origin_world) / layout.cell_size + 0.5f * place.normal;
    const glm::ivec3 middle(glm::floor(before));
    Best best;
    add_cell(middle, place, best);
    if (best.patch != kNoPatch) return best.patch;
    for_each_in(Box<int>{middle - 1, middle + 2}, [&](glm::ivec3 c) { add_cell(c, place, best); });
    return best.patch;
  }

 private:
  struct Best {
    std::uint32_t patch = kNoPatch;
    float unlikeness = 1e30f;
  };

  void add_cell(glm::ivec3 cell, const Surfaces::Place& place, Best& best) const {
    if (!grid_.is_free(cell)) return;
    for (const std::uint32_t i : cells_[grid_.index(cell)]) {
      if (i == kNoPatch) continue;
      const float facing = glm::dot(patches_[i].normal, place.normal);
      if (facing <= 0.1f) continue;
      const glm::vec3 apart = (patches_[i].position_world - place.position) / grid_.layout().cell_size;
      const float unlikeness = glm::dot(apart, apart) + 2 * (1 - facing);
      if (unlikeness < best.unlikeness) best = {i, unlikeness};
    }
  }

  const CellGrid& grid_;
  const std::vector<CellPatches>& cells_;
  const std::vector<shared::SurfacePatch>& patches_;
};

/// The patches between free cells and solid ones, and which each cell has.
std::vector<CellPatches> add_patches(const CellGrid& grid, const Surfaces& surfaces,
                                     const SmallEmitters& small, LightCells& level) {
  struct Face {
    std::uint32_t cell, face;
  };
  std::vector<Face> faces;
  std::vector<CellPatches> of_cells(grid.count());
  for (std::uint32_t cell = 0; cell < grid.count(); ++cell) {
    of_cells[cell].fill(kNoPatch);
    if (!grid.is_free(grid.at(cell))) continue;
    for (std::uint32_t face = 0; face < kFaces; ++face) {
      if (!grid.is_solid(grid.at(cell) + glm::ivec3(shared::cube_forward(face)))) continue;
      of_cells[cell][face] = static_cast<std::uint32_t>(faces.size());
      faces.push_back({cell, face});
    }
  }
  level.patches.resize(faces.size());
  parallel_for(faces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      level.patches[i] =
          patch_of(surfaces, small, grid.centre(faces[i].cell), faces[i].face, level.layout.cell_size);
  });
  return of_cells;
}

/// The first patch that a ray meets, and how far away, in cells. What has no patch lets it pass: it is not
/// voxelized, as what smoke passes through.
std::uint32_t trace(const Surfaces& surfaces, const PatchFinder& patch_at, Ray ray, float cell_size) {
  constexpr int kMostSurfaces = 16;
  constexpr float kBehind = 1e-3f;  // from a surface to where the ray goes on [m]
  const glm::vec3 from = ray.origin;
  for (int i = 0; i < kMostSurfaces; ++i) {
    const std::optional<Surfaces::Place> place = surfaces.place(ray);
    if (!place) break;
    if (const std::uint32_t patch = patch_at(*place); patch != kNoPatch)
      return shared::pack_hit(patch, glm::distance(place->position, from) / cell_size);
    ray.origin = place->position + kBehind * ray.direction;
  }
  return shared::pack_hit(shared::kSkyPatch, shared::kMostHitCells);
}

/// What the rays of each probe meet.
std::vector<std::uint32_t> trace_probes(const CellGrid& grid, const Surfaces& surfaces,
                                        std::span<const std::uint32_t> probes, const PatchFinder& patch_at) {
  std::vector<std::uint32_t> hits(probes.size() * shared::kProbeRays);
  parallel_for(probes.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 centre = grid.centre(probes[i]);
      for (std::uint32_t r = 0; r < shared::kProbeRays; ++r) {
        const Ray ray{centre, shared::probe_direction(r, shared::probe_phase(grid.at(probes[i])))};
        hits[r * probes.size() + i] = trace(surfaces, patch_at, ray, grid.layout().cell_size);
      }
    }
  });
  return hits;
}

std::vector<shared::EmitterRay> emitter_rays(const CellGrid& grid, const SmallEmitters& small,
                                             std::span<const std::uint32_t> probes) {
  std::vector<shared::EmitterRay> all(probes.size() * shared::kEmitterRays);
  parallel_for(probes.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::array<shared::EmitterRay, shared::kEmitterRays> rays;
    for (std::size_t i = begin; i < end; ++i) {
      small.find_rays(grid.centre(probes[i]), shared::probe_phase(grid.at(probes[i])), rays);
      for (std::size_t r = 0; r < rays.size(); ++r) all[r * probes.size() + i] = rays[r];
    }
  });
  return all;
}

}  // namespace

LightCells make_light_cells(const voxel::BitGrid& grid, const Surfaces& surfaces) {
  const int edge = voxel::coarse_edge(grid.size(), kMaxLightCells, kMaxLightCellsPerAxis);
  LightCells level;
  level.layout.origin_world = grid.layout().origin_world;
  level.layout.cell_size = grid.layout().voxel_size * static_cast<float>(edge);
  level.layout.size = voxel::coarse_size(grid.size(), edge);
  CellGrid cells(grid, level.layout, edge);
  close_hollows(cells, surfaces);
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell)
    if (cells.is_free(cells.at(cell))) level.probes.push_back(cell);

  const SmallEmitters small(surfaces, level.layout.cell_size);
  if (!small.empty()) {
    level.emitter_samples.assign(small.samples().begin(), small.samples().end());
    level.emitter_rays = emitter_rays(cells, small, level.probes);
  }
  const std::vector<CellPatches> of_cells = add_patches(cells, surfaces, small, level);
  level.hits = trace_probes(cells, surfaces, level.probes, PatchFinder(cells, of_cells, level.patches));
  return level;
}

}  // namespace brume::surfaces
