// Density fields and lines of sight through the C interface: the same bits as the libraries below it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include "sim/level_edit.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/api/match.hpp"
#include "tests/api/traps.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::api {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class FieldTest : public testing::Test {
 protected:
  FieldTest() { params_.masks = masks_.get(); }
  World world() const {
    brume_world_params params = brume_world_defaults();
    params.masks = masks_.get();
    World world(level_, params);
    world.append(match_.events);
    return world;
  }
  /// The field of a tick, updated once.
  Field field_at(World& world, std::uint32_t tick) const {
    world.advance_to(tick);
    Field field(level_, params_);
    field.update(world.state());
    return field;
  }

  Match match_;
  Context context_;
  Level level_ = match_.level(context_);
  Masks masks_ = match_.masks(context_);
  brume_field_params params_ = brume_field_defaults();
};

/// The same match in the libraries, with the rule of the interface for planes in edited cells.
class Expected {
 public:
  explicit Expected(const Match& match)
      : triangles_(match.triangles()),
        grid_(*voxel::voxelize(triangles_, match.grid_layout())),
        planes_(voxel::SurfacePlanes::build(triangles_, grid_)),
        atlas_(*smoke::MaskAtlas::pack(match.sim_masks())),
        world_(match.sim_world(grid_)) {}

  void advance_to(std::uint32_t tick) {
    world_.advance_to(tick);
    // Built from nothing: what a field remembers of earlier states must not matter.
    volume_.emplace(grid_, [this](glm::ivec3 cell) {
      for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner = cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
        if (world_.grid().solid(corner) != grid_.solid(corner)) return std::span<const voxel::Plane>();
      }
      return planes_.at(cell);
    });
    volume_->update(world_);
    holes_ = smoke::make_holes(world_.state(), &atlas_);
    smoke::SightSettings settings;
    settings.masks = &atlas_;
    sight_.emplace(*volume_, world_.grid(), holes_, world_.state().seconds(tick), settings);
  }
  const smoke::Sight& sight() const { return *sight_; }
  const sim::State& state() const { return world_.state(); }
  bool edited() const { return world_.state().edits != nullptr; }

 private:
  std::vector<voxel::Triangle> triangles_;
  voxel::BitGrid grid_;
  voxel::SurfacePlanes planes_;
  smoke::MaskAtlas atlas_;
  sim::World world_;
  std::optional<smoke::SmokeVolume> volume_;
  std::vector<shared::Hole> holes_;
  std::optional<smoke::Sight> sight_;
};

glm::vec3 vec_of(const brume_point& p) {
  return {p.x, p.y, p.z};
}

TEST_F(FieldTest, EqualsTheLibraries) {
  Expected expected(match_);
  World world = this->world();
  Field field(level_, params_);
  std::size_t dark = 0, walls = 0, hidden = 0, edited = 0;
  for (const std::uint32_t tick : {0u, 60u, 61u, 95u, 130u, 185u, 240u, 300u, 100u, 410u, 50u}) {
    expected.advance_to(tick);
    world.advance_to(tick);
    field.update(world.state());
    const auto segments = match_.segments(300, tick);
    const auto depths = field.optical_depths(segments);
    const auto visible = field.visible(segments, 1.5f);
    const auto first_walls = field.first_walls(segments);
    edited += expected.edited();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const glm::vec3 a = vec_of(segments[i].a), b = vec_of(segments[i].b);
      ASSERT_EQ(depths[i], *expected.sight().optical_depth(a, b)) << "tick " << tick << ", " << i;
      ASSERT_EQ(visible[i] != 0, *expected.sight().visible(a, b, 1.5f)) << "tick " << tick << ", " << i;
      const auto wall = *expected.sight().first_wall(a, b);
      ASSERT_EQ(first_walls[i].hit != 0, wall.has_value());
      dark += depths[i] > 1;
      hidden += visible[i] == 0;
      if (!wall) continue;
      ++walls;
      ASSERT_EQ(first_walls[i].distance, wall->distance);
      ASSERT_EQ(first_walls[i].voxel.x, wall->voxel.x);
      ASSERT_EQ(first_walls[i].normal.z, wall->normal.z);
    }
  }
  EXPECT_GT(edited, 5u);
  EXPECT_FALSE(expected.edited()) << "the last tick comes before the edits";
  EXPECT_GT(dark, 300u);
  EXPECT_GT(walls, 300u);
  EXPECT_GT(hidden, 300u);
}

