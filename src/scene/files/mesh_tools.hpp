// Mesh processing shared by the loaders.
#pragma once

#include "scene/scene.hpp"

namespace brume::scene {

/// Computes tangents from positions, normals and texture coordinates: the mean over a vertex' triangles of
/// the direction in which u increases, orthogonalized to the normal (Lengyel 2001). With degenerate
/// coordinates, any unit vector perpendicular to the normal, with w = 1.
void compute_tangents(Mesh& mesh);

/// Computes every normal as the area-weighted mean of its triangles' normals. Vertices without area point up.
void compute_normals(Mesh& mesh);

/// The mesh for objects with a mirroring matrix: reverses the winding, so that triangles are
/// counter-clockwise from outside once transformed, and flips the tangent signs.
Mesh mirrored(const Mesh& mesh);

/// Moves the middle of the mesh's bounding box to the origin.
void centre(Mesh& mesh);

}  // namespace brume::scene
