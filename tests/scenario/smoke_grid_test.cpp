#include "scenario/smoke_grid.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/box.hpp"
#include "grids/check.hpp"
#include "sim/world.hpp"
#include "smoke/noise_look.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::scenario {
namespace {

/// A hall with a wall across, two smokes that overlap, and a blast.
struct Hall {
  Hall() {
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 17; ++z) level.set({14, y, z}, true);
    const auto at = [](double x, double y, double z) { return sim::position_from_metres({x, y, z}); };
    world.append(sim::ThrowSmoke{0, at(-3, 1, 0), at(-3, 1, 0), {900, 64, 100, 60}}).value_or_throw();
    world.append(sim::ThrowSmoke{20, at(-2, 1, 1), at(-2, 1, 1), {500, 40, 70, 40}}).value_or_throw();
    world.append(sim::Blast{.tick = 80, .at = at(-3, 1, 0), .radius = 2048, .refill_middle_ms = 900})
        .value_or_throw();
  }
  voxel::BitGrid level{{{29, 13, 25}, 0.5f, glm::vec3(-7.25f, -0.5f, -5)}};
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build({}, level);
  sim::World world{level};
};

struct Value {
  float density = 0;
  bool active = false;
};
Value value_at(const grids::Grid& grid, glm::ivec3 voxel) {
  const auto brick = grids::find_brick(grid, voxel & ~7);
  if (!brick) return {};
  const glm::uvec3 local(voxel & 7);
  const std::size_t i = local.x + 8 * (local.y + 8 * local.z);
  Value value{0, grid.bricks[*brick].is_active(i)};
  std::memcpy(&value.density, grid.values_of(*brick).data() + i * sizeof(float), sizeof(float));
  return value;
}

/// Density in [0, 255] as the renderer has it.
std::uint8_t texel_at(const smoke::SmokeVolume& volume, glm::ivec3 voxel) {
  const std::uint32_t slot = volume.slot_at(voxel >> 3);
  if (slot == smoke::SmokeVolume::kNoSlot) return 0;
  const glm::uvec3 texel((voxel & 7) + 1);
  return volume.texels(slot)[texel.x + 10 * (texel.y + 10 * texel.z)].density;
}

template <typename T>
T metadata_of(const grids::Grid& grid, const std::string& name, const std::string& type) {
  T value{};
  for (const grids::Metadata& entry : grid.metadata) {
    if (entry.name != name) continue;
    EXPECT_EQ(entry.type, type);
    EXPECT_EQ(entry.bytes.size(), sizeof value);
    std::memcpy(&value, entry.bytes.data(), sizeof value);
    return value;
  }
  ADD_FAILURE() << "no " << name;
  return value;
}

TEST(SmokeGrid, HoldsTheDensitiesOfStateAndVolume) {
  Hall hall;
  smoke::SmokeVolume volume(hall.level, hall.planes);
  for (const std::uint32_t tick : {0u, 30u, 70u, 90u, 200u, 400u}) {
    hall.world.advance_to(tick);
    volume.update(hall.world);
    const grids::Grid grid = smoke_grid(hall.world.state(), {UpAxis::y, 2.5f});
    ASSERT_TRUE(grids::check_grid(grid));
    const glm::ivec3 size = hall.level.size();
    std::uint64_t active = 0;
    for (int i = 0; i < size.x * size.y * size.z; ++i) {
      const glm::ivec3 voxel(i % size.x, i / size.x % size.y, i / size.x / size.y);
      const Value value = value_at(grid, voxel);
      const float state = static_cast<float>(hall.world.state().density(voxel)) / 255;
      ASSERT_EQ(value.density, state) << i;
      ASSERT_EQ(value.density, static_cast<float>(texel_at(volume, voxel)) / 255) << i;
      ASSERT_EQ(value.active, state > 0) << i;
      active += value.active;
    }
    EXPECT_EQ(grids::count_active(grid), active) << "none outside of the level";
    EXPECT_EQ(active > 100, tick > 0 && tick < 400) << tick;
  }
}

TEST(SmokeGrid, LiesInTheWorld) {
  Hall hall;
  hall.world.advance_to(70);
  const voxel::GridLayout& layout = hall.level.layout();
  const auto world_of = [&](UpAxis up, glm::ivec3 voxel) {
    const grids::Grid grid = smoke_grid(hall.world.state(), {up, 1});
    return glm::dvec3(grid.world_from_index * glm::dvec4(glm::dvec3(voxel), 1));
  };
  for (const glm::ivec3 voxel : {glm::ivec3(0), glm::ivec3(3, 7, 11), glm::ivec3(28, 12, 24)}) {
    const glm::dvec3 centre(voxel::world_from_voxel(layout, glm::vec3(voxel) + 0.5f));
    EXPECT_EQ(world_of(UpAxis::y, voxel), centre);
    EXPECT_EQ(world_of(UpAxis::z, voxel), glm::dvec3(centre.x, -centre.z, centre.y));
  }
}

