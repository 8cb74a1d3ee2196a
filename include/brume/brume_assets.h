// The C interface for everything that frames show besides smoke: volumes from files, decals and tanks of
// spheres. Each object is created once, and shown in any frame of any renderer (brume_vulkan.h, which
// includes this header). Library: libbrume.
//
// Example    A fire from a sequence of files, in the frame of the example of brume_vulkan.h.
//
// ```c
//   brume_volume* fire;
//   brume_volume_params file = brume_volume_defaults();
//   file.file = "fire_%04d.brv";
//   file.frame_rate = 24.0f;
//   file.repeat = BRUME_REPEAT_LOOP;
//   check(brume_volume_create(context, &file, &fire));  // once, behind a loading screen
//
//   brume_shown_volume shown = brume_shown_volume_defaults(fire);
//   shown.position = hearth;
//   shown.seconds = seconds;
//   shown.extinction = 8.0f;
//   frame.volumes = &shown;
//   frame.volume_count = 1;
//   check(brume_renderer_record(renderer, field, &frame));
//
//   check(brume_volume_destroy(fire));  // frames in flight may still show it
// ```
//
// The rules of brume.h for results, handles, threads and structs hold here, too.
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

/// The frames that a sequence shows at times before its first frame and after its last one.
typedef enum brume_repeat {
  BRUME_REPEAT_NONE = 0,       ///< The first frame before the sequence, the last frame after it.
  BRUME_REPEAT_LOOP = 1,       ///< The sequence again, from the start.
  BRUME_REPEAT_PING_PONG = 2,  ///< The sequence backwards, then forwards, and so on.
  BRUME_REPEAT_CLIP = 3        ///< Nothing.
} brume_repeat;

/// A file of grids, or a sequence of files.
typedef struct brume_volume_params {
  uint32_t struct_size;
  const void* next;
  /// Path, UTF-8, to a .brv, .vdb or .nvdb file. The program brume-vdb, beside your program or on the PATH,
  /// reads .vdb and .nvdb files. The name of a sequence contains the frame number as %d or %04d.
  const char* file;
  /// Name of the grid that holds the density; null: the first grid with a usual name.
  const char* density;
  /// Name of the grid that glows; "none": nothing glows. Null or empty: a grid with a usual name, if the file
  /// also has a grid of fire that burns somewhere, or if its values are in kelvin; without that, heat may
  /// only be the lift of smoke.
  const char* heat;
  const char* color;  ///< Name of the grid of colours that multiply the albedo; null: a usual name.
  float frame_rate;   ///< Frames of a sequence per second [1/s], [0.001, 1000].
  uint32_t repeat;    ///< A brume_repeat, for sequences.
  /// 1: recording waits until the sequence's frame is loaded. 0: the frame shown last remains until then.
  uint32_t wait_for_frame;
  /// Device memory for the bricks of a frame [bytes]. A larger frame is shown at half its resolution, or a
  /// quarter, and so on, with a warning in the log. 0: as much as a device can address.
  uint64_t max_bytes;
  /// 1: the library starts no process: .brv files alone. Errors: BRUME_ERROR_ARGUMENT for others.
  uint32_t no_processes;
} brume_volume_params;

/// Writes what brume_volume_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_volume_params_init(brume_volume_params* params,
                                                uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: 24 frames per second, no repetition. Set `file`.
static inline brume_volume_params brume_volume_defaults(void) {
  brume_volume_params params;
  brume_volume_params_init(&params, sizeof params);
  return params;
}

/// Loads a file of grids, or the first file of a sequence. A sequence has a thread that loads ahead, from the
/// first frame that shows it until it is destroyed. Errors: BRUME_ERROR_DATA when a file is missing, damaged
/// or lacks the grids, and when brume-vdb is required and missing; BRUME_ERROR_LIMIT when it is too large.
BRUME_API brume_result brume_volume_create(brume_context* context, const brume_volume_params* params,
                                           brume_volume** volume) BRUME_NOEXCEPT;
