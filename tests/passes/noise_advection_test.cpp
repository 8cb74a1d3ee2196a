#include "passes/noise_advection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "passes/noise.hpp"
#include "shared/erosion.h"
#include "shared/frame.h"
#include "smoke/holes.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/passes/half.hpp"
#include "tests/passes/smoke_room.hpp"
#include "tests/reference/noise.hpp"
#include "tests/smoke/displacements.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kTicks = 64;  // a second

sim::Cloud cloud_of(const sim::SmokeSettings& settings, std::uint32_t detonation_tick) {
  sim::CloudOrigin origin;
  origin.source = glm::ivec3(16);
  origin.settings = settings;
  origin.detonation_tick = detonation_tick;
  return sim::Cloud(voxel::BitGrid({glm::ivec3(33), 0.25f, glm::vec3(0)}), origin);
}

TEST(CloudMotion, IsBoundedAndContinuousOverALife) {
  const sim::Cloud cloud = cloud_of({3000, 64, 64, 128}, 32);
  constexpr double kStep = 1.0 / 1920;
  shared::CloudMotion before = smoke::cloud_motion(cloud, kTicks, 0, 12);
  for (double t = kStep; t < 5; t += kStep) {
    const shared::CloudMotion now = smoke::cloud_motion(cloud, kTicks, t, 12);
    EXPECT_GE(now.grown, -1.0f / 7 - 1e-6f);
    EXPECT_LE(now.grown, 1.5f);
    EXPECT_GE(std::hypot(now.swirl_cos, now.swirl_sin), 0.999f);
    EXPECT_LE(std::hypot(now.swirl_cos, now.swirl_sin), 3.001f);
    // A thirtieth of a tick: no jump, neither at ticks nor where its phase changes.
    EXPECT_LT(std::abs(now.grown - before.grown), 0.02f) << t;
    EXPECT_LT(std::hypot(now.swirl_cos - before.swirl_cos, now.swirl_sin - before.swirl_sin), 0.01f) << t;
    before = now;
  }
}

TEST(CloudMotion, CarriesOutwardWhileItBloomsAndDiesDown) {
  const sim::Cloud cloud = cloud_of({3000, 64, 1152, 128}, 0);
  double before = 1e9, fastest_late = 0, fastest = 0;
  for (int frame = 8; frame < 240; ++frame) {
    const auto grown = static_cast<double>(smoke::cloud_motion(cloud, kTicks, frame / 24.0, 12).grown);
    if (frame > 8) {
      EXPECT_LE(grown, before + 1e-6);  // never back
      (frame < 24 ? fastest : fastest_late) = std::max(frame < 24 ? fastest : fastest_late, before - grown);
    }
    before = grown;
  }
  EXPECT_LT(fastest_late, 0.2 * fastest);
}

TEST(Impulses, OfAShotBeginAndEndWithNothing) {
  voxel::BitGrid grid({glm::ivec3(33), 0.25f, glm::vec3(0)});
  sim::World world(grid);
  sim::ThrowSmoke smoke;
  smoke.from = smoke.at = sim::position_from_metres({4, 4, 4});
  smoke.smoke.voxels = 3000;
  world.append(smoke).value_or_throw();
  sim::Shot shot;
  shot.tick = 128;
  shot.origin = sim::position_from_metres({0.5, 4, 4});
  shot.toward = sim::position_from_metres({4, 4, 4});
  world.append(shot).value_or_throw();
  world.advance_to(129);
  ASSERT_EQ(world.state().holes.size(), 1u);
  const float radius = smoke::make_hole(world.state().holes[0], world.state()).radius;
  float most = 0;
  for (double t = 2; t < 5; t += 1.0 / 480) {
    const auto impulses = smoke::make_impulses(world.state(), t);
    if (impulses.empty()) continue;
    const float along = impulses[0].along.x;
    EXPECT_GE(along, 0.0f);
    EXPECT_LE(along, 2.001f * radius);
    EXPECT_NEAR(impulses[0].along.y, 0, 1e-5);
    most = std::max(most, along);
  }
  EXPECT_GT(most, 1.5f * radius);
  EXPECT_TRUE(smoke::make_impulses(world.state(), 2.0).empty());
  EXPECT_TRUE(smoke::make_impulses(world.state(), 4.5).empty());
}

