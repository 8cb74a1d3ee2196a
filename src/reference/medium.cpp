#include "reference/medium.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "surfaces/motion.hpp"

namespace brume::reference {
namespace {

using surfaces::at_time;

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

void Medium::set_motion(std::vector<glm::mat4> world_from_rest) {
  world_from_rest_ = std::move(world_from_rest);
}

Ray Medium::at_rest(const Ray& ray) const {
  if (world_from_rest_.empty()) return ray;
  const glm::mat4 rest = glm::inverse(at_time<glm::mat4>(world_from_rest_, ray.time));
  return {glm::vec3(rest * glm::vec4(ray.origin, 1)), glm::mat3(rest) * ray.direction, ray.end, ray.time};
}

glm::vec3 Medium::world_from_rest(const glm::vec3& p_rest, float time) const {
  if (world_from_rest_.empty()) return p_rest;
  return glm::vec3(at_time<glm::mat4>(world_from_rest_, time) * glm::vec4(p_rest, 1));
}

float Medium::collisions(const glm::vec3& p_world) const {
  const std::optional<std::uint32_t> cell = majorants_.cell_at(p_world);
  if (!cell || !(majorants_.bound(*cell) > 0)) return 0;
  return glm::min(extinction(p_world), majorants_.bound(*cell));
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
