// The C interface of what frames show besides smoke: volumes of files, decals and tanks of spheres. Each is
// made once, and shown in any frame of any renderer (brume_vulkan.h, which includes this header). Library:
// libbrume.
//
// Everything that brume.h says of results, handles, threads and structs holds here.
#ifndef BRUME_BRUME_ASSETS_H
#define BRUME_BRUME_ASSETS_H

#include <brume/brume.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct brume_volume brume_volume;
typedef struct brume_decal brume_decal;
typedef struct brume_tank brume_tank;

// ---- Volumes ----

typedef enum brume_repeat {
  BRUME_REPEAT_NONE = 0,       ///< The first frame before it, the last one after it.
  BRUME_REPEAT_LOOP = 1,       ///< From the start again.
  BRUME_REPEAT_PING_PONG = 2,  ///< Backwards, and so on.
  BRUME_REPEAT_CLIP = 3        ///< Nothing before and after it.
} brume_repeat;

/// A file of grids, or a sequence of them.
typedef struct brume_volume_params {
  uint32_t struct_size;
  const void* next;
  /// Path, UTF-8: .brv, or .vdb and .nvdb, which the program brume-vdb reads, installed beside the host's
  /// program or on the PATH. Of a sequence the name has the number of its frames as %d or %04d.
  const char* file;
  /// Name of the grid that is dense; null: the first of the usual names.
  const char* density;
  /// Name of the grid that glows; "none": nothing does. Null or empty: a grid of a usual name, if the file
  /// also has one of fire that burns somewhere, or if its values are kelvin: smoke is lifted by heat, too.
  const char* heat;
  const char* color;  ///< Of the grid of colours that multiply the albedo; null: the same.
  float frame_rate;   ///< Of a sequence [1/s], [0.001, 1000].
  uint32_t repeat;    ///< brume_repeat, of a sequence.
  /// 1: recording waits until the frame of its time is loaded. 0: the frame before is shown until then.
  uint32_t waits;
  /// Device memory that the bricks of a frame may take: a larger one is shown at half its resolution, or a
  /// quarter, and so on, with a warning in the log. 0: as much as a device can address.
  uint64_t max_bytes;
} brume_volume_params;

static inline brume_volume_params brume_volume_defaults(void) {
  brume_volume_params params = {
      sizeof(brume_volume_params), BRUME_NULL, BRUME_NULL, BRUME_NULL, BRUME_NULL, BRUME_NULL, 24.0f,
      BRUME_REPEAT_NONE,           0,          0};
  return params;
}

/// Loads a file of grids, or the first one of a sequence. A sequence has a thread that loads ahead, from the
/// first frame that shows it until it is destroyed. Errors: BRUME_ERROR_DATA for a file that is missing or
/// damaged or lacks the grids, or without brume-vdb; BRUME_ERROR_LIMIT for one that is too large.
BRUME_API brume_result brume_volume_create(brume_context* context, const brume_volume_params* params,
                                           brume_volume** volume) BRUME_NOEXCEPT;
/// What frames in flight show of it stays with their renderers.
BRUME_API brume_result brume_volume_destroy(brume_volume* volume) BRUME_NOEXCEPT;

/// What the first frame of a volume holds.
typedef struct brume_volume_info {
  brume_point low, high;   ///< Around all that is dense in the first frame, in the file's space.
  float density;           ///< Largest value of the density.
  uint32_t glows;          ///< 1: a grid of heat was found.
  uint32_t z_is_up;        ///< 1: in the file z is up, as Blender writes it; else y.
  uint32_t is_extinction;  ///< 1: the density is an extinction per unit of the file.
  uint32_t halvings;       ///< Of the resolution: brume_volume_params::max_bytes.
} brume_volume_info;

/// Writes what its first frame holds.
BRUME_API brume_result brume_volume_describe(const brume_volume* volume,
                                             brume_volume_info* info) BRUME_NOEXCEPT;

/// A volume in a frame: where it is and how it looks.
typedef struct brume_shown_volume {
  const brume_volume* volume;          ///< One may be shown several times.
  brume_point x_axis, y_axis, z_axis;  ///< Of the file's space in the world; they must span space.
  brume_point position;                ///< Of the file's origin [m].
  double seconds;                      ///< From the start of a sequence [s], within +-10^6.
  float extinction;                    ///< [1/m] where the density is 1, [0, 10^6].
  float albedo[3];                     ///< [0, 1].
  float anisotropy;                    ///< Mean cosine of the phase function, (-1, 1).
  float multiple_scattering;           ///< Weight of light that is scattered more than once, [0, 1].
  float emission;                      ///< Multiplies what glows, [0, 10^6].
  float kelvin;  ///< [K] where the heat is 1, [1, 40000]; at 1000, values above 100 are kelvin.
} brume_shown_volume;

