#include "scenario/doors.hpp"

#include <algorithm>

#include "scenario/ticks.hpp"
#include "scenario/world_triangles.hpp"

namespace brume::scenario {
namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

/// Whether a name contains a word, given in lower case, in any case and as a word of its own.
bool has_word(std::string_view name, std::string_view word) {
  const auto same = [](char a, char b) { return (is_upper(a) ? a - 'A' + 'a' : a) == b; };
  for (auto at = name.begin();; ++at) {
    at = std::search(at, name.end(), word.begin(), word.end(), same);
    if (at == name.end()) return false;
    const auto end = at + static_cast<std::ptrdiff_t>(word.size());
    const bool begins =
        at == name.begin() || (!is_lower(at[-1]) && !is_upper(at[-1])) || (is_lower(at[-1]) && is_upper(*at));
    const bool ends =
        end == name.end() || (!is_lower(*end) && !is_upper(*end)) || (is_lower(end[-1]) && is_upper(*end));
    if (begins && ends) return true;
  }
}

}  // namespace

bool is_door_name(std::string_view name) {
  return has_word(name, "door") && !has_word(name, "frame");
}

std::vector<Door> doors_of(const scene::Scene& scene) {
  std::vector<Door> doors;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    if (!is_door_name(object.name)) continue;
    auto door =
        std::find_if(doors.begin(), doors.end(), [&](const Door& d) { return d.name == object.name; });
    if (door == doors.end()) door = doors.insert(doors.end(), {object.name, {}, {}});
    door->objects.push_back(i);
    for (const voxel::Triangle& triangle : object_triangles(scene, object))
      for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c}) {
        door->bounds_world.low = glm::min(door->bounds_world.low, corner);
        door->bounds_world.high = glm::max(door->bounds_world.high, corner);
      }
  }
  return doors;
}

bool is_open(const scene::Timeline& timeline, std::string_view name, double time) {
  bool open = false;
  for (const scene::DoorEvent& event : timeline.doors)
    if (event.object == name && tick_at(event.time) <= tick_at(time)) open = event.open;
  return open;
}

}  // namespace brume::scenario
