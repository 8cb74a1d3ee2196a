#include "spheres/export.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "spheres/pack.hpp"
#include "tests/work_folder.hpp"

namespace brume::spheres {
namespace {

namespace fs = std::filesystem;

class Export : public testing::Test {
 protected:
  static Tank tank(std::uint32_t count) {
    PackOptions options;
    options.size = {60, 40, 20};
    options.voxel = 0.05f;
    options.count = count;
    options.radius = {0.5f, 3};
    options.opacity = 0.25f;
    options.palette = {0x336699, 0xffcc00};
    return pack(options).value_or_throw();
  }
  const cli::WorkFolder folder_;
};

glm::dvec3 world_of(const Tank& tank, const Sphere& sphere) {
  return (glm::dvec3(sphere.center) - 0.5 * glm::dvec3(tank.size)) * double{tank.voxel};
}

TEST_F(Export, PointsArePlacedInTheWorld) {
  const Tank tank = Export::tank(100);
  const fs::path path = folder_.path() / "a.ply";
  ASSERT_TRUE(save_tank_ply(path, tank));
  const std::string text = read_text_file(path).value_or_throw();
  const std::string end = "end_header\n";
  const std::size_t begin = text.find(end) + end.size();
  EXPECT_NE(text.find("element vertex 100\n"), std::string::npos);
  ASSERT_EQ(text.size() - begin, 100u * 20);
  for (std::size_t i = 0; i < 100; ++i) {
    float numbers[4];
    Color color = 0;
    std::memcpy(numbers, text.data() + begin + 20 * i, sizeof numbers);
    std::memcpy(&color, text.data() + begin + 20 * i + 16, sizeof color);
    const glm::dvec3 world = world_of(tank, tank.spheres[i]);
    // Rounded to a float at up to 2 m.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(double{numbers[axis]}, world[axis], 0x1p-23);
    EXPECT_FLOAT_EQ(numbers[3], tank.spheres[i].radius * tank.voxel);
    EXPECT_EQ(color, tank.colors[i]);
  }
}

TEST_F(Export, MeshesAreClosedAndLieOnTheSpheres) {
  for (const std::uint32_t count : {0u, 1u, 100u, 1500u}) {
    const Tank tank = Export::tank(count);
    ASSERT_EQ(tank.spheres.size(), count);
    const fs::path path = folder_.path() / "a.obj";
    ASSERT_TRUE(save_tank_obj(path, tank));
    const std::uint64_t faces = 20ull << 2 * obj_subdivisions(count), vertices = faces / 2 + 2;

    std::istringstream lines(read_text_file(path).value_or_throw());
    std::size_t vertex = 0, face = 0;
    std::map<std::pair<std::uint64_t, std::uint64_t>, int> edges;
    std::vector<glm::dvec3> positions;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "v") {
        glm::dvec3 at, color;
        ASSERT_TRUE(words >> at.x >> at.y >> at.z >> color.r >> color.g >> color.b);
        const Sphere& sphere = tank.spheres[vertex++ / vertices];
        // Coordinates are rounded to floats of up to 2 m.
        EXPECT_NEAR(glm::distance(at, world_of(tank, sphere)), double{sphere.radius} * double{tank.voxel},
                    0x1p-22);
        EXPECT_EQ(std::lround(255 * color.b), tank.colors[(vertex - 1) / vertices] >> 16 & 0xff);
        positions.push_back(at);
      } else if (word == "f") {
        std::uint64_t corners[3];
        ASSERT_TRUE(words >> corners[0] >> corners[1] >> corners[2]);
        const std::size_t index = face++ / faces;
        for (int i = 0; i < 3; ++i) {
          EXPECT_EQ((corners[i] - 1) / vertices, index);
          ++edges[{corners[i], corners[(i + 1) % 3]}];
        }
        const glm::dvec3 a = positions[corners[0] - 1], b = positions[corners[1] - 1],
                         c = positions[corners[2] - 1];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a - world_of(tank, tank.spheres[index])), 0)
            << "outside";
      }
    }
    EXPECT_EQ(vertex, count * vertices);
    EXPECT_EQ(face, count * faces);
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
  }
}

TEST_F(Export, MeshesHaveASizeLimit) {
  EXPECT_EQ(obj_subdivisions(1), 3u);
  EXPECT_EQ(obj_subdivisions(781), 3u);
  EXPECT_EQ(obj_subdivisions(782), 2u);
  EXPECT_EQ(obj_subdivisions(65535), 0u);
  Tank many = tank(1);
  many.spheres.resize(500'001, many.spheres[0]);
  many.colors.resize(500'001);
  const auto written = save_tank_obj(folder_.path() / "a.obj", many);
  EXPECT_EQ(written.failure().code, ErrorCode::resource_limit);
  EXPECT_NE(written.failure().message.find("a.obj: 500001 spheres; at most 500000 are written as meshes"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_.path() / "a.obj"));
}

}  // namespace
}  // namespace brume::spheres
