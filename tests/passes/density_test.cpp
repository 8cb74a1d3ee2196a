#include <random>

#include "brume_test_shaders.hpp"
#include "tests/passes/probes.h"
#include "tests/passes/smoke_room.hpp"

namespace brume::passes {
namespace {

class DensityTest : public gpu::GpuTest {
 protected:
  static std::vector<float> probe(const SmokeRoom& room, const std::vector<glm::vec3>& points) {
    const gpu::ComputePipeline pipeline(context(), shaders::density_probe_comp);
    const gpu::Sampler linear(context(), {});
    const gpu::Buffer in = upload(points);
    const gpu::Buffer out(context(), points.size() * sizeof(float),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const SmokeResources& smoke = room.upload.resources();
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(pipeline,
                    {{shared::kBindProbeIn, gpu::read(in)},
                     {shared::kBindPages, gpu::read(smoke.pages)},
                     {shared::kBindDensity, gpu::sampled(smoke.density, linear)},
                     {shared::kBindCells, gpu::read(smoke.cells)},
                     {shared::kBindBoundary, gpu::read(smoke.boundary)},
                     {shared::kBindCorners, gpu::read(smoke.corners)},
                     {shared::kBindProbeOut, gpu::write(out)}},
                    room.volume.layout());
      recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(points.size()));
    });
    return read_back<float>(out, points.size());
  }
};

TEST_F(DensityTest, ShadersReadWhatTheProcessorReads) {
  // A thin flat wall with a gap, and a slanted roof.
  std::vector<voxel::Triangle> walls;
  add_quad(walls, {3.1f, 0, 0}, {3.1f, 6, 0}, {3.1f, 6, 4}, {3.1f, 0, 4});
  add_quad(walls, {0, 4, 0}, {6, 5.5f, 0}, {6, 5.5f, 6}, {0, 4, 6});
  SmokeRoom room(context(), runner(), walls, {{33, 17, 23}, 0.3f, {-1.3f, -0.2f, -0.4f}}, {1, 1, 1}, 1800,
                 100);

  std::mt19937 random(8);
  std::uniform_real_distribution<float> share(-0.05f, 1.05f);
  std::vector<glm::vec3> points;
  for (int i = 0; i < 20000; ++i)
    points.push_back(glm::vec3(33, 17, 23) * glm::vec3(share(random), share(random), share(random)));
  const auto densities = probe(room, points);
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float expected = smoke::sample_density(room.volume, points[i]);
    // Texture units weigh with 8 bits in each of three axes (half a step each) and may round to 8 bits after
    // each.
    EXPECT_NEAR(densities[i], expected, 3 * 0.5 / 256 + 3 * 0.5 / 255)
        << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
    inside += expected > 0.5f;
  }
  EXPECT_GT(inside, 1000);
}

TEST_F(DensityTest, WhatWasUploadedInPartsReadsAsTheProcessorReads) {
  std::vector<voxel::Triangle> walls;
  add_quad(walls, {3.1f, 0, 0}, {3.1f, 6, 0}, {3.1f, 6, 4}, {3.1f, 0, 4});
  add_quad(walls, {0, 0.2f, 0}, {40, 0.2f, 0}, {40, 0.2f, 6}, {0, 0.2f, 6});
  const glm::ivec3 size(133, 17, 23);
  SmokeRoom room(context(), runner(), walls, {size, 0.3f, {-0.3f, -0.2f, -0.4f}}, {1, 1, 1}, 600, 20);
  // Another far off, so that the page table grows; one between them; a blast; and all of it back and forth.
  for (const auto& [tick, x] : {std::pair{30u, 36.0}, {40u, 18.0}}) {
    sim::ThrowSmoke thrown = smoke_at({x, 1, 3}, 900, tick);
    thrown.smoke = {900, 20, 25, 20};
    room.append(thrown);
  }
  room.append(sim::Blast{.tick = 50, .at = sim::position_from_metres({2, 1, 2}), .radius = 2048});
  std::mt19937 random(12);
  std::uniform_real_distribution<float> share(-0.02f, 1.02f);
  for (const std::uint32_t tick : {25u, 33u, 34u, 45u, 52u, 60u, 75u, 100u, 38u, 20u, 140u}) {
    room.advance_to(tick);
    room.upload.reserve(room.volume);
    runner().run([&](gpu::Recorder& recorder) { room.upload.record(recorder, room.volume); });
    std::vector<glm::vec3> points;
    for (int i = 0; i < 4000; ++i)
      points.push_back(glm::vec3(size) * glm::vec3(share(random), share(random), share(random)));
    const auto densities = probe(room, points);
    int smoky = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float expected = smoke::sample_density(room.volume, points[i]);
      EXPECT_NEAR(densities[i], expected, 3 * 0.5 / 256 + 3 * 0.5 / 255) << "tick " << tick;
      smoky += expected > 0;
    }
    EXPECT_GT(smoky, 20) << "tick " << tick;
  }
}

TEST_F(DensityTest, NothingWhereThereIsNoSmoke) {
  SmokeRoom room(context(), runner(), {}, {{7, 1, 7}, 0.5f, {0, 0, 0}}, {1, 0.2, 1}, 10, 0);
  for (const float density : probe(room, {{3, 0.5f, 3}, {-100, 0, 0}, {1e6f, 0, 0}})) EXPECT_EQ(density, 0);
}

}  // namespace
}  // namespace brume::passes
