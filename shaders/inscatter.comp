// In-scattered radiance at every texel of every brick: each lamp's light, through the scene's shadows and through
// the smoke in between. The march then pays one fetch a sample, however many lamps there are.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 4
#define BINDING_DENSITY 5
#define BINDING_CELLS 6
#define BINDING_BOUNDARY 7
#define BINDING_CORNERS 8
#include "lib/lights.glsl"
#include "shared/frame.h"
#include "shared/inscatter.h"
#include "shared/scattering.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 2) readonly buffer Views { ShadowView sun; };
layout(binding = 3) uniform sampler2DArrayShadow shadows;
layout(scalar, binding = 9) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(binding = 10, rgba16f) uniform writeonly image3D inscatter;
layout(binding = 11) uniform sampler3D noise_tile;
layout(push_constant, scalar) uniform Push { InscatterParams params; };
#include "lib/optical_depth.glsl"

/// Whether any of the 27 texels around one holds smoke: only then a sample of the march can meet its light.
bool smoke_around(ivec3 atlas_texel) {
  const vec3 texel = 1.0 / vec3(textureSize(density_atlas, 0));
  float sum = 0.0;
  for (uint i = 0u; i < 8u; ++i) {
    const vec3 offset = vec3(i & 1u, i >> 1u & 1u, i >> 2u);
    sum += textureLod(density_atlas, (vec3(atlas_texel) + offset) * texel, 0.0).r;
  }
  return sum > 0.0;
}

void main() {
  const uint texel = gl_GlobalInvocationID.x;
  const uint slot = params.first_slot + texel / kTexelsPerBrick;
  if (slot >= params.first_slot + params.slot_count) return;
  const uint at = texel % kTexelsPerBrick;
  const ivec3 local = ivec3(at % 10u, at / 10u % 10u, at / 100u);
  const uvec3 bricks = uvec3(frame.volume.atlas_bricks);
  const uvec3 corner = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y)) * uint(kBrickTexels);
  const ivec3 atlas_texel = ivec3(corner) + local;

  if (!smoke_around(atlas_texel)) {
    imageStore(inscatter, atlas_texel, vec4(0.0));
    return;
  }
  const vec3 p_voxel = vec3(slot_bricks[slot] * kBrickVoxels + local) - 0.5;
  const vec3 p_world = frame.volume.origin_world + p_voxel * frame.volume.voxel_size;
  const vec3 to_eye = normalize(frame.camera.eye_world - p_world);
  // The sky's light comes from everywhere: what is above stands for all of it.
  vec3 radiance = frame.sky.ambient * exp(-0.5 * optical_depth(p_voxel, vec3(0.0, 1.0, 0.0), 1e3, 12.0));
  for (uint i = 0u; i < frame.light_count; ++i) {
    const Light light = lights[i];
    const Incident incident = light_at(light, p_world);
    if (max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) < 1e-4) continue;
    const float lit = shadow_at(shadows, shadow_coordinates(light, sun.clip_from_world, p_world));
    if (lit <= 0.0) continue;
    const float depth = optical_depth(p_voxel, incident.to_light, incident.distance, float(params.volume_steps));
    radiance += incident.irradiance * (lit * scattered(frame.look, depth, -dot(incident.to_light, to_eye)));
  }
  imageStore(inscatter, atlas_texel, vec4(radiance, 1.0));
}