TEST(Impulses, OfABodyFollowItAndDieDown) {
  const voxel::BitGrid grid({glm::ivec3(33), 0.25f, glm::vec3(0)});
  sim::World world(grid);
  for (std::uint32_t i = 0; i < 3; ++i) {
    sim::MoveBody move;
    move.tick = 10 + 8 * i;
    move.to = sim::position_from_metres({2 + 0.5 * i, 1, 4});  // 4 m/s
    world.append(move).value_or_throw();
  }
  world.advance_to(26);
  const auto now = smoke::make_impulses(world.state(), 26.0 / kTicks);
  ASSERT_EQ(now.size(), 1u);
  EXPECT_LT(glm::distance(now[0].to_world, glm::vec3(3, 1, 4)), 1e-3f);
  EXPECT_LT(glm::distance(now[0].from_world, glm::vec3(1, 1, 4)), 1e-3f);  // half a second of its path
  EXPECT_NEAR(now[0].along.x, 0.6, 1e-4);
  const auto later = smoke::make_impulses(world.state(), 26.0 / kTicks + 0.75);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_NEAR(later[0].along.x, 0.3, 1e-3);
  EXPECT_TRUE(smoke::make_impulses(world.state(), 26.0 / kTicks + 1.51).empty());
}

TEST(Impulses, OfABlastCarryOutwards) {
  const voxel::BitGrid grid({glm::ivec3(33), 0.25f, glm::vec3(0)});
  sim::World world(grid);
  sim::Blast blast;
  blast.tick = 64;
  blast.at = sim::position_from_metres({4, 4, 4});
  blast.radius = 2 * 1024;
  world.append(blast).value_or_throw();
  world.advance_to(65);
  EXPECT_TRUE(smoke::make_impulses(world.state(), 1.0).empty());
  const auto open = smoke::make_impulses(world.state(), 1.2);
  ASSERT_EQ(open.size(), 1u);
  EXPECT_EQ(open[0].along, glm::vec3(0));
  EXPECT_NEAR(open[0].radius, 3, 1e-3);
  EXPECT_NEAR(open[0].outward, 0.75, 1e-2);
}

