// The quads of particles, across the view axis, in the order of the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/particles.h"

layout(scalar, binding = kBindParticleSystems) readonly buffer Systems { ParticleSystem systems[]; };
layout(scalar, binding = kBindParticles) readonly buffer Particles { Particle particles[]; };
layout(scalar, binding = kBindParticleOrder) readonly buffer Order { uvec2 order[]; };

layout(location = 0) flat out vec3 centre_world;
layout(location = 1) flat out float view_m;
layout(location = 2) flat out uint system;

const vec2 kCorners[6] =
    vec2[](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0));

void main() {
  const uvec2 entry = order[gl_VertexIndex / 6];
  const Particle particle = particles[entry.y];
  centre_world = unpacked(particle.centre_world);
  view_m = particle.view_m;
  system = particle.system;
  const vec2 at = systems[system].radius * kCorners[gl_VertexIndex % 6];
  const vec3 corner_world =
      centre_world + at.x * normalize(frame.camera.right) + at.y * normalize(frame.camera.up);
  gl_Position = frame.camera.clip_from_world * vec4(corner_world, 1.0);
  // The near plane is that of surfaces: quads go on up to the eye.
  gl_Position.z = 0.0;
  // Behind the eye: nothing.
  if (entry.x == 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
