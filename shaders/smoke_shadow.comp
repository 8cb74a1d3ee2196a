// For each direction from a light: the optical depth of the smoke up to the first surface. What a surface that the
// light reaches has to be dimmed by.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 4
#define BINDING_DENSITY 5
#define BINDING_CELLS 6
#define BINDING_BOUNDARY 7
#define BINDING_CORNERS 8
#define BINDING_HOLES 11
#define BINDING_HOLE_GRID 12
#define BINDING_HOLE_MASKS 13
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/smoke_shadow.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 2) readonly buffer Views { ShadowView sun; };
layout(binding = 3) uniform sampler2DArray shadows;
layout(binding = 9) uniform sampler3D drift_atlas;
layout(binding = 10, r16f) uniform writeonly image2DArray smoke_shadows;
layout(push_constant, scalar) uniform Push { SmokeShadowParams params; };
#include "lib/optical_depth.glsl"

void main() {
  const uvec3 at = gl_GlobalInvocationID;
  if (any(greaterThanEqual(at.xy, uvec2(params.size)))) return;
  const Light light = lights[params.light];
  const vec2 uv = (vec2(at.xy) + 0.5) / float(params.size);
  const vec2 ndc = uv * 2.0 - 1.0;
  const float layer = float(light.shadow_layer + at.z);
  const float depth = textureLod(shadows, vec3(uv, layer), 0.0).r;

  // From the light to the first surface.
  vec3 from, to;
  if (light.kind == kLightDirectional) {
    from = (sun.world_from_clip * vec4(ndc, 1.0, 1.0)).xyz;
    to = (sun.world_from_clip * vec4(ndc, depth, 1.0)).xyz;
  } else {
    const vec3 ray = cube_forward(at.z) + ndc.x * cube_right(at.z) - ndc.y * cube_up(at.z);
    from = light.position_world;
    to = from + ray * min(kShadowNear / max(depth, 1e-6), light.range);
  }
  const float distance_m = length(to - from);
  const vec3 p_voxel = (from - frame.volume.origin_world) / frame.volume.voxel_size;
  const float tau = optical_depth(p_voxel, (to - from) / max(distance_m, 1e-6), distance_m, params.max_steps);
  imageStore(smoke_shadows, ivec3(at.xy, int(layer)), vec4(tau));
}
