// The public C interface of Brume: the simulation of smoke and the line of sight through it, without Vulkan.
// Library: libbrume-sim. Walk through: docs/embedding.md. C++: brume.hpp, beside this file.
//
//   context --> level --> world --> state --> field        optical depths, visibility, walls, densities
//                          ^         |  `---> sender --> packets --> receiver --> state
//                       events       `-----> bytes (a snapshot) ---> state --> world
//
// Results    Each function returns BRUME_OK or an error, and then brume_last_error() is one line about it, of
//            the calling thread. After an error nothing has changed and no output has been written, except
//            where the function says otherwise. No exception and no signal reaches the caller for arguments
//            that are wrong: null, another kind of handle, another struct_size, NaN, out of range.
//            BRUME_ERROR_MEMORY may stop a change halfway: see BRUME_ERROR_BROKEN.
// Handles    Created by *_create and similar, released by *_destroy, which accepts null. What a handle refers
//            to lives as long as required: a level may be destroyed before its worlds. A destroyed handle
//            must not be used again.
// Threads    Any function may be called from any thread. Calls that change one handle run one after another,
//            reads of it run concurrently. Destroying a handle is the last call with it: no other may run.
//            Nothing is set for the whole process. A context has its own number of threads, which a call may
//            start and which end before it returns. Calls have their own floating-point environment: rounding
//            modes, flushed denormals and traps of the caller do not matter.
// Structs    Parameter structs begin with `struct_size` = sizeof(the struct) and `next` = NULL. Take their
//            defaults from the *_defaults functions. Other structs never change, nor does brume_event.
// Growth     Later versions may add members at the end of a parameter struct, where 0 means what the library
//            did before. A shorter struct of an earlier header works: the members that it lacks have their
//            defaults. A longer one of a later header works as long as what this library does not know is 0,
//            and else is BRUME_ERROR_ARGUMENT. `next` is for structs of later versions; there are none yet.
// Arrays     A null pointer is accepted where the count is 0. Outputs must not overlap inputs.
// Bytes      Functions that write bytes take `buffer`, `capacity` and `size`: *size receives the number of
//            bytes; a null buffer with capacity 0 queries it. BRUME_ERROR_BUFFER: the capacity is too small;
//            *size is set, the buffer is unchanged.
// Lists      The same for functions that write lists: `capacity` and `count` are numbers of elements.
// Units      Metres, right-handed, Y up. Voxel i of a level covers [i, i + 1) in voxel space;
//            position_voxel = (position - origin) / voxel_size. Positions of events are integers of 1/1024 m,
//            times are ticks: the same events give the same bits on every machine.
#ifndef BRUME_BRUME_H
#define BRUME_BRUME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define BRUME_NOEXCEPT noexcept
#define BRUME_NULL nullptr
extern "C" {
#else
#define BRUME_NOEXCEPT
#define BRUME_NULL NULL
#endif

#if defined(__GNUC__)
#define BRUME_API __attribute__((visibility("default")))
#else
#define BRUME_API
#endif

// ---- Version and errors ----

/// Version of this header. Before 1.0, a minor version may change the interface; the library's SOVERSION
/// then changes too.
#define BRUME_VERSION_MAJOR 0
#define BRUME_VERSION_MINOR 2
#define BRUME_VERSION_PATCH 0

typedef enum brume_result {
  BRUME_OK = 0,
  BRUME_ERROR_ARGUMENT = 1,  ///< An argument is null, not finite, out of range, or a struct of another size.
  BRUME_ERROR_HANDLE = 2,    ///< A handle is null, of another kind, or not a handle.
  BRUME_ERROR_DATA = 3,      ///< Received bytes are damaged, truncated, foreign or of another version.
  BRUME_ERROR_HISTORY = 4,   ///< A tick lies before the history that the world retains.
  BRUME_ERROR_MISMATCH = 5,  ///< Two objects differ in level layout, ticks per second or masks.
  BRUME_ERROR_ORDER = 6,     ///< Something must come first: the message names it.
  BRUME_ERROR_BUFFER = 7,    ///< The capacity of an output is too small.
  BRUME_ERROR_LIMIT = 8,     ///< More than a limit of the library allows.
  BRUME_ERROR_MEMORY = 9,    ///< Out of memory or threads.
  /// An earlier call ran out of memory or over a limit halfway. Until brume_world_restore (world),
  /// brume_field_update (field) or brume_receiver_reset (receiver) succeeds, only *_destroy works; of a
  /// sender nothing else ever does.
  BRUME_ERROR_BROKEN = 10,
  BRUME_ERROR_INTERNAL = 11,  ///< A defect of the library.
  BRUME_ERROR_DEVICE = 12     ///< The Vulkan device lacks what is required, or is lost (brume_vulkan.h).
} brume_result;

/// Writes the version of the library in use. Any pointer may be null. Never fails.
BRUME_API brume_result brume_version(uint32_t* major, uint32_t* minor, uint32_t* patch) BRUME_NOEXCEPT;

/// Returns one line about the last failure in this thread: the function, what it expected and what it got;
/// "" before the first one. UTF-8, at most 511 bytes. Valid until the next failure in this thread; calls that
/// succeed do not change it.
BRUME_API const char* brume_last_error(void) BRUME_NOEXCEPT;

/// Returns the name of a result: "BRUME_OK"; "unknown" for a number that is none. A constant.
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
/// with BRUME_OK warnings, such as of a volume that is shown at a lower resolution. Called in the thread of
/// that call, after its work, possibly by several threads at once; it may then call any function but the
/// destruction of the handle in use. Warnings come also from threads that load volumes: there it must call
/// none. `line` is valid during the call. It must not throw.
typedef void (*brume_log_callback)(void* user, brume_result result, const char* line);

/// What a context is created with.
typedef struct brume_context_params {
  uint32_t struct_size;
  const void* next;
  uint32_t thread_count;   ///< Threads of one call, the caller's included: [1, 1024]; 0: one per core.
  brume_log_callback log;  ///< Null: none.
  void* log_user;          ///< Passed to `log`.
} brume_context_params;

static inline brume_context_params brume_context_defaults(void) {
  brume_context_params params = {sizeof(brume_context_params), BRUME_NULL, 0, BRUME_NULL, BRUME_NULL};
  return params;
}

/// Creates a context, which everything else is created from. `params` may be null: the defaults.
BRUME_API brume_result brume_context_create(const brume_context_params* params,
                                            brume_context** context) BRUME_NOEXCEPT;
/// Objects of the context live on, without its log callback: after this call it is not called again, unless a
/// call in another thread is about to.
BRUME_API brume_result brume_context_destroy(brume_context* context) BRUME_NOEXCEPT;

// ---- Levels ----

/// Voxels per axis of the largest level.
#define BRUME_MAX_AXIS 4096

/// A voxel, or a size in voxels.
typedef struct brume_voxel {
  int32_t x, y, z;  ///< Coordinate, or size along an axis.
} brume_voxel;

/// A point in the world [m].
typedef struct brume_point {
  float x, y, z;  ///< Coordinate [m].
} brume_point;

/// Where the voxels of a level lie. All machines of a match must use the same bits.
typedef struct brume_layout {
  brume_voxel size;    ///< Voxels per axis, each in [1, BRUME_MAX_AXIS].
  float voxel_size;    ///< Edge of a voxel [m], [1/64, 64].
  brume_point origin;  ///< Low corner of voxel (0, 0, 0) [m], each within +-16384.
} brume_layout;

/// What a surface stops. Each role stops less than the one before it.
typedef enum brume_role {
  BRUME_ROLE_WALL = 0,    ///< Smoke, sight, shots, bodies and thrown grenades.
  BRUME_ROLE_GLASS = 1,   ///< The same without sight.
  BRUME_ROLE_GRILLE = 2,  ///< Bodies and thrown grenades: a fence, leaves.
  BRUME_ROLE_GHOST = 3    ///< Nothing.
} brume_role;

/// A level as solid voxels.
typedef struct brume_voxels_params {
  uint32_t struct_size;
  const void* next;
  brume_layout layout;  ///< Where the voxels lie.
  /// One bit per voxel, 1 = solid, x fastest, then y, then z: voxel (x, y, z) is bit i % 8 of byte i / 8 with
  /// i = x + size.x * (y + size.y * z). Bits after the last voxel are ignored.
  const uint8_t* bits;
  size_t byte_count;  ///< Of `bits`: (size.x * size.y * size.z + 7) / 8.
  /// As many bytes, in the same order: which of the solid voxels are glass. Null: none, all are walls.
  const uint8_t* glass_bits;
  /// Likewise: which of the others are grilles. Null: none.
  const uint8_t* grille_bits;
} brume_voxels_params;

static inline brume_voxels_params brume_voxels_defaults(void) {
  brume_voxels_params params = {sizeof(brume_voxels_params),
                                BRUME_NULL,
                                {{0, 0, 0}, 0.5f, {0.0f, 0.0f, 0.0f}},
                                BRUME_NULL,
                                0,
                                BRUME_NULL,
                                BRUME_NULL};
  return params;
}

/// A level as the triangles of its collision mesh.
typedef struct brume_triangles_params {
  uint32_t struct_size;
  const void* next;
  /// With size (0, 0, 0), the smallest layout around all triangles with `margin` voxels on every side and an
  /// origin that is a multiple of voxel_size; the given origin is ignored then.
  brume_layout layout;
  uint32_t margin;            ///< Voxels, [0, 256].
  const brume_point* points;  ///< Corners [m], finite.
  size_t point_count;         ///< Of `points`.
  /// Three numbers of points for each triangle, in any winding. Triangles without area are allowed.
  const uint32_t* indices;
  size_t index_count;  ///< A multiple of 3.
  /// The brume_role of each triangle: index_count / 3 of them. A voxel has the role that stops most of those
  /// that touch it. Null: all are walls.
  const uint8_t* roles;
} brume_triangles_params;

static inline brume_triangles_params brume_triangles_defaults(void) {
  brume_triangles_params params = {sizeof(brume_triangles_params),
                                   BRUME_NULL,
                                   {{0, 0, 0}, 0.5f, {0.0f, 0.0f, 0.0f}},
                                   2,
                                   BRUME_NULL,
                                   0,
                                   BRUME_NULL,
                                   0,
                                   BRUME_NULL};
  return params;
}

/// Creates a level from solid voxels. Smoke ends at their faces.
BRUME_API brume_result brume_level_create_from_voxels(brume_context* context,
                                                      const brume_voxels_params* params,
                                                      brume_level** level) BRUME_NOEXCEPT;
/// Creates a level from the triangles of its collision mesh: every voxel that a wall or glass touches is
/// solid, exactly, and smoke ends at the surface of the triangles, not at the grid. The same triangles, roles
/// and layout give the same level on every machine. Errors: BRUME_ERROR_LIMIT when an axis would exceed
/// BRUME_MAX_AXIS.
BRUME_API brume_result brume_level_create_from_triangles(brume_context* context,
                                                         const brume_triangles_params* params,
                                                         brume_level** level) BRUME_NOEXCEPT;
BRUME_API brume_result brume_level_destroy(brume_level* level) BRUME_NOEXCEPT;

/// Writes the layout of the level.
BRUME_API brume_result brume_level_layout(const brume_level* level, brume_layout* layout) BRUME_NOEXCEPT;
/// Writes which voxels of the box [low, high) are solid as loaded, walls or glass: 1 or 0 each, x fastest,
/// then y, then z. The box must lie in the level and have a voxel; `count` is the number of its voxels.
BRUME_API brume_result brume_level_solid(const brume_level* level, brume_voxel low, brume_voxel high,
                                         uint8_t* solid, size_t count) BRUME_NOEXCEPT;
/// Writes the brume_role of each voxel of a box, likewise; BRUME_ROLE_GHOST where it is free.
BRUME_API brume_result brume_level_roles(const brume_level* level, brume_voxel low, brume_voxel high,
                                         uint8_t* roles, size_t count) BRUME_NOEXCEPT;

// ---- Masks: images that shots may cut out of smoke ----

/// An image of how much smoke a shot removes.
typedef struct brume_mask_image {
  uint32_t width, height;  ///< [1, 4094] texels.
  const uint8_t* texels;   ///< width * height, rows from the top: 255 removes all smoke, 0 none.
} brume_mask_image;

/// Creates a set of masks; shots refer to them by their place in `images`. At most 65,536; together they must
/// fit into 4096 x 4096 texels (BRUME_ERROR_LIMIT). Sender and receiver need the same set.
BRUME_API brume_result brume_masks_create(brume_context* context, const brume_mask_image* images,
                                          size_t count, brume_masks** masks) BRUME_NOEXCEPT;
BRUME_API brume_result brume_masks_destroy(brume_masks* masks) BRUME_NOEXCEPT;

// ---- Worlds ----

/// Largest tick: 97 days at 64 ticks per second.
#define BRUME_MAX_TICK 536870912u
/// Most events of one call.
#define BRUME_MAX_EVENTS 1048576u
/// Largest coordinate of a position: 16384 m.
#define BRUME_MAX_COORDINATE 16777216

/// A position of an event [1/1024 m], each coordinate within +-BRUME_MAX_COORDINATE.
typedef struct brume_position {
  int32_t x, y, z;  ///< Coordinate [1/1024 m].
} brume_position;

/// Rounds a point [m] to the nearest position. Fails with BRUME_ERROR_ARGUMENT when it is not finite or
/// farther than 16384 m from the origin on an axis.
BRUME_API brume_result brume_position_from_metres(double x, double y, double z,
                                                  brume_position* position) BRUME_NOEXCEPT;

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

/// A smoke grenade is thrown from `from`. It flies straight at 20 m/s through `at` to the first wall, glass
/// or grille, and detonates in the free voxel before it; without one, at `at`.
typedef struct brume_smoke_event {
  brume_position from, at;  ///< Where it is thrown from, and at.
  uint32_t voxels;          ///< Amount of smoke: voxels that it fills, [1, 2^27].
  uint32_t bloom_ticks;     ///< From the detonation to the full amount, [1, BRUME_MAX_TICK].
  uint32_t hold_ticks;      ///< Then to the start of the dissolve, [0, BRUME_MAX_TICK].
  uint32_t dissolve_ticks;  ///< Then to its end, [1, BRUME_MAX_TICK].
} brume_smoke_event;

/// A bullet bores a hole into the smoke that is there at this tick. Times are at most 2^30 ms.
typedef struct brume_shot_event {
  brume_position origin, toward;  ///< Must differ.
  uint32_t radius;                ///< Half the edge of a box or mask [1/1024 m], [1, BRUME_MAX_COORDINATE].
  uint32_t reach_far_ms;          ///< Until the hole is open along its whole length.
  uint32_t expand_ms;             ///< At each place, until it has its full radius.
  uint32_t stay_open_ms;          ///< How long it then stays open.
  uint32_t fade_ms;               ///< How long it then takes to close.
  uint32_t shape;                 ///< brume_hole_shape.
  uint32_t mask;                  ///< Number in the masks of the world; 0 unless the shape is a mask.
  uint32_t roll;                  ///< Clockwise as the shooter sees it [1/65536 turn], [0, 65535].
} brume_shot_event;

/// An explosion drives the smoke away from all that is visible from it.
typedef struct brume_blast_event {
  brume_position at;          ///< The centre.
  uint32_t radius;            ///< [1/1024 m], from 1 to 64 voxels.
  uint32_t speed;             ///< Of the front [1/1024 m/s], [1024, 2^24].
  uint32_t remaining;         ///< Density that remains, of 255, [0, 255].
  uint32_t refill_rim_ms;     ///< Until the rim is full again, [1, 2^30].
  uint32_t refill_middle_ms;  ///< Until the middle is, [refill_rim_ms, 2^30].
} brume_blast_event;

/// A player or object moves. Its first move places it.
typedef struct brume_move_event {
  uint32_t body;      ///< A number of the caller's choice.
  brume_position to;  ///< Its new position.
} brume_move_event;

/// The level changes: all voxels of the box [low, high) become wall or free of all roles. A door opens, a
/// wall breaks. The part of the box outside of the level is ignored; the box must have a voxel. In an edited
/// voxel, smoke ends at the voxel's faces.
typedef struct brume_edit_event {
  brume_voxel low, high;  ///< The box [low, high).
  uint32_t solid;         ///< 1: solid, 0: free.
} brume_edit_event;

/// An event of a world's log.
typedef struct brume_event {
  uint32_t struct_size;  ///< sizeof(brume_event), in every version: new kinds fit into `reserved`.
  const void* next;
  uint32_t kind;  ///< brume_event_kind: which member of the union counts.
  uint32_t tick;  ///< [0, BRUME_MAX_TICK].
  union {
    brume_smoke_event smoke;
    brume_shot_event shot;
    brume_blast_event blast;
    brume_move_event move;
    brume_edit_event edit;
    uint32_t reserved[32];
  } u;  ///< What the event holds, by its kind.
} brume_event;

/// An event of a kind (brume_event_kind) at a tick with the default settings of that kind and all positions
/// 0. The defaults of ticks are 1 s, 18 s and 3 s at 64 ticks per second.
static inline brume_event brume_event_defaults(uint32_t kind, uint32_t tick) {
  brume_event event = {sizeof(brume_event), BRUME_NULL, kind, tick, {{{0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0}}};
  for (int i = 0; i < 32; ++i) event.u.reserved[i] = 0;
  if (kind == BRUME_EVENT_SMOKE) {
    event.u.smoke.voxels = 1800;
    event.u.smoke.bloom_ticks = 64;
    event.u.smoke.hold_ticks = 1152;
    event.u.smoke.dissolve_ticks = 192;
  } else if (kind == BRUME_EVENT_SHOT) {
    event.u.shot.radius = 205;
    event.u.shot.reach_far_ms = 250;
    event.u.shot.expand_ms = 50;
    event.u.shot.stay_open_ms = 1000;
    event.u.shot.fade_ms = 350;
  } else if (kind == BRUME_EVENT_BLAST) {
    event.u.blast.radius = 5 * 1024;
    event.u.blast.speed = 32 * 1024;
    event.u.blast.remaining = 5;
    event.u.blast.refill_rim_ms = 500;
    event.u.blast.refill_middle_ms = 5000;
  }
  return event;
}

/// What a world is created with.
typedef struct brume_world_params {
  uint32_t struct_size;
  const void* next;
  uint32_t ticks_per_second;  ///< [1, 1000].
  const brume_masks* masks;   ///< For shots; null: none.
} brume_world_params;

static inline brume_world_params brume_world_defaults(void) {
  brume_world_params params = {sizeof(brume_world_params), BRUME_NULL, 64, BRUME_NULL};
  return params;
}

/// Creates a world at tick 0, without events. `params` may be null: the defaults.
BRUME_API brume_result brume_world_create(const brume_level* level, const brume_world_params* params,
                                          brume_world** world) BRUME_NOEXCEPT;
BRUME_API brume_result brume_world_destroy(brume_world* world) BRUME_NOEXCEPT;

/// Adds events to the log, all or none. Those at or before the present tick change the past: the world rolls
/// back once and replays to the present, with the same result as if they had come in time. Events of one tick
/// take effect in the order appended.
/// Errors: BRUME_ERROR_HISTORY for an event of a tick that brume_world_forget_before or brume_world_restore
/// has dropped.
BRUME_API brume_result brume_world_append(brume_world* world, const brume_event* events,
                                          size_t count) BRUME_NOEXCEPT;
/// Replaces all events at or after `tick` by others, each of that tick or later: a prediction is corrected.
/// Otherwise as brume_world_append.
BRUME_API brume_result brume_world_replace_from(brume_world* world, uint32_t tick, const brume_event* events,
                                                size_t count) BRUME_NOEXCEPT;

/// Moves to a tick, forwards or backwards. Costs time only for ticks at which something starts or ends.
/// Errors: BRUME_ERROR_HISTORY for a tick before brume_world_earliest_tick.
BRUME_API brume_result brume_world_advance_to(brume_world* world, uint32_t tick) BRUME_NOEXCEPT;
/// Moves to the next tick.
BRUME_API brume_result brume_world_step(brume_world* world) BRUME_NOEXCEPT;
/// Writes the present tick.
BRUME_API brume_result brume_world_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT;
/// Writes the earliest tick that the world can roll back to.
BRUME_API brume_result brume_world_earliest_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT;
/// Drops history before the last checkpoint at or before `tick`, which becomes the earliest tick; in a busy
/// match checkpoints are about 64 ticks apart. Cheap; to be called every tick, or memory grows with the
/// length of the match.
BRUME_API brume_result brume_world_forget_before(brume_world* world, uint32_t tick) BRUME_NOEXCEPT;
/// Writes the hash of the present state: equal states have equal hashes on every machine.
BRUME_API brume_result brume_world_hash(const brume_world* world, uint64_t* hash) BRUME_NOEXCEPT;

/// Creates a snapshot of the present state. Cheap: clouds are shared, not copied.
BRUME_API brume_result brume_world_state(const brume_world* world, brume_state** state) BRUME_NOEXCEPT;
/// Adopts a state of a world with the same layout, ticks per second and masks (else BRUME_ERROR_MISMATCH).
/// Events up to its tick are dropped from the log, later ones remain; its tick becomes the earliest one.
BRUME_API brume_result brume_world_restore(brume_world* world, const brume_state* state) BRUME_NOEXCEPT;

// ---- States: immutable snapshots ----

/// Counts and times of a state.
typedef struct brume_state_info {
  uint32_t tick;              ///< The tick of the state.
  uint32_t ticks_per_second;  ///< As of its world.
  uint32_t event_count;       ///< Events so far.
  uint32_t grenade_count;     ///< Grenades in the air.
  uint32_t cloud_count;       ///< Smokes.
  uint32_t blast_count;       ///< Cavities of explosions.
  uint32_t hole_count;        ///< Holes of shots.
  uint32_t body_count;        ///< Bodies.
} brume_state_info;

BRUME_API brume_result brume_state_destroy(brume_state* state) BRUME_NOEXCEPT;
/// Writes counts and times.
BRUME_API brume_result brume_state_describe(const brume_state* state, brume_state_info* info) BRUME_NOEXCEPT;
/// As brume_world_hash.
BRUME_API brume_result brume_state_hash(const brume_state* state, uint64_t* hash) BRUME_NOEXCEPT;
/// Writes the state as bytes, a keyframe of the wire format: a grown cloud takes a few hundred. Equal states
/// give equal bytes. The first call encodes, further ones copy.
BRUME_API brume_result brume_state_save(const brume_state* state, void* buffer, size_t capacity,
                                        size_t* size) BRUME_NOEXCEPT;
/// Creates a state from the bytes of brume_state_save, which need not be trusted: BRUME_ERROR_DATA when they
/// are damaged or describe a state that no world has. At most 16 MiB and 2^26 voxels.
BRUME_API brume_result brume_state_load(brume_context* context, const void* bytes, size_t size,
                                        brume_state** state) BRUME_NOEXCEPT;

/// A grenade in the air. An id is the number of the event that something comes from, the same on all
/// machines.
typedef struct brume_grenade {
  uint32_t id;                           ///< Its cloud will have the same.
  uint32_t throw_tick, detonation_tick;  ///< When its flight begins and ends.
  brume_voxel landing;                   ///< Where it detonates.
  brume_point position;                  ///< At the state's tick [m].
} brume_grenade;

/// A smoke.
typedef struct brume_cloud {
  uint32_t id;               ///< Number of its event.
  uint32_t detonation_tick;  ///< When it began to bloom.
  uint32_t end_tick;         ///< When the last of it is gone.
  brume_voxel source;        ///< Where it detonated.
  brume_voxel low, high;     ///< Around all voxels that it may fill at some tick, [low, high).
} brume_cloud;

/// The cavity of an explosion.
typedef struct brume_blast {
  uint32_t id;            ///< Number of its event.
  uint32_t tick;          ///< When it exploded.
  uint32_t end_tick;      ///< When it has refilled.
  brume_position centre;  ///< Where it exploded.
  uint32_t radius;        ///< [1/1024 m]
} brume_blast;

/// A hole of a shot.
typedef struct brume_hole {
  uint32_t id;                    ///< Number of its event.
  uint32_t tick;                  ///< Of the shot.
  brume_position origin, toward;  ///< Where the shot came from, and a point along it.
  uint32_t radius;                ///< [1/1024 m]
  uint32_t distance;              ///< Depth from the origin [1/1024 m].
  uint32_t shape;                 ///< brume_hole_shape.
  uint32_t mask, roll;            ///< As of brume_shot_event.
} brume_hole;

/// A body, and where it was before its last move.
typedef struct brume_body {
  uint32_t body;                      ///< The caller's number.
  uint32_t tick, previous_tick;       ///< When it moved, and the time before.
  brume_position position, previous;  ///< Its positions after these moves.
} brume_body;

/// Write what a state holds, by rising id (bodies: by rising number).
BRUME_API brume_result brume_state_grenades(const brume_state* state, brume_grenade* grenades,
                                            size_t capacity, size_t* count) BRUME_NOEXCEPT;
BRUME_API brume_result brume_state_clouds(const brume_state* state, brume_cloud* clouds, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;
BRUME_API brume_result brume_state_blasts(const brume_state* state, brume_blast* blasts, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;
BRUME_API brume_result brume_state_holes(const brume_state* state, brume_hole* holes, size_t capacity,
                                         size_t* count) BRUME_NOEXCEPT;
BRUME_API brume_result brume_state_bodies(const brume_state* state, brume_body* bodies, size_t capacity,
                                          size_t* count) BRUME_NOEXCEPT;

// ---- Packets ----

/// What a sender is created with.
typedef struct brume_sender_params {
  uint32_t struct_size;
  const void* next;
  uint32_t history;  ///< States retained for answers, [1, 65536]. 128 ticks: two seconds.
} brume_sender_params;

static inline brume_sender_params brume_sender_defaults(void) {
  brume_sender_params params = {sizeof(brume_sender_params), BRUME_NULL, 128};
  return params;
}

/// Creates the sending side: one packet per tick for all receivers, and answers to those that missed some.
/// `params` may be null: the defaults.
BRUME_API brume_result brume_sender_create(brume_context* context, const brume_sender_params* params,
                                           brume_sender** sender) BRUME_NOEXCEPT;
BRUME_API brume_result brume_sender_destroy(brume_sender* sender) BRUME_NOEXCEPT;
/// Takes the state of a tick, above the last one's (else BRUME_ERROR_ORDER) and of the same world (else
/// BRUME_ERROR_MISMATCH), and makes its packet: the difference from the last state, or all of the first one.
/// A state with fewer events than the last one starts a new world.
BRUME_API brume_result brume_sender_push(brume_sender* sender, const brume_state* state) BRUME_NOEXCEPT;
/// Writes the packet of the last state pushed, to be sent to every receiver. BRUME_ERROR_ORDER before that.
BRUME_API brume_result brume_sender_packet(const brume_sender* sender, void* buffer, size_t capacity,
                                           size_t* size) BRUME_NOEXCEPT;
/// Writes the answer to a receiver's request, to be sent to that receiver: 0 bytes when it is up to date. The
/// request need not be trusted: BRUME_ERROR_DATA when it is not one. BRUME_ERROR_ORDER before the first push.
BRUME_API brume_result brume_sender_answer(brume_sender* sender, const void* request, size_t request_size,
                                           void* buffer, size_t capacity, size_t* size) BRUME_NOEXCEPT;

/// Limits of a receiver.
typedef struct brume_receiver_params {
  uint32_t struct_size;
  const void* next;
  uint64_t max_bytes;   ///< Of one packet.
  uint64_t max_voxels;  ///< Of all smoke of one packet.
  uint64_t max_items;   ///< Of each list in a packet.
} brume_receiver_params;

static inline brume_receiver_params brume_receiver_defaults(void) {
  brume_receiver_params params = {sizeof(brume_receiver_params), BRUME_NULL, 16777216u, 67108864u, 1048576u};
  return params;
}

typedef enum brume_reception {
  BRUME_RECEPTION_APPLIED = 0,  ///< The receiver's state is now that of the packet.
  BRUME_RECEPTION_OLD = 1,      ///< Ignored: its state is of that tick or a later one.
  BRUME_RECEPTION_MISSED = 2  ///< Ignored: the state that the packet starts from is missing. Send a request.
} brume_reception;

/// Creates the receiving side, which requires neither level nor world. `params` may be null: the defaults,
/// which are also the largest values.
BRUME_API brume_result brume_receiver_create(brume_context* context, const brume_receiver_params* params,
                                             brume_receiver** receiver) BRUME_NOEXCEPT;
BRUME_API brume_result brume_receiver_destroy(brume_receiver* receiver) BRUME_NOEXCEPT;
/// Processes a packet or answer, in any order and with gaps, and writes what became of it. It need not be
/// trusted: BRUME_ERROR_DATA when it is damaged or gives another state than the sender's; the receiver's
/// state is then unchanged and brume_receiver_behind reports 1. `reception` may be null.
BRUME_API brume_result brume_receiver_receive(brume_receiver* receiver, const void* packet, size_t size,
                                              uint32_t* reception) BRUME_NOEXCEPT;
/// Writes 1 when a state is known to be missing, else 0: send a request every few ticks until it is 0, and
/// also when no packet has arrived for a while.
BRUME_API brume_result brume_receiver_behind(const brume_receiver* receiver, uint32_t* behind) BRUME_NOEXCEPT;
/// Writes a request for the sender, at most 16 bytes.
BRUME_API brume_result brume_receiver_request(const brume_receiver* receiver, void* buffer, size_t capacity,
                                              size_t* size) BRUME_NOEXCEPT;
/// Creates a snapshot of the newest state, equal bit for bit to the sender's of that tick. BRUME_ERROR_ORDER
/// when none has been received.
BRUME_API brume_result brume_receiver_state(const brume_receiver* receiver,
                                            brume_state** state) BRUME_NOEXCEPT;
/// Drops all states: a new match starts.
BRUME_API brume_result brume_receiver_reset(brume_receiver* receiver) BRUME_NOEXCEPT;

// ---- The density field and the line of sight ----

/// Most elements of one array of queries.
#define BRUME_MAX_QUERIES 268435456u

/// What a field is created with.
typedef struct brume_field_params {
  uint32_t struct_size;
  const void* next;
  float extinction;          ///< Of the densest smoke [1/m], [0, 10^6].
  const brume_masks* masks;  ///< Those of the worlds whose states it shows; null: none.
} brume_field_params;

static inline brume_field_params brume_field_defaults(void) {
  brume_field_params params = {sizeof(brume_field_params), BRUME_NULL, 3.0f, BRUME_NULL};
  return params;
}

/// A line from a to b. Coordinates must be finite and within +-16384 m; they may lie outside of the level,
/// where there is air.
typedef struct brume_segment {
  brume_point a, b;  ///< An end [m].
} brume_segment;

/// The first voxel of a wall along a segment. Glass and grilles are none.
typedef struct brume_wall {
  uint32_t hit;        ///< 1; 0: there is none, and all other members are 0.
  brume_voxel voxel;   ///< The voxel.
  brume_voxel normal;  ///< Outward normal of the face that the segment enters: a unit vector.
  float distance;      ///< From a to that face [m].
} brume_wall;

/// Creates the density field of a level, without smoke. It keeps what a state's queries require: worlds may
/// advance while others query the field. `params` may be null: the defaults.
BRUME_API brume_result brume_field_create(const brume_level* level, const brume_field_params* params,
                                          brume_field** field) BRUME_NOEXCEPT;
BRUME_API brume_result brume_field_destroy(brume_field* field) BRUME_NOEXCEPT;
/// Takes over a state, with its holes and level edits. Only what changed since the last update costs time.
/// Errors: BRUME_ERROR_MISMATCH for a state of another level layout or with other masks; BRUME_ERROR_LIMIT
/// when the smoke fills more than 2^22 bricks of 8^3 voxels.
BRUME_API brume_result brume_field_update(brume_field* field, const brume_state* state) BRUME_NOEXCEPT;

/// Writes the bricks (8^3 voxels, voxel / 8) in which the last update may have changed densities, by rising
/// z, then y, then x: what a copy of the densities has to read again.
BRUME_API brume_result brume_field_changed_bricks(const brume_field* field, brume_voxel* bricks,
                                                  size_t capacity, size_t* count) BRUME_NOEXCEPT;

/// Writes the optical depth of the smoke along each segment, holes included; walls do not count. exp(-depth)
/// of the light passes. The same bits on every machine, for any number of threads, for one segment or many.
BRUME_API brume_result brume_field_optical_depths(const brume_field* field, const brume_segment* segments,
                                                  size_t count, float* depths) BRUME_NOEXCEPT;
/// Writes 1 for each segment whose ends see each other, else 0: no wall between the voxels of a and b, where
/// glass and grilles are none, and an optical depth of at most `threshold` (at least 0; infinity: walls
/// only). Faster than the depth: it ends at the first obstacle.
BRUME_API brume_result brume_field_visible(const brume_field* field, const brume_segment* segments,
                                           size_t count, float threshold, uint8_t* visible) BRUME_NOEXCEPT;
/// How noise erodes smoke in the picture: brume_smoke_look of brume_vulkan.h has the same members.
typedef struct brume_drawn_params {
  uint32_t struct_size;
  const void* next;
  float erosion;     ///< How much noise erodes, [0, 1].
  float noise_size;  ///< Of its largest billows [m], [0.05, 100].
  float detail;      ///< Weight of what is finer than a tenth of that, [0, 1].
  float hole_rim;    ///< How far noise frays the rims of holes [m], [0, 1].
  float swirl;       ///< How far noise swirls [m], [0, 10].
  float rise;        ///< How fast noise rises [m/s], [-10, 10].
} brume_drawn_params;

static inline brume_drawn_params brume_drawn_defaults(void) {
  brume_drawn_params params = {sizeof(brume_drawn_params), BRUME_NULL, 0.5f, 1.5f, 1.0f, 0.06f, 0.2f, 0.12f};
  return params;
}

/// As brume_field_optical_depths, of the smoke as a renderer draws it at the state's tick: eroded by noise,
/// with frayed rims. The same bits on every machine; some hundred times as slow. The first query of a
/// process makes the noise, in a second of processor time; the first after an update, or with other `params`,
/// takes some milliseconds more. `params` may be null: the defaults.
BRUME_API brume_result brume_field_drawn_depths(const brume_field* field, const brume_drawn_params* params,
                                                const brume_segment* segments, size_t count,
                                                float* depths) BRUME_NOEXCEPT;
/// As brume_field_visible, likewise: whether a player sees through a rim, not only whether the smoke lets
/// them.
BRUME_API brume_result brume_field_drawn_visible(const brume_field* field, const brume_drawn_params* params,
                                                 const brume_segment* segments, size_t count, float threshold,
                                                 uint8_t* visible) BRUME_NOEXCEPT;
/// Writes the first voxel of a wall along each segment, other than those that a and b lie in.
BRUME_API brume_result brume_field_first_walls(const brume_field* field, const brume_segment* segments,
                                               size_t count, brume_wall* walls) BRUME_NOEXCEPT;
/// Writes the density of each voxel of the box [low, high), [0, 255], x fastest, then y, then z. Blasts
/// count, holes do not; 0 in solid voxels. The box must lie in the level and have a voxel; `count` is the
/// number of its voxels.
BRUME_API brume_result brume_field_densities(const brume_field* field, brume_voxel low, brume_voxel high,
                                             uint8_t* densities, size_t count) BRUME_NOEXCEPT;

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_H
