// A timeline: a scene, a camera path and timed events. Rendering it twice gives identical images.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "scene/transfer.hpp"

namespace brume::scene {

// Units, ranges and meanings: of settings scene/options.hpp, of events scene/event_fields.hpp.

/// Placement of the voxel grid. Without size and origin the grid covers the scene's bounds and its smokes.
struct GridOptions {
  float voxel = 0.25f;
  std::optional<glm::ivec3> size;
  std::optional<glm::vec3> origin_world;
};

struct SmokeOptions {
  std::uint32_t voxels = 1800;
  float bloom = 1.0f;
  float hold = 18.0f;
  float dissolve = 3.0f;
  float extinction = 3.0f;
  glm::vec3 albedo{0.92f};
  float anisotropy = 0.2f;
  std::optional<float> droplet;  ///< Overrides anisotropy when set.
  float multiple_scattering = 1;
  float erosion = 0.5f;
  float noise_size = 1.5f;
  float detail = 1;
  float hole_rim = 0.06f;
  float swirl = 0.2f;
  float swirl_period = 12.0f;
  float rise = 0.12f;
  bool operator==(const SmokeOptions&) const = default;
};

/// Linear radiance of the sky where no surface covers it, and of the ambient light.
struct SkyOptions {
  glm::vec3 zenith{0.20f, 0.36f, 0.70f};
  glm::vec3 horizon{0.55f, 0.65f, 0.78f};
  glm::vec3 ambient{0.25f, 0.29f, 0.35f};
  float stars = 0;
  float bounce = 0.2f;
};

/// The one sun of a scene, in the place of its own.
struct SunOptions {
  float azimuth = 0.87266463f;    ///< 50 degrees.
  float elevation = 0.87266463f;  ///< 50 degrees.
  glm::vec3 irradiance{2.6f, 2.4f, 2.1f};
};

/// Where a carrier is at one time.
struct CarrierKey {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 position_world{0};
  glm::vec3 rotation{0};  ///< About x, then y, then z [degrees]; may exceed a turn.
};

/// What volumes and decals move with, and objects of the scene: a drone, an engine.
struct Carrier {
  std::string name;
  /// Objects of the scene that move with it: the place and rotation of the first of this name are replaced by
  /// those of the carrier, and the others stay where they are beside it. Empty: none.
  std::string object = {};
  std::vector<CarrierKey> keys;  ///< At least one, sorted by time, no two times equal.
  std::string place = {};        ///< "file:line:column" for error messages.
};

/// Where a carrier is at a time [s], as a key of that time: passes through all keys with continuous velocity,
/// at rest before the first and after the last.
CarrierKey key_at(const Carrier& carrier, double time);

/// world_from_carrier of key_at.
glm::mat4 pose_at(const Carrier& carrier, double time);

/// Rotation about x, then y, then z [degrees].
glm::mat4 rotation_of(const glm::vec3& degrees);

/// The colour of a mask at one time.
struct MaskKey {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 color{1};
  float intensity = 1;
};

/// A grid of a volume that glows in one colour: where its value is 1, color * intensity leaves each metre.
struct VolumeMask {
  std::string grid;
  glm::vec3 color{1};
  float intensity = 1;
  std::vector<MaskKey> keys;  ///< Replace both; sorted by time, no two times equal. Linear in between.
};
inline constexpr std::size_t kMostMasks = 4;
/// Extinction of a volume with masks whose file states none: what only glows blocks no light.
inline constexpr float kMaskedExtinction = 0;

/// Radiance per metre of a mask at a time.
glm::vec3 glow_at(const VolumeMask& mask, double time);

/// Noise that moves the places at which a volume is sampled.
struct Disturbance {
  float strength = 0;  ///< Largest displacement along each axis, in units of the file; 0: none.
  float size = 0.1f;   ///< Of the noise's largest features, likewise.
  glm::vec3 drift{0};  ///< How fast the noise moves, likewise [1/s].
  float grow = 0;      ///< Length along `drift` over which the strength grows from 0; 0: it is everywhere.
  bool operator==(const Disturbance&) const = default;
};

/// Noise below the voxels of a volume, which wears away its thin parts.
struct VolumeDetail {
  float strength = 0;  ///< 0: none; 1: only what is as dense as the densest stays.
  float size = 0;      ///< Of its largest billows, in units of the file; 0: four voxels.
  glm::vec3 drift{0};  ///< How fast it moves, likewise [1/s].
  bool operator==(const VolumeDetail&) const = default;
};

/// A decal of baked occlusion (brume bake occlusion): darkens the surfaces in its box.
struct DecalOptions {
  std::filesystem::path file;  ///< A volume, resolved.
  std::string grid = {};  ///< Of the occlusion; empty: up and down if there are such grids, else the first.
  std::string carrier = {};     ///< Empty: the world.
  glm::vec3 position_world{0};  ///< In the carrier's space if there is one.
  glm::vec3 rotation{0};        ///< About x, then y, then z [degrees].
  float scale = 1;
  float strength = 1;
  float gamma = 1;
  float correction = 1;
  float falloff = 1;
  float fade = 0.05f;
  float scatter = 0.5f;
  std::string place = {};  ///< "file:line:column" for error messages.
};
/// Decals of a timeline at most: a frame shows as many.
inline constexpr std::size_t kMostDecals = 32;

/// Volumes of a timeline at most: a frame shows as many.
inline constexpr std::size_t kMostVolumes = 32;

/// A volume of a file of grids (grids/files.hpp), placed in the world: its axes replaced, scaled, rotated
/// about x, then y, then z, moved.
struct VolumeOptions {
  /// Resolved. A sequence has the number of a frame as %d or %04d.
  std::filesystem::path file;
  std::optional<std::uint32_t> first = {}, last = {};  ///< Frames of a sequence; empty: those of its files.
  bool clip = false, ping_pong = false;                ///< Not together, nor with `loop`.
  glm::vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
  std::string density = {};  ///< Name of the grid of densities; empty: the first of the usual names.
  std::string heat = {};     ///< Of the grid that glows; empty: the first of the usual names, or none.
  std::string color = {};    ///< Of the grid of colours that multiply the albedo; the same.
  glm::vec3 position_world{0};
  glm::vec3 rotation{0};  ///< About x, y and z [degrees].
  float scale = 1;
  float extinction = 1;
  glm::vec3 albedo{0.9f};
  float anisotropy = 0.2f;
  float multiple_scattering = 1;
  float emission = 1;
  float kelvin = 1000;
  float frame_rate = 24;
  float start = 0;
  bool loop = false;
  // Transfer functions of the density's values.
  std::optional<glm::vec2> range = {};     ///< Values that they span; empty: those of the first frame.
  std::vector<OpacityPoint> opacity = {};  ///< Replaces the value as factor of the extinction.
  ColorMap color_map = {};                 ///< Replaces the albedo.
  float glow = 0;
  std::string carrier = {};            ///< What it moves with; empty: the world.
  std::vector<VolumeMask> masks = {};  ///< At most kMostMasks.
  Disturbance disturbance = {};
  VolumeDetail detail = {};
  std::uint32_t particles = 0;  ///< Quads that show its masks instead of a march; 0: none.
  float particle_size = 0.6f;
  std::string place = {};  ///< "file:line:column" for error messages.
};

/// The role of all objects of a name, in the place of what the scene's file gives them.
struct RoleOptions {
  std::string object;
  Role role = Role::wall;
  std::string place = {};  ///< "file:line:column" for error messages.
};

struct CameraKey {
  double time = 0;  ///< [s], [0, 3600].
  Camera camera;
  std::string place = {};  ///< Of the lens's opening in the file, for messages.
};

/// Largest number of a frame of a sequence.
constexpr std::uint32_t kLastFrame = 1'000'000'000;

/// Largest distance of an event from the world's origin, along each axis [m].
constexpr double kFarthestEvent = 16384;

/// A grenade is thrown: it flies in a straight line at 20 m/s and detonates at its target.
struct SmokeEvent {
  double time = 0;  ///< Of the throw [s], [0, 3600].
  glm::vec3 from_world{0}, at_world{0};
  std::string place = {};  ///< "file:line:column" for error messages, as in all events.
};

/// How a hole opens and closes [s].
struct HoleTimes {
  float reach = 0.25f;
  float expand = 0.05f;
  float stay = 0.6f;
  float fade = 0.35f;
};

enum class ShotShape { cylinder, box, mask };

/// A shot and the hole it leaves in smoke.
struct ShotEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< A point that the shot passes through; not `from_world`.
  float radius = 0.25f;
  HoleTimes times = {};
  ShotShape shape = ShotShape::cylinder;
  std::filesystem::path mask = {};  ///< Image of the cross-section, resolved; only for ShotShape::mask.
  float roll = 0;                   ///< [-2 pi, 2 pi]
  std::string place = {};
  float flash = 25.0f;
};

