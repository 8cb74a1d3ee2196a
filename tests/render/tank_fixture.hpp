// Tanks on a device whose pictures are known numbers.
#pragma once

#include "planning/tank_plan.hpp"
#include "render/tank_picture.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/path_tracer/tank_fixture.hpp"

namespace brume::render {

using reference::dark_scene, reference::grey, reference::kLooser, reference::kPi, reference::kWhite,
    reference::Mean, reference::put, reference::tank_of;

class TankPicturesTest : public gpu::GpuTest {
 protected:
  /// What a picture shows next: from its first sample on.
  static void begin(TankPicture& picture, const scene::TankScene& scene, const spheres::Tank& tank,
                    const scene::Camera& camera, glm::uvec2 size_px) {
    picture.restart();
    picture.show(planning::plan_tank(scene, tank, 0, size_px, camera),
                 planning::plan_tank_display(scene, size_px));
  }
  static void add_samples(TankPicture& picture, std::uint32_t count) {
    runner().run([&](gpu::Recorder& recorder) { picture.record(recorder, {count}); });
  }
  static std::vector<glm::vec4> sums(const TankPicture& picture) {
    return read_back<glm::vec4>(picture.sampler().sum());
  }
  /// Radiance of each pixel.
  static std::vector<glm::dvec3> draw(TankPicture& picture, const scene::TankScene& scene,
                                      const spheres::Tank& tank, const scene::Camera& camera,
                                      glm::uvec2 size_px, std::uint32_t samples) {
    begin(picture, scene, tank, camera, size_px);
    add_samples(picture, samples);
    std::vector<glm::dvec3> pixels;
    for (const glm::vec4& sum : sums(picture))
      pixels.push_back(glm::dvec3(sum) / static_cast<double>(samples));
    return pixels;
  }
};

/// A camera that looks from a point at another with all of its rays all but parallel.
inline scene::Camera narrow_camera(const glm::dvec3& from, const glm::dvec3& to) {
  return {glm::vec3(from), glm::vec3(to), 1e-5f};
}

}  // namespace brume::render
