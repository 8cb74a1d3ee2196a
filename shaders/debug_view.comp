// Debug views of intermediate data (shared/debug_view.h): the view kView in 8 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/debug_view.h"
#include "shared/display.h"
#include "shared/hole_clusters.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kView = kViewNone;
const uint kHoles = kHolesClustered;
layout(scalar, push_constant) uniform Push { DebugViewParams params; };
layout(binding = kBindRadiance, rgba16f) uniform readonly image2D radiance_image;
layout(binding = kBindDisplay, rgba8) uniform writeonly image2D display;
#include "lib/legend.glsl"
#include "lib/ray_views.glsl"
#include "lib/slice_view.glsl"
#include "lib/view_pixel.glsl"
#include "lib/voxel_views.glsl"

vec3 depth_view(ViewPixel pixel) {
  const float along_axis_m = pixel.surface_m / length(pixel.along);
  return pixel.has_surface ? ramp_colour(ramp_of_view(kView), depth_fraction(along_axis_m)) : backdrop();
}

/// The radiance of a frame with this view is a count of quads.
vec3 overdraw_view(ViewPixel pixel) {
  const float quads = imageLoad(radiance_image, pixel.px).r;
  return heat_colour(ramp_of_view(kView), quads / params.full, dimmed_scene(pixel));
}

vec3 view_colour(ViewPixel pixel) {
  switch (kView) {
    case kViewSolid: return solid_view(pixel);
    case kViewDistance: return distance_view(pixel);
    case kViewDensity: return slice_view(pixel);
    case kViewLight: return slice_view(pixel);
    case kViewHoles: return holes_view(pixel);
    case kViewSteps: return steps_view(pixel);
    case kViewBricks: return bricks_view(pixel);
    case kViewNormals: return pixel.has_surface ? 0.5 + 0.5 * pixel.normal : backdrop();
    case kViewAlbedo: return pixel.has_surface ? srgb_from_linear(pixel.albedo) : backdrop();
    case kViewOverdraw: return overdraw_view(pixel);
    default: return depth_view(pixel);
  }
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const vec3 colour = view_colour(view_pixel(px));
  imageStore(display, px, vec4(with_legend(colour, px, ramp_of_view(kView)), 1.0));
}