/// Longest text of a TextEvent.
constexpr std::size_t kMaxTextBytes = 1024;

/// Shoots a line of text through the smoke: one hole per letter, parallel and side by side, legible from the
/// shooter's position.
struct TextEvent {
  double time = 0;   ///< Of the first letter [s], [0, 3600].
  std::string text;  ///< One line, UTF-8, 1 to 1024 bytes.
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< A point on the path of the row's middle; not `from_world`.
  float size = 0.5f;
  std::filesystem::path font = {};  ///< Resolved path; empty: image::default_font().
  float spacing = 0;
  float interval = 0;
  HoleTimes times = {};
  float roll = 0;  ///< [-2 pi, 2 pi]; rotates the whole row.
  std::string place = {};
};

/// An explosion opens a cavity in the surrounding smoke, which then refills.
struct BlastEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 at_world{0};
  float radius = 5.0f;
  float speed = 32.0f;
  float remaining = 0.02f;
  float refill_rim = 0.5f;
  float refill_middle = 5.0f;  ///< [refill_rim, 60]
  std::string place = {};
  float flash = 250.0f;
};

/// A body moves to a position; its first move places it.
struct MoveEvent {
  double time = 0;   ///< [s], [0, 3600].
  std::string body;  ///< Name of the body: any text.
  glm::vec3 to_world{0};
  std::string place = {};
};

