#include "spheres/export.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "core/progress.hpp"

namespace brume::spheres {
namespace {

constexpr std::uint64_t kIcosahedron = 20;  // triangles
constexpr std::uint64_t kFineTriangles = 1'000'000;
constexpr std::uint32_t kMostSubdivisions = 3;
constexpr std::size_t kChunk = 1 << 20;  // bytes written at a time

struct Icosphere {
  std::vector<glm::dvec3> vertices;  // unit vectors
  std::vector<glm::uvec3> triangles;
};

Icosphere icosahedron() {
  const double a = 0.525731112119133606, b = 0.850650808352039932;  // 1 and the golden ratio, normalized
  return {{{-a, b, 0},
           {a, b, 0},
           {-a, -b, 0},
           {a, -b, 0},
           {0, -a, b},
           {0, a, b},
           {0, -a, -b},
           {0, a, -b},
           {b, 0, -a},
           {b, 0, a},
           {-b, 0, -a},
           {-b, 0, a}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

Icosphere icosphere(std::uint32_t subdivisions) {
  Icosphere sphere = icosahedron();
  for (std::uint32_t i = 0; i < subdivisions; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(sphere.vertices.size()));
      if (added) sphere.vertices.push_back(glm::normalize(sphere.vertices[a] + sphere.vertices[b]));
      return at->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : sphere.triangles) {
      const glm::uvec3 m(middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x));
      for (const glm::uvec3& part :
           {glm::uvec3(t.x, m.x, m.z), glm::uvec3(t.y, m.y, m.x), glm::uvec3(t.z, m.z, m.y), m})
        finer.push_back(part);
    }
    sphere.triangles = std::move(finer);
  }
  return sphere;
}

glm::dvec3 in_world(const Tank& tank, const glm::dvec3& at) {
  return (at - 0.5 * glm::dvec3(tank.size)) * double{tank.voxel};
}

void add_number(std::string& text, double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<float>(number)).ptr;
  text += ' ';
  text.append(digits, end);
}

void add_number(std::string& text, std::uint64_t number) {
  char digits[24];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  text += ' ';
  text.append(digits, end);
}

// "r g b" of a byte each: three decimals tell all 256 values apart.
void add_color(std::string& text, Color color) {
  for (int channel = 0; channel < 3; ++channel) {
    const std::uint32_t thousandths = ((color >> 8 * channel & 0xff) * 1000 + 127) / 255;
    add_number(text, thousandths / 1000.0);
  }
}

void add_sphere(std::string& text, const Tank& tank, std::size_t index, const Icosphere& shape) {
  const Sphere& sphere = tank.spheres[index];
  std::string color;
  add_color(color, tank.colors[index]);
  for (const glm::dvec3& vertex : shape.vertices) {
    const glm::dvec3 at = in_world(tank, glm::dvec3(sphere.center) + double{sphere.radius} * vertex);
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) add_number(text, at[axis]);
    text += color;
    text += '\n';
  }
  text += "g sphere_" + std::to_string(index + 1) + "\n";
  const std::uint64_t first = std::uint64_t{index} * shape.vertices.size() + 1;
  for (const glm::uvec3& triangle : shape.triangles) {
    text += 'f';
    for (int corner = 0; corner < 3; ++corner) add_number(text, first + triangle[corner]);
    text += '\n';
  }
}

}  // namespace

std::uint32_t obj_subdivisions(std::uint64_t spheres) {
  std::uint32_t subdivisions = kMostSubdivisions;
  while (subdivisions > 0 && spheres * (kIcosahedron << 2 * subdivisions) > kFineTriangles) --subdivisions;
  return subdivisions;
}

Result<void> save_tank_obj(const std::filesystem::path& path, const Tank& tank) {
  if (tank.spheres.size() * kIcosahedron > kMostObjTriangles)
    return Failure{ErrorCode::resource_limit, path.string() + ": " + std::to_string(tank.spheres.size()) +
                                                  " spheres; at most " +
                                                  std::to_string(kMostObjTriangles / kIcosahedron) +
                                                  " are written as meshes; write points (.ply) instead"};
  const Icosphere shape = icosphere(obj_subdivisions(tank.spheres.size()));
  auto file = AtomicFile::open(path);
  if (!file) return file.failure();
  Progress progress("write spheres", tank.spheres.size());
  std::string text = "# spheres of a tank, in metres\n";
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    add_sphere(text, tank, i, shape);
    progress.advance();
    if (text.size() < kChunk) continue;
    if (auto written = file->write(std::as_bytes(std::span(text))); !written) return written;
    text.clear();
  }
  if (auto written = file->write(std::as_bytes(std::span(text))); !written) return written;
  return file->commit();
}

Result<void> save_tank_ply(const std::filesystem::path& path, const Tank& tank) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment spheres of a tank, in metres\nelement vertex " +
      std::to_string(tank.spheres.size()) + "\n";
  for (const char* property : {"float x", "float y", "float z", "float radius", "uchar red", "uchar green",
                               "uchar blue", "uchar alpha"})
    text += std::string("property ") + property + "\n";
  text += "end_header\n";
  text.reserve(text.size() + tank.spheres.size() * 20);
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const Sphere& sphere = tank.spheres[i];
    const Sphere point{glm::vec3(in_world(tank, glm::dvec3(sphere.center))), sphere.radius * tank.voxel};
    std::array<char, sizeof point + sizeof(Color)> bytes;
    std::memcpy(bytes.data(), &point, sizeof point);
    std::memcpy(bytes.data() + sizeof point, &tank.colors[i], sizeof(Color));
    text.append(bytes.data(), bytes.size());
  }
  return write_file_atomic(path, text);
}

}  // namespace brume::spheres