/// Destroys a volume; null is ignored. Renderers keep the resources of frames in flight.
BRUME_API brume_result brume_volume_destroy(brume_volume* volume) BRUME_NOEXCEPT;

/// The contents of a volume's first frame.
typedef struct brume_volume_info {
  brume_point low, high;   ///< A box around all that is dense, in the file's space.
  float density;           ///< Largest value of the density.
  uint32_t has_heat;       ///< 1: a grid of heat was found; it glows.
  uint32_t z_is_up;        ///< 1: z is up in the file, as Blender writes it; 0: y is up.
  uint32_t is_extinction;  ///< 1: the density is an extinction per unit of the file.
  uint32_t halvings;       ///< Number of times that max_bytes has halved the resolution.
} brume_volume_info;

/// Writes the contents of the first frame.
BRUME_API brume_result brume_volume_describe(const brume_volume* volume,
                                             brume_volume_info* info) BRUME_NOEXCEPT;

/// A volume in a frame: its place and its look.
typedef struct brume_shown_volume {
  const brume_volume* volume;          ///< A frame may show one volume several times.
  brume_point x_axis, y_axis, z_axis;  ///< The axes of the file's space in the world; they must span space.
  brume_point position;                ///< The origin of the file's space in the world [m].
  double seconds;                      ///< Time since the start of a sequence [s], within +-10^6.
  float extinction;                    ///< Extinction where the density is 1 [1/m], [0, 10^12].
  float albedo[3];                     ///< Fraction of the light that is scattered, per channel, [0, 1].
  float anisotropy;                    ///< Mean cosine of the phase function, [-0.99, 0.99].
  float multiple_scattering;           ///< Weight of light that is scattered more than once, [0, 1].
  float emission;                      ///< Factor of the glow, [0, 10^6].
  /// Temperature where the heat is 1 [K], [0, 10^5]. At 1000, values of heat above 100 count as kelvin.
  float kelvin;
} brume_shown_volume;

/// Writes what brume_shown_volume_defaults returns: for other languages.
BRUME_API brume_result brume_shown_volume_init(brume_shown_volume* shown,
                                               const brume_volume* volume) BRUME_NOEXCEPT;
/// Returns the defaults: the file's space is the world's, extinction 1, albedo 0.9, time 0.
static inline brume_shown_volume brume_shown_volume_defaults(const brume_volume* volume) {
  brume_shown_volume shown;
  brume_shown_volume_init(&shown, volume);
  return shown;
}

// ---- Decals ----

/// Baked occlusion around a mesh: the fraction of the hemisphere that the mesh hides, above surfaces that
/// face up (along y of the box), and above surfaces that face down. It comes from a file (`brume bake
/// occlusion`, then `brume convert`) or from arrays.
typedef struct brume_decal_params {
  uint32_t struct_size;
  const void* next;
  const char* file;  ///< Path as brume_volume_params::file, without frame number; null: the arrays below.
  /// Name of a grid for both directions; null or empty: the grids "up" and "down", or else the first grid.
  const char* grid;
  /// If `file` is null: size[0] * size[1] * size[2] finite numbers, from 0 (nothing is hidden) to 1 (all is
  /// hidden). Voxel (i, j, k) is element i + size[0] * (j + size[1] * k). The arrays are copied.
  const float* up;
  const float* down;  ///< As many numbers for surfaces that face down; null: `up` counts for both.
  uint32_t size[3];   ///< Voxels along x, y and z, at least 1 each, at most 2^26 in all.
  brume_point low;    ///< Low corner of the box of all voxels, in the decal's space [m].
  brume_point high;   ///< High corner, above `low` along each axis [m].
} brume_decal_params;

/// Writes what brume_decal_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_decal_params_init(brume_decal_params* params,
                                               uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: a box from (-1, -1, -1) to (1, 1, 1). Set `file`, or `up` and `size`.
static inline brume_decal_params brume_decal_defaults(void) {
  brume_decal_params params;
  brume_decal_params_init(&params, sizeof params);
  return params;
}