static inline brume_shown_volume brume_shown_volume_defaults(const brume_volume* volume) {
  brume_shown_volume shown = {volume,
                              {1.0f, 0.0f, 0.0f},
                              {0.0f, 1.0f, 0.0f},
                              {0.0f, 0.0f, 1.0f},
                              {0.0f, 0.0f, 0.0f},
                              0.0,
                              1.0f,
                              {0.9f, 0.9f, 0.9f},
                              0.2f,
                              1.0f,
                              1.0f,
                              1000.0f};
  return shown;
}

// ---- Decals ----

/// Baked occlusion around a mesh: how much it hides of the hemisphere above what faces up, along y of the
/// box, and above what faces down. Of a file (`brume bake occlusion`, then `brume convert`), or of
/// arrays.
typedef struct brume_decal_params {
  uint32_t struct_size;
  const void* next;
  const char* file;  ///< As brume_volume_params::file, one frame; null: the arrays.
  /// Name of a grid for both directions; null or empty: the grids "up" and "down", or else the first grid.
  const char* grid;
  /// Where `file` is null: size[0] * size[1] * size[2] finite numbers, 0: nothing is hidden, 1: all; voxel
  /// (i, j, k) is i + size[0] * (j + size[1] * k). They are copied.
  const float* up;
  const float* down;  ///< The same of what faces down; null: as `up`.
  uint32_t size[3];   ///< Voxels along x, y and z, at least 1; 2^26 in all at most.
  brume_point low;    ///< Of the box of all voxels, in the decal's space.
  brume_point high;   ///< Above `low` along each axis.
} brume_decal_params;

static inline brume_decal_params brume_decal_defaults(void) {
  brume_decal_params params = {sizeof(brume_decal_params),
                               BRUME_NULL,
                               BRUME_NULL,
                               BRUME_NULL,
                               BRUME_NULL,
                               BRUME_NULL,
                               {0, 0, 0},
                               {-1.0f, -1.0f, -1.0f},
                               {1.0f, 1.0f, 1.0f}};
  return params;
}

/// Loads a decal. Errors: BRUME_ERROR_DATA as brume_volume_create; BRUME_ERROR_LIMIT for too many voxels.
BRUME_API brume_result brume_decal_create(brume_context* context, const brume_decal_params* params,
                                          brume_decal** decal) BRUME_NOEXCEPT;
/// What frames in flight show of it stays with their renderers.
BRUME_API brume_result brume_decal_destroy(brume_decal* decal) BRUME_NOEXCEPT;

/// A decal in a frame: where it is and how it darkens. Its box must lie within 10^6 m of the world's origin
/// and have edges of at least 10^-6 m.
typedef struct brume_shown_decal {
  const brume_decal* decal;            ///< One may be shown several times.
  brume_point x_axis, y_axis, z_axis;  ///< Of its space in the world; they must span space.
  brume_point position;                ///< Of its origin [m].
  float strength;                      ///< Fraction of the occlusion that darkens, [0, 1].
  float gamma;       ///< Exponent of the occlusion in the middle of y; below 1 darkens, [0.1, 10].
  float correction;  ///< How much of `gamma` applies there, [0, 1].
  float falloff;     ///< How fast that fades towards the ends of y, [0, 100].
  float fade;        ///< Part of the box, at each side, over which the decal fades out, [0, 0.5].
  float scatter;     ///< How far noise scatters the samples [voxels], [0, 4].
} brume_shown_decal;

static inline brume_shown_decal brume_shown_decal_defaults(const brume_decal* decal) {
  brume_shown_decal shown = {decal,
                             {1.0f, 0.0f, 0.0f},
                             {0.0f, 1.0f, 0.0f},
                             {0.0f, 0.0f, 1.0f},
                             {0.0f, 0.0f, 0.0f},
                             1.0f,
                             1.0f,
                             1.0f,
                             1.0f,
                             0.05f,
                             0.5f};
  return shown;
}

// ---- Tanks of spheres ----

/// A box of voxels that holds balls of colour: a file, or arrays.
typedef struct brume_tank_params {
  uint32_t struct_size;
  const void* next;
  const char* file;        ///< Path of a .spheres file, UTF-8; null: what follows.
  uint32_t size[3];        ///< Of the box [voxels], each in [1, 2048], their product at most 2^28.
  float voxel;             ///< Edge of a voxel [m], [1e-6, 1e3].
  const float* spheres;    ///< Four numbers each: middle and radius [voxels] from the low corner, in the box.
  const uint32_t* colors;  ///< One each, bytes from the lowest: R, G and B of sRGB, and 255 for an opaque
                           ///< surface, else a medium of which a voxel's length blocks a/255 of the light.
  size_t sphere_count;     ///< Of `spheres` and `colors`, at most 2^23. Spheres must not overlap,
                           ///< which is not checked.
} brume_tank_params;

