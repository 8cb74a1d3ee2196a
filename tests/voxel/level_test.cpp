#include "voxel/level.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/voxel/random.hpp"
#include "voxel/patched_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;
using glm::vec3;
using Triangles = std::vector<Triangle>;

int whole(Random& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

/// A random slab of triangles, partly outside of the grid, often on voxel faces.
Triangles random_part(Random& random, const GridLayout& layout) {
  Triangles part;
  const vec3 extent = layout.voxel_size * vec3(layout.size);
  const bool snapped = random() % 2 == 0;
  const auto corner = [&](vec3 around, float reach) {
    vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = around[axis] + uniform(random, -reach, reach);
      if (snapped) p[axis] = std::round(p[axis] / (0.5f * layout.voxel_size)) * (0.5f * layout.voxel_size);
    }
    return layout.origin_world + p;
  };
  const vec3 centre =
      extent * vec3(uniform(random, -0.1f, 1.1f), uniform(random, -0.1f, 1.1f), uniform(random, -0.1f, 1.1f));
  const float reach = layout.voxel_size * uniform(random, 0.3f, 6);
  for (int i = whole(random, 0, 80); i > 0; --i)
    part.push_back({corner(centre, reach), corner(centre, reach), corner(centre, reach)});
  if (random() % 4 == 0) part.push_back({vec3(NAN), vec3(1), vec3(2)});
  return part;
}

void expect_same_voxels(const BitGrid& a, const BitGrid& b, const char* what) {
  int differing = 0;
  for_each_in({ivec3(0), a.size()}, [&](ivec3 v) { differing += a.solid(v) != b.solid(v); });
  ASSERT_EQ(differing, 0) << what;
}

template <typename A, typename B>
void expect_same_planes(const A& a, const B& b, ivec3 size) {
  int differing = 0;
  for_each_in({ivec3(-1), size}, [&](ivec3 cell) {
    const auto p = a.at(cell), q = b.at(cell);
    differing += !std::equal(p.begin(), p.end(), q.begin(), q.end());
  });
  ASSERT_EQ(differing, 0);
}

/// The definition of a Level without its optimizations: all layers in order, over the whole grid.
struct Slow {
  struct Layer {
    std::uint32_t part;  // or none
    Box<int> box;
    bool solid;
  };
  static constexpr std::uint32_t kNone = ~0u;
  GridLayout layout;
  std::vector<Triangles> parts;
  std::vector<Layer> layers;
  std::vector<Role> roles = {};  // of the parts; those beyond its end are walls

  Role role(std::uint32_t part) const { return part < roles.size() ? roles[part] : Role::wall; }

  void hide(std::uint32_t part) {
    std::erase_if(layers, [&](const Layer& l) { return l.part == part; });
  }
  bool shown(std::uint32_t part) const {
    return std::any_of(layers.begin(), layers.end(), [&](const Layer& l) { return l.part == part; });
  }
  void put(std::uint32_t part) {
    hide(part);
    layers.push_back({part, {}, false});
  }
  /// Of parts with roles that stop something.
  BitGrid grid(bool (*stops)(Role) = stops_smoke) const {
    BitGrid grid(layout);
    for (const Layer& layer : layers) {
      if (layer.part == kNone) {
        for_each_in(intersection(layer.box, {ivec3(0), layout.size}),
                    [&](ivec3 v) { grid.set(v, layer.solid); });
        continue;
      }
      if (!stops(role(layer.part))) continue;
      const BitGrid drawn = voxelize(parts[layer.part], layout).value_or_throw();
      for_each_in({ivec3(0), layout.size}, [&](ivec3 v) {
        if (drawn.solid(v)) grid.set(v, true);
      });
    }
    return grid;
  }
  /// Of the parts alone.
  SurfacePlanes planes(const BitGrid& solid) const {
    Triangles all;
    for (std::uint32_t i = 0; i < parts.size(); ++i)
      if (shown(i) && stops_smoke(role(i))) all.insert(all.end(), parts[i].begin(), parts[i].end());
    return SurfacePlanes::build(all, solid);
  }
};

