// What is shown where a file is missing: visible, never silent.
#pragma once

#include "scene/scene.hpp"

namespace brume::scene {

/// A cube of edge length 1 around the origin, with its own normals and texture coordinates a face.
Mesh unit_cube();

/// A hand grenade-sized can with bevelled ends, 0.11 m high and 0.06 m wide, centred on the origin.
Mesh grenade_mesh();

/// Gives a scene that has no grenade a built-in one, with a mesh and a material of its own.
void add_built_in_grenade(Scene& scene);

/// 8 x 8 squares of magenta and black.
image::Image8 magenta_checker();

}  // namespace brume::scene
