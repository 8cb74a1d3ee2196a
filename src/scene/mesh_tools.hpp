// What loaders do to meshes before anybody else sees them.
#pragma once

#include "scene/scene.hpp"

namespace brume::scene {

/// Sets every tangent from positions, normals and texture coordinates: the mean over a vertex' triangles of
/// the direction in which u grows, made perpendicular to the normal (Lengyel 2001). Where the coordinates
/// say nothing, any unit vector perpendicular to the normal, with w = 1.
void compute_tangents(Mesh& mesh);

/// Sets every normal to the mean of its triangles' normals, weighted by area. Vertices without area point up.
void compute_normals(Mesh& mesh);

/// The mesh for objects whose matrix mirrors: triangles run the other way round, so that they are
/// counter-clockwise from outside once transformed, and tangent signs change with them.
Mesh mirrored(const Mesh& mesh);

/// Moves the middle of the mesh's box to the origin.
void centre(Mesh& mesh);

}  // namespace brume::scene
