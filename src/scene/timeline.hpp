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

/// Where the voxels are. Without size and origin the grid covers the scene's bounds.
struct GridOptions {
  float voxel = 0.25f;                    ///< Edge of a voxel [m], [1/64, 10].
  std::optional<glm::ivec3> size;         ///< Voxels per axis, [1, 4096].
  std::optional<glm::vec3> origin_world;  ///< The grid's low corner [m].
};

struct SmokeOptions {
  std::uint32_t voxels = 1800;    ///< How many voxels a grown smoke fills, [1, 16777216].
  float bloom = 1.0f;             ///< From going off to full size [s], [0.05, 60].
  float hold = 18.0f;             ///< From there until it begins to dissolve [s], [0, 3600].
  float dissolve = 3.0f;          ///< From there until nothing is left [s], [0.05, 60].
  float extinction = 3.0f;        ///< In dense smoke [1/m], [0.01, 100].
  glm::vec3 albedo{0.92f};        ///< Share of light that is scattered, per channel, [0, 1].
  float anisotropy = 0.2f;        ///< Henyey-Greenstein's g, [-0.9, 0.9]; above 0: forward.
  std::optional<float> droplet;   ///< Instead of anisotropy: diameter of its droplets [um], [0.1, 50].
  float multiple_scattering = 1;  ///< Share of the light scattered more than once, [0, 1].
  float noise = 0.5f;             ///< How deep the noise cuts into the density, [0, 1].
  float noise_size = 1.5f;        ///< Edge of a noise cell [m], [0.05, 100].
  float rim = 0.06f;              ///< How far noise moves the rims of holes at most [m], [0, 10].
  float swirl = 0.2f;             ///< How far the noise rolls around its place [m], [0, 10].
  float swirl_time = 12.0f;       ///< How long one roll takes [s], [0.1, 3600].
  float rise = 0.12f;             ///< How fast the noise rises [m/s], [-10, 10].
};

/// Linear radiance of what no surface covers, and of the light from everywhere, [0, 1000].
struct SkyOptions {
  glm::vec3 zenith{0.20f, 0.36f, 0.70f};
  glm::vec3 horizon{0.55f, 0.65f, 0.78f};
  glm::vec3 ambient{0.25f, 0.29f, 0.35f};
  float stars = 0;      ///< Radiance of the brightest star, [0, 1000].
  float bounce = 0.2f;  ///< Share of ambient that comes to where no sky is seen, [0, 1].
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
  float reach = 0.25f;   ///< Until the front is at the far end [s], [0, 60].
  float expand = 0.05f;  ///< Growing at each depth [s], [0, 60].
  float stay = 0.6f;     ///< Open [s], [0, 600].
  float fade = 0.35f;    ///< Closing [s], [0, 60].
};

enum class ShotShape { cylinder, box, mask };

/// A shot, and the hole that it leaves in smoke.
struct ShotEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< A point that the shot passes through; not `from_world`.
  float radius = 0.25f;              ///< Of the hole, half the edge of a box or mask [m], [0.01, 10].
  HoleTimes times = {};
  ShotShape shape = ShotShape::cylinder;
  std::filesystem::path mask = {};  ///< Picture of the cross-section, ready to open; for masks.
  float roll = 0;                   ///< Turns a box or mask clockwise as the shooter sees it, [-2 pi, 2 pi].
  std::string place = {};
  float flash = 25.0f;  ///< Intensity of the muzzle's light [W/sr], [0, 10^6].
};

/// A row of letters is shot through the smoke, each a hole: parallel shots, side by side, that read from
/// where they are fired.
struct TextEvent {
  double time = 0;   ///< Of the first letter [s], [0, 3600].
  std::string text;  ///< One line, UTF-8, 1 to 1024 bytes.
  glm::vec3 from_world{0};
  glm::vec3 toward_world{0, 0, -1};  ///< Where the middle of the row passes; not `from_world`.
  float size = 0.5f;                 ///< Height of capital letters [m], [0.02, 10].
  std::filesystem::path font = {};   ///< Ready to open; empty: image::default_font().
  float spacing = 0;                 ///< More room between letters [cap heights], [-0.5, 10].
  float interval = 0;                ///< From letter to letter [s], [0, 10].
  HoleTimes times = {};
  float roll = 0;  ///< As that of a shot; the row turns with its letters.
  std::string place = {};
};

/// An explosion opens a cavity in the smoke around it, which then fills again.
struct BlastEvent {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 at_world{0};
  float radius = 5.0f;         ///< [m], [0.1, 100].
  float speed = 32.0f;         ///< Of the front [m/s], [1, 10000].
  float left = 0.02f;          ///< Share of the density that stays, [0, 1].
  float refill_rim = 0.5f;     ///< Until the rim is full again [s], [0.01, 60].
  float refill_middle = 5.0f;  ///< Until the middle is [s], [refill_rim, 60].
  std::string place = {};
  float flash = 250.0f;  ///< Intensity of its light [W/sr], [0, 10^6].
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
  float duration = 4.0f;        ///< [s], [0.01, 3600].
  float exposure = 0.0f;        ///< [EV], [-20, 20]: the picture is multiplied by 2^exposure.
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

/// Reads a timeline: TOML with `version = 1`, `scene`, `duration`, `exposure`, the tables [grid] (voxel,
/// size, origin), [smoke] and [sky] with the members above as keys, and [[camera]] (time, position, target,
/// fov in degrees, [1, 170]) in order of time, [[event]] with type = "smoke" (time, from, at), "shot" (time,
/// from, toward, radius, reach, expand, stay, fade, shape, mask, roll in degrees, flash), "text" (time, text,
/// from, toward, size, font, spacing, interval, reach, expand, stay, fade, roll), "blast" (time, at, radius,
/// speed, left, refill_rim, refill_middle, flash), "move" (time, body, to), "edit" (time, low, high, solid)
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
