// A pixel of a debug view: its ray, and the surface behind. The includer has `params`.
#ifndef VIEW_PIXEL_GLSL
#define VIEW_PIXEL_GLSL
#include "lib/camera.glsl"
#include "lib/frame.glsl"
#include "shared/debug_view.h"
#include "shared/gbuffer.h"

layout(binding = kBindAlbedoRoughness) uniform sampler2D albedo_roughness;
layout(binding = kBindNormalMetallic) uniform sampler2D normal_metallic;
layout(binding = kBindDepth) uniform sampler2D depth;

struct ViewPixel {
  ivec2 px;
  vec3 along;       // of the ray; one unit along the view axis
  vec3 direction;   // of the ray, unit
  float surface_m;  // distance of the surface along the ray; huge where there is none
  vec3 normal, albedo;
  bool has_surface;
};

ViewPixel view_pixel(ivec2 px) {
  ViewPixel pixel;
  pixel.px = px;
  pixel.along = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  pixel.direction = normalize(pixel.along);
  const float d = texelFetch(depth, px, 0).r;
  pixel.has_surface = d > 0.0;
  pixel.surface_m = view_distance(frame.camera, d) * length(pixel.along);
  pixel.normal = normalize(texelFetch(normal_metallic, px, 0).xyz);
  pixel.albedo = texelFetch(albedo_roughness, px, 0).rgb;
  return pixel;
}

/// The dimmed scene behind a view.
vec3 dimmed_scene(ViewPixel pixel) {
  if (!pixel.has_surface) return backdrop();
  const float luminance = dot(pixel.albedo, vec3(0.2126, 0.7152, 0.0722));
  return dimmed_surface(luminance, abs(dot(pixel.normal, pixel.direction)));
}

/// Width of a pixel at a distance, on a plane seen under this cosine [voxels].
float pixel_voxels(ViewPixel pixel, float distance_m, float facing) {
  const float at_one = 2.0 * length(frame.camera.up) / float(frame.size_px.y) / length(pixel.along);
  return at_one * distance_m / params.voxel_size / max(facing, 0.1);
}

/// Distance along the ray to the slice [m].
float slice_distance(ViewPixel pixel) {
  const int axis = params.slice_axis;
  return (params.slice_world - frame.camera.eye_world[axis]) / pixel.direction[axis];
}

vec3 eye_voxel() { return (frame.camera.eye_world - params.grid_origin_world) / params.voxel_size; }

/// A colour behind the pixel's surface, or in front of it.
vec3 over_surface(ViewPixel pixel, float distance_m, vec3 behind, vec3 colour) {
  return distance_m > pixel.surface_m ? mix(behind, colour, kOccludedOpacity) : colour;
}

#endif
