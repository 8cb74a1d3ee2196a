// Smoke at walls: a voxel of half a metre must not show. Rooms made of triangles are filled with smoke of
// full density; along lines towards a surface the density must be that of the middle of the room up to one
// millimetre before the surface, and nothing behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iomanip>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/sanitized.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::smoke {
namespace {

using glm::dvec3;
using glm::vec3;
using voxel::Triangle;

constexpr float kVoxel = 0.5f;
constexpr double kNearWall = 0.001;  // [m]

using Mesh = std::vector<Triangle>;

void add_quad(Mesh& mesh, dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
  mesh.push_back({vec3(a), vec3(b), vec3(c)});
  mesh.push_back({vec3(a), vec3(c), vec3(d)});
}

/// Six faces of a box: three edges from a corner.
void add_box(Mesh& mesh, dvec3 o, dvec3 u, dvec3 v, dvec3 w) {
  for (int end = 0; end < 2; ++end) {
    const dvec3 e(end);
    add_quad(mesh, o + e * w, o + e * w + u, o + e * w + u + v, o + e * w + v);
    add_quad(mesh, o + e * v, o + e * v + u, o + e * v + u + w, o + e * v + w);
    add_quad(mesh, o + e * u, o + e * u + v, o + e * u + v + w, o + e * u + w);
  }
}

/// A wall through `through` with unit normal `n`, far larger than the room: one sheet, or a slab that begins
/// at the sheet and is `thickness` thick against the normal.
void add_wall(Mesh& mesh, dvec3 through, dvec3 n, double thickness) {
  const dvec3 side = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
  const dvec3 up = glm::cross(side, n);
  const dvec3 corner = through - 40.0 * side - 40.0 * up;
  if (thickness == 0)
    add_quad(mesh, corner, corner + 80.0 * side, corner + 80.0 * (side + up), corner + 80.0 * up);
  else
    add_box(mesh, corner - thickness * n, 80.0 * side, 80.0 * up, thickness * n);
}

void add_column(Mesh& mesh, double x, double z, double radius, double height) {
  constexpr int kSides = 64;
  for (int i = 0; i < kSides; ++i) {
    const auto at = [&](int k, double y) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      return dvec3(x + radius * std::cos(angle), y, z + radius * std::sin(angle));
    };
    add_quad(mesh, at(i, 0), at(i + 1, 0), at(i + 1, height), at(i, height));
  }
}

/// A room of 12 x 6 x 12 m full of smoke on the side of `source`.
struct Room {
  explicit Room(const Mesh& mesh, dvec3 source)
      : grid(std::move(voxel::voxelize(mesh, {{24, 12, 24}, kVoxel, vec3(0)})).value_or_throw()),
        planes(voxel::SurfacePlanes::build(mesh, grid)),
        volume(grid, planes) {
    sim::World world(grid);
    // So much smoke that even the farthest corner is past the taper.
    const sim::Position at = sim::position_from_metres(source);
    sim::ThrowSmoke thrown{0, at, at + sim::Position(0, 1, 0), {200000, 1, 2000, 1}};
    world.append(thrown).value_or_throw();
    world.advance_to(1000);
    full = !world.state().clouds.empty();
    for (const sim::LiveCloud& live : world.state().clouds) {
      const sim::CloudPhase phase = live.cloud->phase(world.tick());
      for (std::uint32_t rank = 0; rank < live.cloud->voxels().size(); ++rank)
        full &= live.cloud->density(rank, phase) == 255;
    }
    volume.update(world);
  }
  double density(dvec3 p_world) const { return sample_density(volume, vec3(p_world / double{kVoxel})); }

  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  SmokeVolume volume;
  bool full = false;
};

/// What all lines of one case have shown.
struct Profiles {
  int lines = 0;
  int thin = 0;        // lines with less than 95 % somewhere before the surface
  int leaking = 0;     // lines with 1 % or more behind it
  double least = 1;    // density before the surface
  double most = 0;     // density behind it
  double thin_at = 0;  // farthest from the surface that it is below 95 % [m]
  double leak_at = 0;  // farthest behind the surface that it is 1 % or more [m]
  std::string worst;
};

