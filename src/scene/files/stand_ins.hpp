// Visible stand-ins for missing files.
#pragma once

#include "scene/scene.hpp"

namespace brume::scene {

/// A unit cube centred on the origin, with separate normals and texture coordinates per face.
Mesh unit_cube();

/// A can the size of a hand grenade with bevelled ends, 0.11 m high and 0.06 m wide, centred on the origin.
Mesh grenade_mesh();

/// Gives a scene that has no grenade a built-in one, with a mesh and a material of its own.
void add_built_in_grenade(Scene& scene);

/// 8 x 8 squares of magenta and black.
image::Image8 magenta_checker();

}  // namespace brume::scene
