// Tanks for other programs: meshes and points. In metres, the middle of the tank at the origin.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Most triangles of an .obj file: 0.7 GB.
constexpr std::uint64_t kMostObjTriangles = 10'000'000;

/// How often an icosahedron's triangles are divided into four for a sphere of an .obj file: 0 to 3, so that
/// all spheres have at most a million triangles or, undivided, kMostObjTriangles.
std::uint32_t obj_subdivisions(std::uint64_t spheres);

/// Writes spheres as icospheres whose vertices lie on them, with their colours ("v x y z r g b", encoded as
/// sRGB), each a group of faces. Opacity is not written. Fails with resource_limit above kMostObjTriangles.
Result<void> save_tank_obj(const std::filesystem::path& path, const Tank& tank);

/// Writes a point for each sphere as binary little-endian PLY: x, y, z, radius (float), red, green, blue,
/// alpha (uchar, sRGB; alpha is the opacity byte of Color).
Result<void> save_tank_ply(const std::filesystem::path& path, const Tank& tank);

}  // namespace brume::spheres
