// Trilinear samples of a volume from a slice atlas, an image with the slices of the volume as tiles: two bilinear
// fetches, in the tiles before and behind the point, and a blend of both. The same in GLSL and HLSL, for any engine.
//
//   GLSL  VolumeProjection p = volume_projection(dimensions, adjusted_position, slices);
//         vec4 value = volume_sample(atlas, p, 0.0);
//   HLSL  VolumeProjection p = volume_projection(dimensions, adjusted_position, slices);
//         float4 value = volume_sample(atlas, atlas_sampler, p, 0.0);
//
// Atlas: u runs right along the rows of texels, v down; (0, 0) is the top left corner of the image. Tiles follow each
// other row by row from the top left, in the order of the third axis of the volume; the last row may be partly empty.
// Tile i is the mean of the slab [i, i + 1) / tile_count of that axis, so that its centre is at (i + 0.5) / tile_count.
//
// Inside of the box, a sample equals that of a 3D texture with linear filtering that is clamped to its edges. The UVs
// stay half a texel inside of their tile, so that no fetch of mip level 0 reaches another tile or the padding. Level l
// requires 2^l texels of padding that mirror the tile beside them, and a tile_texels that 2^l divides.
//
// The UVs jump from tile to tile, where their derivatives would select the coarsest mip level. The level is therefore
// an argument, which also permits calls in compute shaders and in branches.
//
// Any unit and handedness will do, the same for all vectors. Unreal: centimetres, Z up.
#ifndef VOLUME_PROJECTION_GLSL
#define VOLUME_PROJECTION_GLSL

#define VOLUME_ATLAS sampler2D atlas
#define VOLUME_TEXEL(uv, lod) textureLod(atlas, uv, lod)

// The layout of an atlas. All are whole numbers.
struct VolumeSlices {
  vec2 tile_texels;  // size of a tile without its padding
  float padding;     // texels around each tile, at least 0
  float tile_count;  // slices, at least 1
  float columns;     // tiles in a row, at least 1
  float rows;        // at least tile_count / columns, rounded up
};

struct VolumeProjection {
  vec2 uv1;           // in the tile before the point
  vec2 uv2;           // in the tile behind it; behind the last tile, in that
  float blend_mask;   // weight of uv2, in [0, 1)
  float volume_mask;  // 1 inside of the box and on its faces, 0 outside
};

// A point of the world relative to the centre of the volume, along its axes: those of u, of v, and from the first slice
// to the last. They are unit vectors in the world.
vec3 volume_adjusted_position(vec3 position_world, vec3 center_world,
                              vec3 axis_u, vec3 axis_v, vec3 axis_slice) {
  vec3 from_center = position_world - center_world;
  return vec3(dot(from_center, axis_u), dot(from_center, axis_v), dot(from_center, axis_slice));
}

// The UV of a point in a tile. `texel` is counted from the top left corner of the tile.
vec2 volume_tile_uv(VolumeSlices slices, float tile, vec2 texel) {
  float row = floor((tile + 0.5) / slices.columns);  // the half keeps the quotient off whole numbers, whatever rounds
  vec2 pitch = slices.tile_texels + 2.0 * slices.padding;
  vec2 at = vec2(tile - row * slices.columns, row) * pitch + slices.padding + texel;
  return at / (vec2(slices.columns, slices.rows) * pitch);
}

// dimensions: size of the box along the axes of adjusted_position, above 0. Points outside have the UVs and the blend
// mask of the nearest point inside.
VolumeProjection volume_projection(vec3 dimensions, vec3 adjusted_position, VolumeSlices slices) {
  vec3 inside = step(abs(adjusted_position), 0.5 * dimensions);
  vec3 uvw = adjusted_position / dimensions + 0.5;
  vec2 texel = min(max(uvw.xy * slices.tile_texels, 0.5), slices.tile_texels - 0.5);
  float slice = min(max(uvw.z * slices.tile_count - 0.5, 0.0), slices.tile_count - 1.0);
  float tile = floor(slice);

  VolumeProjection projection;
  projection.uv1 = volume_tile_uv(slices, tile, texel);
  projection.uv2 = volume_tile_uv(slices, min(tile + 1.0, slices.tile_count - 1.0), texel);
  projection.blend_mask = slice - tile;
  projection.volume_mask = inside.x * inside.y * inside.z;
  return projection;
}

// The value of the volume at a projected point, 0 outside of the box. The sampler filters linearly.
vec4 volume_sample(VOLUME_ATLAS, VolumeProjection projection, float lod) {
  vec4 before = VOLUME_TEXEL(projection.uv1, lod);
  vec4 behind = VOLUME_TEXEL(projection.uv2, lod);
  return mix(before, behind, projection.blend_mask) * projection.volume_mask;
}

#endif
