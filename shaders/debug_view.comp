// Pictures of what the picture is made from (shared/debug_view.h): one view, that kView names, in 8 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 1
#define BINDING_DENSITY 2
#define BINDING_CELLS 3
#define BINDING_BOUNDARY 4
#define BINDING_CORNERS 5
#define BINDING_HOLES 10
#define BINDING_HOLE_LISTS 11
#define BINDING_HOLE_MASKS 12
#define BINDING_LEVEL 14
#define BINDING_WAYS 15
#include "lib/camera.glsl"
#include "lib/smoke_density.glsl"
#include "lib/tone.glsl"
#include "shared/debug_view.h"
#include "shared/frame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kView = kViewNone;
const uint kHoles = kHolesClustered;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 6) uniform sampler3D inscatter_atlas;
layout(binding = 7) uniform sampler2D albedo_roughness;
layout(binding = 8) uniform sampler2D normal_metallic;
layout(binding = 9) uniform sampler2D depth;
layout(scalar, binding = 13) readonly buffer Filled { uint filled[]; };
layout(scalar, binding = 16) readonly buffer Counters {
  uint texture_samples;
  uint ray_steps[];
};
layout(binding = 17, rgba8) uniform writeonly image2D display;
layout(scalar, push_constant) uniform Impulse { DebugViewParams params; };
#include "lib/legend.glsl"
#include "lib/ray_holes.glsl"
#include "lib/voxel_rays.glsl"

/// What a pixel looks along, and the surface that it sees.
struct Look {
  ivec2 px;
  vec3 along;       // one unit along the view axis
  vec3 direction;   // unit
  float surface_m;  // along the direction; huge where nothing is
  vec3 normal, albedo;
  bool surface;
};

Look look_at(ivec2 px) {
  Look look;
  look.px = px;
  look.along = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  look.direction = normalize(look.along);
  const float d = texelFetch(depth, px, 0).r;
  look.surface = d > 0.0;
  look.surface_m = view_distance(frame.camera, d) * length(look.along);
  look.normal = normalize(texelFetch(normal_metallic, px, 0).xyz);
  look.albedo = texelFetch(albedo_roughness, px, 0).rgb;
  return look;
}

/// The scene below what a view shows.
vec3 dimmed_scene(Look look) {
  if (!look.surface) return backdrop();
  return dimmed_surface(dot(look.albedo, vec3(0.2126, 0.7152, 0.0722)), abs(dot(look.normal, look.direction)));
}

/// Width of a pixel at a distance, on a plane seen at an angle [voxels].
float pixel_voxels(Look look, float distance_m, float facing) {
  const float at_one = 2.0 * length(frame.camera.up) / float(frame.size_px.y) / length(look.along);
  return at_one * distance_m / params.voxel_size / max(facing, 0.1);
}

/// Where a ray comes through the slice [m].
float slice_distance(Look look) {
  const int axis = params.slice_axis;
  return (params.slice_world - frame.camera.eye_world[axis]) / look.direction[axis];
}

vec3 eye_voxel() { return (frame.camera.eye_world - params.grid_origin_world) / params.voxel_size; }

/// The two axes of a face, as unit steps.
void face_axes(ivec3 normal, out ivec3 u, out ivec3 v) {
  u = normal.x != 0 ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
  v = normal.z != 0 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
}

// ---- solid voxels, and those of the smoke by their distance

vec3 solid_view(Look look) {
  const VoxelHit hit = first_voxel(eye_voxel(), look.direction, 0.0, 1e6);
  if (hit.what == 0u) return backdrop();
  ivec3 u, v;
  face_axes(hit.normal, u, v);
  const vec3 at = eye_voxel() + look.direction * hit.t - vec3(hit.voxel);
  const vec2 f = clamp(vec2(dot(at, vec3(u)), dot(at, vec3(v))), 0.0, 1.0);
  uint around = 0u;
  for (int i = 0; i < 9; ++i) {
    if (i != 4) around |= voxel_at(hit.voxel + hit.normal + (i % 3 - 1) * u + (i / 3 - 1) * v) << uint(i);
  }
  const float distance_m = hit.t * params.voxel_size;
  const bool outside = hit.normal != ivec3(0);
  const float width = pixel_voxels(look, distance_m, abs(dot(vec3(hit.normal), look.direction)));
  return solid_colour(hit.normal, outside ? face_light(around, f) : 1.0, outside ? grid_line(f, width) : 0.0, distance_m);
}

/// How far smoke came to a voxel [m].
float way_metres(uint way) { return float(way - 1u) * 0.1 * params.voxel_size; }

