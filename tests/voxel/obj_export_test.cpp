#include "voxel/obj_export.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <random>
#include <sstream>

#include "core/file.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;
using glm::vec3;

BitGrid random_grid(std::uint64_t seed, ivec3 size, unsigned solid_of_8) {
  std::mt19937_64 random(seed);
  BitGrid grid({size, 0.5f, vec3(-30, 1, 7)});
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (random() % 8 < solid_of_8) grid.set({x, y, z}, true);
  return grid;
}

// Every face of the grid, by voxel and direction, by brute force.
std::map<std::array<int, 4>, int> brute_force_faces(const BitGrid& grid) {
  std::map<std::array<int, 4>, int> faces;
  const ivec3 size = grid.size();
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        for (int side = 0; side < 6; ++side) {
          ivec3 towards(0);
          towards[side / 2] = side % 2 ? 1 : -1;
          if (grid.solid({x, y, z}) && !grid.solid(ivec3(x, y, z) + towards)) faces[{x, y, z, side}] = 0;
        }
  return faces;
}

TEST(SurfaceRectangles, CoverEachFaceOnce) {
  const ivec3 sizes[] = {{1, 1, 1}, {7, 7, 7}, {33, 17, 5}, {2, 65, 3}};
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    const BitGrid grid = random_grid(seed, sizes[seed % 4], 1 + static_cast<unsigned>(seed % 8));
    auto faces = brute_force_faces(grid);
    for (const FaceRectangle& r : surface_rectangles(grid))
      for (int j = 0; j < r.height; ++j)
        for (int i = 0; i < r.width; ++i) {
          ivec3 v = r.low;
          v[r.axis] -= r.positive ? 1 : 0;
          v[(r.axis + 1) % 3] += i;
          v[(r.axis + 2) % 3] += j;
          const auto face = faces.find({v.x, v.y, v.z, 2 * r.axis + (r.positive ? 1 : 0)});
          ASSERT_NE(face, faces.end());
          ASSERT_EQ(++face->second, 1) << "covered twice";
        }
    for (const auto& [key, count] : faces) ASSERT_EQ(count, 1) << "not covered";
  }
}

TEST(SurfaceRectangles, MergeABoxIntoSixQuads) {
  EXPECT_EQ(surface_rectangles(random_grid(0, {20, 9, 13}, 8)).size(), 6u);
  EXPECT_TRUE(surface_rectangles(random_grid(0, {20, 9, 13}, 0)).empty());
}

struct Obj {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::size_t, 4>> quads;
};

Obj parse(const std::string& text) {
  Obj obj;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      glm::dvec3& v = obj.vertices.emplace_back();
      words >> v.x >> v.y >> v.z;
    } else if (kind == "f") {
      for (std::size_t& i : obj.quads.emplace_back()) words >> i;
    }
    EXPECT_FALSE(words.fail()) << line;
  }
  return obj;
}

TEST(ExportObj, IsClosedAndFacesOutward) {
  const auto path = std::filesystem::path(testing::TempDir()) / "brume_voxels.obj";
  const BitGrid grid = random_grid(3, {9, 20, 11}, 3);
  const auto counts = export_obj(grid, path).value_or_throw();
  const auto text = read_text_file(path);
  ASSERT_TRUE(text);
  const Obj obj = parse(*text);
  EXPECT_EQ(obj.vertices.size(), counts.vertices);
  EXPECT_EQ(obj.quads.size(), counts.quads);
  // Closed and outward: the area vectors sum to zero, and the volume by the divergence theorem is that of the
  // voxels.
  glm::dvec3 flux(0);
  double volume = 0, area = 0;
  for (const auto& quad : obj.quads) {
    glm::dvec3 p[4];
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_TRUE(quad[i] >= 1 && quad[i] <= obj.vertices.size());
      p[i] = obj.vertices[quad[i] - 1];
    }
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[3] - p[0]);
    flux += normal;
    area += glm::length(normal);
    volume += glm::dot(normal, p[0]) / 3;
  }
  EXPECT_EQ(flux, glm::dvec3(0));
  EXPECT_NEAR(volume, 0.125 * static_cast<double>(grid.count_solid()), 1e-6);
  EXPECT_NEAR(area, 0.25 * static_cast<double>(counts.faces), 1e-6);
  EXPECT_EQ(counts.faces, brute_force_faces(grid).size());
  std::filesystem::remove(path);
}

TEST(ExportObj, FailsWhereItCannotWrite) {
  const auto counts = export_obj(random_grid(3, {3, 3, 3}, 3), "no such folder/voxels.obj");
  ASSERT_FALSE(counts);
  EXPECT_NE(counts.failure().message.find("no such folder"), std::string::npos);
}

}  // namespace
}  // namespace brume::voxel
