// The events of a timeline, one struct per kind. Fields, units and ranges: scene/event_fields.hpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace brume::scene {

/// Largest distance of an event from the world's origin, along each axis [m].
constexpr double kFarthestEvent = 16384;

/// A grenade is thrown: it flies in a straight line at 20 m/s and detonates at its target.
struct SmokeEvent {
  double time = 0;  ///< When it is thrown [s], [0, 3600].
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
  double time = 0;   ///< When the first letter is shot [s], [0, 3600].
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
  std::string place = {};  ///< Where the file names the object, for messages.
};

/// The events of a timeline, each list sorted by time; events of the same time in file order. A new kind of
/// event needs a line in for_each_event_kind.
struct EventLists {
  std::vector<SmokeEvent> smokes;
  std::vector<ShotEvent> shots;
  std::vector<TextEvent> texts;
  std::vector<BlastEvent> blasts;
  std::vector<MoveEvent> moves;
  std::vector<EditEvent> edits;
  std::vector<DoorEvent> doors;
};

/// Calls visit(type, member) for each kind of event: its `type` in timeline files, and a pointer to its list.
/// The one place that enumerates the kinds.
template <typename Visitor>
constexpr void for_each_event_kind(Visitor&& visit) {
  visit("smoke", &EventLists::smokes);
  visit("shot", &EventLists::shots);
  visit("text", &EventLists::texts);
  visit("blast", &EventLists::blasts);
  visit("move", &EventLists::moves);
  visit("edit", &EventLists::edits);
  visit("door", &EventLists::doors);
}

/// Calls visit(type, list) for each list of events of a timeline; a const timeline gives const lists.
template <typename AnyTimeline, typename Visitor>
void for_each_event_list(AnyTimeline& timeline, Visitor&& visit) {
  for_each_event_kind([&](const char* type, auto member) { visit(type, timeline.*member); });
}

}  // namespace brume::scene
