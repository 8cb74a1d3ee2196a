#include "reference/medium.hpp"

#include <cmath>

namespace brume::reference {
namespace {

/// An exponentially distributed optical depth of mean 1.
float random_depth(Sampler& sampler) {
  return -std::log(1 - sampler.random());
}

/// What a possible collision emits towards the ray's origin.
struct Glint {
  float t;
  glm::vec3 radiance;
};

}  // namespace

Media::Media(std::vector<std::unique_ptr<Medium>> media) : media_(std::move(media)) {
  std::vector<const Medium*> emitting;
  for (const auto& medium : media_)
    if (medium->emits()) emitting.push_back(medium.get());
  emission_ = EmissionCells(emitting);
}

std::optional<Collision> Media::collide(const Ray& ray, Sampler& sampler, glm::vec3& emitted) const {
  std::optional<Collision> first;
  Ray rest = ray;
  thread_local std::vector<Glint> glints;
  glints.clear();
  for (const auto& medium : media_) {
    float depth = random_depth(sampler);
    medium->majorants().traverse(rest, [&](float begin, float end, float bound) {
      float t = begin;
      while (true) {
        const float to_next = depth / bound;
        if (t + to_next >= end) {
          depth -= (end - t) * bound;
          return false;
        }
        t += to_next;
        const glm::vec3 p = ray.at(t);
        // Possible collisions lie as densely as the bound times the transmittance.
        if (medium->emits()) glints.push_back({t, medium->emission(p) / bound});
        if (sampler.random() * bound < medium->extinction(p)) {
          first = Collision{t, medium.get()};
          rest.end = t;
          return true;
        }
        depth = random_depth(sampler);
      }
    });
  }
  for (const Glint& glint : glints)
    if (glint.t <= rest.end) emitted += glint.radiance;
  return first;
}

float Media::transmittance(const Ray& ray, Sampler& sampler) const {
  // Below, roulette is cheaper than to go on.
  constexpr float kLittle = 0.1f;
  float passed = 1;
  for (const auto& medium : media_) {
    float depth = random_depth(sampler);
    medium->majorants().traverse(ray, [&](float begin, float end, float bound) {
      float t = begin;
      while (true) {
        const float to_next = depth / bound;
        if (t + to_next >= end) {
          depth -= (end - t) * bound;
          return false;
        }
        t += to_next;
        passed *= 1 - medium->extinction(ray.at(t)) / bound;
        if (passed < kLittle) {
          if (sampler.random() * kLittle >= passed) {
            passed = 0;
            return true;
          }
          passed = kLittle;
        }
        depth = random_depth(sampler);
      }
    });
    if (passed <= 0) return 0;
  }
  return passed;
}

}  // namespace brume::reference