class NoiseAdvectionTest : public gpu::GpuTest {
 protected:
  NoiseAdvectionTest()
      : room_(context(), runner(), {}, {{40, 33, 37}, 0.25f, {-5, -4, -4.6f}}, {0, 0, 0}, 8000, 400) {
    noise_ = make_noise_tile(context(), smoke::kSmokeNoise.size);
    const NoisePass noise(context());
    runner().run([&](gpu::Recorder& recorder) { noise.record(recorder, noise_, smoke::kSmokeNoise); });
    frame_.smoke = room_.volume.layout();
    frame_.look.noise_frequency = 1.0f / 6;
    frame_.look.swirl = 0.2f;
    frame_.look.swirl_width = 3;
  }
  /// How far the noise is carried at each texel, and the fraction of the density that remains.
  std::vector<glm::vec4> record(const sim::State& state, double seconds, float erosion) {
    return record(pass_, state, seconds, erosion);
  }
  std::vector<glm::vec4> record(NoiseAdvectionPass& pass, const sim::State& state, double seconds,
                                float erosion) {
    frame_.look.erosion = erosion;
    frame_.time = static_cast<float>(seconds);
    const auto frame = upload(std::vector{frame_});
    const planning::NoisePlan plan{smoke::noise_motion(state, seconds, 12)};
    pass.reserve(state, room_.volume, plan);
    runner().run([&](gpu::Recorder& recorder) {
      pass.upload(recorder, plan);
      pass.record(recorder, plan, {frame, room_.upload.resources(), noise_});
    });
    const auto medium = read_back<Half4>(room_.upload.resources().density_displacement);
    const auto remaining = read_back<std::uint32_t>(room_.upload.resources().filtered_density);
    std::vector<glm::vec4> out;
    for (std::size_t i = 0; i < medium.size(); ++i) {
      const glm::vec4 texel = from_half(medium[i]);
      out.emplace_back(texel.y, texel.z, texel.w, glm::unpackHalf2x16(remaining[i]).y);
    }
    return out;
  }
  const sim::State& state() const { return room_.world.state(); }
  /// Index in the atlas of a texel of a slot's brick.
  std::size_t atlas_texel(std::uint32_t slot, glm::ivec3 local) const {
    const shared::BrickLayout& layout = room_.volume.layout().bricks;
    const glm::ivec3 bricks = layout.atlas_bricks;
    const glm::ivec3 at = glm::ivec3(shared::atlas_first_texel(layout, slot)) + local;
    return static_cast<std::size_t>(at.x) +
           static_cast<std::size_t>(10 * bricks.x) *
               (static_cast<std::size_t>(at.y) +
                static_cast<std::size_t>(10 * bricks.y) * static_cast<std::size_t>(at.z));
  }
  /// Calls visit(texel of the atlas, voxel) for all voxels of all bricks.
  void for_each_voxel(auto visit) const {
    for (std::uint32_t slot = 0; slot < room_.volume.slot_count(); ++slot)
      for (int i = 0; i < 512; ++i) {
        const glm::ivec3 local(i & 7, i >> 3 & 7, i >> 6);
        visit(atlas_texel(slot, local + 1), 8 * room_.volume.brick_of(slot) + local);
      }
  }
  /// Shows the world at a tick.
  void show(std::uint32_t tick) {
    room_.world.advance_to(tick);
    room_.volume.update(room_.world);
    room_.upload.reserve(room_.volume);
    runner().run([&](gpu::Recorder& recorder) {
      room_.upload.record(recorder, room_.volume);
      room_.upload.record_visibility(recorder, planning::all_smoke_visible(room_.volume));
    });
    frame_.smoke = room_.volume.layout();
  }
  std::size_t compare_with_processor(double seconds, auto compared);

  SmokeRoom room_;
  NoiseAdvectionPass pass_{context()};
  gpu::Image noise_;
  shared::FrameConstants frame_{};
};

TEST_F(NoiseAdvectionTest, StandsStillWithoutAState) {
  const auto texels = record({}, 3, 0);
  for_each_voxel([&](std::size_t texel, glm::ivec3 voxel) {
    if (state().density(voxel) == 0) return;
    EXPECT_EQ(texels[texel], glm::vec4(0, 0, 0, 1));
  });
}

TEST_F(NoiseAdvectionTest, CarriesAsTheReference) {
  const sim::Cloud& cloud = *state().clouds.at(0).cloud;
  for (const double seconds : {0.3, 0.8, 6.0}) {
    const auto texels = record(state(), seconds, 0);
    const shared::CloudMotion motion = smoke::cloud_motion(cloud, kTicks, seconds, 12);
    int compared = 0;
    for_each_voxel([&](std::size_t texel, glm::ivec3 voxel) {
      // In the open, where all voxels around belong to the cloud, its growth is a straight line.
      for (int i = 0; i < 125; ++i)
        if (!cloud.voxels().contains(voxel + glm::ivec3(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2))) return;
      if (++compared % 7 != 0) return;
      const glm::dvec3 growth = 0.25 * glm::dvec3(voxel - cloud.origin().source);
      const glm::dvec3 p = glm::dvec3(-5, -4, -4.6) + 0.25 * (glm::dvec3(voxel) + 0.5);
      const glm::dvec3 one = reference::curl_noise(p / 192.0, 64, 11),
                       other = reference::curl_noise(p / 192.0, 64, 21);
      const glm::dvec3 expected =
          static_cast<double>(motion.grown) * growth +
          0.2 * (static_cast<double>(motion.swirl_cos) * one + static_cast<double>(motion.swirl_sin) * other);
      // Half floats in and out, each of at most 8 m, the first times 1.5.
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(texels[texel][axis], expected[axis], 0.008);
    });
    EXPECT_GT(compared, 1000);
  }
}

