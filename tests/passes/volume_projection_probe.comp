// The exported shader functions at given points of the world.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "export/volume_projection.glsl"

#include "probes.h"
#include "volume_projection_probe.h"

layout(local_size_x = 64) in;
layout(binding = kBindProbeIn2) uniform sampler2D atlas;
layout(scalar, binding = kBindProbeIn) readonly buffer Positions { vec4 positions[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Outcomes { ProjectionOutcome outcomes[]; };
layout(scalar, push_constant) uniform Push { ProjectionParams params; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(positions.length())) return;
  const VolumeSlices slices = VolumeSlices(params.tile_texels, params.padding, params.tile_count, params.columns,
                                           params.rows);
  const vec3 adjusted = volume_adjusted_position(positions[i].xyz, params.center, params.axis_u, params.axis_v,
                                                 params.axis_slice);
  const VolumeProjection projection = volume_projection(params.dimensions, adjusted, slices);
  outcomes[i].uvs = vec4(projection.uv1, projection.uv2);
  outcomes[i].value = volume_sample(atlas, projection, params.lod);
  outcomes[i].adjusted_position = adjusted;
  outcomes[i].blend_mask = projection.blend_mask;
  outcomes[i].trilinear_uvw = adjusted / params.dimensions + 0.5;
  outcomes[i].volume_mask = projection.volume_mask;
}
