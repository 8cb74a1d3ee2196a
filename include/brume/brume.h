// The public C interface of Brume: the simulation of smoke and the line of sight through smoke, without
// Vulkan. Library: libbrume-sim. Guide: docs/start/your-server.md. C++: brume.hpp, in the same folder.
//
//   context --> level --> world --> state --> field        optical depths, visibility, walls, densities
//                          ^         |  `---> sender --> packets --> receiver --> state
//                       events       `-----> bytes (a snapshot) ---> state --> world
//
// Example    A player throws a smoke grenade, and a bot looks for that player. `check` is your function that
//            handles an error, `points` and `indices` are your collision mesh [m].
//
// ```c
//   brume_context* context;
//   brume_level* level;
//   brume_world* world;
//   brume_field* field;
//   brume_triangles_params mesh = brume_triangles_defaults();  // voxels of half a metre
//   mesh.points = points;
//   mesh.point_count = point_count;
//   mesh.indices = indices;
//   mesh.index_count = index_count;
//   check(brume_context_create(NULL, &context));
//   check(brume_level_create_from_triangles(context, &mesh, &level));
//   check(brume_world_create(level, NULL, &world));  // 64 ticks per second
//   check(brume_field_create(level, NULL, &field));
//
//   brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, 0);  // thrown at tick 0
//   event.u.smoke.voxels = brume_smoke_voxels(200, mesh.layout.voxel_size);
//   check(brume_position_from_metres(2, 1.5, 8, &event.u.smoke.from));
//   check(brume_position_from_metres(2, 0.5, 2, &event.u.smoke.at));
//   check(brume_world_append(world, &event, 1));
//
//   for (uint32_t tick = 0; tick <= 128; ++tick) {
//     brume_state* state;
//     uint8_t visible;
//     check(brume_world_advance_to(world, tick));
//     check(brume_world_state(world, &state));
//     check(brume_field_update(field, state));
//     check(brume_state_destroy(state));  // the field has its own copy
//     const brume_segment line = {bot_eyes, player_eyes};
//     check(brume_field_visible(field, &line, 1, 3.0f, &visible));  // 3: at least 5 % of the light passes
//     printf("tick %u: visible %d\n", (unsigned)tick, visible);
//     if (tick > 64) check(brume_world_forget_before(world, tick - 64));  // events may be 1 s late
//   }
// ```
//
// Results    Each function returns BRUME_OK or an error. After an error, brume_last_error() returns one line
//            about it for the calling thread, nothing has changed and no output has been written, except
//            where the description of a function states otherwise. Arguments that are wrong (null, another
//            kind of handle, another struct_size, NaN, out of range) give BRUME_ERROR_ARGUMENT or
//            BRUME_ERROR_HANDLE; descriptions list further errors. No exception and no signal reaches the
//            caller. BRUME_ERROR_MEMORY may stop a change halfway: see BRUME_ERROR_BROKEN.
// Handles    *_create and similar functions create objects, *_destroy releases them and accepts null. An
//            object lives as long as another one requires it: a level may be destroyed before its worlds. A
//            destroyed handle must not be used again.
// Threads    Any function may be called from any thread. Calls that change one object run one after another;
//            calls that read it run concurrently. The call that destroys an object must be the last one: no
//            other call with its handle may still be running. The library changes no setting of the process.
//            A call may start as many threads as its context allows, and ends them before it returns. Calls
//            run in their own floating-point environment: the caller's rounding mode, flushed denormals and
//            traps have no effect on results.
// Structs    Parameter structs begin with `struct_size` = sizeof(the struct) and `next` = NULL. Take their
//            defaults from the *_defaults functions; bindings to other languages call the *_init functions
//            behind them. The size of other structs never changes, nor does the size of brume_event.
// Growth     Later versions may add members at the end of a parameter struct, where 0 selects the behaviour
//            without the member. A shorter struct of an earlier header works: members that it lacks have
//            their defaults. A longer struct of a later header works as long as every member that this
//            library does not have is 0; otherwise the call fails with BRUME_ERROR_ARGUMENT. `next` is
//            reserved for structs of later versions; there are none yet.
// Enums      Structs store enumerations as uint32_t: C leaves the size of an enum to the compiler.
// Arrays     A null pointer is accepted where the count is 0. Outputs must not overlap inputs.
// Bytes      Functions that write bytes take `buffer`, `capacity` and `size`. *size receives the number of
//            bytes; call with a null buffer and capacity 0 to query it. BRUME_ERROR_BUFFER: the capacity is
//            too small; *size is set, the buffer is unchanged.
// Lists      Functions that write lists work in the same way: `capacity` and `count` are numbers of elements.
// Units      Metres, right-handed, Y up. Voxel i of a level covers [i, i + 1) in voxel space; position_voxel
//            = (position - origin) / voxel_size. Events have integers, so that the same events give the same
//            bits on every machine: ticks, milliseconds, and lengths in 1/1024 m. The suffix of a member
//            names its unit: `radius_1024` is in 1/1024 m, `roll_65536` in 1/65536 turn.
#ifndef BRUME_BRUME_H
#define BRUME_BRUME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define BRUME_NOEXCEPT noexcept
#define BRUME_CAST(type, value) static_cast<type>(value)
extern "C" {
#else
#define BRUME_NOEXCEPT
#define BRUME_CAST(type, value) ((type)(value))
#endif

// On Windows, who links a static library defines BRUME_STATIC.
#if defined(_WIN32) && defined(BRUME_STATIC)
#define BRUME_API
#elif defined(_WIN32) && defined(BRUME_EXPORTS)
#define BRUME_API __declspec(dllexport)
#elif defined(_WIN32)
#define BRUME_API __declspec(dllimport)
#elif defined(__GNUC__)
#define BRUME_API __attribute__((visibility("default")))
#else
#define BRUME_API
#endif

// ---- Version and errors ----

/// The version of this header. Before 1.0, a minor version may change the interface; the library's SOVERSION
/// then changes too.
#define BRUME_VERSION_MAJOR 0
#define BRUME_VERSION_MINOR 2
#define BRUME_VERSION_PATCH 0

typedef enum brume_result {
  BRUME_OK = 0,
  BRUME_ERROR_ARGUMENT = 1,  ///< An argument is null, not finite, out of range, or a struct of another size.
  BRUME_ERROR_HANDLE = 2,    ///< A handle is null, of another kind, or not a handle.
  BRUME_ERROR_DATA = 3,      ///< Received bytes are damaged, truncated, foreign or of another version.
  BRUME_ERROR_HISTORY = 4,   ///< A tick is earlier than the history that the world retains.
  BRUME_ERROR_MISMATCH = 5,  ///< Two objects differ in level, ticks per second or masks.
  BRUME_ERROR_ORDER = 6,     ///< Another call must come first: the message names it.
  BRUME_ERROR_BUFFER = 7,    ///< The capacity of an output is too small.
  BRUME_ERROR_LIMIT = 8,     ///< The call exceeds a limit of the library.
  BRUME_ERROR_MEMORY = 9,    ///< Memory or threads are exhausted.
  /// An earlier call ran out of memory or over a limit halfway. Until brume_world_restore (for a world),
  /// brume_field_update (for a field) or brume_receiver_reset (for a receiver) succeeds, only *_destroy
  /// works. A broken sender can only be destroyed.
  BRUME_ERROR_BROKEN = 10,
  BRUME_ERROR_INTERNAL = 11,  ///< The library has a defect.
  BRUME_ERROR_DEVICE = 12     ///< The Vulkan device lacks a required feature, or is lost (brume_vulkan.h).
} brume_result;

/// Writes the version of the library in use. Any pointer may be null. Never fails.
BRUME_API brume_result brume_version(uint32_t* major, uint32_t* minor, uint32_t* patch) BRUME_NOEXCEPT;

/// Returns one line about the last failure in this thread: the function, the expected and the given value; ""
/// before the first failure. UTF-8, at most 511 bytes. The pointer is valid until the next failure in this
/// thread; calls that succeed do not change the line.
BRUME_API const char* brume_last_error(void) BRUME_NOEXCEPT;

/// Returns the name of a result, such as "BRUME_OK"; "unknown" for a number that is not a brume_result. The
/// string is a constant.
BRUME_API const char* brume_result_name(brume_result result) BRUME_NOEXCEPT;

// ---- Context ----

typedef struct brume_context brume_context;
typedef struct brume_level brume_level;
typedef struct brume_masks brume_masks;
typedef struct brume_world brume_world;
typedef struct brume_state brume_state;
typedef struct brume_sender brume_sender;
typedef struct brume_receiver brume_receiver;
typedef struct brume_field brume_field;

/// Receives the line of each failed call with a handle of its context, as brume_last_error() returns it, and
/// warnings with BRUME_OK, for example when a volume is shown at a lower resolution. It is called in the
/// thread of the failed call, after the call's work, possibly by several threads at once; it may then call
/// any function except the destruction of the handle in use. Threads that load volumes report warnings, too;
/// from such a thread it must call no function. `line` is valid during the callback, which must not throw.
typedef void (*brume_log_callback)(void* user, brume_result result, const char* line);

/// Runs the loops of a call in threads of yours: it calls job(job_data) `count` times, which is at most
/// thread_count, in any threads and at best at once, and returns when all of these calls have returned.
/// Fewer calls are right, too: what no job does, the call does. A job neither waits for others nor calls a
/// callback. It is called within functions that may take many threads, by several threads at once where you
/// call several at once, and by threads that load volumes. It must not call Brume or throw.
typedef void (*brume_run_jobs_callback)(void* user, void (*job)(void* job_data), void* job_data,
                                        uint32_t count);

/// The settings of a new context.
typedef struct brume_context_params {
  uint32_t struct_size;
  const void* next;
  uint32_t thread_count;   ///< Threads of one call, the caller's included: [1, 1024]; 0: one per core.
  brume_log_callback log;  ///< Null: no callback.
  void* log_user;          ///< Passed to `log`.
  /// Null: calls start threads, which end before they return. One thread for each volume file that changes
  /// over time is started in any case.
  brume_run_jobs_callback run_jobs;
  void* jobs_user;  ///< Passed to `run_jobs`.
} brume_context_params;

/// Writes what brume_context_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_context_params_init(brume_context_params* params,
                                                 uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: one thread per core, no callbacks.
static inline brume_context_params brume_context_defaults(void) {
  brume_context_params params;
  brume_context_params_init(&params, sizeof params);
  return params;
}

/// Creates a context, from which all other objects are created. `params` may be null: the defaults.
BRUME_API brume_result brume_context_create(const brume_context_params* params,
                                            brume_context** context) BRUME_NOEXCEPT;
/// Destroys a context; null is ignored. Objects of the context live on, without its callbacks: they are
/// not called again, unless a call in another thread is already about to call them.
BRUME_API brume_result brume_context_destroy(brume_context* context) BRUME_NOEXCEPT;

// ---- Levels ----

/// The largest number of voxels of a level along one axis.
#define BRUME_MAX_LEVEL_AXIS 4096

/// A voxel, or a size in voxels.
typedef struct brume_voxel {
  int32_t x, y, z;  ///< Coordinate, or size along an axis.
} brume_voxel;

/// A point in the world [m].
typedef struct brume_point {
  float x, y, z;  ///< Coordinate [m].
} brume_point;

/// The position and size of a level's voxels. All machines of a match must use the same bits.
typedef struct brume_layout {
  brume_voxel size;    ///< Voxels per axis, each in [1, BRUME_MAX_LEVEL_AXIS].
  float voxel_size;    ///< Edge length of a voxel [m], [1/64, 64].
  brume_point origin;  ///< Low corner of voxel (0, 0, 0) [m], each coordinate within +-16384.
} brume_layout;

/// The obstacle that a surface is. Each role stops less than the previous one.
typedef enum brume_role {
  BRUME_ROLE_WALL = 0,    ///< Stops smoke, sight, shots, bodies and thrown grenades.
  BRUME_ROLE_GLASS = 1,   ///< Stops smoke, shots, bodies and thrown grenades, but not sight.
  BRUME_ROLE_GRILLE = 2,  ///< Stops bodies and thrown grenades: a fence, leaves.
  BRUME_ROLE_GHOST = 3    ///< Stops nothing.
} brume_role;

/// A level as solid voxels.
typedef struct brume_voxels_params {
  uint32_t struct_size;
  const void* next;
  brume_layout layout;  ///< The position and size of the voxels.
  /// One bit per voxel, 1 = solid, x fastest, then y, then z: voxel (x, y, z) is bit i % 8 of byte i / 8 with
  /// i = x + size.x * (y + size.y * z). Bits after the last voxel are ignored.
  const uint8_t* bits;
  size_t byte_count;  ///< The size of `bits` in bytes: (size.x * size.y * size.z + 7) / 8.
  /// As many bytes, in the same order: the solid voxels that are glass. Null: all are walls.
  const uint8_t* glass_bits;
  /// As many bytes, in the same order: the voxels that are grilles, which are not set in `bits`. Null: none.
  const uint8_t* grille_bits;
} brume_voxels_params;

/// Writes what brume_voxels_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_voxels_params_init(brume_voxels_params* params,
                                                uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: voxels of 0.5 m, origin 0. Set `layout.size`, `bits` and `byte_count`.
static inline brume_voxels_params brume_voxels_defaults(void) {
  brume_voxels_params params;
  brume_voxels_params_init(&params, sizeof params);
  return params;
}

/// A level as the triangles of its collision mesh.
typedef struct brume_triangles_params {
  uint32_t struct_size;
  const void* next;
  /// With size (0, 0, 0), the level has the smallest layout around all triangles with `margin` voxels on
  /// every side and an origin that is a multiple of voxel_size; the given origin is then ignored.
  brume_layout layout;
  uint32_t margin;            ///< Free voxels on every side, [0, 256].
  const brume_point* points;  ///< Corners of the triangles [m], finite.
  size_t point_count;         ///< Number of `points`, at most 2^28.
  /// Three indices into `points` for each triangle, in any winding. Triangles without area are allowed.
  const uint32_t* indices;
  size_t index_count;  ///< Number of `indices`: a multiple of 3, at most 2^28.
  /// The brume_role of each triangle, index_count / 3 bytes. A voxel that several triangles touch has the
  /// role that stops most. Null: all are walls.
  const uint8_t* roles;
} brume_triangles_params;

/// Writes what brume_triangles_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_triangles_params_init(brume_triangles_params* params,
                                                   uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: voxels of 0.5 m, a layout around all triangles with a margin of 2 voxels. Set the
/// points and the indices.
static inline brume_triangles_params brume_triangles_defaults(void) {
  brume_triangles_params params;
  brume_triangles_params_init(&params, sizeof params);
  return params;
}

/// Creates a level from solid voxels. Smoke ends at their faces. Errors: BRUME_ERROR_LIMIT when an axis
/// exceeds BRUME_MAX_LEVEL_AXIS.
BRUME_API brume_result brume_level_create_from_voxels(brume_context* context,
                                                      const brume_voxels_params* params,
                                                      brume_level** level) BRUME_NOEXCEPT;
/// Creates a level from the triangles of its collision mesh. Every voxel that a wall or glass touches is
/// solid, exactly (a triangle on a face between two voxels touches both), and smoke ends at the surface of
/// the triangles, not at the grid. The same triangles, in the same order, with the same roles and layout give
/// the same level on every machine. Errors: BRUME_ERROR_LIMIT when an axis would exceed BRUME_MAX_LEVEL_AXIS.
BRUME_API brume_result brume_level_create_from_triangles(brume_context* context,
                                                         const brume_triangles_params* params,
                                                         brume_level** level) BRUME_NOEXCEPT;
/// Destroys a level; null is ignored. Its worlds and fields live on.
BRUME_API brume_result brume_level_destroy(brume_level* level) BRUME_NOEXCEPT;

/// Writes the layout of the level.
BRUME_API brume_result brume_level_layout(const brume_level* level, brume_layout* layout) BRUME_NOEXCEPT;
/// Writes the hash of the level as loaded, without the edits of any world: its layout, what each voxel stops,
/// and the surfaces at which smoke ends. Levels of one hash give the same smoke and the same lines of sight
/// on every machine. Give all machines the same triangles in the same order and winding. States and packets
/// carry the hash, and calls that would combine two levels fail with BRUME_ERROR_MISMATCH. It is computed
/// once, when a level is created: some 60 ns for each brick of 8^3 voxels with a wall.
BRUME_API brume_result brume_level_hash(const brume_level* level, uint64_t* hash) BRUME_NOEXCEPT;
/// Writes 1 for each voxel of the box [low, high) that is a wall or glass in the level as loaded, without the
/// edits of any world, else 0; x fastest, then y, then z. The box must lie in the level and contain a voxel;
/// `count` is the number of its voxels.
BRUME_API brume_result brume_level_solid(const brume_level* level, brume_voxel low, brume_voxel high,
                                         uint8_t* solid, size_t count) BRUME_NOEXCEPT;
/// Writes the brume_role of each voxel of the box [low, high), BRUME_ROLE_GHOST where a voxel is free. Order,
/// box and `count` are as in brume_level_solid.
BRUME_API brume_result brume_level_roles(const brume_level* level, brume_voxel low, brume_voxel high,
                                         uint8_t* roles, size_t count) BRUME_NOEXCEPT;

// ---- Masks: images that shots may cut out of smoke ----

/// An image of how much smoke a shot removes.
typedef struct brume_mask_image {
  uint32_t width, height;  ///< Size in texels, each in [1, 4094].
  const uint8_t* texels;   ///< width * height bytes, rows from the top: 255 removes all smoke, 0 none.
} brume_mask_image;

/// Creates a set of masks; brume_shot_event::mask_index is an index into `images`, which are copied. At most
/// 65,536 images. Sender and receiver need the same set. Errors: BRUME_ERROR_LIMIT when the images do not fit
/// into 4096 x 4096 texels together.
BRUME_API brume_result brume_masks_create(brume_context* context, const brume_mask_image* images,
                                          size_t count, brume_masks** masks) BRUME_NOEXCEPT;
/// Destroys a set of masks; null is ignored. Worlds, fields and renderers that use it live on.
BRUME_API brume_result brume_masks_destroy(brume_masks* masks) BRUME_NOEXCEPT;

// ---- Lengths and amounts of events ----

/// The largest coordinate of a position and the largest length of an event [1/1024 m]: 16384 m.
#define BRUME_MAX_COORDINATE 16777216
/// The largest amount of one smoke [voxels].
#define BRUME_MAX_SMOKE_VOXELS 134217728u

/// A position of an event [1/1024 m], each coordinate within +-BRUME_MAX_COORDINATE.
typedef struct brume_position {
  int32_t x, y, z;  ///< Coordinate [1/1024 m].
} brume_position;

/// Rounds a point [m] to the nearest position. Errors: BRUME_ERROR_ARGUMENT when a coordinate is not finite
/// or beyond +-16384 m.
BRUME_API brume_result brume_position_from_metres(double x, double y, double z,
                                                  brume_position* position) BRUME_NOEXCEPT;

/// Returns the integer nearest to `value`, halves rounded up, clamped to [low, high]; `low` for NaN.
static inline uint32_t brume_rounded(double value, uint32_t low, uint32_t high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  const uint32_t whole = BRUME_CAST(uint32_t, value);
  return value - whole >= 0.5 ? whole + 1 : whole;
}

/// Returns a length [m] in 1/1024 m, rounded to the nearest, clamped to [0, BRUME_MAX_COORDINATE]; 0 for NaN.
/// The same function converts a speed from m/s to 1/1024 m/s.
static inline uint32_t brume_length(double metres) {
  return brume_rounded(metres * 1024.0, 0, BRUME_MAX_COORDINATE);
}

/// Returns the number of voxels with an edge of voxel_size [m] that an amount of smoke [m^3] fills, rounded
/// to the nearest, clamped to [1, BRUME_MAX_SMOKE_VOXELS]; 1 where an argument is NaN or voxel_size is not
/// above 0. Pass brume_layout::voxel_size of the level: the same amount then fills the same volume in any
/// level.
static inline uint32_t brume_smoke_voxels(double cubic_metres, double voxel_size) {
  if (!(voxel_size > 0.0)) return 1;
  return brume_rounded(cubic_metres / (voxel_size * voxel_size * voxel_size), 1, BRUME_MAX_SMOKE_VOXELS);
}

// ---- Events ----
//
// A state lists the effects of the events up to its tick. The id of a grenade, cloud, hole or blast is the
// number of its event, in the order in which events take effect, from 0: the same on all machines.
//
//   event               effect in a state                      begins with        ends when
//   BRUME_EVENT_SMOKE   brume_grenade (brume_state_grenades)   the throw          it detonates
//                       brume_cloud (brume_state_clouds)       the detonation     it has dissolved
//   BRUME_EVENT_SHOT    brume_hole (brume_state_holes)         the shot           it has closed
//   BRUME_EVENT_BLAST   brume_blast (brume_state_blasts)       the explosion      its cavity has refilled
//   BRUME_EVENT_MOVE    brume_body (brume_state_bodies)        the first move     never
//   BRUME_EVENT_EDIT    the edited level, in no list:          the edit           another edit restores
//                       brume_field_update takes it over                          the voxels
//
// An event may have no effect: a grenade whose path misses the level, a shot or blast that meets no smoke, an
// edit that changes no voxel. A blast inside a wall moves to the nearest free voxel.

/// The largest tick: 97 days at 64 ticks per second.
#define BRUME_MAX_TICK 536870912u
/// The largest number of events of one call.
#define BRUME_MAX_EVENTS 1048576u

typedef enum brume_event_kind {
  BRUME_EVENT_SMOKE = 1,
  BRUME_EVENT_SHOT = 2,
  BRUME_EVENT_BLAST = 3,
  BRUME_EVENT_MOVE = 4,
  BRUME_EVENT_EDIT = 5
} brume_event_kind;

typedef enum brume_hole_shape {
  BRUME_HOLE_CYLINDER = 0,
  BRUME_HOLE_BOX = 1,
  BRUME_HOLE_MASK = 2
} brume_hole_shape;

/// A smoke grenade is thrown. It flies straight at 20 m/s from `from` through `at` to the first wall, glass
/// or grille, and detonates in the last free voxel in front of it; without an obstacle it detonates at `at`.
/// A flight that starts in a solid voxel detonates in the nearest free one, on whichever side of the wall
/// that lies: let it start at least a voxel in front of the wall that a grenade rests at.
/// Times are in ticks, because smoke spreads from tick to tick.
typedef struct brume_smoke_event {
  brume_position from;  ///< The start of the flight.
  brume_position at;    ///< A point on its path; equal to `from`, it detonates there.
  /// Amount of smoke, [1, BRUME_MAX_SMOKE_VOXELS]: brume_smoke_voxels(). It reaches as many voxels, and thins
  /// out towards its rim: about three quarters of them show, and their densities add up to about half.
  uint32_t voxels;
  uint32_t bloom_ticks;     ///< Time from the detonation to the full amount, [1, BRUME_MAX_TICK].
  uint32_t hold_ticks;      ///< Time from the full amount to the start of the dissolve, [0, BRUME_MAX_TICK].
  uint32_t dissolve_ticks;  ///< Time from the start of the dissolve to its end, [1, BRUME_MAX_TICK].
} brume_smoke_event;

/// A bullet bores a hole into the smoke that is present at this tick. Times are in ms, because a hole is
/// drawn at any time between two ticks; each is at most 2^30.
typedef struct brume_shot_event {
  brume_position origin, toward;  ///< The muzzle and a point on the bullet's path; they must differ.
  /// Radius of a cylinder, half the edge of a box or mask [1/1024 m], [1, BRUME_MAX_COORDINATE]:
  /// brume_length().
  uint32_t radius_1024;
  uint32_t reach_far_ms;  ///< Time until the hole is open along its whole length.
  uint32_t expand_ms;     ///< Time until the hole, once open at a place, has its full radius there.
  uint32_t stay_open_ms;  ///< Time for which the hole then stays open.
  uint32_t fade_ms;       ///< Time in which the hole then closes.
  uint32_t shape;         ///< A brume_hole_shape.
  uint32_t mask_index;    ///< Index into the masks of the world; 0 unless the shape is BRUME_HOLE_MASK.
  uint32_t roll_65536;    ///< Clockwise rotation as the shooter sees it [1/65536 turn], [0, 65535].
} brume_shot_event;

/// An explosion drives the smoke out of every voxel that is visible from it. Times are in ms, as for shots.
typedef struct brume_blast_event {
  brume_position at;          ///< The centre of the explosion.
  uint32_t radius_1024;       ///< Radius of the cavity [1/1024 m], from 1 to 64 voxels: brume_length().
  uint32_t speed_1024;        ///< Speed of its front [1/1024 m/s], [1024, 2^24]: brume_length().
  uint32_t remaining_255;     ///< Fraction of the density that remains inside [1/255], [0, 255].
  uint32_t refill_rim_ms;     ///< Time until the rim is full again, [1, 2^30].
  uint32_t refill_middle_ms;  ///< Time until the middle is full again, [refill_rim_ms, 2^30].
} brume_blast_event;

/// A player or object moves. Its first move places it.
typedef struct brume_move_event {
  uint32_t body;      ///< The caller's number for the player or object.
  brume_position to;  ///< Its new position.
} brume_move_event;

/// The level changes, because a door opens or a wall breaks: all voxels of the box [low, high) become walls,
/// or free of all roles. The part of the box outside the level is ignored; the box must contain a voxel.
/// Smoke ends at the faces of edited voxels.
typedef struct brume_edit_event {
  brume_voxel low, high;  ///< The box [low, high).
  uint32_t solid;         ///< 1: the voxels become walls; 0: they become free.
} brume_edit_event;

/// An event of a world's log.
typedef struct brume_event {
  uint32_t struct_size;  ///< sizeof(brume_event), in every version: new kinds fit into `reserved`.
  const void* next;
  uint32_t kind;  ///< A brume_event_kind: it selects the member of `u`.
  uint32_t tick;  ///< The tick at which the event takes effect, [0, BRUME_MAX_TICK].
  union {
    brume_smoke_event smoke;
    brume_shot_event shot;
    brume_blast_event blast;
    brume_move_event move;
    brume_edit_event edit;
    uint32_t reserved[32];
  } u;  ///< The contents of the event, by its kind.
} brume_event;

/// Writes what brume_event_defaults returns: for other languages.
BRUME_API brume_result brume_event_init(brume_event* event, uint32_t kind, uint32_t tick) BRUME_NOEXCEPT;
/// Returns an event of a kind (brume_event_kind) at a tick with the defaults of that kind. All positions are
/// 0: set them. A smoke fills 225 m^3 where voxels have edges of 0.5 m, blooms for 1 s, holds for 18 s and
/// dissolves for 3 s at 64 ticks per second.
static inline brume_event brume_event_defaults(uint32_t kind, uint32_t tick) {
  brume_event event;
  brume_event_init(&event, kind, tick);
  return event;
}

// ---- Worlds ----

/// The settings of a new world.
typedef struct brume_world_params {
  uint32_t struct_size;
  const void* next;
  uint32_t ticks_per_second;  ///< The tick rate, [1, 1000].
  const brume_masks* masks;   ///< The masks that shots may use; null: none.
} brume_world_params;

/// Writes what brume_world_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_world_params_init(brume_world_params* params,
                                               uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: 64 ticks per second, no masks.
static inline brume_world_params brume_world_defaults(void) {
  brume_world_params params;
  brume_world_params_init(&params, sizeof params);
  return params;
}

/// Creates a world at tick 0, without events. `params` may be null: the defaults.
BRUME_API brume_result brume_world_create(const brume_level* level, const brume_world_params* params,
                                          brume_world** world) BRUME_NOEXCEPT;
/// Destroys a world; null is ignored. Its states live on.
BRUME_API brume_result brume_world_destroy(brume_world* world) BRUME_NOEXCEPT;

/// Adds events to the log, all or none, at most BRUME_MAX_EVENTS. Events at or before the present tick change
/// the past: the world rolls back once and replays to the present, with the same result as if they had come
/// in time. Events of one tick take effect in the order in which they were appended. Errors:
/// BRUME_ERROR_HISTORY for an event before the last tick that was given to brume_world_forget_before, and for
/// one at or before the tick of a restored state.
BRUME_API brume_result brume_world_append(brume_world* world, const brume_event* events,
                                          size_t count) BRUME_NOEXCEPT;
/// Replaces all events at or after `tick` by others, each of that tick or later; a client corrects its
/// prediction with it. Otherwise it works and fails as brume_world_append does.
BRUME_API brume_result brume_world_replace_from(brume_world* world, uint32_t tick, const brume_event* events,
                                                size_t count) BRUME_NOEXCEPT;

/// Moves the world to a tick in [0, BRUME_MAX_TICK], forwards or backwards. Only ticks at which an effect
/// starts or ends cost time. Errors: BRUME_ERROR_HISTORY for a tick before brume_world_earliest_tick.
BRUME_API brume_result brume_world_advance_to(brume_world* world, uint32_t tick) BRUME_NOEXCEPT;
/// Moves the world to the next tick.
BRUME_API brume_result brume_world_step(brume_world* world) BRUME_NOEXCEPT;
/// Writes the present tick.
BRUME_API brume_result brume_world_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT;
/// Writes the earliest tick to which the world can roll back.
BRUME_API brume_result brume_world_earliest_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT;
/// Drops the history before `tick`, and refuses late input exactly from there on: an event before `tick` is
/// BRUME_ERROR_HISTORY, one of `tick` or later is accepted, also in a match in which nothing has happened.
/// `tick` becomes the earliest tick; if it is after the present one, events before it are refused as well,
/// and the present tick becomes the earliest. A lower tick than before changes nothing;
/// brume_world_restore begins a new history without a limit. Call it every tick: without it, memory grows
/// with the length of the match. The call is cheap.
BRUME_API brume_result brume_world_forget_before(brume_world* world, uint32_t tick) BRUME_NOEXCEPT;
/// Writes the hash of the present state, its level included. Equal states have equal hashes on every machine;
/// at tick 0, equal hashes show that worlds have the same level, tick rate and masks.
BRUME_API brume_result brume_world_hash(const brume_world* world, uint64_t* hash) BRUME_NOEXCEPT;

/// Creates a snapshot of the present state. The call is cheap, because clouds are shared instead of copied.
BRUME_API brume_result brume_world_state(const brume_world* world, brume_state** state) BRUME_NOEXCEPT;
/// Makes `state` the present state. Events up to its tick are dropped from the log, later ones remain; its
/// tick becomes the earliest one. Errors: BRUME_ERROR_MISMATCH when the state comes from a world with another
/// level, other ticks per second or other masks.
BRUME_API brume_result brume_world_restore(brume_world* world, const brume_state* state) BRUME_NOEXCEPT;

// ---- States: immutable snapshots ----

/// Counts and times of a state.
typedef struct brume_state_info {
  uint32_t tick;              ///< The tick of the state.
  uint32_t ticks_per_second;  ///< The tick rate of its world.
  uint32_t event_count;       ///< Events that have taken effect so far.
  uint32_t grenade_count;     ///< Grenades in the air.
  uint32_t cloud_count;       ///< Clouds of smoke.
  uint32_t blast_count;       ///< Cavities of explosions.
  uint32_t hole_count;        ///< Holes of shots.
  uint32_t body_count;        ///< Bodies.
} brume_state_info;

/// Destroys a state; null is ignored. Fields, senders and worlds that took it over have their own copy.
BRUME_API brume_result brume_state_destroy(brume_state* state) BRUME_NOEXCEPT;
/// Writes counts and times.
BRUME_API brume_result brume_state_describe(const brume_state* state, brume_state_info* info) BRUME_NOEXCEPT;
/// Writes the hash of the state, as brume_world_hash does.
BRUME_API brume_result brume_state_hash(const brume_state* state, uint64_t* hash) BRUME_NOEXCEPT;
/// Writes the state as bytes, a keyframe of the wire format; a grown cloud takes a few hundred bytes. Equal
/// states give equal bytes. The first call encodes, further calls copy.
BRUME_API brume_result brume_state_save(const brume_state* state, void* buffer, size_t capacity,
                                        size_t* size) BRUME_NOEXCEPT;

/// A box in the world, in metres and closed, unlike boxes of voxels.
typedef struct brume_box {
  brume_point low, high;  ///< Its corners [m], each coordinate within +-16384, `low` not above `high`.
} brume_box;

/// Creates a state of what reaches one of the boxes: what a client may know whose players see only into them.
/// Push it to a sender of that team or client; packets, requests and checks work as usual.
///
/// Boxes grow outwards to whole voxels and by two more. Clouds and cavities are kept whole if any voxel that
/// they have at any tick lies there; holes, with their muzzle, if their axis passes within two radii of
/// there; grenades while they are there; bodies if they are there or were before their last move. Edits of
/// the level and the number of events are always kept.
///
/// brume_field_optical_depths of a line within a box gives what it does in the whole state, but for rounding
/// (through holes of masks far from the origin up to 0.2 %) and, beside a thin wall, for smoke behind it in a
/// closed space of fewer than 4096 voxels. A field of the filtered state has the client's results bit for
/// bit. The noise of drawn smoke may lack the wake of a body or shot outside. Do not restore the state into a
/// world that goes on. One box takes some 0.02 ms for 1,000 clouds; at most 4096 boxes; null if there are
/// none. Errors: BRUME_ERROR_ARGUMENT for a box out of range.
BRUME_API brume_result brume_state_filter(const brume_state* state, const brume_box* boxes, size_t box_count,
                                          brume_state** filtered) BRUME_NOEXCEPT;

/// Creates a state from the bytes that brume_state_save wrote. At most 16 MiB and 2^26 voxels. The bytes need
/// not be trusted. Errors: BRUME_ERROR_DATA when they are damaged or describe a state that no world can have.
BRUME_API brume_result brume_state_load(brume_context* context, const void* bytes, size_t size,
                                        brume_state** state) BRUME_NOEXCEPT;

/// A grenade in the air.
typedef struct brume_grenade {
  uint32_t id;                           ///< Number of its event. Its cloud will have the same id.
  uint32_t throw_tick, detonation_tick;  ///< Start and end of its flight.
  brume_voxel landing;                   ///< The voxel in which it detonates.
  brume_point position;                  ///< Its position at the state's tick [m].
} brume_grenade;

/// The smoke of one grenade.
typedef struct brume_cloud {
  uint32_t id;               ///< Number of its event.
  uint32_t detonation_tick;  ///< Start of the bloom.
  uint32_t end_tick;         ///< End of the dissolve: from this tick on the cloud is not listed.
  brume_voxel source;        ///< The voxel of the detonation.
  brume_voxel low, high;     ///< A box [low, high) around all voxels that it may fill at any tick.
} brume_cloud;

/// The cavity of an explosion.
typedef struct brume_blast {
  uint32_t id;            ///< Number of its event.
  uint32_t tick;          ///< The tick of the explosion.
  uint32_t end_tick;      ///< The tick from which on the cavity is full again, and not listed.
  brume_position centre;  ///< The centre of the explosion.
  uint32_t radius_1024;   ///< Its radius [1/1024 m].
} brume_blast;

/// The hole of a shot.
typedef struct brume_hole {
  uint32_t id;                    ///< Number of its event.
  uint32_t tick;                  ///< The tick of the shot.
  brume_position origin, toward;  ///< The muzzle and a point on the bullet's path.
  uint32_t radius_1024;           ///< Radius, or half the edge [1/1024 m].
  uint32_t distance_1024;         ///< Depth of the hole from the muzzle [1/1024 m].
  uint32_t shape;                 ///< A brume_hole_shape.
  uint32_t mask_index;            ///< As in brume_shot_event.
  uint32_t roll_65536;            ///< As in brume_shot_event.
} brume_hole;

/// A body, with its last two positions.
typedef struct brume_body {
  uint32_t body;                               ///< The caller's number.
  uint32_t tick, previous_tick;                ///< The ticks of its last move and of the move before.
  brume_position position, previous_position;  ///< Its positions after these moves.
} brume_body;

/// Writes the grenades in the air, by rising id.
BRUME_API brume_result brume_state_grenades(const brume_state* state, brume_grenade* grenades,
                                            size_t capacity, size_t* count) BRUME_NOEXCEPT;
/// Writes the clouds, by rising id.
BRUME_API brume_result brume_state_clouds(const brume_state* state, brume_cloud* clouds, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;
/// Writes the cavities of explosions, by rising id.
BRUME_API brume_result brume_state_blasts(const brume_state* state, brume_blast* blasts, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;
/// Writes the holes of shots, by rising id.
BRUME_API brume_result brume_state_holes(const brume_state* state, brume_hole* holes, size_t capacity,
                                         size_t* count) BRUME_NOEXCEPT;
/// Writes the bodies, by rising number.
BRUME_API brume_result brume_state_bodies(const brume_state* state, brume_body* bodies, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;

// ---- Packets ----

/// The settings of a new sender.
typedef struct brume_sender_params {
  uint32_t struct_size;
  const void* next;
  /// Number of past states from which it can answer a receiver with a difference, [1, 65536]. A receiver that
  /// is further behind gets a whole state.
  uint32_t history;
} brume_sender_params;

/// Writes what brume_sender_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_sender_params_init(brume_sender_params* params,
                                                uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: a history of 128 states, two seconds at 64 ticks per second.
static inline brume_sender_params brume_sender_defaults(void) {
  brume_sender_params params;
  brume_sender_params_init(&params, sizeof params);
  return params;
}

/// Creates the sending side: one packet per tick for all receivers, and answers to those that missed some.
/// `params` may be null: the defaults.
BRUME_API brume_result brume_sender_create(brume_context* context, const brume_sender_params* params,
                                           brume_sender** sender) BRUME_NOEXCEPT;
/// Destroys a sender; null is ignored.
BRUME_API brume_result brume_sender_destroy(brume_sender* sender) BRUME_NOEXCEPT;
/// Takes the state of a tick and makes its packet: the difference from the last state, or the whole state on
/// the first call. A state with fewer events than the last one starts a new world. Errors: BRUME_ERROR_ORDER
/// unless its tick is above the last one's; BRUME_ERROR_MISMATCH when its world has another level, other
/// ticks per second or other masks than the last one's.
BRUME_API brume_result brume_sender_push(brume_sender* sender, const brume_state* state) BRUME_NOEXCEPT;
/// Writes the packet of the last state pushed, to be sent to every receiver. Errors: BRUME_ERROR_ORDER before
/// the first push.
BRUME_API brume_result brume_sender_packet(const brume_sender* sender, void* buffer, size_t capacity,
                                           size_t* size) BRUME_NOEXCEPT;
/// Writes the answer to a receiver's request, to be sent to that receiver: 0 bytes when it is up to date. The
/// request need not be trusted. Errors: BRUME_ERROR_DATA when it is not a request; BRUME_ERROR_ORDER before
/// the first push.
BRUME_API brume_result brume_sender_answer(brume_sender* sender, const void* request, size_t request_size,
                                           void* buffer, size_t capacity, size_t* size) BRUME_NOEXCEPT;

/// The settings of a new receiver. A packet above a limit is BRUME_ERROR_DATA.
typedef struct brume_receiver_params {
  uint32_t struct_size;
  const void* next;
  uint64_t max_bytes;   ///< Bytes of one packet, [1, 2^24].
  uint64_t max_voxels;  ///< Voxels of all smoke in one packet, [1, 2^26].
  uint64_t max_items;   ///< Elements of each list in a packet, [1, 2^20].
  /// The level that the sender's states must be of; it may be destroyed before the receiver. Null: any.
  const brume_level* level;
  /// By how many ticks your transport lets packets overtake others, [0, 64]. Packets that come up to so many
  /// ticks early are held, so many at most and max_bytes together at most, and used in the order of their
  /// ticks as soon as the earlier ones arrive. The loss of a packet is noticed so many ticks later. 0: none
  /// are held, for a transport that keeps the order. 2 suits most others at 64 ticks per second.
  uint32_t hold_ticks;
} brume_receiver_params;

/// Writes what brume_receiver_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_receiver_params_init(brume_receiver_params* params,
                                                  uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: the largest limits, states of any level, no packets held.
static inline brume_receiver_params brume_receiver_defaults(void) {
  brume_receiver_params params;
  brume_receiver_params_init(&params, sizeof params);
  return params;
}

typedef enum brume_reception {
  BRUME_RECEPTION_APPLIED = 0,  ///< The receiver now has the packet's state, or one of a packet held before.
  BRUME_RECEPTION_OLD = 1,      ///< Ignored: the receiver has this state or a later one, or holds its packet.
  BRUME_RECEPTION_MISSED = 2,   ///< The state on which the packet builds is missing. Send a request.
  BRUME_RECEPTION_HELD = 3      ///< The packet is early, and used as soon as those before it have arrived.
} brume_reception;

/// Creates the receiving side, which requires no world. `params` may be null: the defaults.
BRUME_API brume_result brume_receiver_create(brume_context* context, const brume_receiver_params* params,
                                             brume_receiver** receiver) BRUME_NOEXCEPT;
/// Destroys a receiver; null is ignored. Its states live on.
BRUME_API brume_result brume_receiver_destroy(brume_receiver* receiver) BRUME_NOEXCEPT;
/// Processes a packet or an answer, in any order and with gaps, and held packets that build on it; writes the
/// brume_reception of the given one; `reception` may be null. The packet need not be trusted. Errors:
/// BRUME_ERROR_DATA when it is damaged or gives another state than the sender's; the receiver's state is then
/// unchanged, and brume_receiver_behind writes 1. BRUME_ERROR_MISMATCH when the packet is a whole state of
/// another level than the receiver's; the difference from such a state finds no state to build on.
BRUME_API brume_result brume_receiver_receive(brume_receiver* receiver, const void* packet, size_t size,
                                              uint32_t* reception) BRUME_NOEXCEPT;
/// Writes 1 when the receiver has detected that a state is missing, else 0. Send a request every few ticks
/// until it is 0, and also when no packet has arrived for a while.
BRUME_API brume_result brume_receiver_behind(const brume_receiver* receiver, uint32_t* behind) BRUME_NOEXCEPT;
/// Writes a request for the sender, at most 16 bytes.
BRUME_API brume_result brume_receiver_request(const brume_receiver* receiver, void* buffer, size_t capacity,
                                              size_t* size) BRUME_NOEXCEPT;
/// Creates a snapshot of the newest state, equal bit for bit to the sender's state of that tick. Errors:
/// BRUME_ERROR_ORDER before the first state has been received.
BRUME_API brume_result brume_receiver_state(const brume_receiver* receiver,
                                            brume_state** state) BRUME_NOEXCEPT;
/// Drops all states, for a new match.
BRUME_API brume_result brume_receiver_reset(brume_receiver* receiver) BRUME_NOEXCEPT;

// ---- The density field and the line of sight ----

/// The largest number of elements in one array of queries.
#define BRUME_MAX_QUERIES 268435456u

/// The settings of a new field.
typedef struct brume_field_params {
  uint32_t struct_size;
  const void* next;
  float extinction;          ///< Extinction of the densest smoke, without erosion [1/m], [0, 10^6].
  const brume_masks* masks;  ///< The masks of the worlds whose states it takes over; null: none.
} brume_field_params;

/// Writes what brume_field_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_field_params_init(brume_field_params* params,
                                               uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: an extinction of 3 per metre, no masks.
static inline brume_field_params brume_field_defaults(void) {
  brume_field_params params;
  brume_field_params_init(&params, sizeof params);
  return params;
}

/// A line from a to b. Coordinates must be finite and within +-16384 m; they may lie outside the level, where
/// the air is clear.
typedef struct brume_segment {
  brume_point a, b;  ///< An end [m].
} brume_segment;

/// The first voxel of a wall along a segment. Glass and grilles are not walls.
typedef struct brume_wall {
  uint32_t hit;        ///< 1: there is a wall; 0: there is none, and all other members are 0.
  brume_voxel voxel;   ///< The voxel.
  brume_voxel normal;  ///< Outward normal of the face through which the segment enters: a unit vector.
  float distance;      ///< Distance from a to that face [m].
} brume_wall;

/// Creates the density field of a level, without smoke. The field holds copies of all that its queries read:
/// worlds may advance while other threads query it. `params` may be null: the defaults.
BRUME_API brume_result brume_field_create(const brume_level* level, const brume_field_params* params,
                                          brume_field** field) BRUME_NOEXCEPT;
/// Destroys a field; null is ignored.
BRUME_API brume_result brume_field_destroy(brume_field* field) BRUME_NOEXCEPT;
/// Takes over a state with its smoke, holes and level edits. Only changes since the last update cost time.
/// Errors: BRUME_ERROR_MISMATCH for a state of another level or with other masks; BRUME_ERROR_LIMIT when the
/// smoke fills more than 2^22 bricks of 8^3 voxels.
BRUME_API brume_result brume_field_update(brume_field* field, const brume_state* state) BRUME_NOEXCEPT;

/// Writes the bricks of 8^3 voxels (voxel / 8) in which the last update may have changed densities, by rising
/// z, then y, then x. A copy of the densities has to read these bricks again.
BRUME_API brume_result brume_field_changed_bricks(const brume_field* field, brume_voxel* bricks,
                                                  size_t capacity, size_t* count) BRUME_NOEXCEPT;

/// Writes the optical depth of the smoke along each segment, at most BRUME_MAX_QUERIES. Holes count, walls
/// and the noise of the drawn smoke do not. exp(-depth) of the light passes. The results are the same bits on
/// every machine, for any number of threads, for one segment or many.
BRUME_API brume_result brume_field_optical_depths(const brume_field* field, const brume_segment* segments,
                                                  size_t count, float* depths) BRUME_NOEXCEPT;
/// Writes 1 for each segment whose ends are visible from each other, else 0. They are when no wall lies
/// between the voxels of a and b (sight passes glass and grilles) and the optical depth is at most
/// `threshold`. Walls are voxels here: the voxels of a and b themselves hide nothing, so that a point up to
/// a voxel behind a wall may be visible, and a line along a wall or floor within a voxel of it is blocked.
/// Use your own ray cast where that matters, and a threshold on brume_field_optical_depths for smoke.
/// Optical depths of 1, 3 and 5 let 37, 5 and 0.7 % of the light pass. `threshold` is at least 0; infinity
/// tests walls only. Guarantees are as for brume_field_optical_depths; this query is faster, as it ends at
/// the first obstacle.
BRUME_API brume_result brume_field_visible(const brume_field* field, const brume_segment* segments,
                                           size_t count, float threshold, uint8_t* visible) BRUME_NOEXCEPT;

/// The noise that erodes drawn smoke; brume_smoke_look of brume_vulkan.h has members of the same names. Give
/// both the same values, and `detail` = 1 - brume_frame_params::detail_reduction.
typedef struct brume_drawn_params {
  uint32_t struct_size;
  const void* next;
  float erosion;     ///< Strength of the erosion, [0, 1]; 0: no erosion.
  float noise_size;  ///< Size of the largest billows [m], [0.05, 100].
  float detail;      ///< Weight of the noise finer than a tenth of noise_size, [0, 1].
  float hole_rim;    ///< Distance by which noise frays the rims of holes [m], [0, 10].
  float swirl;       ///< Distance by which the noise swirls [m], [0, 10].
  float rise;        ///< Speed at which the noise rises [m/s], [-10, 10].
} brume_drawn_params;

/// Writes what brume_drawn_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_drawn_params_init(brume_drawn_params* params,
                                               uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults, equal to the defaults of brume_frame_params in brume_vulkan.h.
static inline brume_drawn_params brume_drawn_defaults(void) {
  brume_drawn_params params;
  brume_drawn_params_init(&params, sizeof params);
  return params;
}

/// Writes the optical depth along each segment as brume_field_optical_depths does, but of the smoke as a
/// renderer draws it at the state's tick: eroded by noise, with frayed rims of holes. The results are the
/// same bits on every machine. The query takes some hundred times as long; the first one in a process also
/// generates the noise, in a second of CPU time, and the first one after an update, or with other `params`,
/// takes some milliseconds more. `params` may be null: the defaults.
BRUME_API brume_result brume_field_drawn_depths(const brume_field* field, const brume_drawn_params* params,
                                                const brume_segment* segments, size_t count,
                                                float* depths) BRUME_NOEXCEPT;
/// Writes visibility as brume_field_visible does, but through the smoke as a renderer draws it: it answers
/// whether a player can see through the gaps of a rim. Cost and `params` are as for brume_field_drawn_depths.
BRUME_API brume_result brume_field_drawn_visible(const brume_field* field, const brume_drawn_params* params,
                                                 const brume_segment* segments, size_t count, float threshold,
                                                 uint8_t* visible) BRUME_NOEXCEPT;
/// Writes the first voxel of a wall along each segment, apart from the voxels that contain a and b.
BRUME_API brume_result brume_field_first_walls(const brume_field* field, const brume_segment* segments,
                                               size_t count, brume_wall* walls) BRUME_NOEXCEPT;
/// Writes the density of each voxel of the box [low, high), [0, 255], x fastest, then y, then z. Cavities of
/// explosions count, holes and noise do not; solid voxels have 0. The box must lie in the level and contain a
/// voxel; `count` is the number of its voxels.
BRUME_API brume_result brume_field_densities(const brume_field* field, brume_voxel low, brume_voxel high,
                                             uint8_t* densities, size_t count) BRUME_NOEXCEPT;

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_H