/// Rows of the CSV file that BRUME_PROFILES names.
std::ostringstream& csv() {
  static std::ostringstream rows;
  return rows;
}

class Csv : public ::testing::Environment {
 public:
  void SetUp() override { csv() << "case,line,metres_before_surface,density\n"; }
  void TearDown() override {
    const char* path = std::getenv("BRUME_PROFILES");
    if (path == nullptr) return;
    EXPECT_TRUE(static_cast<bool>(write_file_atomic(path, csv().str())));
  }
};
const auto* const kCsv = ::testing::AddGlobalTestEnvironment(new Csv);

bool wants_csv() {
  return std::getenv("BRUME_PROFILES") != nullptr;
}

void probe(Profiles& profiles, const Room& room, const std::string& name, dvec3 hit, dvec3 n,
           double thickness, double before, double behind, double near = kNearWall, double far = 0.01) {
  bool thin = false, leaks = false;
  const auto record = [&](double distance, double density) {
    if (wants_csv() && profiles.lines < 3)
      csv() << name << ',' << profiles.lines << ',' << distance << ',' << density << '\n';
  };
  for (int i = 0; i <= 60; ++i) {
    // Closer together near the surface.
    const double distance = near + before * std::pow(i / 60.0, 2);
    const double density = room.density(hit + distance * n);
    record(distance, density);
    thin |= density < 0.95;
    if (density < 0.95) profiles.thin_at = std::max(profiles.thin_at, distance);
    if (density < profiles.least) {
      std::ostringstream at;
      const dvec3 p = (hit + distance * n) / double{kVoxel};
      at << name << ": " << density << " at " << distance << " m before the surface, voxel " << p.x << ", "
         << p.y << ", " << p.z;
      profiles.worst = at.str();
    }
    profiles.least = std::min(profiles.least, density);
  }
  for (int i = 0; i <= 60 && behind > 0; ++i) {
    const double distance = thickness + far + behind * i / 60;
    const double density = room.density(hit - distance * n);
    record(-distance, density);
    leaks |= density >= 0.01;
    if (density >= 0.01) profiles.leak_at = std::max(profiles.leak_at, distance - thickness);
    profiles.most = std::max(profiles.most, density);
  }
  ++profiles.lines;
  profiles.thin += thin;
  profiles.leaking += leaks;
}

void expect_even(const Profiles& profiles, const std::string& name) {
  std::cout << "  " << std::left << std::setw(32) << name << " lines " << profiles.lines << ", least "
            << profiles.least << ", most behind " << profiles.most << ", thin " << profiles.thin << " up to "
            << profiles.thin_at << " m, leaking " << profiles.leaking << " up to " << profiles.leak_at
            << " m\n";
  EXPECT_GE(profiles.least, 0.95) << profiles.worst;
  EXPECT_LT(profiles.most, 0.01) << name;
}

std::string label(const std::string& kind, double number, double thickness) {
  std::ostringstream out;
  out << kind << ' ' << number << (thickness > 0 ? " slab" : " sheet");
  return out.str();
}

/// Lines towards a wall through `through` with normal n; smoke on the side of n.
void probe_wall(Profiles& profiles, const std::string& name, dvec3 through, dvec3 n, double thickness) {
  Mesh mesh;
  add_wall(mesh, through, n, thickness);
  const Room room(mesh, through + 2.5 * n);
  ASSERT_TRUE(room.full) << name;
  const dvec3 side = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
  const dvec3 up = glm::cross(side, n);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> spread(-1.2, 1.2);
  for (int i = 0; i < (kSanitized ? 50 : 300); ++i)
    probe(profiles, room, name, through + spread(random) * side + spread(random) * up, n, thickness, 1.5,
          1.5);
}

