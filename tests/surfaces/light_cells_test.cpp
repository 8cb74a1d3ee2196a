// Cells of indirect light and what their rays meet.
#include "surfaces/light_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/tasks.hpp"
#include "tests/render/boxes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::surfaces {
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
  scene.objects = {{"walls", 0, 0, glm::mat4(1)}};
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

// Free voxels are free cells, but not those between the two sides of a wall.
TEST(LightCells, AreFreeWhereTheLevelIsAndNotInsideOfWalls) {
  const Made made = cells_of(room(0));
  const std::set<std::uint32_t> probes(made.cells.probes.begin(), made.cells.probes.end());
  EXPECT_TRUE(std::ranges::is_sorted(made.cells.probes));
  std::size_t hollows = 0;
  for (std::uint32_t i = 0; i < 22u * 22 * 22; ++i) {
    const glm::vec3 a = glm::abs(centre_of(made.cells, i));
    const float farthest = std::max({a.x, a.y, a.z});
    const bool free = made.grid.free(shared::cell_at(made.cells.layout, i));
    const bool in_wall = farthest > kHalf && farthest < kOut;
    EXPECT_EQ(probes.contains(i), free && !in_wall) << i;
    hollows += free && in_wall;
  }
  EXPECT_GT(hollows, 0u);
}

TEST(LightCells, PatchesLieOnTheSurfaces) {
  const Made made = cells_of(room(0));
  std::size_t inner = 0;
  for (const shared::SurfacePatch& patch : made.cells.patches) {
    const glm::vec3 a = glm::abs(patch.position_world);
    const float farthest = std::max({a.x, a.y, a.z});
    if (farthest > 0.5f * (kHalf + kOut)) continue;  // of the walls' outer sides
    ++inner;
    EXPECT_NEAR(farthest, kHalf, 1e-4f);
    EXPECT_LT(glm::dot(patch.normal, patch.position_world), 0) << "towards the room";
    EXPECT_LT(glm::distance(patch.albedo, glm::vec3(0.2f, 0.4f, 0.6f)), 1e-6f);
  }
  // The walls run through voxels 2 and 18.
  EXPECT_EQ(inner, 6u * 15 * 15);
}

TEST(LightCells, RaysMeetThePatchNearestToWhereTheyEnd) {
  const Made made = cells_of(room(0));
  const LightCells& cells = made.cells;
  // A patch is in the middle of a cell's face; before a corner, in the last free cell, 1.3 cells from the
  // wall.
  const float farthest = std::sqrt(2.0f) * 1.3f * cells.layout.cell_size + 1e-4f;
  for (std::size_t i = 0; i < cells.probes.size(); ++i) {
    const glm::vec3 from = centre_of(cells, cells.probes[i]);
    if (!is_inside(from)) continue;
    const std::uint32_t phase = shared::probe_phase(shared::cell_at(cells.layout, cells.probes[i]));
    for (std::uint32_t r = 0; r < shared::kProbeRays; ++r) {
      const std::uint32_t hit = cells.hits[r * cells.probes.size() + i];
      ASSERT_NE(shared::hit_patch(hit), shared::kSkyPatch) << "the room is closed";
      const glm::vec3 direction = shared::probe_direction(r, phase);
      float reach = 1e9f;
      for (int axis = 0; axis < 3; ++axis) {
        const float ahead = direction[axis] < 0 ? -from[axis] : from[axis];
        reach = std::min(reach, (kHalf - ahead) / std::abs(direction[axis]));
      }
      EXPECT_NEAR(shared::hit_cells(hit), reach / cells.layout.cell_size, 0.25f + 1e-3f);
      const shared::SurfacePatch& patch = cells.patches[shared::hit_patch(hit)];
      EXPECT_LT(glm::distance(patch.position_world, from + reach * direction), farthest);
    }
  }
}

// What is drawn but not voxelized has no patch and lets rays pass.
TEST(LightCells, RaysPassWhatIsNotVoxelized) {
  const Made empty = cells_of(room(0));
  scene::Scene scene = room(0);
  render::add_box(scene.meshes.emplace_back(), {-0.51f, -1, -1}, {-0.49f, 1, 1});
  scene.objects.push_back({"curtain", 1, 0, glm::mat4(1), Role::ghost});
  const Made curtain = cells_of(scene);
  EXPECT_EQ(curtain.cells.probes, empty.cells.probes);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < empty.cells.hits.size(); ++i)
    differing += curtain.cells.hits[i] != empty.cells.hits[i];
  // Rounding of a ray's origin behind it.
  EXPECT_LT(differing, empty.cells.hits.size() / 100);
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

/// Irradiance at a probe by small emitters, of surfaces that face where the light comes from.
float emitted_to(const LightCells& cells, std::size_t probe) {
  float sum = 0;
  for (std::uint32_t r = 0; r < shared::kEmitterRays; ++r) {
    const shared::EmitterRay& ray = cells.emitter_rays[r * cells.probes.size() + probe];
    sum += ray.weight * shared::kRaySolidAngle * cells.emitter_samples[ray.emitter_sample].radiance.g;
  }
  return sum;
}