/// The voxels with centres inside a box become solid or free.
struct EditEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 low_world{0}, high_world{1};
  bool solid = true;
};

/// A door opens, which hides its objects, or closes, which shows them again.
struct DoorEvent {
  double time = 0;     ///< [s], [0, 3600].
  std::string object;  ///< Name of the scene objects that make up the door.
  bool open = true;
  std::string place = {};  ///< Of the object's name.
};

/// How radiance becomes display values.
enum class ToneCurve : std::uint32_t {
  neutral,   ///< Khronos PBR Neutral: compresses highlights.
  standard,  ///< None: clipped at 1, as Blender's "Standard".
};

struct Timeline {
  std::filesystem::path scene;  ///< Resolved against the timeline's own folder.
  float duration = 4.0f;
  float exposure = 0.0f;
  std::uint32_t bounces = 0;
  ToneCurve tone = ToneCurve::neutral;
  glm::vec3 origin{0};
  float scale = 1;
  std::optional<float> ground;
  GridOptions grid;
  SmokeOptions smoke;
  SkyOptions sky;
  std::optional<SunOptions> sun;
  std::vector<Carrier> carriers;
  std::vector<VolumeOptions> volumes;
  std::vector<DecalOptions> decals;
  std::vector<RoleOptions> roles;
  std::vector<CameraKey> camera;  ///< Sorted by time, no two times equal.
  // Events, each list sorted by time; events of the same time in file order. A new kind of event needs a line
  // in for_each_event_kind.
  std::vector<SmokeEvent> smokes;
  std::vector<ShotEvent> shots;
  std::vector<TextEvent> texts;
  std::vector<BlastEvent> blasts;
  std::vector<MoveEvent> moves;
  std::vector<EditEvent> edits;
  std::vector<DoorEvent> doors;
};

/// Calls visit(type, member) for each kind of event: its `type` in timeline files, and a pointer to its list
/// in Timeline. The one place that enumerates the kinds.
template <typename Visitor>
void for_each_event_kind(Visitor&& visit) {
  visit("smoke", &Timeline::smokes);
  visit("shot", &Timeline::shots);
  visit("text", &Timeline::texts);
  visit("blast", &Timeline::blasts);
  visit("move", &Timeline::moves);
  visit("edit", &Timeline::edits);
  visit("door", &Timeline::doors);
}

/// Calls visit(type, list) for each list of events of a timeline; a const timeline gives const lists.
template <typename AnyTimeline, typename Visitor>
void for_each_event_list(AnyTimeline& timeline, Visitor&& visit) {
  for_each_event_kind([&](const char* type, auto member) { visit(type, timeline.*member); });
}

/// Sorts each list of events by time. Stable: events of the same time keep their order.
void sort_events(Timeline& timeline);

/// Reads a timeline: TOML with `version = 1`, `scene`, `duration`, `exposure`, `tone`, `origin`, `scale`,
/// `ground`, the tables [grid] (voxel, size, origin), [smoke], [sky] and [sun] with the members above as
/// keys, [[volume]] (file, first, last, density, heat, color, position, clip, ping_pong, loop, range,
/// opacity, color_map, carrier, [[volume.mask]], [volume.disturb], [volume.detail], particles and its
/// members), [[carrier]] (name, object, [[carrier.key]]), [[decal]], [[role]] (object, role), and [[camera]]
/// (time, position, target, fov in degrees, [1, 170]) in order of time, [[event]] with type, time and the
/// fields of its type (scene/event_fields.hpp). Points are in metres, [-10^6, 10^6]; those of events [-16384,
/// 16384]. check_objects checks whether the objects of doors, roles and carriers exist. Fails with bad_input
/// and file:line:column for malformed TOML, an unknown key (suggesting what was probably meant), and a value
/// of the wrong type or out of range.
Result<Timeline> load_timeline(const std::filesystem::path& path);

/// The same from text; `path` names it in messages and is the base of its relative paths.
Result<Timeline> parse_timeline(std::string_view text, const std::filesystem::path& path);

/// Fails with bad_input at the first door, role or carrier whose object is missing from the scene, suggesting
/// what was probably meant.
Result<void> check_objects(const Timeline& timeline, const Scene& scene);

/// The pose of a carrier by its name at a time; the identity without one.
glm::mat4 pose_of(std::span<const Carrier> carriers, const std::string& name, double time);

/// The camera at a time [s]: passes through all keys with continuous velocity, at rest before the first and
/// after the last; `fallback` when there are no keys. The field of view stays within that of the two
/// neighbouring keys.
Camera camera_at(const std::vector<CameraKey>& keys, const Camera& fallback, double time);
inline Camera camera_at(const Timeline& timeline, const Camera& fallback, double time) {
  return camera_at(timeline.camera, fallback, time);
}

}  // namespace brume::scene
