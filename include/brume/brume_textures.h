// Smoke as data, for a renderer of your own: textures that follow a field, and the constants of a frame.
// Library: libbrume-sim (and libbrume, which contains it). The shader that draws them:
// shaders/export/smoke.glsl and smoke.hlsl, installed in share/brume/shaders. Guide:
// docs/start/your-engine.md.
//
//   field --> textures --> regions to upload, constants --> brume_march() in your shader
//
// Example    Each frame, after brume_field_update:
//
// ```c
//   brume_textures_frame frame = brume_textures_frame_defaults();
//   frame.seconds = seconds;  // since tick 0, between two ticks too
//   check(brume_textures_update(textures, field, &frame));
//
//   brume_texture list[BRUME_TEXTURE_COUNT];
//   check(brume_textures_list(textures, list, BRUME_TEXTURE_COUNT));
//   for (uint32_t i = 0; i < BRUME_TEXTURE_COUNT; ++i)
//     if (list[i].generation != made[i]) make_texture(i, &list[i]), made[i] = list[i].generation;
//
//   const brume_region* regions;
//   size_t count;
//   check(brume_textures_regions(textures, &regions, &count));
//   for (size_t i = 0; i < count; ++i) upload(&regions[i]);  // glTexSubImage3D(..., regions[i].texels)
//
//   float constants[BRUME_CONSTANTS];
//   check(brume_textures_constants(textures, constants, BRUME_CONSTANTS));
//   glUniform4fv(location_of_brume_constants, BRUME_CONSTANTS / 4, constants);
// ```
//
// Memory     For each brick of 8^3 voxels with smoke or beside it 2,000 B of density, 8,000 B of
//            displacement and 2,916 B of cells, in textures of powers of two; 5.2 MB of noise; 16 B for each
//            cell at a wall and 8 B for each of its sides; 4,000 B of light for every two lights. Smoke of
//            225 m^3 in voxels of half a metre takes some 60 bricks.
//
// Uploads    Bricks whose densities or walls changed, and displacement and light of all bricks with smoke.
//
// Threads    As many as the context allows; results are the same for any number.
#ifndef BRUME_BRUME_TEXTURES_H
#define BRUME_BRUME_TEXTURES_H

#include <brume/brume.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Textures of the smoke of one field at a time.
typedef struct brume_textures brume_textures;

/// What each texture holds: its place in the list of brume_textures_list, and its name in the shader.
/// Textures are sampled with linear filtering where that is said, else read texel by texel; edges are clamped
/// except where they repeat.
typedef enum brume_texture_kind {
  BRUME_TEXTURE_DENSITY = 0,       ///< brume_density: RG8, 3D, linear.
  BRUME_TEXTURE_DISPLACEMENT = 1,  ///< brume_displacement: RGBA16F, 3D, linear.
  BRUME_TEXTURE_PAGES = 2,         ///< brume_pages: R16UI, 3D.
  BRUME_TEXTURE_CELLS = 3,         ///< brume_cells: R32UI, 3D.
  BRUME_TEXTURE_BOUNDARY = 4,      ///< brume_boundary: RGBA32UI, 2D.
  BRUME_TEXTURE_CORNERS = 5,       ///< brume_corners: RG32UI, 2D.
  BRUME_TEXTURE_HOLES = 6,         ///< brume_holes: RGBA32F, 2D.
  BRUME_TEXTURE_MASKS = 7,         ///< brume_masks: R8, 2D, linear.
  BRUME_TEXTURE_NOISE = 8,         ///< brume_noise: RGBA8, 3D, linear, repeats. Make its mip levels.
  BRUME_TEXTURE_DETAIL = 9,        ///< brume_detail: RG8, 3D, linear, repeats. Make its mip levels.
  BRUME_TEXTURE_LIGHT = 10,        ///< brume_light_volume: RGBA8, 3D, linear. Only with lights or the sky.
  BRUME_TEXTURE_COUNT = 11
} brume_texture_kind;

/// Channels, their bits and their type, as graphics interfaces name them. Texels are little-endian.
typedef enum brume_texture_format {
  BRUME_FORMAT_NONE = 0,  ///< The texture does not exist yet: its size is 0.
  BRUME_FORMAT_R8 = 1,    ///< Numbers in [0, 1], like RG8 and RGBA8.
  BRUME_FORMAT_RG8 = 2,
  BRUME_FORMAT_RGBA8 = 3,
  BRUME_FORMAT_RGBA16F = 4,  ///< Half floats.
  BRUME_FORMAT_RGBA32F = 5,
  BRUME_FORMAT_R16UI = 6,  ///< Unsigned integers, as those that follow.
  BRUME_FORMAT_R32UI = 7,
  BRUME_FORMAT_RG32UI = 8,
  BRUME_FORMAT_RGBA32UI = 9
} brume_texture_format;

/// A texture that your renderer makes.
typedef struct brume_texture {
  uint32_t format;                ///< A brume_texture_format.
  uint32_t width, height, depth;  ///< Size in texels; the depth of a 2D texture is 1.
  /// Rises when the texture has to be made again, empty: the regions of the same update then write all of it
  /// that is read.
  uint32_t generation;
} brume_texture;

