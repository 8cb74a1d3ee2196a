// Photons that a shader gathers: as on the processor.
#include "shared/photons.h"

#include <random>

#include "brume_test_shaders.hpp"
#include "spheres/light_paths.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"

namespace brume::passes {
namespace {

class PhotonsTest : public gpu::GpuTest {};

TEST_F(PhotonsTest, ShadersGatherTheSame) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> share(0, 1);
  const auto unit_vector = [&] {
    return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
  };
  // An opaque ball, and one of medium.
  const std::vector<spheres::Sphere> balls{{{9, 10, 11}, 6}, {{20, 12, -3}, 4}};
  const auto point = [&](std::uint32_t ball) {
    const float out = ball == 0 ? 1 : std::cbrt(share(random));
    return balls[ball].center + balls[ball].radius * out * unit_vector();
  };
  std::vector<shared::Photon> photons;
  for (std::uint32_t i = 0; i < 4000; ++i)
    photons.push_back({point(i & 1), (i & 1) + 1, glm::vec3(share(random), share(random), 1),
                       shared::packed_direction(unit_vector())});
  // Of small parts of the surface, of more than half of it, and of all.
  for (const float radius : {0.02f, 1.0f, 5.0f, 9.5f, 20.0f}) {
    const spheres::LightPaths paths = spheres::sort_photons(photons, radius);
    std::vector<shared::PhotonQuery> queries;
    for (std::uint32_t i = 0; i < 500; ++i) {
      const std::uint32_t ball = i & 1;
      // Some where photons lie: small radii find nothing elsewhere.
      const glm::vec3 at = i % 4 < 2 ? photons[i].position : point(ball);
      queries.push_back({spheres::packed(balls[ball]), at, ball + 1, paths.grid, ball == 0 ? 0 : 0.3f});
    }
    const gpu::Buffer in_queries = upload(queries), in_photons = upload(paths.photons),
                      in_cells = upload(paths.cells);
    const gpu::Buffer out(context(), queries.size() * sizeof(glm::vec3),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const gpu::ComputePipeline pipeline(context(), shaders::photon_probe_comp);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(pipeline, {{shared::kBindProbeIn, gpu::read(in_queries)},
                               {shared::kBindPhotons, gpu::read(in_photons)},
                               {shared::kBindPhotonCells, gpu::read(in_cells)},
                               {shared::kBindProbeOut, gpu::write(out)}});
      recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(queries.size()));
    });
    const auto found = read_back<glm::vec3>(out, queries.size());
    double sum = 0;
    int others = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const shared::PhotonQuery& query = queries[i];
      const glm::vec3 expected = paths.gather(query.at, query.id - 1, balls[query.id - 1], query.extinction);
      sum += double{expected.g};
      // Vulkan's acos and atan are exact to 2^-11 or so, and only the weights of photons near the edge of the
      // light have them.
      const glm::vec3 off = glm::abs(found[i] - expected);
      others += glm::any(glm::greaterThan(off, 2e-3f * expected + 1e-7f)) ? 1 : 0;
    }
    EXPECT_GT(sum, 0);
    // Where a fused multiply-add decides otherwise whether a photon is within the radius: of the two million
    // distances, one in 10^7 is so near.
    EXPECT_LE(others, 3) << radius;
  }
}

}  // namespace
}  // namespace brume::passes
