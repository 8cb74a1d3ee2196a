// Marches a ray through the bricks of a medium: equal steps with one jitter, brick by brick, until the ray is opaque.
//
// The medium is a lib/medium_*.glsl that the entry point includes first. It defines:
//
//   VolumeLayout medium_volume()         placement of its bricks
//   float medium_step_length()           upper limit of a step [m]
//   float medium_extinction()            at density 1 [1/m]
//   float medium_opaque_transmittance()  a ray below it is opaque
//   vec3 medium_albedo()
//   struct MediumRay                     what the samples of a ray have in common; made by the entry point
//   struct MediumBrick, MediumBrick medium_brick(MediumRay, uint slot, vec3 low_voxel)
//                                        what the samples of a brick have in common
//   struct MediumSample                  of a point; has `float density`
//   MediumSample sample_medium(MediumRay, MediumBrick, vec3 p_world, float t, inout uint texture_samples)
//   vec3 medium_inscatter(MediumRay, MediumSample, inout uint texture_samples)
//                                        radiance towards the eye per unit of albedo, where the density is above 0
#ifndef MARCH_GLSL
#define MARCH_GLSL
#include "lib/bricks.glsl"

layout(scalar, binding = kBindFilled) readonly buffer Filled { uint filled[]; };

struct MarchRay {
  vec3 origin_world, direction;  // unit
  float jitter;                  // position of each sample in its step, [0, 1)
  MediumRay medium;
};

/// Result of a ray so far.
struct Gathered {
  vec3 radiance;  // per unit of albedo
  float transmittance;
  uint texture_samples, steps;
};

/// The part of a ray inside a brick, or inside the empty cube around it.
struct BrickSpan {
  vec3 low;  // low corner [voxels]
  uint slot;
  float t_first, t_stop;  // samples in [t_first, t_stop) may be inside the medium
  float t_next;           // the first sample behind the brick
};

BrickSpan find_brick_span(MarchRay ray, float t, float ds) {
  const VolumeLayout volume = medium_volume();
  const vec3 origin = (ray.origin_world - volume.origin_world) / volume.voxel_size;
  const vec3 per_metre = ray.direction / volume.voxel_size;
  BrickSpan span;
  const vec3 brick = floor((origin + per_metre * t) / float(kBrickVoxels));
  int edge;
  span.slot = slot_at(volume, ivec3(brick), edge);
  if (span.slot != kNoSlot) edge = kBrickVoxels;
  span.low = floor(brick * float(kBrickVoxels) / float(edge)) * float(edge);
  const vec3 inverse = 1.0 / (per_metre + vec3(equal(per_metre, vec3(0.0))) * 1e-9);
  const vec3 to_low = (span.low - origin) * inverse, exits = max(to_low, to_low + float(edge) * inverse);
  span.t_next = t + ds * max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ds));
  span.t_first = span.t_stop = t;
  if (span.slot == kNoSlot) return span;
  // Cell 0 of a brick begins half a voxel before it.
  const uint box = filled[span.slot];
  const vec3 to_first = to_low + (vec3(cells_low(box)) - 0.5) * inverse;
  const vec3 to_end = to_low + (vec3(cells_end(box)) - 0.5) * inverse;
  const vec3 enters = min(to_first, to_end), leaves = max(to_first, to_end);
  span.t_first = t + ds * max(0.0, ceil((max(enters.x, max(enters.y, enters.z)) - t) / ds - 1e-3));
  span.t_stop = min(min(leaves.x, min(leaves.y, leaves.z)) + 1e-3 * ds, span.t_next - 0.5 * ds);
  return span;
}

/// Marches the part [begin, end) of a ray in equal steps no longer than medium_step_length(), one sample per step. What
/// the samples of a brick have in common is computed once per brick; little is carried from step to step, because
/// registers limit how many rays run at a time.
void march(MarchRay ray, float begin, float end, inout Gathered gathered) {
  const float count = ceil((end - begin) / medium_step_length()), ds = (end - begin) / max(count, 1.0);
  const float after_last = begin + (count - 0.5 + ray.jitter) * ds;
  const float per_density = -1.44269504 * medium_extinction() * ds;  // for exp2
  for (float t = begin + ray.jitter * ds; t < after_last;) {
    const BrickSpan span = find_brick_span(ray, t, ds);
    const MediumBrick brick = medium_brick(ray.medium, span.slot, span.low);
    const float t_stop = min(span.t_stop, after_last);
    for (t = span.t_first; t < t_stop; t += ds) {
      const vec3 p_world = ray.origin_world + ray.direction * t;
      const MediumSample here = sample_medium(ray.medium, brick, p_world, t, gathered.texture_samples);
      ++gathered.steps;
      if (here.density > 0.0) {
        // In-scatter is constant over the step, so its integral is exact: the energy does not depend on the step
        // length.
        const float passed = exp2(per_density * here.density);
        const vec3 light = medium_inscatter(ray.medium, here, gathered.texture_samples);
        gathered.radiance += gathered.transmittance * (1.0 - passed) * light;
        gathered.transmittance *= passed;
        if (gathered.transmittance < medium_opaque_transmittance()) {
          gathered.transmittance = 0.0;
          return;
        }
      }
    }
    t = span.t_next;
  }
}

#endif