TEST(WallProfile, FlatWallAtAnyPlaceInTheVoxel) {
  for (const double thickness : {0.0, 0.1}) {
    for (const dvec3 n : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, -1)}) {
      Profiles profiles;
      for (int i = 0; i <= 18; ++i) {
        const double offset = 0.05 + 0.05 * i;  // of a voxel
        const dvec3 through = dvec3(6, 3, 6) + offset * double{kVoxel} * glm::abs(n);
        probe_wall(profiles, label("flat", offset, thickness), through, n, thickness);
      }
      expect_even(profiles, label("flat, all offsets, axis", n.x + 2 * n.y + 3 * n.z, thickness));
    }
  }
}

TEST(WallProfile, FlatWallExactlyBetweenTwoVoxels) {
  Profiles profiles;
  probe_wall(profiles, "flat on the grid", {6, 3, 6}, {1, 0, 0}, 0);
  expect_even(profiles, "flat on the grid");
}

TEST(WallProfile, SlantedWallsAndRoofs) {
  for (const double thickness : {0.0, 0.1}) {
    for (const double degrees : {10.0, 30.0, 45.0, 60.0}) {
      const double angle = degrees * std::numbers::pi / 180;
      Profiles walls, roofs;
      for (const double offset : {0.0, 0.13, 0.27, 0.41}) {
        const dvec3 through = dvec3(6, 3, 6) + offset * dvec3(1, 0.6, 0.3) * double{kVoxel};
        probe_wall(walls, label("wall", degrees, thickness), through, {std::cos(angle), 0, std::sin(angle)},
                   thickness);
        probe_wall(roofs, label("roof", degrees, thickness), through, {std::sin(angle), -std::cos(angle), 0},
                   thickness);
      }
      expect_even(walls, label("wall", degrees, thickness));
      expect_even(roofs, label("roof", degrees, thickness));
    }
    Profiles any;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 8; ++i) {
      const dvec3 n = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
      probe_wall(any, label("any way", i, thickness), dvec3(6, 3, 6) + 0.1 * i, n, thickness);
    }
    expect_even(any, label("any way", 8, thickness));
  }
}

/// Lines towards a round wall about (x, z) from outside of it, or from inside.
void probe_round(Profiles& profiles, const Room& room, const std::string& name, dvec3 centre, double radius,
                 bool from_inside, double thickness, double behind, double near = kNearWall,
                 double far = 0.01) {
  ASSERT_TRUE(room.full) << name;
  for (int i = 0; i < 200; ++i) {
    const double angle = 2 * std::numbers::pi * i / 200;
    const dvec3 out(std::cos(angle), 0, std::sin(angle));
    probe(profiles, room, name, centre + dvec3(0, 2 + i * 0.005, 0) + radius * out, from_inside ? -out : out,
          thickness, from_inside ? 0.8 * radius : 1.5, behind, near, far);
  }
}

TEST(WallProfile, RoundColumns) {
  for (const double radius : {0.4, 0.6, 0.8, 1.0, 1.25, 1.5}) {
    Profiles profiles;
    for (const double shift : {0.0, 0.11, 0.23}) {
      const dvec3 centre(6 + shift, 0, 6 - 0.7 * shift);
      Mesh mesh;
      add_column(mesh, centre.x, centre.z, radius, 8);
      const Room room(mesh, {2, 3, 2});
      // No camera sees the space behind.
      probe_round(profiles, room, label("column", radius, 0), centre, radius, false, 0, 0);
    }
    expect_even(profiles, label("column", radius, 0));
  }
}