TEST_F(FieldTest, DensitiesAreThoseOfTheState) {
  Expected expected(match_);
  World world = this->world();
  std::size_t full = 0, some = 0;
  for (const std::uint32_t tick : {50u, 95u, 200u, 330u}) {
    expected.advance_to(tick);
    const Field field = field_at(world, tick);
    const brume_voxel low{3, 1, 5}, high{48, 12, 38};
    const Bytes densities = field.densities(low, high);
    std::size_t i = 0;
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x, ++i) {
          ASSERT_EQ(densities[i], expected.state().density({x, y, z})) << x << " " << y << " " << z;
          full += densities[i] == 255;
          some += densities[i] > 0;
        }
  }
  EXPECT_GT(some, 2000u);
  EXPECT_GT(full, 200u);
}

TEST_F(FieldTest, ChangedBricksAreAllThatChanges) {
  World world = this->world();
  Field field(level_, params_);
  const brume_voxel size = match_.layout().size;
  const auto index = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x + size.x * (y + size.y * z));
  };
  Bytes copy(index(size.x - 1, size.y - 1, size.z - 1) + 1);
  std::size_t bricks = 0, updates = 0;
  const auto follow = [&](std::uint32_t tick) {
    world.advance_to(tick);
    field.update(world.state());
    for (const brume_voxel& brick : field.changed_bricks()) {
      const brume_voxel low{8 * brick.x, 8 * brick.y, 8 * brick.z};
      const brume_voxel high{std::min(low.x + 8, size.x), std::min(low.y + 8, size.y),
                             std::min(low.z + 8, size.z)};
      const Bytes densities = field.densities(low, high);
      std::size_t i = 0;
      for (int z = low.z; z < high.z; ++z)
        for (int y = low.y; y < high.y; ++y)
          for (int x = low.x; x < high.x; ++x) copy[index(x, y, z)] = densities[i++];
      ++bricks;
    }
    ++updates;
    ASSERT_EQ(copy, field.densities({0, 0, 0}, size)) << tick;
  };
  for (std::uint32_t tick = 0; tick < Match::kTicks; ++tick) follow(tick);
  for (const std::uint32_t tick : {200u, 0u, 333u, 90u}) follow(tick);
  EXPECT_GT(bricks, 1000u);
  EXPECT_LT(bricks, updates * 30) << "of 60";
  field.update(world.state());
  EXPECT_TRUE(field.changed_bricks().empty());
}

