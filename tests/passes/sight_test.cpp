// What bots see through is what is drawn: the march's own density and holes, without noise.
#include "smoke/sight.hpp"

#include <random>

#include "brume_test_shaders.hpp"
#include "passes/hole_masks.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/hole_clusters.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"
#include "tests/smoke/sight_scene.hpp"

namespace brume::passes {
namespace {

constexpr std::size_t kHoles = 32;
constexpr float kStep = 1.0f / 64;  // of sight_probe.comp [voxels]

struct ProbeConstants {
  float time;
  std::uint32_t hole_count;
};

class SightTest : public gpu::GpuTest {
 protected:
  /// Integrals of density along the segments [voxels].
  static std::vector<float> probe(const smoke::SightScene& scene, const std::vector<shared::Hole>& open,
                                  const std::vector<smoke::Segment>& segments) {
    SmokeUpload smoke(context());
    smoke.reserve(scene.volume());
    runner().run([&](gpu::Recorder& recorder) { smoke.record(recorder, scene.volume()); });
    const gpu::ComputePipeline pipeline(context(), shaders::sight_probe_comp);
    const gpu::Sampler linear(context(), {}), nearest(context(), {VK_FILTER_NEAREST});
    gpu::Image masks;
    runner().run(
        [&](gpu::Recorder& recorder) { masks = make_hole_masks(context(), recorder, scene.masks()); });
    const gpu::Buffer in = upload(segments), holes = upload(open);
    const gpu::Buffer out(context(), segments.size() * sizeof(float),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const SmokeResources& on_device = smoke.resources();
    const gpu::Buffer layout = upload(std::vector{scene.volume().layout()});
    const ProbeConstants constants{scene.time(), static_cast<std::uint32_t>(open.size())};
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(pipeline,
                    {{shared::kBindProbeIn, gpu::read(in)},
                     {shared::kBindPages, gpu::read(on_device.pages)},
                     {shared::kBindDensity, gpu::sampled(on_device.density, linear)},
                     {shared::kBindCells, gpu::read(on_device.cells)},
                     {shared::kBindBoundary, gpu::read(on_device.boundary)},
                     {shared::kBindCorners, gpu::read(on_device.corners)},
                     {shared::kBindProbeIn2, gpu::read(holes)},
                     {shared::kBindProbeIn3, gpu::read(layout)},
                     {shared::kBindProbeOut, gpu::write(out)},
                     {shared::kBindHoleMasks, gpu::sampled(masks, nearest)}},
                    constants);
      recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(segments.size()));
    });
    return read_back<float>(out, segments.size());
  }
};

TEST_F(SightTest, MarchAndLineOfSightSeeTheSameSmoke) {
  const smoke::SightScene scene(2, 64);
  ASSERT_GE(scene.holes().size(), kHoles);
  const std::vector<shared::Hole> holes(scene.holes().begin(), scene.holes().begin() + kHoles);
  ASSERT_FALSE(scene.volume().boundary_cells().empty());

  std::mt19937 random(12);
  std::vector<smoke::Segment> segments(10000);
  for (smoke::Segment& s : segments) s = smoke::SightScene::segment(random);
  const std::vector<float> marched = probe(scene, holes, segments);

  const smoke::Sight plain(scene.volume(), scene.grid(), {}, 0, {1 / smoke::SightScene::kVoxel});
  const smoke::Sight sight(scene.volume(), scene.grid(), holes, scene.time(),
                           {.extinction = 1 / smoke::SightScene::kVoxel, .masks = &scene.masks()});
  std::vector<float> depths(segments.size()), without(segments.size());
  sight.optical_depths(segments, depths).value_or_throw();
  plain.optical_depths(segments, without).value_or_throw();
  // Below some voxel's depth 1 % is finer than the march is: where a ray crosses a surface with smoke against
  // it, a step is off by up to half of itself; a ray crosses some eight of them here. Texture units weigh
  // with 8 bits: half a step in each of three axes.
  const float least = 8 * 0.5f * kStep + 3 * 0.5f / 256;
  double worst = 0, carved = 0;
  int smoky = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    EXPECT_NEAR(marched[i], depths[i], 0.01f * depths[i] + least) << i;
    if (depths[i] > 1) worst = std::max(worst, std::abs(double{marched[i]} / double{depths[i]} - 1));
    smoky += depths[i] > 1;
    carved += double{without[i]} - double{depths[i]};
  }
  RecordProperty("worst_relative", std::to_string(worst));
  EXPECT_GT(smoky, 2000);
  EXPECT_GT(carved, 50);
}

TEST(FilledCells, HoldAllThatLinesOfSightFind) {
  for (const std::uint32_t seed : {1u, 2u}) {
    const smoke::SightScene scene(seed, 0);
    const smoke::Sight sight(scene.volume(), scene.grid(), {}, 0, {});
    const shared::VolumeLayout& frame = scene.volume().layout();
    std::mt19937 random(seed);
    std::vector<smoke::Segment> points(20000);  // as good as
    for (smoke::Segment& p : points) {
      p = smoke::SightScene::segment(random);
      p.b_world = p.a_world + glm::vec3(1e-4f);
    }
    std::vector<float> depths(points.size());
    sight.optical_depths(points, depths).value_or_throw();
    int smoky = 0, left_out = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::vec3 p = (points[i].a_world + 0.5e-4f - frame.origin_world) / frame.voxel_size;
      const glm::ivec3 brick(glm::floor(p / 8.0f));
      const std::uint32_t slot = scene.volume().slot_at(brick);
      if (slot == smoke::SmokeVolume::kNoSlot) continue;
      const glm::uvec3 cell(glm::floor(p - 8.0f * glm::vec3(brick) + 0.5f));
      const std::uint32_t filled = filled_cells(scene.volume(), slot);
      const bool inside = glm::all(glm::greaterThanEqual(cell, shared::cells_low(filled))) &&
                          glm::all(glm::lessThan(cell, shared::cells_end(filled)));
      smoky += depths[i] > 0;
      left_out += !inside;
      EXPECT_TRUE(inside || depths[i] == 0) << i;
    }
    EXPECT_GT(smoky, 1000);
    EXPECT_GT(left_out, 100);
  }
}

}  // namespace
}  // namespace brume::passes