/// Densities of the texels around one that its brick has, outside of it 0.
class DensitiesAround {
 public:
  DensitiesAround(std::span<const smoke::Texel> texels, glm::ivec3 local) {
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 at = local + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
      if (glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, glm::ivec3(10))))
        densities_[static_cast<std::size_t>(i)] =
            texels[static_cast<std::size_t>(at.x + 10 * (at.y + 10 * at.z))].density;
    }
  }
  bool none() const {
    return std::ranges::all_of(densities_, [](int density) { return density == 0; });
  }
  /// Of the eight cubes of 2^3 texels, the largest mean.
  double largest_mean() const {
    int most = 0;
    for (int cube = 0; cube < 8; ++cube) {
      int sum = 0;
      for (int i = 0; i < 8; ++i) {
        const glm::ivec3 at((cube & 1) + (i & 1), (cube >> 1 & 1) + (i >> 1 & 1), (cube >> 2) + (i >> 2));
        sum += densities_[static_cast<std::size_t>(at.x + 3 * (at.y + 3 * at.z))];
      }
      most = std::max(most, sum);
    }
    return most / 8.0;
  }

 private:
  std::array<int, 27> densities_{};
};

/// How far apart displacements by two processors may be whose rolls have an amplitude of `swirl`, u = 2^-24:
/// the device rounds or cuts to a half float. Each is off by 160u in its place in the cells of the curl
/// noise, whose derivatives change by 27.5 + 2 x 32 a cell at most, and each of the two in a curl by 1,700u
/// in rounding (noise_tile_test.cpp has the terms). Growth, weights and impulses of a few metres are off by
/// less than 1e-4 on each.
double displacement_bound(double expected, double swirl) {
  const double curl = 2 * (1700 + 160 * (27.5 + 2 * 32)) * 0x1p-24;
  return std::abs(expected) * 0x1p-10 + 0x1p-24 + 2 * (swirl * curl + 1e-4);
}

/// Compares all texels for which compared(voxel) holds, and returns how many have a displacement.
std::size_t NoiseAdvectionTest::compare_with_processor(double seconds, auto compared) {
  const auto device = record(state(), seconds, 0);
  const auto processor =
      smoke::displacements_of({room_.volume, state(), frame_.look, seconds, 12}, room_.volume);
  EXPECT_EQ(processor.size(), std::size_t{1000} * room_.volume.slot_count());
  double swirl = 0;
  for (const sim::LiveCloud& live : state().clouds) {
    const shared::CloudMotion motion = smoke::cloud_motion(*live.cloud, kTicks, seconds, 12);
    swirl = std::max<double>(swirl,
                             frame_.look.swirl * (std::abs(motion.swirl_cos) + std::abs(motion.swirl_sin)));
  }
  std::size_t displaced = 0;
  for (std::uint32_t slot = 0; slot < room_.volume.slot_count(); ++slot)
    for (int i = 0; i < 1000; ++i) {
      const glm::ivec3 local(i % 10, i / 10 % 10, i / 100);
      const glm::vec3 here(device[atlas_texel(slot, local)]);
      const glm::vec3 expected = processor[std::size_t{1000} * slot + static_cast<std::size_t>(i)];
      const DensitiesAround around(room_.volume.texels(slot), local);
      if (around.none()) {
        EXPECT_EQ(expected, glm::vec3(0));
        // At the end of its brick the device's filter may see a trace of the brick beside it.
        const bool inside = glm::all(glm::equal(glm::clamp(local, 1, 8), local));
        EXPECT_TRUE(!inside || here == glm::vec3(0)) << slot << " " << i;
        continue;
      }
      // A filter of 8 bits may round three times down, to no smoke at all.
      if (here == glm::vec3(0) && around.largest_mean() < 3) continue;
      if (!compared(8 * room_.volume.brick_of(slot) + local - 1)) continue;
      ++displaced;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(here[axis], expected[axis], displacement_bound(expected[axis], swirl))
            << slot << " " << i;
    }
  return displaced;
}