TEST_F(FieldTest, ManyEqualOne) {
  World world = this->world();
  const Field field = field_at(world, 200);
  const auto segments = match_.segments(3000, 9);
  const auto depths = field.optical_depths(segments);
  const auto visible = field.visible(segments, 0.7f), open = field.visible(segments, kInfinity);
  const auto walls = field.first_walls(segments);
  for (std::size_t i = 0; i < segments.size(); i += 3) {
    ASSERT_EQ(field.optical_depth(segments[i]), depths[i]);
    ASSERT_EQ(field.visible(segments[i], 0.7f), visible[i] != 0);
    ASSERT_EQ(field.first_wall(segments[i]).has_value(), walls[i].hit != 0);
    ASSERT_EQ(open[i] != 0, walls[i].hit == 0) << "an infinite threshold sees walls only";
  }
  // More than the interface takes at a time.
  std::vector<brume_segment> many;
  while (many.size() < 140'000) many.insert(many.end(), segments.begin(), segments.end());
  const auto repeated = field.optical_depths(many);
  for (std::size_t i = 0; i < many.size(); ++i) ASSERT_EQ(repeated[i], depths[i % depths.size()]);
}

TEST_F(FieldTest, ThreadsDoNotMatter) {
  const auto segments = match_.segments(5000, 4);
  std::vector<float> first;
  for (const std::uint32_t threads : {1u, 2u, 7u}) {
    brume_context_params params = brume_context_defaults();
    params.thread_count = threads;
    const Context context(params);
    const Level level = match_.level(context);
    World world = this->world();
    world.advance_to(260);
    Field field(level, params_);
    field.update(world.state());
    const auto depths = field.optical_depths(segments);
    if (first.empty()) first = depths;
    EXPECT_EQ(depths, first);
  }
}

/// A host's job system, whose threads round upwards.
struct JobSystem {
  static void run(void* self, void (*job)(void*), void* job_data, std::uint32_t count) {
    JobSystem& jobs = *static_cast<JobSystem*>(self);
    ++jobs.calls;
    std::vector<std::jthread> threads;
    for (std::uint32_t i = 0; i < count; ++i)
      threads.emplace_back([=] {
        std::fesetround(FE_UPWARD);
        job(job_data);
        EXPECT_EQ(std::fegetround(), FE_UPWARD) << "the thread has its own settings again";
      });
  }
  std::atomic<int> calls = 0;
};

TEST_F(FieldTest, JobsOfTheHostGiveTheSameResults) {
  const auto segments = match_.segments(5000, 4);
  World world = this->world();
  const auto expected = field_at(world, 260).optical_depths(segments);
  JobSystem jobs;
  brume_context_params params = brume_context_defaults();
  params.thread_count = 4;
  params.run_jobs = JobSystem::run;
  params.jobs_user = &jobs;
  std::optional<Context> context(params);
  const Level level = match_.level(*context);
  Field field(level, params_);
  field.update(world.state());
  EXPECT_EQ(field.optical_depths(segments), expected);
  const int calls = jobs.calls;
  EXPECT_GT(calls, 0);
  context.reset();
  EXPECT_EQ(field.optical_depths(segments), expected);
  EXPECT_EQ(jobs.calls, calls) << "not called after the context's end";
}

TEST_F(FieldTest, FloatingPointSettingsOfTheCallerDoNotMatter) {
  World world = this->world();
  const Field expected = field_at(world, 260);
  const auto segments = match_.segments(600, 8);
  const auto depths = expected.optical_depths(segments);
  for (const int mode : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    std::fenv_t before;
    std::fegetenv(&before);
    std::fesetround(mode);
    std::feclearexcept(FE_ALL_EXCEPT);
    set_traps();
    brume_level* level = nullptr;
    const brume_triangles_params params = match_.triangle_params();
    EXPECT_EQ(brume_level_create_from_triangles(context_.get(), &params, &level), BRUME_OK);
    brume_field* field = nullptr;
    EXPECT_EQ(brume_field_create(level, &params_, &field), BRUME_OK);
    brume_state* state = nullptr;
    EXPECT_EQ(brume_world_state(world.get(), &state), BRUME_OK);
    EXPECT_EQ(brume_field_update(field, state), BRUME_OK);
    std::vector<float> out(segments.size());
    EXPECT_EQ(brume_field_optical_depths(field, segments.data(), segments.size(), out.data()), BRUME_OK);
    EXPECT_EQ(brume_world_tick(nullptr, nullptr), BRUME_ERROR_HANDLE);
    EXPECT_EQ(std::fegetround(), mode) << "the caller has its own settings again";
    EXPECT_TRUE(has_traps());
    std::fesetenv(&before);
    EXPECT_EQ(out, depths);
    brume_field_destroy(field), brume_level_destroy(level), brume_state_destroy(state);
  }
}

TEST_F(FieldTest, ReceivedStatesGiveTheSameField) {
  World world = this->world();
  const Field field = field_at(world, 280);
  const State loaded(context_, world.state().save());
  Field other(level_, params_);
  other.update(loaded);
  const auto segments = match_.segments(1000, 5);
  EXPECT_EQ(other.optical_depths(segments), field.optical_depths(segments));
  EXPECT_EQ(other.visible(segments, 1), field.visible(segments, 1));
}

TEST_F(FieldTest, FilteredStatesHaveTheDepthsOfTheirBoxes) {
  // Lines start where they meet the bounds of all smoke, and their places within a cell are floats: of at
  // most `kVoxels` voxels, in at most as many cells for each axis.
  constexpr float kVoxels = 80, kPerVoxel = 3 * 0.5f;
  constexpr float kRounding = kPerVoxel * 3 * kVoxels * kVoxels / (1u << 24);
  World world = this->world();
  std::mt19937 random(12);
  std::size_t dark = 0, fewer = 0;
  for (const std::uint32_t tick : {60u, 95u, 200u, 280u, 330u}) {
    const Field field = field_at(world, tick);
    const State state = world.state();
    for (int round = 0; round < 6; ++round) {
      const auto real = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
      };
      const brume_point low{real(-2, 18), real(-1, 3), real(-2, 15)};
      const brume_box box{low, {low.x + 7, low.y + 3, low.z + 6}};
      const State part = state.filtered({box});
      fewer += part.describe().cloud_count < state.describe().cloud_count;
      Field other(level_, params_);
      other.update(part);
      std::vector<brume_segment> segments(300);
      for (brume_segment& s : segments)
        for (brume_point* p : {&s.a, &s.b})
          *p = {real(box.low.x, box.high.x), real(box.low.y, box.high.y), real(box.low.z, box.high.z)};
      const auto whole = field.optical_depths(segments), of_part = other.optical_depths(segments);
      for (std::size_t i = 0; i < segments.size(); ++i) {
        ASSERT_NEAR(of_part[i], whole[i], kRounding)
            << "tick " << tick << " round " << round << " line " << i;
        dark += whole[i] > 1;
      }
    }
  }
  EXPECT_GT(dark, 300u);
  EXPECT_GT(fewer, 5u);
}