static inline brume_tank_params brume_tank_defaults(void) {
  brume_tank_params params = {
      sizeof(brume_tank_params), BRUME_NULL, BRUME_NULL, {1, 1, 1}, 0.005f, BRUME_NULL, BRUME_NULL, 0};
  return params;
}

/// Loads or copies a tank, which is lit by brume_tank_lighting_defaults(). Errors: BRUME_ERROR_DATA for a
/// file that is missing or damaged, BRUME_ERROR_LIMIT for one that is too large.
BRUME_API brume_result brume_tank_create(brume_context* context, const brume_tank_params* params,
                                         brume_tank** tank) BRUME_NOEXCEPT;
/// What frames in flight show of it stays with their renderers.
BRUME_API brume_result brume_tank_destroy(brume_tank* tank) BRUME_NOEXCEPT;

/// A ball that shines evenly in all directions; invisible itself.
typedef struct brume_tank_light {
  brume_point position;  ///< [m], in the tank's space.
  float radius;          ///< [m], [0, 1000]; 0: a point.
  float intensity[3];    ///< [W/sr], [0, 10^9].
} brume_tank_light;

/// Light, glass and air of a tank, in its own space: metres around its middle, before it is scaled.
typedef struct brume_tank_lighting {
  uint32_t struct_size;
  const void* next;
  const brume_tank_light* lights;  ///< At most 16.
  size_t light_count;              ///< Of `lights`.
  float ambient[3];                ///< Radiance from all around, [0, 10^6].
  uint32_t bounces;                ///< Most scatterings of a path, [0, 16]; 0: direct and ambient light only.
  float fog_extinction;            ///< Inside of the box, along rays of the camera [1/m], [0, 10^6].
  float fog_color[3];              ///< Radiance of deep fog, [0, 10^6].
  float glass_index;               ///< Of refraction, [1, 4]; 0: no glass.
  brume_point glass_position;      ///< Middle of an ellipsoid of glass.
  brume_point glass_radii;         ///< Half its axes [m], [0.0001, 10000].
  uint32_t photons;                ///< Paths of light through the glass, [0, 2^22]; 0: none comes through it.
} brume_tank_lighting;

static inline brume_tank_lighting brume_tank_lighting_defaults(void) {
  brume_tank_lighting lighting = {sizeof(brume_tank_lighting),
                                  BRUME_NULL,
                                  BRUME_NULL,
                                  0,
                                  {0.6f, 0.6f, 0.6f},
                                  2,
                                  0.0f,
                                  {0.02f, 0.05f, 0.08f},
                                  0.0f,
                                  {0.0f, 0.0f, 0.0f},
                                  {0.5f, 0.5f, 0.5f},
                                  0};
  return lighting;
}

/// Lights a tank from the next frame on. Paths through glass are traced on this call, by the threads of the
/// context, about a second for a million; without glass it is a copy.
BRUME_API brume_result brume_tank_set_lighting(brume_tank* tank,
                                               const brume_tank_lighting* lighting) BRUME_NOEXCEPT;

typedef enum brume_tank_view {
  BRUME_TANK_SPHERES = 0,  ///< The spheres themselves, by paths of light: exact, and noisy with few samples.
  BRUME_TANK_VOXELS = 1    ///< The voxels painted with them, lit once: smooth, and about as large as a voxel.
} brume_tank_view;

/// A tank in a frame. It hides what is behind it and is hidden by the host's surfaces; smoke and volumes are
/// drawn before it and behind it. No shadows fall from one on the other.
typedef struct brume_shown_tank {
  const brume_tank* tank;              ///< One may be shown several times.
  brume_point x_axis, y_axis, z_axis;  ///< Of the tank's space in the world: at right angles, right-handed,
                                       ///< of one length, which scales the tank.
  brume_point position;                ///< Of its middle [m].
  uint32_t view;                       ///< brume_tank_view
  uint32_t samples;                    ///< Paths of each pixel in this frame, [1, 64].
  /// 1: the host's surfaces have not changed since the last frame. While camera, tank and light have not
  /// either, the samples of all these frames are averaged.
  uint32_t continues;
} brume_shown_tank;

static inline brume_shown_tank brume_shown_tank_defaults(const brume_tank* tank) {
  brume_shown_tank shown = {tank,
                            {1.0f, 0.0f, 0.0f},
                            {0.0f, 1.0f, 0.0f},
                            {0.0f, 0.0f, 1.0f},
                            {0.0f, 0.0f, 0.0f},
                            BRUME_TANK_SPHERES,
                            1,
                            0};
  return shown;
}

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_ASSETS_H