/// Loads or copies a decal. Errors: BRUME_ERROR_DATA when a file is missing, damaged or lacks the grids, and
/// when brume-vdb is required and missing; BRUME_ERROR_LIMIT when it has too many voxels.
BRUME_API brume_result brume_decal_create(brume_context* context, const brume_decal_params* params,
                                          brume_decal** decal) BRUME_NOEXCEPT;
/// Destroys a decal; null is ignored. Renderers keep the resources of frames in flight.
BRUME_API brume_result brume_decal_destroy(brume_decal* decal) BRUME_NOEXCEPT;

/// A decal in a frame: its place and its strength. Its box must lie within 10^6 m of the world's origin and
/// have edges of at least 10^-6 m.
typedef struct brume_shown_decal {
  const brume_decal* decal;            ///< A frame may show one decal several times.
  brume_point x_axis, y_axis, z_axis;  ///< The axes of the decal's space in the world; they must span space.
  brume_point position;                ///< The origin of the decal's space in the world [m].
  float strength;                      ///< Fraction of the occlusion that darkens surfaces, [0, 1].
  float gamma;  ///< Exponent of the occlusion in the middle of the box's height; below 1 darkens, [0.1, 10].
  float correction;  ///< Fraction of `gamma` that applies there, [0, 1].
  float falloff;     ///< Rate at which it fades towards the top and bottom of the box, [0, 100].
  float fade;        ///< Part of the box, at each side, over which the decal fades out, [0, 0.5].
  float scatter;     ///< Distance by which noise scatters the samples [voxels], [0, 4].
} brume_shown_decal;

/// Writes what brume_shown_decal_defaults returns: for other languages.
BRUME_API brume_result brume_shown_decal_init(brume_shown_decal* shown,
                                              const brume_decal* decal) BRUME_NOEXCEPT;
/// Returns the defaults: the decal's space is the world's, full strength.
static inline brume_shown_decal brume_shown_decal_defaults(const brume_decal* decal) {
  brume_shown_decal shown;
  brume_shown_decal_init(&shown, decal);
  return shown;
}

// ---- Tanks of spheres ----

/// A box of voxels that contains coloured spheres: from a file, or from arrays.
typedef struct brume_tank_params {
  uint32_t struct_size;
  const void* next;
  const char* file;  ///< Path of a .spheres file, UTF-8; null: the members below.
  uint32_t size[3];  ///< Size of the box [voxels], each in [1, 2048], their product at most 2^28.
  float voxel;       ///< Edge length of a voxel [m], [1e-6, 1e3].
  /// Four numbers for each sphere: its centre and its radius [voxels], from the low corner, inside the box.
  /// Spheres must not overlap, which is not checked.
  const float* spheres;
  /// One number for each sphere, in bytes from the lowest: R, G and B in sRGB, then A. A of 255 is an opaque
  /// surface; a smaller A is a medium that blocks A/255 of the light over the length of a voxel.
  const uint32_t* colors;
  size_t sphere_count;  ///< Number of spheres and colours, at most 2^23; 0 if `file` is set.
} brume_tank_params;

/// Writes what brume_tank_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_tank_params_init(brume_tank_params* params, uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: a box of one voxel of 5 mm, without spheres. Set `file`, or the box and its spheres.
static inline brume_tank_params brume_tank_defaults(void) {
  brume_tank_params params;
  brume_tank_params_init(&params, sizeof params);
  return params;
}

/// Loads or copies a tank, with the light of brume_tank_lighting_defaults(). Errors: BRUME_ERROR_DATA when a
/// file is missing or damaged; BRUME_ERROR_LIMIT when the tank is too large.
BRUME_API brume_result brume_tank_create(brume_context* context, const brume_tank_params* params,
                                         brume_tank** tank) BRUME_NOEXCEPT;
/// Destroys a tank; null is ignored. Renderers keep the resources of frames in flight.
BRUME_API brume_result brume_tank_destroy(brume_tank* tank) BRUME_NOEXCEPT;

