// The generalized winding number of triangles: how often they enclose a point, for meshes that have holes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "voxel/triangle.hpp"

namespace brume::bake {

/// The solid angle of all triangles around a point over 4 pi (Jacobson, Kavan and Sorkine-Hornung 2013,
/// "Robust Inside-Outside Segmentation using Generalized Winding Numbers"): 1 inside of a closed mesh whose
/// triangles face outwards, 0 outside of it, between them near a hole. Far groups of triangles count by the
/// first three terms of their multipole expansion (Barill et al. 2018, "Fast Winding Numbers for Soups and
/// Clouds").
class WindingTree {
 public:
  /// The error of the approximation stays below this where a surface has few layers.
  static constexpr double kError = 0.01;

  /// Triangles with a corner that is not finite are dropped.
  explicit WindingTree(std::span<const voxel::Triangle> triangles);

  /// Finite for every finite point, also on triangles.
  double winding_number(const glm::dvec3& point) const;

 private:
  // A group of triangles; its subtree follows it. With r from a point to the centre, its solid angle is about
  // dipole . r / |r|^3 + quadrupole(r) / |r|^5 + octupole(r) / |r|^7.
  struct Node {
    glm::dvec3 centre{0};
    double far_squared = 0;              // Beyond this distance, squared, the expansion holds.
    glm::dvec3 dipole{0};                // Factors of x, y, z.
    glm::dvec3 squares{0}, products{0};  // The quadrupole: factors of xx, yy, zz and of yz, zx, xy.
    glm::dmat3 cubes{0};                 // The octupole: the factor [j][i] of (r_i)^2 r_j,
    double xyz = 0;                      // and the factor of xyz.
    std::uint32_t next = 0;              // The node after its subtree.
    std::uint32_t first = 0, count = 0;  // The triangles of a leaf; none in other nodes.
  };
  struct Corners {
    glm::dvec3 a, b, c;
  };

  void add_node(std::size_t first, std::size_t count);
  static Node expanded(std::span<const Corners> triangles);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

/// The signed solid angle of a triangle around a point [sr], positive where it faces away from the point
/// (A. van Oosterom and J. Strackee 1983, "The Solid Angle of a Plane Triangle"). a, b, c: the corners minus
/// the point.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace brume::bake
