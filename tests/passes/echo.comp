// Writes a number of its own to every member of every struct that C++ and the shaders share.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/accumulate.h"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/hole.h"
#include "shared/smoke_light.h"
#include "shared/light.h"
#include "shared/resolve.h"
#include "shared/smoke_shadow.h"
#include "shared/noise.h"

layout(local_size_x = 1) in;
layout(scalar, binding = 0) buffer Out0 { FrameConstants frame; };
layout(scalar, binding = 1) buffer Out1 { Light light; };
layout(scalar, binding = 2) buffer Out2 { Hole hole; };
layout(scalar, binding = 3) buffer Out3 { BoundaryCell cell; };
layout(scalar, binding = 4) buffer Out4 { DrawConstants draw; };
layout(scalar, binding = 5) buffer Out5 { Vertex vertex; };
layout(scalar, binding = 6) buffer Out6 { NoiseParams noise; };
layout(scalar, binding = 7) buffer Out7 { SmokeLightParams smoke_light; };
layout(scalar, binding = 8) buffer Out8 { SmokeShadowParams smoke_shadow; };
layout(scalar, binding = 9) buffer Out9 { ShadowView view; };
layout(scalar, binding = 11) buffer Out11 { SmokeShadowFace smoke_face; };
layout(scalar, binding = 10) buffer Out10 { RayEnds ends; };
layout(scalar, binding = 12) buffer Out12 { MarchList march_list; };
layout(scalar, binding = 13) buffer Out13 { AccumulateParams accumulate; };
layout(scalar, binding = 14) buffer Out14 { AccumulatedPixel pixel; };
layout(scalar, binding = 15) buffer Out15 { TexelList light_row; };
layout(scalar, binding = 16) buffer Out16 { ShadowRays light_pair; };
layout(scalar, binding = 17) buffer Out17 { LightGather light_brick; };

vec2 v2(float first) { return vec2(first, first + 1.0); }
vec3 v3(float first) { return vec3(first, first + 1.0, first + 2.0); }
vec4 v4(float first) { return vec4(first, first + 1.0, first + 2.0, first + 3.0); }
ivec3 i3(int first) { return ivec3(first, first + 1, first + 2); }
mat4 m4(float first) { return mat4(v4(first), v4(first + 4.0), v4(first + 8.0), v4(first + 12.0)); }

void main() {
  frame.camera = Camera(m4(100.0), v3(120.0), 123.0, v3(124.0), v3(127.0), v3(130.0));
  frame.sky = Sky(v3(140.0), v3(143.0), v3(146.0), 149.0, 189.0);
  frame.look = SmokeLook(v3(150.0), 153.0, 154.0, 155.0, 156.0, 157.0, 158.0, 159.0, 160.0, 161.0, 162.0, Phase(163.0, 164.0, 165.0, 166.0));
  frame.volume = VolumeLayout(v3(170.0), 173.0, i3(174), i3(177), i3(180), v3(183.0), v3(186.0));
  frame.caster_bounds_min = v3(210.0);
  frame.caster_bounds_max = v3(213.0);
  frame.solid = SolidLayout(v3(200.0), 203.0, i3(204));
  frame.size_px = uvec2(190u, 191u);
  frame.light_count = 192u;
  frame.holes = HoleClusterLayout(193u, 198u, 199u, 200u);
  frame.frame_index = 194u;
  frame.time = 195.0;
  frame.exposure = 196.0;
  frame.march_scale = 197u;
  frame.resolve_error = 201.0;
  light = Light(v3(1.0), 4.0, v3(5.0), 8u, v3(9.0), 12.0, 13.0, 14u, vec2(15.0, 16.0));
  hole = Hole(v3(1.0), 4.0, v3(5.0), 8.0, v3(9.0), 12.0, v3(13.0), 16.0, 17.0, 18.0, 19.0, 20u, v2(21.0), v2(23.0));
  cell = BoundaryCell(1u, 2u, 3u, 4u);
  draw = DrawConstants(v4(1.0), v4(5.0), v4(9.0), MaterialConstants(v3(13.0), 16.0, v3(17.0), 20.0, 21.0));
  vertex = Vertex(v3(1.0), v3(4.0), v4(7.0), vec2(11.0, 12.0));
  noise = NoiseParams(1u, 2u, 3u);
  smoke_light = SmokeLightParams(1u, 2u, 3u);
  light_row = TexelList(1u, 2u, 3u, 4u, 5u, 6u);
  light_pair = ShadowRays(1u, 2u, 3u, 4u, 5u);
  light_brick = LightGather(1u, 2u, 3u, 4u, 5u, 6u);
  smoke_shadow = SmokeShadowParams(1u, 2.0, 3u, uvec2(4u, 5u));
  smoke_face = SmokeShadowFace(1.0, vec2(2.0, 3.0), 4u, uvec2(5u, 6u), uvec2(7u, 8u));
  view = ShadowView(m4(1.0), m4(17.0));
  ends = RayEnds(vec2(1.0, 2.0), 3.0, 4.0, 5.0, 6.0);
  march_list = MarchList(uvec3(1u, 2u, 3u), 4u);
  accumulate = AccumulateParams(m4(1.0), 17u);
  pixel = AccumulatedPixel(1.0, 2.0);
}
