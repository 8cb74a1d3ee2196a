#include "reference/media.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace brume::reference {
namespace {

/// An exponentially distributed optical depth of mean 1.
float random_depth(Sampler& sampler) {
  return -std::log(1 - sampler.random());
}

/// Transmittance below which roulette is cheaper than to go on, and an optical depth that surely leads below
/// it.
constexpr float kLittle = 0.1f, kSeen = 2.5f;

/// Roulette for a ray whose transmittance is `passed` exp(-`certain`): little becomes kLittle, or 0 and true.
bool ends(float& passed, float& certain, Sampler& sampler) {
  const float now = passed * std::exp(-certain);
  if (now >= kLittle) return false;
  certain = 0;
  passed = sampler.random() * kLittle < now ? kLittle : 0.0f;
  return passed <= 0;
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
    const Ray past = medium->at_rest(rest);
    medium->majorants().traverse_between(past, [&](float begin, float end, float least, float bound) {
      float t = begin;
      while (true) {
        const float to_next = depth / bound;
        if (t + to_next >= end) {
          depth -= (end - t) * bound;
          return false;
        }
        t += to_next;
        const glm::vec3 p = past.at(t);
        // Possible collisions lie as densely as the bound times the transmittance.
        if (medium->emits()) glints.push_back({t, medium->emission(p) / bound});
        const float chosen = sampler.random() * bound;
        if (chosen < least || chosen < medium->extinction(p)) {
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
  float passed = 1;
  for (const auto& medium : media_) {
    float depth = random_depth(sampler);
    float certain = 0;  // optical depth of what is everywhere in the cells
    const Ray past = medium->at_rest(ray);
    medium->majorants().traverse_between(past, [&](float begin, float end, float least, float bound) {
      certain += least * (end - begin);
      const float rest = bound - least;
      float t = begin;
      while (true) {
        const float to_next = depth / rest;
        if (t + to_next >= end) {
          depth -= (end - t) * rest;
          return certain > kSeen && ends(passed, certain, sampler);
        }
        t += to_next;
        passed *= 1 - (medium->extinction(past.at(t)) - least) / rest;
        if (passed < kLittle && ends(passed, certain, sampler)) return true;
        depth = random_depth(sampler);
      }
    });
    if (passed <= 0) return 0;
    passed *= std::exp(-certain);
  }
  return passed;
}

}  // namespace brume::reference
