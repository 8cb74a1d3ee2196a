// Doors: the objects of a scene that players can open and close.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/box.hpp"
#include "scene/timeline.hpp"

namespace brume::scenario {

/// A door as door events refer to it: all objects of one name.
struct Door {
  std::string name;
  std::vector<std::uint32_t> objects;   ///< Indices into Scene::objects, ascending.
  Box<float> bounds_world = kEmptyBox;  ///< Bounds of all of them, closed.
};

/// Whether an object of this name counts as a door: the name contains the word "door" in any case ("front
/// door", "door_2"), also in camel case ("FrontDoor", "DoorRoom"), but not the word "frame".
bool is_door_name(std::string_view name);

/// The doors of a scene, in the order of their first objects.
std::vector<Door> doors_of(const scene::Scene& scene);

/// Whether a door is open at a time [s].
bool is_open(const scene::Timeline& timeline, std::string_view name, double time);

}  // namespace brume::scenario
