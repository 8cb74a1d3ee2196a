// Transfer functions of volumes, after filtering. A function is read over the values of a ray segment, not at a point:
// with the value linear between the segment's ends, the mean of the curve over these values is exact, and a peak
// that is narrower than the difference of two samples keeps its optical depth (pre-integration: Engel, Kraus and
// Ertl 2001, "High-Quality Pre-Integrated Volume Rendering Using Hardware-Accelerated Pixel Shading"). The integrals of
// the curves give the means between any two ends.
//
// The includer defines the constant kMedia.
#ifndef VOLUME_TRANSFER_GLSL
#define VOLUME_TRANSFER_GLSL
#include "lib/volume_values.glsl"
#include "shared/media.h"

const bool kHasTransfer = (kMedia & kMediumTransfer) != 0u, kHasColorGrids = (kMedia & kMediumColors) != 0u;
const bool kHasVolumeDetail = (kMedia & kMediumVolumeDetail) != 0u;
const bool kHasSeveral = (kMedia & kMediumSeveral) != 0u;
/// Whether the gathered light is stored per albedo.
const bool kHasAlbedos = (kMedia & kMediaOfAlbedos) != 0u;

layout(scalar, binding = kBindTransfers) readonly buffer Transfers { vec4 transfers[]; };
layout(binding = kBindColorGrids) uniform sampler3D color_grids;

/// What a volume is over a segment of a ray.
struct VolumeMatter {
  float density;  // per look.extinction
  vec3 albedo, emission;
};

/// The integral of table i up to a position in [0, 1].
vec4 transfer_integral(uint i, float position) {
  const float at = position * float(kTransferCells);
  const uint cell = min(uint(at), kTransferCells - 1u), entry = i * kTransferEntries + 1u + cell;
  // Not mix, which rounds where both are equal: the difference of two integrals there must be 0.
  return transfers[entry] + (transfers[entry + 1u] - transfers[entry]) * (at - float(cell));
}

/// The mean of table i between two positions, at least over a cell; beyond the range it is that of the range's end.
vec4 transfer_mean(uint i, vec2 positions) {
  positions = clamp(positions, vec2(-kTransferReach), vec2(1.0 + kTransferReach));
  float low = min(positions.x, positions.y), high = max(positions.x, positions.y);
  const float widened = 0.5 * max(1.0 / float(kTransferCells) - (high - low), 0.0);
  low -= widened;
  high += widened;
  vec4 sum = transfer_integral(i, clamp(high, 0.0, 1.0)) - transfer_integral(i, clamp(low, 0.0, 1.0));
  sum += max(min(high, 0.0) - low, 0.0) * transfers[i * kTransferEntries];
  sum += max(high - max(low, 1.0), 0.0) * transfers[(i + 1u) * kTransferEntries - 1u];
  return max(sum / (high - low), vec4(0.0));
}

/// Of volume i, from the values at the two ends of a segment. Nothing is where both are 0, whatever the curve: else the
/// bricks would show.
VolumeMatter matter_of(VolumeInstance volume, uint i, vec2 values) {
  VolumeMatter matter = VolumeMatter(0.5 * (values.x + values.y), volume.look.albedo, volume.look.emission);
  if (volume.transfer_kind == kTransferNone || matter.density <= 0.0) return matter;
  const vec4 mean = transfer_mean(i, values * volume.transfer.per_value + volume.transfer.first);
  const vec3 color = mean.a > 0.0 ? min(mean.rgb / mean.a, vec3(1.0)) : vec3(0.0);
  matter.albedo = volume.transfer.scattered * color;
  matter.emission = volume.transfer.emitted * color;
  if (volume.transfer_kind == kTransferOpacity) matter.density = mean.a;
  return matter;
}

/// Half a step of a ray, at most half a voxel along any axis: as far as the apron of a brick reaches [m].
float half_segment(vec3 per_metre, float ds) {
  const vec3 voxels = abs(per_metre);
  return 0.5 * min(ds, 1.0 / max(voxels.x, max(voxels.y, voxels.z)));
}

/// The colour of a volume's grid at a point of a brick of its own.
vec3 grid_color(VolumeInstance volume, BrickAt brick, vec3 p_voxel) {
  const vec3 corner = atlas_corner(volume.color_bricks, brick.slot);
  const vec3 uvw = (corner + p_voxel - brick.low) * volume.color_bricks.atlas_texel;
  return textureLod(color_grids, uvw, 0.0).rgb;
}

/// The values at the ends of a segment inside of a volume's bounds.
vec2 end_values(VolumeInstance volume, vec3 p_voxel, vec3 half_voxels) {
  // What is on a high bound is in the brick behind it.
  const vec3 low = volume.bounds_min + 1e-3, high = volume.bounds_max - 1e-3;
  return vec2(volume_value(volume.bricks, clamp(p_voxel - half_voxels, low, high)),
              volume_value(volume.bricks, clamp(p_voxel + half_voxels, low, high)));
}

/// The matter of a segment around a point of the volume's voxel space: from p_voxel - half_voxels to + half_voxels.
VolumeMatter matter_around(VolumeInstance volume, uint i, vec3 p_voxel, vec3 half_voxels) {
  if (!kHasAlbedos) return VolumeMatter(volume_value(volume.bricks, p_voxel), volume.look.albedo, volume.look.emission);
  const vec2 values =
      kHasTransfer ? end_values(volume, p_voxel, half_voxels) : vec2(volume_value(volume.bricks, p_voxel));
  VolumeMatter matter = matter_of(volume, i, values);
  if (kHasColorGrids && volume.color_kind == kColorsAlbedo) {
    const BrickAt brick = volume_brick(volume.bricks, p_voxel);
    if (brick.slot != kNoSlot) matter.albedo *= grid_color(volume, brick, p_voxel);
  }
  return matter;
}

/// A line through a texture: at + t along.
struct TextureRay {
  vec3 at, along;
};

/// A ray through the brick of a span, in an atlas.
TextureRay texture_ray(BrickLayout bricks, BrickSpan span, VoxelRay ray) {
  const vec3 corner = atlas_corner(bricks, span.slot) - span.low;
  return TextureRay((corner + ray.origin) * bricks.atlas_texel, ray.per_metre * bricks.atlas_texel);
}

/// The matter of volume i in the step around t, from rays through its values and colours. `uniform_value` is
/// that of a uniform brick, else below 0.
VolumeMatter matter_along(VolumeInstance volume, uint i, TextureRay values, TextureRay colors, float uniform_value,
                          vec3 per_metre, float ds, float t) {
  const vec3 uvw = values.at + t * values.along;
  VolumeMatter matter;
  if (kHasTransfer) {
    const vec3 along = half_segment(per_metre, ds) * values.along;
    vec2 ends = vec2(uniform_value);
    if (uniform_value < 0.0)
      ends = vec2(textureLod(volume_values, uvw - along, 0.0).r, textureLod(volume_values, uvw + along, 0.0).r);
    matter = matter_of(volume, i, ends);
  } else {
    matter = VolumeMatter(uniform_value, volume.look.albedo, volume.look.emission);
    if (uniform_value < 0.0) matter.density = textureLod(volume_values, uvw, 0.0).r;
  }
  if (kHasColorGrids && volume.color_kind == kColorsAlbedo)
    matter.albedo *= textureLod(color_grids, colors.at + t * colors.along, 0.0).rgb;
  return matter;
}

#endif