TEST_F(NoiseAdvectionTest, DisplacesAsTheProcessor) {
  for (const double seconds : {0.3, 0.8, 6.0})
    EXPECT_GT(compare_with_processor(seconds, [](glm::ivec3) { return true; }), 10000u);
}

TEST_F(NoiseAdvectionTest, DisplacesAsTheProcessorWhereCloudsMeetAndImpulsesAct) {
  sim::ThrowSmoke second;
  second.tick = 402;
  second.from = second.at = sim::position_from_metres({1.5, 0, 0});
  second.smoke.voxels = 8000;
  second.smoke.bloom_ticks = 8;  // grown soon
  room_.world.append(second).value_or_throw();
  sim::MoveBody move;
  for (move.tick = 420; move.tick <= 436; move.tick += 8) {
    move.to = sim::position_from_metres({move.tick / 64.0 - 7, 0.5, 0});
    room_.world.append(move).value_or_throw();
  }
  sim::Shot shot;
  shot.tick = 437;
  shot.origin = sim::position_from_metres({-4, 0, 1});
  shot.toward = sim::position_from_metres({0, 0, 0});
  room_.world.append(shot).value_or_throw();
  sim::Blast blast;
  blast.tick = 438;
  blast.at = sim::position_from_metres({0, 1, -1});
  blast.radius = 2 * 1024;
  room_.world.append(blast).value_or_throw();
  show(448);
  ASSERT_EQ(state().clouds.size(), 2u);
  const double seconds = 448.0 / kTicks;
  ASSERT_EQ(smoke::make_impulses(state(), seconds).size(), 3u);
  const std::size_t displaced = compare_with_processor(seconds, [&](glm::ivec3 voxel) {
    // Well behind a front, in a cloud: elsewhere all weights may be near 0, and their ratio hardly
    // determined.
    return std::ranges::any_of(state().clouds, [&](const sim::LiveCloud& live) {
      const glm::ivec3 from_source = voxel - live.cloud->origin().source;
      const float front = smoke::cloud_motion(*live.cloud, kTicks, seconds, 12).front;
      if (glm::length(glm::vec3(from_source)) > front - 6) return false;
      for (int i = 0; i < 125; ++i)
        if (!live.cloud->voxels().contains(voxel + glm::ivec3(i % 5, i / 5 % 5, i / 25) - 2)) return false;
      return true;
    });
  });
  EXPECT_GT(displaced, 1000u);
}

TEST_F(NoiseAdvectionTest, ANewCloudDoesNotMakeTheOldOneJump) {
  sim::ThrowSmoke second;
  second.tick = 440;
  second.from = second.at = sim::position_from_metres({1.5, 0, 0});
  second.smoke.voxels = 8000;
  room_.world.append(second).value_or_throw();
  const sim::Cloud& old = *state().clouds.at(0).cloud;
  std::vector<glm::vec3> before, after;
  const auto record_at = [&](std::uint32_t tick, std::vector<glm::vec3>& out) {
    show(tick);
    const auto texels = record(state(), tick / 64.0, 0);
    out.assign(old.voxels().size(), glm::vec3(0));
    for_each_voxel([&](std::size_t texel, glm::ivec3 voxel) {
      const std::uint32_t rank = old.voxels().rank(voxel);
      if (rank != sim::BlockSet::kNone && state().density(voxel) > 0) out[rank] = glm::vec3(texels[texel]);
    });
  };
  record_at(438, before);
  ASSERT_EQ(state().clouds.size(), 1u);
  record_at(442, after);
  ASSERT_EQ(state().clouds.size(), 2u);
  // Away from the new source, which stirs what is around it, a sixteenth of a second moves nothing far.
  const glm::ivec3 source = state().clouds.at(1).cloud->origin().source;
  std::size_t compared = 0;
  old.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    if (before[rank] == glm::vec3(0) || glm::length(glm::vec3(voxel - source)) < 8) return;
    ++compared;
    EXPECT_LT(glm::distance(before[rank], after[rank]), 0.06f);
  });
  EXPECT_GT(compared, 3000u);
}