TEST_F(FieldTest, FiltersCheckTheirBoxes) {
  World world = this->world();
  world.advance_to(200);
  const State state = world.state();
  EXPECT_EQ(state.filtered({}).describe().cloud_count, 0u);
  EXPECT_EQ(state.filtered({{{-1000, -1000, -1000}, {1000, 1000, 1000}}}).hash(), state.hash());
  for (const brume_box& box : {brume_box{{0, 0, 0}, {1, -1, 1}}, brume_box{{0, 0, 0}, {1, 1, std::nanf("")}},
                               brume_box{{-16385, 0, 0}, {1, 1, 1}}}) {
    brume_state* out = nullptr;
    EXPECT_EQ(brume_state_filter(state.get(), &box, 1, &out), BRUME_ERROR_ARGUMENT);
    EXPECT_EQ(out, nullptr);
  }
}

TEST_F(FieldTest, IsReadWhileItsWorldAdvancesAndItIsUpdated) {
  World world = this->world();
  Field field = field_at(world, 200);
  const State state = world.state();
  const auto segments = match_.segments(400, 6);
  const auto expected = field.optical_depths(segments);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      for (int round = 0; round < 10; ++round) EXPECT_EQ(field.optical_depths(segments), expected);
    });
  for (std::uint32_t tick = 201; tick < 260; ++tick) {
    world.advance_to(tick);
    if (tick % 10 == 0) field.update(state);
  }
}

