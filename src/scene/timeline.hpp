// A timeline: which scene, where the camera is, what happens when. Renders the same twice.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

// Units, ranges and meanings of all settings: scene/options.hpp.

/// Where the voxels are. Without size and origin the grid covers the scene's bounds.
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
  std::optional<float> droplet;  ///< Where it is, anisotropy does not count.
  float multiple_scattering = 1;
  float erosion = 0.5f;
  float noise_size = 1.5f;
  float hole_rim = 0.06f;
  float swirl = 0.2f;
  float swirl_period = 12.0f;
  float rise = 0.12f;
  bool operator==(const SmokeOptions&) const = default;
};

/// Linear radiance of what no surface covers, and of the light from everywhere.
struct SkyOptions {
  glm::vec3 zenith{0.20f, 0.36f, 0.70f};
  glm::vec3 horizon{0.55f, 0.65f, 0.78f};
  glm::vec3 ambient{0.25f, 0.29f, 0.35f};
  float stars = 0;
  float bounce = 0.2f;
};

struct CameraKey {
  double time = 0;  ///< [s], [0, 3600].
  Camera camera;
};

/// How far from the origin of the world something may happen, along each axis [m].
constexpr double kFarthestEvent = 16384;

/// A grenade is thrown; it flies straight at 20 m/s and goes off at its target.
struct SmokeEvent {
  double time = 0;  ///< Of throwing [s], [0, 3600].
  glm::vec3 from_world{0}, at_world{0};
  std::string place = {};  ///< "file:line:column", for messages; so in all events.
};

/// How a hole opens and closes.
struct HoleTimes {
  float reach = 0.25f;
  float expand = 0.05f;
  float stay = 0.6f;
  float fade = 0.35f;
};

enum class ShotShape { cylinder, box, mask };

/// A shot, and the hole that it leaves in smoke.
struct ShotEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< A point that the shot passes through; not `from_world`.
  float radius = 0.25f;
  HoleTimes times = {};
  ShotShape shape = ShotShape::cylinder;
  std::filesystem::path mask = {};  ///< Picture of the cross-section, ready to open; for masks.
  float roll = 0;                   ///< [-2 pi, 2 pi]
  std::string place = {};
  float flash = 25.0f;
};

/// Longest text of a TextEvent.
constexpr std::size_t kMaxTextBytes = 1024;

/// A row of letters is shot through the smoke, each a hole: parallel shots, side by side, that read from
/// where they are fired.
struct TextEvent {
  double time = 0;   ///< Of the first letter [s], [0, 3600].
  std::string text;  ///< One line, UTF-8, 1 to 1024 bytes.
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< Where the middle of the row passes; not `from_world`.
  float size = 0.5f;
  std::filesystem::path font = {};  ///< Ready to open; empty: image::default_font().
  float spacing = 0;
  float interval = 0;
  HoleTimes times = {};
  float roll = 0;  ///< [-2 pi, 2 pi]; the row turns with its letters.
  std::string place = {};
};

/// An explosion opens a cavity in the smoke around it, which then fills again.
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

/// A body is at a place now; its first move puts it there.
struct MoveEvent {
  double time = 0;   ///< [s], [0, 3600].
  std::string body;  ///< Its name: any text.
  glm::vec3 to_world{0};
  std::string place = {};
};

/// The voxels whose centres lie in a box become solid or free.
struct EditEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 low_world{0}, high_world{1};
  bool solid = true;
};

/// A door opens, which takes its objects out of the scene, or shuts, which puts them back.
struct DoorEvent {
  double time = 0;     ///< [s], [0, 3600].
  std::string object;  ///< Name of the scene's objects that are the door.
  bool open = true;
  std::string place = {};  ///< Of the name.
};

struct Timeline {
  std::filesystem::path scene;  ///< Ready to open: what the file says, from the timeline's own folder.
  float duration = 4.0f;
  float exposure = 0.0f;
  GridOptions grid;
  SmokeOptions smoke;
  SkyOptions sky;
  std::vector<CameraKey> camera;   ///< By time, no two alike.
  std::vector<SmokeEvent> smokes;  ///< By time; those of the same time as in the file.
  std::vector<ShotEvent> shots;    ///< The same, and so for all kinds of events.
  std::vector<TextEvent> texts;
  std::vector<BlastEvent> blasts;
  std::vector<MoveEvent> moves;
  std::vector<EditEvent> edits;
  std::vector<DoorEvent> doors;
};

/// Puts the events of each list in order of time; those of the same time stay as they stood.
void sort_events(Timeline& timeline);

/// Reads a timeline: TOML with `version = 1`, `scene`, `duration`, `exposure`, the tables [grid] (voxel,
/// size, origin), [smoke] and [sky] with the members above as keys, and [[camera]] (time, position, target,
/// fov in degrees, [1, 170]) in order of time, [[event]] with type = "smoke" (time, from, at), "shot" (time,
/// from, toward, radius, reach, expand, stay, fade, shape, mask, roll in degrees, flash), "text" (time, text,
/// from, toward, size, font, spacing, interval, reach, expand, stay, fade, roll), "blast" (time, at, radius,
/// speed, remaining, refill_rim, refill_middle, flash), "move" (time, body, to), "edit" (time, low, high, solid)
/// or "door" (time, object, open). Points in metres, [-10^6, 10^6]; those of events [-16384, 16384]. Whether
/// a door's object exists, is seen by check_doors. Fails with bad_input and file:line:column for broken TOML,
/// a key that is not known (naming the nearest that is), a value of the wrong type or out of its range.
Result<Timeline> load_timeline(const std::filesystem::path& path);

/// The same from text; `path` is what messages call it and what its scene is relative to.
Result<Timeline> parse_timeline(std::string_view text, const std::filesystem::path& path);

/// Fails with bad_input at the first door whose object the scene does not have, naming the nearest that it
/// has.
Result<void> check_doors(const Timeline& timeline, const Scene& scene);

/// The timeline of a scene file without one: a smoke thrown from the camera to what it looks at.
Timeline timeline_for_scene(const std::filesystem::path& path, const Scene& scene);

/// The camera at a time [s]: through all keys, with continuous speed, at rest before the first and after the
/// last; `fallback` where there is no key. The field of view never leaves the range of its two keys.
Camera camera_at(const Timeline& timeline, const Camera& fallback, double time);

}  // namespace brume::scene
