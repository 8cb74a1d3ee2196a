// Media by formula, and scenes around them.
#pragma once

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "reference/path_tracer.hpp"
#include "scene/scene.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {

/// A box whose extinction and emission are functions of the point.
class BoxMedium final : public Medium {
 public:
  struct Matter {
    std::function<float(const glm::vec3&)> extinction;
    float largest = 1;  ///< Of the extinction; the bound.
    glm::vec3 albedo{1};
    std::function<glm::vec3(const glm::vec3&)> emission = nullptr;
    float least = 0;  ///< Of the extinction, as far as is known.
  };
  /// `cells` along each axis, with `matter.largest` as their bound.
  BoxMedium(const Box<float>& box, const Matter& matter, const shared::Phase& phase,
            glm::ivec3 cells = glm::ivec3(1))
      : Medium(phase), box_(box), matter_(matter) {
    const glm::mat4 world_from_voxel =
        glm::scale(glm::translate(glm::mat4(1), box.low), (box.high - box.low) / glm::vec3(cells));
    majorants_ = Majorants(world_from_voxel, {glm::ivec3(0), cells}, 1);
    for_each_in(Box<int>{glm::ivec3(0), cells}, [&](glm::ivec3 cell) {
      majorants_.at(cell) = matter.largest;
      majorants_.lower_least(cell, matter.least);
    });
  }
  float extinction(const glm::vec3& p) const override { return box_.contains(p) ? matter_.extinction(p) : 0; }
  glm::vec3 albedo(const glm::vec3&) const override { return matter_.albedo; }
  glm::vec3 emission(const glm::vec3& p) const override {
    return matter_.emission && box_.contains(p) ? matter_.emission(p) : glm::vec3(0);
  }
  bool emits() const override { return matter_.emission != nullptr; }

 private:
  Box<float> box_;
  Matter matter_;
};

inline BoxMedium::Matter constant(float extinction, float albedo) {
  return {[extinction](const glm::vec3&) { return extinction; }, extinction, glm::vec3(albedo)};
}

inline Media media_of(std::unique_ptr<Medium> medium) {
  std::vector<std::unique_ptr<Medium>> all;
  all.push_back(std::move(medium));
  return Media(std::move(all));
}

/// A scene of objects, media and lights; its sky is black.
inline std::unique_ptr<Scene> scene_of(const scene::Scene& objects, Media media,
                                       std::vector<shared::Light> lights = {}, bool matte = false) {
  std::unique_ptr<Scene> scene(new Scene{
      {objects, std::vector<planning::LevelState>(1), matte}, std::move(media), std::move(lights), {}});
  sum_emitters(*scene);
  return scene;
}

/// Light of the same radiance from everywhere.
inline Environment uniform_sky(float radiance) {
  Environment all;
  all.sky.zenith = all.sky.horizon = all.sky.ambient = glm::vec3(radiance);
  all.shape = {1, 0};
  return all;
}

/// Mean luminance-like first component of paths along a ray.
inline double sum_of(const PathSample& sample) {
  return double{sample.seen.r} + double{sample.single.r} + double{sample.multiple.r};
}

/// Mean radiance of paths along a ray.
inline Mean radiance(const Scene& scene, const Ray& ray, std::uint32_t samples,
                     const PathLimits& limits = {}) {
  Mean mean;
  for (std::uint32_t i = 0; i < std::max(samples / kFewer, std::min(samples, 64u)); ++i) {
    Sampler sampler({i & 255u, i >> 8u}, 0);
    mean.add(sum_of(trace_path(scene, ray, limits, sampler)));
  }
  return mean;
}

}  // namespace brume::reference
