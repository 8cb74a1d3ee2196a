// Refraction at an ellipsoid of glass, and points of a lens, for C++ and GLSL.
#ifndef BRUME_OPTICS_H
#define BRUME_OPTICS_H
#include "shared/hash.h"
#include "shared/shim.h"
SHARED_BEGIN

/// An ellipsoid whose axes are those of the world, of a clear dielectric without absorption.
struct Glass {
  vec3 center;  // [m]
  float index;  // of refraction, relative to what surrounds it; > 0. 0: there is no glass
  vec3 radii;   // [m], > 0
  float padding SHARED_ZERO;
};
SHARED_SIZE(Glass, 32);

/// Where a ray is at the surface of the glass, in units of its direction: x where it enters and y where it leaves,
/// which
/// may be behind the origin. y < x: it passes by.
SHARED_FUNCTION vec2 glass_crossings(Glass glass, vec3 origin, vec3 direction) {
  // A unit sphere in scaled space. The discriminant from the point nearest to the middle, which keeps its bits far
  // away
  // (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
  vec3 o = (origin - glass.center) / glass.radii, d = direction / glass.radii;
  float a = dot(d, d), b = -dot(o, d);
  vec3 nearest = o + d * (b / a);
  float rest = 1.0f - dot(nearest, nearest);
  if (rest < 0.0f) return vec2(1.0f, 0.0f);
  float half_chord = sqrt(rest / a);
  return vec2(b / a - half_chord, b / a + half_chord);
}

/// Outward unit normal at a point of the glass's surface.
SHARED_FUNCTION vec3 glass_normal(Glass glass, vec3 at) {
  return normalize((at - glass.center) / (glass.radii * glass.radii));
}

/// Direction behind a surface (Snell's law). Unit vectors; `normal` on the side that `direction` comes from; `ratio`:
/// index of refraction there / behind the surface. 0: total reflection.
SHARED_FUNCTION vec3 refracted(vec3 direction, vec3 normal, float ratio) {
  float cosine = -dot(direction, normal);
  float squared = 1.0f - ratio * ratio * (1.0f - cosine * cosine);
  if (squared < 0.0f) return vec3(0.0f);
  return normalize(ratio * direction + (ratio * cosine - sqrt(squared)) * normal);
}

/// Unit vector.
SHARED_FUNCTION vec3 mirrored(vec3 direction, vec3 normal) {
  return normalize(direction - 2.0f * dot(direction, normal) * normal);
}

/// Which fraction of unpolarized light a smooth dielectric reflects (Fresnel): `cosine` of the angle to the normal,
/// in
/// [0, 1], and `ratio` as refracted() has it. 1: total reflection. The rest passes.
SHARED_FUNCTION float fresnel_reflectance(float cosine, float ratio) {
  float squared = 1.0f - ratio * ratio * (1.0f - cosine * cosine);
  if (squared <= 0.0f) return 1.0f;
  float behind = sqrt(squared);
  float across = (ratio * cosine - behind) / (ratio * cosine + behind);
  float along = (cosine - ratio * behind) / (cosine + ratio * behind);
  return 0.5f * (across * across + along * along);
}

/// Whether a point lies in the regular polygon of `blades` edges, at least 3, whose corners lie on the unit circle,
/// one at
/// (0, 1); below 3: in the unit disk.
SHARED_FUNCTION bool is_on_lens(uint blades, vec2 at) {
  if (blades < 3u) return dot(at, at) <= 1.0f;
  if (blades == 6u) return abs(at.x) <= 0.8660254f && abs(at.y) <= 1.0f - abs(at.x) * 0.57735027f;
  float half_wedge = 3.14159265f / float(blades), apothem = cos(half_wedge);
  for (uint i = 0u; i < blades; ++i) {
    float angle = half_wedge * float(2u * i + 1u);
    if (dot(at, vec2(sin(angle), cos(angle))) > apothem) return false;
  }
  return true;
}

/// A point of is_on_lens, evenly distributed for evenly distributed `u` in [0, 1)^2: a remap, so that points `u`
/// that are
/// well distributed stay so.
SHARED_FUNCTION vec2 lens_point(uint blades, vec2 u) {
  const float kTurn = 6.28318531f;
  if (blades == 6u) {
    // The height of the hexagon falls with |x|: |x| is the inverse of the area up to it, y any height. After a
    // formula of
    // fadaaszhi (2023).
    float x = 2.0f * u.x - 1.0f;
    float across = 1.7320508f - sqrt(3.0f - 2.25f * abs(x));
    return vec2(x < 0.0f ? -across : across, (2.0f * u.y - 1.0f) * (1.0f - across * 0.57735027f));
  }
  float out_to = sqrt(u.y);
  if (blades < 3u) return out_to * vec2(sin(kTurn * u.x), cos(kTurn * u.x));
  // A triangle between the middle and two corners.
  float scaled = u.x * float(blades), wedge = floor(scaled);
  float first = kTurn * wedge / float(blades), second = kTurn * (wedge + 1.0f) / float(blades);
  return out_to *
         mix(vec2(sin(first), cos(first)), vec2(sin(second), cos(second)), scaled - wedge);
}

/// The same by rejection: points of the square around it, until one lies in it. For comparison; `seed` names the
/// sample.
SHARED_FUNCTION vec2 lens_point_by_rejection(uint blades, uvec3 seed) {
  vec2 at = vec2(0.0f);
  for (uint i = 0u; i < 64u; ++i) {
    vec3 random = hash3(seed + uvec3(0u, 0u, i));
    at = 2.0f * vec2(random.x, random.y) - vec2(1.0f);
    if (is_on_lens(blades, at)) return at;
  }
  return vec2(0.0f);
}

SHARED_END
#endif
