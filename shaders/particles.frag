// A fragment of a particle: the volume at its place on the quad, as a slab (shared/particles.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/camera.glsl"
#include "lib/frame.glsl"
#include "lib/slice_texture.glsl"
#include "shared/gbuffer.h"
#include "shared/particles.h"

layout(scalar, binding = kBindParticleSystems) readonly buffer Systems { ParticleSystem systems[]; };
layout(binding = kBindSliceTextures) uniform sampler2D slices;
layout(binding = kBindDepth) uniform sampler2D depth;

layout(location = 0) flat in vec3 centre_world;
layout(location = 1) flat in float view_m;
layout(location = 2) flat in uint system;
layout(location = 0) out vec4 radiance_transmittance;

void main() {
  const vec3 ray = camera_ray(frame.camera, gl_FragCoord.xy, frame.size_px);
  const vec3 p_world = frame.camera.eye_world + view_m * ray;
  const float surface_m = view_distance(frame.camera, texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);
  const float visible = particle_footprint(distance(p_world, centre_world), systems[system].radius) *
                        particle_fade(view_m, surface_m, systems[system].softness);
  if (visible <= 0.0) discard;
  // The ray is 1 long along the view axis: 1 / cos(theta) in all.
  const float length_m = systems[system].weight * length(ray) * visible;
  const vec3 uvw = matrix_of(systems[system].uvw_from_world) * vec4(p_world, 1.0);
  const vec4 value = slice_texture_sample(slices, systems[system].slices, uvw);
  const float density = max(max(value.r, value.g), max(value.b, value.a));
  const float optical_depth = systems[system].extinction * max(density, 0.0) * length_m;
  const vec3 emitted = matrix_of(systems[system].tints) * max(value, vec4(0.0)) * length_m;
  radiance_transmittance = vec4(emitted * slab_transmittance(optical_depth), exp(-optical_depth));
}