/// Lines a whole number of metres from the source: between voxels on either side of one.
float iso_line(VoxelHit hit, ivec3 normal, vec2 f, float width) {
  ivec3 u, v;
  face_axes(normal, u, v);
  const float own = floor(way_metres(hit.what));
  float line = 0.0;
  for (int i = 0; i < 4; ++i) {
    const uint other = voxel_at(hit.voxel + (i < 2 ? u : v) * (i % 2 * 2 - 1));
    const float x = i < 2 ? f.x : f.y;
    const bool differs = other != 0u && other != kNoWay && hit.what != kNoWay && floor(way_metres(other)) != own;
    line = max(line, differs ? line_share(i % 2 == 0 ? x : 1.0 - x, 1.5 * width) : 0.0);
  }
  return line;
}

/// Smoke around the eye is left out as far as this [m].
const float kCleared = 1.0;

vec3 distance_view(Look look) {
  const vec3 behind = dimmed_scene(look);
  // Cut open at the slice: what lies beyond it is shown, seen from the eye.
  const float t_slice = slice_distance(look);
  if (!(t_slice > 0.0 && t_slice < 1e6)) return behind;
  const VoxelHit hit = first_voxel(eye_voxel(), look.direction, max(kCleared, t_slice) / params.voxel_size, 1e6);
  if (hit.what == 0u) return behind;
  const float distance_m = hit.t * params.voxel_size;
  ivec3 normal = hit.normal;
  if (normal == ivec3(0)) normal[params.slice_axis] = look.direction[params.slice_axis] > 0.0 ? -1 : 1;
  ivec3 u, v;
  face_axes(normal, u, v);
  const vec3 at = eye_voxel() + look.direction * hit.t - vec3(hit.voxel);
  const vec2 f = clamp(vec2(dot(at, vec3(u)), dot(at, vec3(v))), 0.0, 1.0);
  const float width = pixel_voxels(look, distance_m, abs(dot(vec3(normal), look.direction)));
  const float lines = max(0.18 * grid_line(f, width), 0.75 * iso_line(hit, normal, f, width));
  const vec3 colour = min(way_colour(hit.what, way_metres(hit.what), params.full) * way_tone(normal), vec3(1.0)) * (1.0 - lines);
  return distance_m > look.surface_m ? mix(behind, colour, kSeenThrough) : colour;
}

// ---- a slice through the world

vec3 slice_view(Look look) {
  const vec3 behind = dimmed_scene(look);
  const int axis = params.slice_axis;
  const float t = slice_distance(look);
  vec3 p_voxel = eye_voxel() + look.direction * (t / params.voxel_size);
  // On the slice to the last bit, so that the voxel is the same for every pixel.
  p_voxel[axis] = (params.slice_world - params.grid_origin_world[axis]) / params.voxel_size;
  const bool on_slice = t > 0.0 && t < 1e6 && all(greaterThanEqual(p_voxel, vec3(0.0))) && all(lessThan(p_voxel, vec3(params.grid_size)));
  if (!on_slice) return behind;

  const ivec3 voxel = ivec3(p_voxel);
  const float width = pixel_voxels(look, t, abs(look.direction[axis]));
  const vec2 f = fract(axis == 0 ? p_voxel.yz : axis == 1 ? p_voxel.xz : p_voxel.xy);
  const float line = grid_line(f, width);
  vec3 colour = slice_air(line, behind);
  const ivec3 brick = voxel >> 3;
  int empty_edge;
  const uint slot = slot_at(frame.volume, brick, empty_edge);
  if (voxel_at(voxel) != 0u) {
    colour = slice_wall(line);
  } else if (slot != kNoSlot) {
    const vec3 local = p_voxel - vec3(brick * kBrickVoxels), texel = atlas_texel(frame.volume);
    const vec3 uvw = (atlas_corner(frame.volume, slot) + local) * texel;
    const SmokeSample here = sample_brick(slot, local, uvw);
    if (kView == kViewDensity) {
      colour = density_colour(here.density, colour);
    } else {
      const vec3 light = textureLod(inscatter_atlas, uvw + here.light_offset * texel, 0.0).rgb * frame.look.albedo;
      colour = mix(colour, srgb_from_linear(tone_curve(light * frame.exposure)), smoothstep(0.0, 0.06, here.density));
    }
  }
  // Behind a surface the slice is seen through it, darker.
  return t > look.surface_m ? mix(behind, colour, kSeenThrough) : colour;
}

// ---- numbers of a pixel's ray

/// Where a ray is within the smoke's bounds, up to the surface [m].
vec2 in_smoke(Look look) {
  const VolumeLayout volume = frame.volume;
  const vec3 inverse = 1.0 / (look.direction + vec3(equal(look.direction, vec3(0.0))) * 1e-9);
  const vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size - frame.camera.eye_world;
  const vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size - frame.camera.eye_world;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, look.surface_m)));
}

