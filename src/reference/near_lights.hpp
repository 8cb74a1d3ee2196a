// Point and spot lights inside of media or close to them: what media scatter there grows with the inverse
// square of the distance. Rays from the eye sample their points by equiangular sampling: Kulla and Fajardo
// 2012, "Importance Sampling Techniques for Path Tracing in Participating Media".
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/scene.hpp"

namespace brume::reference {

/// Part of a line past a light, with a density in proportion to its irradiance: to 1 / max(d^2,
/// kConstantWithin^2) at a distance d.
class LightChord {
 public:
  /// `nearest`: where along the line the light is nearest; `distance`: how near [m]. The part lies between
  /// `begin` and `end` > begin along the line.
  LightChord(float nearest, float distance, float begin, float end);

  /// The integral of 1 / max(d^2, kConstantWithin^2) over the part [1/m].
  float integral() const { return before_ + within_ + after_; }
  /// A place along the line [m] for `u` in [0, 1).
  float sample(float u) const;
  /// Probability per length with which a place is sampled [1/m]; 0 outside of the part.
  float density(float t) const;

 private:
  float integral_between(float a, float b) const;
  float sample_between(float a, float b, float u) const;

  float nearest_, distance_;
  float begin_, end_;                // from the nearest place on
  float within_begin_, within_end_;  // where the light is constant; both end_ if nowhere
  float before_, within_, after_;    // integrals
};

/// The chords of a ray near lights, in media.
class NearChords {
 public:
  /// Up to Scene::near from the scene's near lights, in the cones of spots, where cells of media hold
  /// something; until the ray ends.
  void find(const Scene& scene, const Ray& ray);
  void clear() { chords_.clear(); }
  bool empty() const { return chords_.empty(); }

  struct Point {
    std::uint32_t light = 0;  ///< Index into Scene::lights.
    float t = 0;              ///< Along the ray [m].
    float density = 0;        ///< Probability of the light, per length [1/m].
  };
  /// A light in proportion to what it gives to its whole chord if nothing hides it, and a place on that, for
  /// `u` in [0, 1)^2. Some chord must be there.
  Point sample(const glm::vec2& u) const;
  /// Calls visit(light, density) for each light of which the place may be sampled.
  template <typename Visit>
  void for_each_at(float t, const Visit& visit) const {
    for (const Chord& one : chords_)
      if (const float density = one.chord.density(t); density > 0)
        visit(one.light, density * one.power / power_);
  }

 private:
  struct Chord {
    std::uint32_t light;
    LightChord chord;
    float power;  // intensity times integral
  };
  std::vector<Chord> chords_;
  float power_ = 0;  // sum over the chords
};

}  // namespace brume::reference
