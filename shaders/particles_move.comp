// Places the particles of all systems for a frame, and lists them with the key of their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/particles.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindParticleSystems) readonly buffer Systems { ParticleSystem systems[]; };
layout(scalar, binding = kBindParticles) writeonly buffer Particles { Particle particles[]; };
layout(scalar, binding = kBindParticleOrder) writeonly buffer Order { uvec2 order[]; };
layout(scalar, push_constant) uniform Push { ParticleList list; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= list.padded_count) return;
  uint key = 0u;  // behind the eye, or no particle: last
  if (i < list.count) {
    uint system = 0u;
    for (uint next = 1u; next < list.system_count; ++next) system = i >= systems[next].first ? next : system;
    const vec3 uvw = particle_uvw(systems[system], i - systems[system].first);
    const vec3 centre_world = matrix_of(systems[system].world_from_uvw) * vec4(uvw, 1.0);
    const float view_m = dot(centre_world - frame.camera.eye_world, frame.camera.forward);
    particles[i] = Particle(packed_of(centre_world), view_m, system);
    // The bits of positive floats have their order.
    if (view_m > 0.0) key = floatBitsToUint(view_m);
  }
  order[i] = uvec2(key, i);
}