/// A room with a square that emits 5 W/(sr m^2), of this edge, in the plane x = 0.1.
scene::Scene lit_room(float edge, float y = 0.1f) {
  scene::Scene scene = room(0);
  scene::Mesh& panel = scene.meshes.emplace_back();
  for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
    panel.vertices.push_back({.position = {0.1f, y + 0.5f * edge * at.x, 0.1f + 0.5f * edge * at.y}});
  panel.indices = {0, 1, 2, 0, 2, 3};
  scene.materials.emplace_back().emission = glm::vec3(5);
  scene.objects.push_back({"panel", 1, 1, glm::mat4(1), Role::ghost});
  return scene;
}

// L A cos / d^2 [W/m^2]. Over the square, the second derivatives of x / d^3, of -3 / d^2 and at most 12 / d^2
// times its value, change its mean by 5/8 (edge / d)^2 at most; that the samples' middle is not the square's,
// by three times that distance over d.
TEST(LightCells, SmallEmittersSendTheirLightToAllProbes) {
  const float edge = 0.1f;
  const Made made = cells_of(lit_room(edge));
  ASSERT_FALSE(made.cells.emitter_rays.empty());
  for (const shared::SurfacePatch& patch : made.cells.patches) EXPECT_EQ(patch.emission, glm::vec3(0));
  glm::vec3 middle(0);
  for (const shared::EmitterSample& sample : made.cells.emitter_samples) middle += sample.position_world;
  const float aside =
      glm::distance(middle / static_cast<float>(made.cells.emitter_samples.size()), glm::vec3(0.1f));
  EXPECT_LT(aside, 0.1f * edge);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < made.cells.probes.size(); ++i) {
    const glm::vec3 path = centre_of(made.cells, made.cells.probes[i]) - glm::vec3(0.1f);
    const float distance = glm::length(path);
    if (!is_inside(centre_of(made.cells, made.cells.probes[i]))) {
      EXPECT_EQ(emitted_to(made.cells, i), 0) << "behind the walls";
      continue;
    }
    if (distance < 5 * edge || std::abs(path.x) < 2 * edge) continue;
    ++seen;
    const float expected = 5 * edge * edge * std::abs(path.x) / distance / (distance * distance);
    const float size = edge / distance, error = 0.625f * size * size + 3 * aside / distance + 1e-4f;
    EXPECT_NEAR(emitted_to(made.cells, i), expected, error * expected);
  }
  EXPECT_GT(seen, 1000u);
}

// Of a large one nearby, against its solid angle, which its samples find by importance.
TEST(LightCells, EmittersNearbyAreAsBrightAsTheirSolidAngle) {
  const float edge = 1;
  const Made made = cells_of(lit_room(edge));
  double found = 0, exact = 0;
  for (std::size_t i = 0; i < made.cells.probes.size(); ++i) {
    const glm::dvec3 from(centre_of(made.cells, made.cells.probes[i]) - glm::vec3(0.1f));
    if (std::abs(from.x) < 0.2 || std::abs(from.x) > 0.8 || std::max(std::abs(from.y), std::abs(from.z)) > 1)
      continue;
    // The solid angle of a rectangle, by its corners (van Oosterom and Strackee's formula for a right angle).
    double angle = 0;
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) {
        const double a = y - from.y, b = z - from.z, x = std::abs(from.x);
        angle += (y * z > 0 ? 1 : -1) * std::atan2(a * b, x * std::sqrt(a * a + b * b + x * x));
      }
    const double here = double{emitted_to(made.cells, i)};
    EXPECT_NEAR(here, 5 * angle, 0.35 * 5 * angle) << from.x << ' ' << from.y << ' ' << from.z;
    found += here;
    exact += 5 * angle;
  }
  EXPECT_NEAR(found, exact, 0.03 * exact);
}

TEST(LightCells, LargeEmittersAreLeftToThePatches) {
  scene::Scene scene = room(0);
  scene.materials[0].emission = glm::vec3(1);
  const Made made = cells_of(scene);
  EXPECT_TRUE(made.cells.emitter_rays.empty());
  EXPECT_TRUE(made.cells.emitter_samples.empty());
  for (const shared::SurfacePatch& patch : made.cells.patches) {
    const bool is_unknown = patch.albedo == glm::vec3(0.5f);  // No ray met the wall.
    EXPECT_EQ(patch.emission, glm::vec3(is_unknown ? 0 : 1));
  }
}

TEST(LightCells, AreTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const Made one = cells_of(room(0.1f));
  set_thread_count(3);
  const Made three = cells_of(room(0.1f));
  set_thread_count(0);
  EXPECT_EQ(one.cells.probes, three.cells.probes);
  EXPECT_EQ(one.cells.hits, three.cells.hits);
  ASSERT_EQ(one.cells.patches.size(), three.cells.patches.size());
  for (std::size_t i = 0; i < one.cells.patches.size(); ++i)
    EXPECT_EQ(one.cells.patches[i].position_world, three.cells.patches[i].position_world);
}

}  // namespace
}  // namespace brume::surfaces