TEST(SmokeGrid, SaysWhatAndWhenItIs) {
  Hall hall;
  hall.world.advance_to(72);
  const grids::Grid grid = smoke_grid(hall.world.state(), {UpAxis::y, 2.5f});
  EXPECT_EQ(grid.name, "density");
  EXPECT_EQ(grid.grid_class, grids::GridClass::fog_volume);
  EXPECT_EQ(grid.type, grids::ValueType::float32);
  EXPECT_EQ(metadata_of<float>(grid, "extinction", "float"), 2.5f);
  EXPECT_EQ(metadata_of<std::int32_t>(grid, "tick", "int32"), 72);
  EXPECT_EQ(metadata_of<double>(grid, "time", "double"), 1.125);
}

/// What a hall's smoke is drawn from at its tick.
smoke::SmokeInput input_of(const Hall& hall, const smoke::SmokeVolume& volume, const smoke::NoiseLook& look) {
  smoke::SmokeInput input{.volume = &volume,
                          .state = &hall.world.state(),
                          .holes = {},
                          .time = hall.world.state().seconds(hall.world.tick())};
  smoke::set_noise(input.look, look);
  return input;
}

TEST(SmokeGrid, DrawnWithoutNoiseIsTheDensityOfTheState) {
  Hall hall;
  hall.world.advance_to(70);
  smoke::SmokeVolume volume(hall.level, hall.planes);
  volume.update(hall.world);
  const smoke::DrawnSmoke smoke(input_of(hall, volume, {.erosion = 0}), smoke::smoke_noise, nullptr);
  const grids::Grid expected = smoke_grid(hall.world.state(), {});
  const grids::Grid same = drawn_smoke_grid(smoke, 0.5f, {}).value_or_throw();
  EXPECT_EQ(same.world_from_index, expected.world_from_index);
  int dense = 0;
  for_each_in(Box<int>{glm::ivec3(0), hall.level.layout().size}, [&](glm::ivec3 voxel) {
    if (hall.level.solid(voxel)) return;
    // A voxel's centre is rounded to 2^-21 m, and densities change by at most 1 in half a metre.
    EXPECT_NEAR(value_at(same, voxel).density, value_at(expected, voxel).density, 1e-5);
    dense += value_at(expected, voxel).density > 0;
  });
  EXPECT_GT(dense, 500);
}

TEST(SmokeGrid, DrawnSmokeIsThatOfPointsInVoxelsOfAnySize) {
  Hall hall;
  hall.world.advance_to(90);
  smoke::SmokeVolume volume(hall.level, hall.planes);
  volume.update(hall.world);
  const smoke::DrawnSmoke smoke(input_of(hall, volume, {}), smoke::smoke_noise, nullptr);
  for (const float size : {0.09f, 0.2f, 0.7f}) {
    const grids::Grid grid = drawn_smoke_grid(smoke, size, {UpAxis::y, 7}).value_or_throw();
    grids::check_grid(grid).value_or_throw();
    EXPECT_EQ(metadata_of<float>(grid, "extinction", "float"), 7);
    EXPECT_EQ(metadata_of<std::int32_t>(grid, "tick", "int32"), 90);
    int smoky = 0;
    const glm::ivec3 voxels(glm::vec3(hall.level.layout().size) * 0.5f / size);
    for_each_in(Box<int>{glm::ivec3(-2), voxels}, [&](glm::ivec3 voxel) {
      const glm::vec3 centre = hall.level.layout().origin_world + size * (glm::vec3(voxel) + 0.5f);
      const Value value = value_at(grid, voxel);
      EXPECT_EQ(value.density, smoke.density(centre));
      EXPECT_EQ(value.active, value.density > 0);
      smoky += value.active;
    });
    EXPECT_GT(smoky, 50);
  }
  const auto too_fine = drawn_smoke_grid(smoke, 0.005f, {});
  ASSERT_FALSE(too_fine);
  EXPECT_EQ(too_fine.failure().code, ErrorCode::resource_limit);
}

}  // namespace
}  // namespace brume::scenario
