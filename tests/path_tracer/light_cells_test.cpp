// Cells of indirect light and what their rays meet.
#include "reference/light_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "core/tasks.hpp"
#include "tests/render/boxes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::reference {
namespace {

constexpr float kHalf = 2, kWall = 0.3f, kOut = kHalf + kWall;

/// A closed room; with a slit of this width in the wall towards +x, over its whole height.
scene::Scene room(float slit) {
  scene::Scene scene;
  scene::Mesh& walls = scene.meshes.emplace_back();
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 low(-kOut), high(kOut);
      (side < 0 ? high : low)[axis] = side * kHalf;
      if (axis != 0 || side < 0 || slit <= 0) {
        render::add_box(walls, low, high);
        continue;
      }
      render::add_box(walls, low, {high.x, high.y, -0.5f * slit});
      render::add_box(walls, {low.x, low.y, 0.5f * slit}, high);
    }
  scene.materials.resize(1);
  scene.materials[0].base_color = {0.2f, 0.4f, 0.6f};
  scene.objects = {{"walls", 0, 0, glm::mat4(1), true}};
  return scene;
}

struct Made {
  voxel::BitGrid grid;
  LightCells cells;
};

Made cells_of(const scene::Scene& scene) {
  std::vector<voxel::Triangle> triangles;
  const scene::Mesh& mesh = scene.meshes.front();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.push_back({mesh.vertices[mesh.indices[i]].position, mesh.vertices[mesh.indices[i + 1]].position,
                         mesh.vertices[mesh.indices[i + 2]].position});
  voxel::BitGrid grid =
      voxel::voxelize(triangles, {glm::ivec3(22), 0.25f, glm::vec3(-2.7f)}).value_or_throw();
  const planning::LevelState level;
  const Surfaces surfaces(scene, {&level, 1});
  LightCells cells = make_light_cells(grid, surfaces);
  return {std::move(grid), std::move(cells)};
}

/// Half a cell away from the walls, or more.
bool is_inside(const glm::vec3& p) {
  return glm::all(glm::lessThan(glm::abs(p), glm::vec3(kHalf - 0.01f)));
}

glm::vec3 centre_of(const LightCells& cells, std::uint32_t index) {
  return cells.layout.origin_world +
         (glm::vec3(shared::cell_at(cells.layout, index)) + 0.5f) * cells.layout.cell_size;
}

TEST(LightCells, AreFreeWhereTheLevelIs) {
  const Made made = cells_of(room(0));
  const std::set<std::uint32_t> probes(made.cells.probes.begin(), made.cells.probes.end());
  EXPECT_TRUE(std::ranges::is_sorted(made.cells.probes));
  for (std::uint32_t i = 0; i < made.cells.cells.size(); ++i) {
    const bool free = made.grid.free(shared::cell_at(made.cells.layout, i));
    EXPECT_EQ(made.cells.cells[i] != shared::kSolidCell, free);
    EXPECT_EQ(probes.contains(i), free);
  }
}

TEST(LightCells, PatchesLieOnTheSurfaces) {
  const Made made = cells_of(room(0));
  std::size_t count = 0;
  for (const std::uint32_t probe : made.cells.probes) {
    if (!is_inside(centre_of(made.cells, probe))) continue;
    const std::uint32_t word = made.cells.cells[probe], first = word >> shared::kPatchShift;
    const auto patches = static_cast<std::uint32_t>(std::popcount(word & shared::kPatchFaces));
    for (std::uint32_t i = first; i < first + patches; ++i, ++count) {
      const shared::SurfacePatch& patch = made.cells.patches[i];
      const glm::vec3 a = glm::abs(patch.position_world);
      EXPECT_NEAR(std::max({a.x, a.y, a.z}), kHalf, 1e-4f);
      EXPECT_LT(glm::dot(patch.normal, patch.position_world), 0) << "towards the room";
      EXPECT_LT(glm::distance(patch.albedo, glm::vec3(0.2f, 0.4f, 0.6f)), 1e-6f);
    }
  }
  EXPECT_GE(count, 6u * 14 * 14);
}

TEST(LightCells, RaysMeetThePatchNearestToWhereTheyEnd) {
  const Made made = cells_of(room(0));
  const LightCells& cells = made.cells;
  for (std::size_t i = 0; i < cells.probes.size(); ++i) {
    const glm::vec3 from = centre_of(cells, cells.probes[i]);
    if (!is_inside(from)) continue;
    const std::uint32_t phase = shared::probe_phase(shared::cell_at(cells.layout, cells.probes[i]));
    for (std::uint32_t r = 0; r < shared::kProbeRays; ++r) {
      const std::uint32_t hit = cells.hits[r * cells.probes.size() + i];
      ASSERT_NE(shared::hit_patch(hit), shared::kSkyPatch) << "the room is closed";
      const glm::vec3 direction = shared::probe_direction(r, phase);
      float reach = 1e9f;
      for (int axis = 0; axis < 3; ++axis)
        reach = std::min(reach,
                         std::abs(((direction[axis] > 0 ? kHalf : -kHalf) - from[axis]) / direction[axis]));
      EXPECT_NEAR(shared::hit_cells(hit), reach / cells.layout.cell_size, 0.26f);
      const shared::SurfacePatch& patch = cells.patches[shared::hit_patch(hit)];
      // A cell's diagonal, and half of another one in corners, whose patches are those of their neighbours.
      EXPECT_LT(glm::distance(patch.position_world, from + reach * direction), 1.6f * cells.layout.cell_size);
    }
  }
}

// A gap narrower than a voxel, which voxels close, lets rays through.
TEST(LightCells, RaysPassThroughSlits) {
  const auto open = [](const LightCells& cells) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < cells.probes.size(); ++i)
      for (std::uint32_t r = 0; r < shared::kProbeRays && is_inside(centre_of(cells, cells.probes[i])); ++r)
        count += shared::hit_patch(cells.hits[r * cells.probes.size() + i]) == shared::kSkyPatch;
    return count;
  };
  const Made closed = cells_of(room(0)), slit = cells_of(room(0.1f));
  EXPECT_EQ(open(closed.cells), 0u);
  EXPECT_GT(open(slit.cells), 0u);
}

TEST(LightCells, AreTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const Made one = cells_of(room(0.1f));
  set_thread_count(3);
  const Made three = cells_of(room(0.1f));
  set_thread_count(0);
  EXPECT_EQ(one.cells.cells, three.cells.cells);
  EXPECT_EQ(one.cells.hits, three.cells.hits);
  ASSERT_EQ(one.cells.patches.size(), three.cells.patches.size());
  for (std::size_t i = 0; i < one.cells.patches.size(); ++i)
    EXPECT_EQ(one.cells.patches[i].position_world, three.cells.patches[i].position_world);
}

TEST(LightCells, LargeLevelsHaveLargerCells) {
  EXPECT_EQ(voxels_per_light_cell({40, 20, 42}), 1);
  EXPECT_EQ(voxels_per_light_cell({114, 38, 114}), 2);
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(7, 1, 33), glm::ivec3(4096, 7, 4096)}) {
    const int edge = voxels_per_light_cell(size);
    const glm::u64vec3 cells((size + (edge - 1)) / edge);
    EXPECT_LE(cells.x * cells.y * cells.z, kMaxLightCells);
  }
}

}  // namespace
}  // namespace brume::reference
