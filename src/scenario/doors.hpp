// Doors: what of a scene a player may open and shut.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/timeline.hpp"

namespace brume::scenario {

/// A door, as door events name it: all objects of one name.
struct Door {
  std::string name;
  std::vector<std::uint32_t> objects;  ///< Of the scene, rising.
  scene::Bounds bounds_world;          ///< Around all of them, shut.
};

/// Whether an object of this name is taken for a door: "door" is a word of it, in any case ("front door",
/// "door_2"), also in names run together ("FrontDoor", "DoorRoom"); frames of doors are none.
bool is_door_name(std::string_view name);

/// The doors of a scene, in the order of their first objects.
std::vector<Door> doors_of(const scene::Scene& scene);

/// Whether a door is open at a time [s].
bool is_open(const scene::Timeline& timeline, std::string_view name, double time);

}  // namespace brume::scenario