TEST(WallProfile, ThinRoundWalls) {
  constexpr double kThickness = 0.1;
  for (const double radius : {1.5, 2.0, 3.0}) {
    // The one plane of a cell lies off the surface by up to the height of an arc over the cell's diagonal d,
    // d^2 / 8 r, where there is air on both sides.
    const double arc = 2 * kVoxel * kVoxel / (8 * radius);
    // The closed space inside counts as a hollow: planes are moved into it by 0.3 of the curvature per
    // voxel^2, which is taken for twice as much at the most, where two pieces are half a voxel apart and not
    // one.
    const double moved = 2 * 0.3 * kVoxel * kVoxel / radius;
    Profiles outside, inside;
    for (const double shift : {0.0, 0.11, 0.23}) {
      const dvec3 centre(6 + shift, 0, 6 - 0.7 * shift);
      Mesh mesh;
      add_column(mesh, centre.x, centre.z, radius, 5.2);
      add_column(mesh, centre.x, centre.z, radius - kThickness, 5.2);
      // A lid keeps the smoke on its side.
      add_quad(mesh, {0, 5.2, 0}, {12, 5.2, 0}, {12, 5.2, 12}, {0, 5.2, 12});
      const Room around(mesh, {1, 3, 1});
      probe_round(outside, around, label("round, outside", radius, kThickness), centre, radius, false,
                  kThickness, 0.5 * radius, kNearWall, moved);
      const Room within(mesh, centre + dvec3(0, 3, 0));
      probe_round(inside, within, label("round, inside", radius, kThickness), centre, radius - kThickness,
                  true, kThickness, 0.8, arc, arc);
    }
    expect_even(outside, label("round, outside", radius, kThickness));
    expect_even(inside, label("round, inside", radius, kThickness));
  }
}

TEST(WallProfile, CornersOfRoomsAndOfWalls) {
  Profiles inner, outer;
  for (const double offset : {0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95}) {
    // Two walls and a floor that meet; smoke in the corner.
    const dvec3 corner = dvec3(3, 1, 3) + offset * double{kVoxel};
    Mesh room_mesh;
    add_quad(room_mesh, corner, corner + dvec3(20, 0, 0), corner + dvec3(20, 20, 0),
             corner + dvec3(0, 20, 0));
    add_quad(room_mesh, corner, corner + dvec3(0, 0, 20), corner + dvec3(0, 20, 20),
             corner + dvec3(0, 20, 0));
    add_quad(room_mesh, corner, corner + dvec3(20, 0, 0), corner + dvec3(20, 0, 20),
             corner + dvec3(0, 0, 20));
    const Room room(room_mesh, corner + dvec3(3, 2, 3));
    ASSERT_TRUE(room.full);
    for (int i = 0; i < 60; ++i) {
      const double along = 0.002 + 0.03 * i;
      for (const double other : {0.002, 0.1, 0.4, 0.9}) {
        probe(inner, room, "inner corner", corner + dvec3(0, along, other), {1, 0, 0}, 0, 1.5, 1.0);
        probe(inner, room, "inner corner", corner + dvec3(other, 0, along), {0, 1, 0}, 0, 1.5, 0.4);
        probe(inner, room, "inner corner", corner + dvec3(along, other, 0), {0, 0, 1}, 0, 1.5, 1.0);
      }
    }

    // A block that stands in the smoke: its edges and its corners.
    Mesh block;
    const dvec3 low = dvec3(4, 0, 4) + offset * double{kVoxel};
    add_box(block, low, {3, 0, 0}, {0, 3, 0}, {0, 0, 3});
    const Room around(block, {2, 2, 2});
    ASSERT_TRUE(around.full);
    for (int i = 0; i < 60; ++i) {
      const double along = 0.02 + 0.02 * i;
      for (const double other : {0.02, 0.3, 1.1}) {
        probe(outer, around, "block", low + dvec3(0, 3 - along, other), {-1, 0, 0}, 0, 1.5, 0);
        probe(outer, around, "block", low + dvec3(along, 3, other), {0, 1, 0}, 0, 1.5, 0);
        probe(outer, around, "block", low + dvec3(other, 3 - along, 3), {0, 0, 1}, 0, 1.5, 0);
      }
    }
  }
  expect_even(inner, "inner corner");
  expect_even(outer, "block");
}

}  // namespace
}  // namespace brume::smoke