/// A ball that emits light evenly in all directions; it is invisible itself.
typedef struct brume_tank_light {
  brume_point position;  ///< Its centre in the tank's space [m].
  float radius;          ///< Its radius [m], [0, 1000]; 0: a point.
  float intensity[3];    ///< Its intensity per channel [W/sr], [0, 10^9].
} brume_tank_light;

/// Light, glass and air of a tank, in the tank's space: metres around its centre, before a frame scales it.
typedef struct brume_tank_lighting {
  uint32_t struct_size;
  const void* next;
  const brume_tank_light* lights;  ///< At most 16.
  size_t light_count;              ///< Number of `lights`.
  float ambient[3];                ///< Radiance from all directions, per channel, [0, 10^6].
  uint32_t bounces;            ///< Scatterings of a path at most, [0, 16]; 0: direct and ambient light only.
  float fog_extinction;        ///< Extinction inside the box along camera rays [1/m], [0, 10^6].
  float fog_color[3];          ///< Radiance of deep fog, per channel, [0, 10^6].
  float glass_index;           ///< Refractive index of the glass, [1, 4]; 0: no glass.
  brume_point glass_position;  ///< Centre of an ellipsoid of glass [m].
  brume_point glass_radii;     ///< Its semi-axes [m], [0.0001, 10000].
  uint32_t photons;            ///< Light paths through the glass, [0, 2^22]; 0: no light comes through it.
} brume_tank_lighting;

/// Writes what brume_tank_lighting_defaults returns into a struct of `struct_size` bytes: for other
/// languages.
BRUME_API brume_result brume_tank_lighting_init(brume_tank_lighting* lighting,
                                                uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: ambient light of radiance 0.6, two bounces, no fog, no glass.
static inline brume_tank_lighting brume_tank_lighting_defaults(void) {
  brume_tank_lighting lighting;
  brume_tank_lighting_init(&lighting, sizeof lighting);
  return lighting;
}

/// Changes the light of a tank from the next frame on. With glass and photons, this call traces the light
/// paths with the threads of the context, about a second for a million; otherwise it only copies.
BRUME_API brume_result brume_tank_set_lighting(brume_tank* tank,
                                               const brume_tank_lighting* lighting) BRUME_NOEXCEPT;

typedef enum brume_tank_view {
  BRUME_TANK_SPHERES = 0,  ///< The spheres, path-traced: exact, and noisy with few samples.
  BRUME_TANK_VOXELS = 1    ///< The voxels, in the colours of their spheres, lit once: smooth, and coarse.
} brume_tank_view;

/// A tank in a frame. It hides smoke and surfaces behind it, and your surfaces and smoke in front of it hide
/// it. Tanks and smoke cast no shadows on each other.
typedef struct brume_shown_tank {
  const brume_tank* tank;              ///< A frame may show one tank several times.
  brume_point x_axis, y_axis, z_axis;  ///< The axes of the tank's space in the world: at right angles,
                                       ///< right-handed, of one length, which scales the tank.
  brume_point position;                ///< The tank's centre in the world [m].
  uint32_t view;                       ///< A brume_tank_view.
  uint32_t samples;                    ///< Paths per pixel in this frame, [1, 64].
  /// 1: your surfaces have not changed since the last frame. As long as camera, tank and light have not
  /// changed either, the samples of all these frames are averaged.
  uint32_t continues_previous;
} brume_shown_tank;

/// Writes what brume_shown_tank_defaults returns: for other languages.
BRUME_API brume_result brume_shown_tank_init(brume_shown_tank* shown, const brume_tank* tank) BRUME_NOEXCEPT;
/// Returns the defaults: the tank's space is the world's, its spheres with one sample.
static inline brume_shown_tank brume_shown_tank_defaults(const brume_tank* tank) {
  brume_shown_tank shown;
  brume_shown_tank_init(&shown, tank);
  return shown;
}

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_ASSETS_H
