// What the probes of the exported shader functions read and write: volume_projection_probe.comp and .hlsl, and C++.
#ifndef BRUME_VOLUME_PROJECTION_PROBE_H
#define BRUME_VOLUME_PROJECTION_PROBE_H
#include "shared/shim.h"
SHARED_BEGIN

struct ProjectionParams {
  vec3 dimensions;
  float lod;
  vec3 center;
  float padding;
  vec3 axis_u;
  float tile_count;
  vec3 axis_v;
  float columns;
  vec3 axis_slice;
  float rows;
  vec2 tile_texels;
};
SHARED_SIZE(ProjectionParams, 88);

struct ProjectionOutcome {
  vec4 uvs;    // uv1, uv2
  vec4 value;  // of volume_sample
  vec3 adjusted_position;
  float blend_mask;
  vec3 trilinear_uvw;  // where a 3D texture has the same value
  float volume_mask;
};
SHARED_SIZE(ProjectionOutcome, 64);

SHARED_END
#endif