TEST_F(FieldTest, LevelsFromVoxelsAreTheBitsGiven) {
  for (const brume_voxel size : {brume_voxel{1, 1, 1}, {7, 3, 2}, {8, 8, 8}, {33, 17, 5}, {64, 9, 10}}) {
    std::mt19937 random(5);
    const auto count = static_cast<std::size_t>(size.x * size.y * size.z);
    Bytes bits((count + 7) / 8);
    for (auto& byte : bits) byte = static_cast<std::uint8_t>(random());
    brume_voxels_params params = brume_voxels_defaults();
    params.layout = {size, 0.25f, {-3, 1, 2}};
    params.bits = bits.data();
    params.byte_count = bits.size();
    const Level level(context_, params);
    EXPECT_EQ(level.layout().size.x, size.x);
    EXPECT_EQ(level.layout().origin.x, -3);
    const Bytes solid = level.solid({0, 0, 0}, size);
    ASSERT_EQ(solid.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(solid[i], bits[i / 8] >> i % 8 & 1) << i;
  }
}

TEST_F(FieldTest, LevelsFromTrianglesAreVoxelized) {
  const voxel::BitGrid grid = *voxel::voxelize(match_.triangles(), match_.grid_layout());
  const brume_voxel size = match_.layout().size;
  const Bytes solid = level_.solid({0, 0, 0}, size);
  std::size_t i = 0, count = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        ASSERT_EQ(solid[i] != 0, grid.solid({x, y, z}));
        count += solid[i];
      }
  EXPECT_EQ(count, grid.count_solid());

  // A layout around the triangles.
  brume_triangles_params params = match_.triangle_params();
  params.layout = brume_triangles_defaults().layout;
  params.layout.voxel_size = 0.25f;
  params.margin = 3;
  const brume_layout layout = Level(context_, params).layout();
  EXPECT_EQ(layout.origin.x, -0.75f);
  EXPECT_EQ(layout.size.x, 96 + 6);
}

// What of it is drawn: DrawnSmokeTest.
TEST_F(FieldTest, DrawnSmokeIsErodedAndTheSameFromEveryThread) {
  World world = this->world();
  Field field = field_at(world, 280);
  const auto segments = match_.segments(300, 8);
  const auto smooth = field.optical_depths(segments), drawn = field.drawn_depths(segments);
  EXPECT_NE(drawn, smooth);
  brume_drawn_params none = brume_drawn_defaults();
  none.erosion = none.hole_rim = 0;
  const auto without = field.drawn_depths(segments, none);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    // Steps of 1.8 cm, where it begins and ends.
    EXPECT_NEAR(without[i], smooth[i], params_.extinction * 20 * 0.018f);
  }
  const auto visible = field.drawn_visible(segments, 1);
  for (std::size_t i = 0; i < segments.size(); ++i)
    EXPECT_EQ(visible[i] != 0, !field.first_wall(segments[i]) && drawn[i] <= 1) << i;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 4; ++round)
        EXPECT_EQ(field.drawn_depths(segments, i == 1 ? none : brume_drawn_defaults()),
                  i == 1 ? without : drawn);
    });
  threads.clear();
  // Of the state of the last update.
  field.update(world.state());
  EXPECT_EQ(field.drawn_depths(segments), drawn);
  world.advance_to(300);
  field.update(world.state());
  EXPECT_NE(field.drawn_depths(segments), drawn);
}

TEST_F(FieldTest, DrawnSmokeChecksItsParameters) {
  World world = this->world();
  const Field field = field_at(world, 100);
  const auto segments = match_.segments(2, 8);
  std::vector<float> out(2);
  using Member = float brume_drawn_params::*;
  for (const Member member :
       {&brume_drawn_params::erosion, &brume_drawn_params::noise_size, &brume_drawn_params::detail,
        &brume_drawn_params::hole_rim, &brume_drawn_params::swirl, &brume_drawn_params::rise})
    for (const float bad : {-11.0f, 101.0f, std::nanf("")}) {
      brume_drawn_params params = brume_drawn_defaults();
      params.*member = bad;
      EXPECT_EQ(brume_field_drawn_depths(field.get(), &params, segments.data(), 2, out.data()),
                BRUME_ERROR_ARGUMENT);
    }
  EXPECT_EQ(brume_field_drawn_depths(field.get(), nullptr, segments.data(), 2, out.data()), BRUME_OK);
  EXPECT_EQ(out, field.drawn_depths(segments));
}

}  // namespace
}  // namespace brume::api