Triangles joined(const std::vector<Triangles>& parts) {
  Triangles all;
  for (const Triangles& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void take_change(const LevelChange& change, const BitGrid& old, const BitGrid& now, PatchedPlanes& planes) {
  for_each_in({ivec3(0), now.size()}, [&](ivec3 v) {
    if (change.voxels.contains(v)) {
      ASSERT_EQ(change.before.solid(v), old.solid(v));
    } else {
      ASSERT_EQ(old.solid(v), now.solid(v));
      ASSERT_FALSE(change.before.solid(v));
    }
  });
  planes.add(std::make_shared<const PlanePatch>(PlanePatch{change.cells, change.planes}));
}

/// What a change reports of the other grids.
void expect_same_before(const LevelChange& change, const BitGrid& sight, const BitGrid& bodies) {
  const Solids before(change.before, change.roles_before);
  for_each_in(change.voxels, [&](ivec3 v) {
    ASSERT_EQ(before.sight.solid(v), sight.solid(v));
    ASSERT_EQ(before.bodies.solid(v), bodies.solid(v));
  });
}

/// A level of random roles, or of walls.
Level level_of(const Slow& slow) {
  TrianglesByRole triangles;
  std::vector<LevelPart> parts;
  for (std::uint32_t i = 0; i < slow.parts.size(); ++i) {
    triangles.add(slow.role(i), slow.parts[i]);
    parts.push_back({slow.parts[i], slow.role(i)});
  }
  BitGrid grid = voxelize(triangles.smoke, slow.layout).value_or_throw();
  if (slow.roles.empty()) return {std::move(grid), slow.parts};
  RoleGrids roles = voxelize_roles(triangles, grid).value_or_throw();
  return {std::move(grid), std::move(roles), std::move(parts)};
}

void expect_same_solids(const Solids& solids, const Slow& slow) {
  expect_same_voxels(solids.smoke, slow.grid(), "smoke");
  expect_same_voxels(solids.sight, slow.grid(stops_sight), "sight");
  expect_same_voxels(solids.bodies, slow.grid(stops_bodies), "bodies");
}

/// Changes a level and its definition alike.
LevelChange random_change(Random& random, bool with_boxes, Level& level, Slow& slow) {
  const auto part = static_cast<std::uint32_t>(random() % slow.parts.size());
  const bool was_shown = slow.shown(part);
  switch (random() % (with_boxes ? 5 : 3)) {
    case 0: {
      was_shown ? slow.hide(part) : slow.put(part);
      return level.show({&part, 1}, !was_shown);
    }
    case 1: {
      slow.parts[part] = random_part(random, slow.layout);
      if (was_shown) slow.put(part);
      return level.replace(part, slow.parts[part]);
    }
    case 2: {
      const std::uint32_t added = level.add_part();
      slow.parts.push_back(random_part(random, slow.layout));
      slow.put(added);
      return level.replace(added, slow.parts.back());
    }
    default: {
      const ivec3 size = slow.layout.size;
      const ivec3 low(whole(random, -3, size.x), whole(random, -3, size.y), whole(random, -3, size.z));
      const Box<int> box{low, low + ivec3(whole(random, 0, 6), whole(random, 1, 6), whole(random, 1, 6))};
      const bool solid = random() % 2 == 0;
      if (!box.empty()) slow.layers.push_back({Slow::kNone, box, solid});
      return level.set_box(box, solid);
    }
  }
}

class RandomLevels : public testing::TestWithParam<ivec3> {};

TEST_P(RandomLevels, EveryChangeEqualsAFullRebuild) {
  for (const auto& [with_boxes, with_roles] :
       {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
    Random random(with_boxes ? 5 : 4);
    const GridLayout layout{GetParam(), 0.25f, vec3(-1.5f, 0.5f, 0)};
    Slow slow{layout, {}, {}};
    if (with_roles)
      slow.roles = {Role::glass, Role::wall, Role::grille, Role::ghost, Role::glass, Role::grille};
    for (std::uint32_t i = 0; i < 6; ++i) {
      slow.parts.push_back(random_part(random, layout));
      slow.put(i);
    }
    Level level = level_of(slow);
    expect_same_solids(level.solids(), slow);
    const SurfacePlanes first = slow.planes(level.grid());
    PatchedPlanes patched(first);
    for (int step = 0; step < 40; ++step) {
      const BitGrid old = level.grid(), sight = level.solids().sight, bodies = level.solids().bodies;
      const LevelChange change = random_change(random, with_boxes, level, slow);
      take_change(change, old, level.grid(), patched);
      expect_same_before(change, sight, bodies);
      expect_same_solids(level.solids(), slow);
      expect_same_planes(patched, level.planes_in({ivec3(-1), layout.size}), layout.size);
      if (!with_boxes) expect_same_planes(patched, slow.planes(slow.grid()), layout.size);
      if (HasFatalFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RandomLevels,
                         testing::Values(ivec3(1), ivec3(7), ivec3(33, 17, 5), ivec3(8, 16, 24)));

/// A wall of one voxel across z = 4..5 with a plane in its middle, from two triangles.
Triangles wall(float z) {
  const vec3 a(-1, -1, z), b(9, -1, z), c(9, 9, z), d(-1, 9, z);
  return {{a, b, c}, {a, c, d}};
}

TEST(Level, ClosingADoorRestoresTheLevel) {
  const GridLayout layout{{8, 8, 8}, 1, vec3(0)};
  const std::vector<Triangles> parts{wall(4.5f), {{{2, 0, 2.5f}, {5, 0, 2.5f}, {5, 6, 2.5f}}}};
  Level level(voxelize(joined(parts), layout).value_or_throw(), parts);
  const BitGrid shut = level.grid();
  const SurfacePlanes planes = SurfacePlanes::build(joined(parts), shut);
  const std::uint32_t door = 1;
  EXPECT_TRUE(level.grid().solid({4, 2, 2}));
  const LevelChange opened = level.show({&door, 1}, false);
  EXPECT_FALSE(level.grid().solid({4, 2, 2}));
  EXPECT_TRUE(opened.before.solid({4, 2, 2}));
  EXPECT_TRUE(opened.planes.at({4, 2, 2}).empty());
  EXPECT_FALSE(planes.at({4, 2, 2}).empty());
  EXPECT_TRUE(level.show({&door, 1}, false).voxels.empty());  // already open
  level.show({&door, 1}, true);
  expect_same_voxels(level.grid(), shut, "shut again");
  expect_same_planes(level.planes_in({ivec3(-1), layout.size}), planes, layout.size);
}

TEST(Level, ABoxOfSolidVoxelsHasPlanesAtItsSixFaces) {
  const GridLayout layout{{8, 8, 8}, 0.5f, vec3(-1.1f, 0.3f, 2.7f)};
  Level level(BitGrid(layout), {});
  level.set_box({{2, 3, 1}, {5, 6, 4}}, true);
  const auto only_plane = [&](ivec3 cell) {
    const SurfacePlanes planes = level.planes_in({ivec3(-1), layout.size});
    const auto at = planes.at(cell);
    EXPECT_EQ(at.size(), 1u);
    return at.empty() ? Plane{} : at[0];
  };
  // The face between voxels 1 and 2 is the middle of cell 1.
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      ivec3 cell(3, 4, 2);
      cell[axis] = (high ? ivec3(5, 6, 4) : ivec3(2, 3, 1))[axis] - 1;
      const Plane plane = only_plane(cell);
      EXPECT_NEAR(plane.normal[axis], 1, 1e-6);
      EXPECT_NEAR(plane.offset, 0, 1e-5);
    }
  }
  level.set_box({{2, 3, 1}, {5, 6, 4}}, false);
  EXPECT_EQ(level.grid().count_solid(), 0u);
  EXPECT_EQ(level.planes_in({ivec3(-1), layout.size}).cell_count(), 0u);
}

TEST(Level, AHoleInAWallRemovesItsSurfaceOnly) {
  const GridLayout layout{{8, 8, 8}, 1, vec3(0)};
  const std::vector<Triangles> parts{wall(4.5f)};
  Level level(voxelize(parts[0], layout).value_or_throw(), parts);
  const SurfacePlanes whole_wall = level.planes_in({ivec3(-1), layout.size});
  level.set_box({{2, 2, 3}, {6, 6, 7}}, false);
  EXPECT_TRUE(level.grid().free({3, 3, 4}));
  EXPECT_TRUE(level.grid().solid({1, 3, 4}));
  const SurfacePlanes planes = level.planes_in({ivec3(-1), layout.size});
  EXPECT_TRUE(planes.at({3, 3, 4}).empty());                        // all of its voxels are free
  EXPECT_EQ(planes.at({0, 3, 4}).size(), 1u);                       // none was touched
  EXPECT_EQ(planes.at({0, 3, 4})[0], whole_wall.at({0, 3, 4})[0]);  // and nothing moved
  ASSERT_EQ(planes.at({1, 3, 4}).size(), 1u);                       // half of it is wall
  EXPECT_NEAR(planes.at({1, 3, 4})[0].normal.z, 1, 1e-6);
  EXPECT_NEAR(planes.at({1, 3, 4})[0].offset, whole_wall.at({1, 3, 4})[0].offset, 1e-6);
}

TEST(Level, LaterLayersFillHoles) {
  const GridLayout layout{{8, 8, 8}, 1, vec3(0)};
  const std::vector<Triangles> parts{wall(4.5f), wall(2.5f)};
  Level level(voxelize(joined(parts), layout).value_or_throw(), parts);
  const std::uint32_t second = 1;
  level.show({&second, 1}, false);
  level.set_box({ivec3(0), ivec3(8)}, false);
  EXPECT_EQ(level.grid().count_solid(), 0u);
  level.show({&second, 1}, true);
  EXPECT_EQ(level.grid().count_solid(), 64u);
}

}  // namespace
}  // namespace brume::voxel