/// A box of texels to be uploaded.
typedef struct brume_region {
  uint32_t texture;               ///< A brume_texture_kind.
  uint32_t x, y, z;               ///< Its first texel.
  uint32_t width, height, depth;  ///< Its size in texels.
  uint32_t reserved;              ///< 0.
  const void* texels;             ///< x fastest, then y, then z, without gaps between rows.
  size_t byte_count;              ///< The size of `texels` in bytes.
} brume_region;

/// The number of constants that the shader reads: ten rows of four.
#define BRUME_CONSTANTS 40
/// The largest number of holes that the shader cuts: the latest ones.
#define BRUME_MAX_TEXTURE_HOLES 128

/// The largest number of lights of a texture of light.
#define BRUME_MAX_TEXTURE_LIGHTS 15

/// The settings of new textures.
typedef struct brume_textures_params {
  uint32_t struct_size;
  const void* next;
  const brume_drawn_params* look;  ///< The noise that erodes the smoke; null: the defaults.
  float swirl_seconds;             ///< Time in which the noise rolls around once [s], [0.1, 1000].
  /// Distance of the points at which the noise's displacement is known, 1 or 2 [voxels]. 2: a fifth of the
  /// uploads; the noise then differs from what brume_field_drawn_depths count, by about 1/100 of the light.
  uint32_t noise_spacing;
  /// Number of lights whose way through smoke and walls is found on the CPU, [0, BRUME_MAX_TEXTURE_LIGHTS].
  uint32_t light_count;
  uint32_t sky;  ///< 1: the sky's light is found, too; 0: it is not.
} brume_textures_params;

/// Writes what brume_textures_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_textures_params_init(brume_textures_params* params,
                                                  uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: the noise of brume_drawn_defaults, which rolls around in 12 seconds; no light.
static inline brume_textures_params brume_textures_defaults(void) {
  brume_textures_params params;
  brume_textures_params_init(&params, sizeof params);
  return params;
}

/// A light, as the texture of light needs it.
typedef struct brume_texture_light {
  uint32_t directional;  ///< 1: a sun; 0: a light at a position.
  brume_point at;        ///< The position [m], within +-16384; of a sun the unit vector towards it.
} brume_texture_light;

/// A time at which the smoke is drawn.
typedef struct brume_textures_frame {
  uint32_t struct_size;
  const void* next;
  /// The clock of noise and holes [s], [0, 10^7]: the time of the field's state, or later, between ticks.
  double seconds;
  const brume_texture_light* lights;  ///< brume_textures_params::light_count of them.
  /// Fraction of the texels of light that this update finds, in turn, [1/16, 1]; 0: all. At a fraction f,
  /// light lags by up to 1/f updates, except where there was no smoke before.
  float light_update_fraction;
} brume_textures_frame;

/// Writes what brume_textures_frame_defaults returns into a struct of `struct_size` bytes: for other
/// languages.
BRUME_API brume_result brume_textures_frame_init(brume_textures_frame* frame,
                                                 uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: all light. Set `seconds`, and the lights where there are any.
static inline brume_textures_frame brume_textures_frame_defaults(void) {
  brume_textures_frame frame;
  brume_textures_frame_init(&frame, sizeof frame);
  return frame;
}

/// Creates textures that follow a field, or other fields of its level and with its masks. `params` may be
/// null: the defaults. The first one in a process generates the noise, in a second of CPU time.
BRUME_API brume_result brume_textures_create(const brume_field* field, const brume_textures_params* params,
                                             brume_textures** textures) BRUME_NOEXCEPT;
/// Destroys textures; null is ignored.
BRUME_API brume_result brume_textures_destroy(brume_textures* textures) BRUME_NOEXCEPT;

/// Takes over a field's smoke at a time. What changed since the last update is then in
/// brume_textures_regions. Any number of updates of the field may lie between two updates. Errors:
/// BRUME_ERROR_MISMATCH for a field of another level or with other masks; BRUME_ERROR_LIMIT when the smoke
/// has more than 65,534 bricks.
BRUME_API brume_result brume_textures_update(brume_textures* textures, const brume_field* field,
                                             const brume_textures_frame* frame) BRUME_NOEXCEPT;

/// Writes the BRUME_TEXTURE_COUNT textures, by their kind. `list` has room for them, `capacity` of them.
BRUME_API brume_result brume_textures_list(const brume_textures* textures, brume_texture* list,
                                           size_t capacity) BRUME_NOEXCEPT;
/// Writes where the regions that the last update changed begin, and how many they are. They and their texels
/// are valid until the next update or the end of the textures.
BRUME_API brume_result brume_textures_regions(const brume_textures* textures, const brume_region** regions,
                                              size_t* count) BRUME_NOEXCEPT;
/// Writes the constants of the last update, brume_constants in the shader. `count` is BRUME_CONSTANTS.
BRUME_API brume_result brume_textures_constants(const brume_textures* textures, float* constants,
                                                size_t count) BRUME_NOEXCEPT;

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_TEXTURES_H