TEST_F(NoiseAdvectionTest, IsTheSameWhateverWasDrawnBefore) {
  const auto first = record(state(), 2.1, 0.8f);
  const auto other = record(state(), 5.3, 0.8f);
  EXPECT_NE(first, other);
  EXPECT_EQ(record(state(), 2.1, 0.8f), first);
  NoiseAdvectionPass fresh(context());
  EXPECT_EQ(record(fresh, state(), 2.1, 0.8f), first);
}

/// What the noise may make of a density at least and at most: shared::erode rises with each of its channels
/// (ErosionTest), and between the tile's texels there is no more than in them.
struct ErodedRange {
  shared::SmokeLook look{};
  glm::vec4 low{1}, high{0};
  std::pair<double, double> operator()(float density) const {
    return {static_cast<double>(shared::erode(look, density, low, glm::vec2(0), 0)),
            static_cast<double>(shared::erode(look, density, high, glm::vec2(0), 0))};
  }
};

// Line of sight integrates without noise: through a grown smoke it must about match the rendered image.
TEST_F(NoiseAdvectionTest, LeavesTheOpticalDepthOfDenseSmoke) {
  constexpr float kErosion = 0.8f;
  const auto texels = record(state(), 6.2, kErosion);
  ErodedRange range;
  range.look.erosion = kErosion;
  for (const auto& texel : read_back<std::array<std::uint8_t, 4>>(noise_)) {
    const glm::vec4 noise = glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f;
    range.low = glm::min(range.low, noise);
    range.high = glm::max(range.high, noise);
  }
  struct Line {
    double plain = 0, eroded = 0, least = 0, most = 0;
    int full = 0;
  };
  std::vector<Line> lines(40 * 33);
  for_each_voxel([&](std::size_t texel, glm::ivec3 voxel) {
    if (voxel.x < 0 || voxel.y < 0 || voxel.x >= 40 || voxel.y >= 33) return;
    Line& line = lines[static_cast<std::size_t>(voxel.x + 40 * voxel.y)];
    const double density = state().density(voxel) / 255.0;
    const auto [least, most] = range(static_cast<float>(density));
    line.plain += density;
    line.full += density > 0.99;
    line.eroded += density * static_cast<double>(texels[texel].w);
    line.least += least;
    line.most += most;
  });
  double sum = 0, most_off = 0, plain_sum = 0, eroded_sum = 0;
  int dense = 0;
  std::vector<double> rim_off;
  for (const Line& line : lines) {
    if (line.plain == 0) continue;
    plain_sum += line.plain;
    eroded_sum += line.eroded;
    // Each line by what the noise may do to its densities; fractions are half floats.
    EXPECT_GE(line.eroded, line.least * (1 - 1.0 / 1024) - 1e-6);
    EXPECT_LE(line.eroded, line.most * (1 + 1.0 / 1024) + 1e-6);
    const double off = std::abs(line.eroded / line.plain - 1);
    if (line.full == 0 && line.plain >= 2) rim_off.push_back(off);
    if (line.full < 12) continue;  // 3 m of full density
    ++dense;
    sum += line.eroded / line.plain;
    most_off = std::max(most_off, off);
    EXPECT_NEAR(line.eroded / line.plain, 1, 0.3);
  }
  ASSERT_GT(dense, 50);
  EXPECT_NEAR(sum / dense, 1, 0.15);
  EXPECT_NEAR(eroded_sum / plain_sum, 1, 0.15);
  ASSERT_GT(rim_off.size(), 50u);
  std::sort(rim_off.begin(), rim_off.end());
  std::printf(
      "eroded fraction of dense lines %.3f, most off %.3f, of all %.3f; %zu lines through the rim alone: "
      "half "
      "off by "
      "%.2f at most, nine of ten by %.2f, all by %.2f\n",
      sum / dense, most_off, eroded_sum / plain_sum, rim_off.size(), rim_off[rim_off.size() / 2],
      rim_off[rim_off.size() * 9 / 10], rim_off.back());
}

}  // namespace
}  // namespace brume::passes