vec3 holes_view(Look look) {
  const vec2 reach = in_smoke(look);
  const RayHoles holes = holes_of_ray(vec2(look.px) + 0.5);
  // Fine enough for the narrowest of shots: a quarter of the march's step.
  const float count = holes.blocks == 0u ? 0.0 : clamp(ceil(4.0 * (reach.y - reach.x) / frame.look.step_length), 0.0, 4096.0);
  const float ds = (reach.y - reach.x) / max(count, 1.0);
  float cleared_m = 0.0;
  for (float i = 0.5; i < count; i += 1.0) {
    const float t = reach.x + i * ds;
    cleared_m += ds * (1.0 - remaining_after_holes(holes, t, frame.camera.eye_world + look.direction * t, 0.0, true));
  }
  return heat_colour(ramp_of_view(kView), cleared_m / params.full, dimmed_scene(look));
}

vec3 steps_view(Look look) {
  const uint steps = ray_steps[uint(look.px.x) + frame.size_px.x * uint(look.px.y)];
  return heat_colour(ramp_of_view(kView), float(steps) / params.full, dimmed_scene(look));
}

// ---- bricks

/// A box seen along a ray, over what is behind it: its edges, and a tint.
struct BoxLook {
  float line;  // of the edges of the faces that the ray enters and leaves by
  float way;   // inside the box [voxels]
};

BoxLook box_on_ray(vec3 origin, vec3 direction, vec3 low, vec3 high, Look look, float t_end) {
  const vec3 inverse = vec3(dda_inverse(direction.x), dda_inverse(direction.y), dda_inverse(direction.z));
  const vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
  const float enter = max(dda_max(min(a, b)), 0.0), leave = min(dda_min(max(a, b)), t_end);
  BoxLook seen = BoxLook(0.0, max(leave - enter, 0.0));
  if (enter >= leave) return seen;
  for (int end = 0; end < 2; ++end) {
    const float t = end == 0 ? enter : leave;
    const vec3 at = origin + direction * t;
    const vec3 apart = min(abs(at - low), abs(at - high));
    // On a face one distance is 0; an edge is where a second one is.
    const float second = apart.x + apart.y + apart.z - dda_max(apart) - dda_min(apart);
    const float width = pixel_voxels(look, t * params.voxel_size, 1.0);
    seen.line = max(seen.line, t < t_end ? line_share(second, width) * (end == 0 ? 1.0 : 0.4) : 0.0);
  }
  return seen;
}

vec3 bricks_view(Look look) {
  vec3 colour = vec3(0.0);
  float through = 1.0;
  const vec3 origin = eye_voxel();
  const float t_end = look.surface_m / params.voxel_size;
  const ivec3 first = frame.volume.window_origin * kNodeBricks, last = first + frame.volume.window_size * kNodeBricks;
  Dda d = dda_begin(origin, look.direction, first, last, kBrickVoxels, 0.0, t_end);
  while (d.t < d.t_end && through > 0.02) {
    const uint slot = smoke_brick(d.cell);
    if (slot != kNoSlot) {
      const vec3 low = vec3(d.cell * kBrickVoxels);
      const vec3 fill_low = vec3(cells_low(filled[slot])), fill_high = vec3(cells_end(filled[slot]));
      const vec3 fill = max(fill_high - fill_low, vec3(0.0));
      const float share = fill.x * fill.y * fill.z / float(kCellsPerBrick);
      const BoxLook brick = box_on_ray(origin, look.direction, low, low + float(kBrickVoxels), look, t_end);
      // Cell 0 of a brick begins half a voxel before it.
      const vec3 from = low + max(fill_low - 0.5, vec3(0.0)), to = low + min(fill_high - 0.5, vec3(float(kBrickVoxels)));
      const BoxLook inside = share > 0.0 ? box_on_ray(origin, look.direction, from, to, look, t_end) : BoxLook(0.0, 0.0);
      const vec3 tint = ramp_colour(kRampViridis, 0.15 + 0.85 * share);
      const float cover = max(0.9 * brick.line, 1.0 - exp2(-0.05 * inside.way));
      const vec3 shown = mix(tint, share > 0.0 ? tint * 0.5 + 0.5 : vec3(0.75, 0.3, 0.3), brick.line);
      colour += through * cover * shown;
      through *= 1.0 - cover;
    }
    d = dda_step(d);
  }
  return colour + through * dimmed_scene(look);
}

vec3 shown(Look look) {
  switch (kView) {
    case kViewSolid: return solid_view(look);
    case kViewDistance: return distance_view(look);
    case kViewDensity: return slice_view(look);
    case kViewLight: return slice_view(look);
    case kViewHoles: return holes_view(look);
    case kViewSteps: return steps_view(look);
    case kViewBricks: return bricks_view(look);
    case kViewNormals: return look.surface ? 0.5 + 0.5 * look.normal : backdrop();
    case kViewAlbedo: return look.surface ? srgb_from_linear(look.albedo) : backdrop();
    default: return look.surface ? ramp_colour(ramp_of_view(kView), depth_share(look.surface_m / length(look.along))) : backdrop();
  }
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  imageStore(display, px, vec4(with_legend(shown(look_at(px)), px, ramp_of_view(kView)), 1.0));
}
