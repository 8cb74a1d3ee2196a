#include "scene/files/stand_ins.hpp"

#include <cmath>
#include <numbers>

#include "scene/files/mesh_tools.hpp"

namespace brume::scene {
namespace {

void add_quad(Mesh& mesh, const glm::vec3 (&corners)[4], const glm::vec3 (&normals)[4]) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  constexpr glm::vec2 kUv[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (int i = 0; i < 4; ++i) {
    Vertex vertex;
    vertex.position = corners[i];
    vertex.normal = normals[i];
    vertex.uv = kUv[i];
    mesh.vertices.push_back(vertex);
  }
  for (const std::uint32_t offset : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + offset);
}

}  // namespace

Mesh unit_cube() {
  Mesh mesh;
  mesh.name = "stand-in cube";
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0), u(0), v(0);
      normal[axis] = side;
      u[(axis + 1) % 3] = 0.5f * side;  // u x v is along the normal for both sides.
      v[(axis + 2) % 3] = 0.5f;
      const glm::vec3 middle = normal * 0.5f;
      add_quad(mesh, {middle - u - v, middle + u - v, middle + u + v, middle - u + v},
               {normal, normal, normal, normal});
    }
  }
  compute_tangents(mesh);
  return mesh;
}

Mesh grenade_mesh() {
  // The profile rotated around the y axis: radius and height [m] from the bottom centre to the top centre.
  constexpr glm::vec2 kOutline[] = {{0.0f, -0.055f},  {0.026f, -0.055f}, {0.03f, -0.051f}, {0.03f, 0.031f},
                                    {0.022f, 0.039f}, {0.012f, 0.041f},  {0.012f, 0.055f}, {0.0f, 0.055f}};
  constexpr int kSides = 20;
  Mesh mesh;
  mesh.name = "built-in grenade";
  for (std::size_t ring = 0; ring + 1 < std::size(kOutline); ++ring) {
    const glm::vec2 low = kOutline[ring], high = kOutline[ring + 1];
    const glm::vec2 outward = glm::normalize(glm::vec2(high.y - low.y, low.x - high.x));
    for (int side = 0; side < kSides; ++side) {
      const auto around = [&](int at, float radius, float height) {
        const double angle = 2.0 * std::numbers::pi * (at % kSides) / kSides;
        return glm::vec3(radius * static_cast<float>(std::sin(angle)), height,
                         radius * static_cast<float>(std::cos(angle)));
      };
      const glm::vec3 left = around(side, outward.x, outward.y);
      const glm::vec3 right = around(side + 1, outward.x, outward.y);
      add_quad(mesh,
               {around(side, low.x, low.y), around(side + 1, low.x, low.y), around(side + 1, high.x, high.y),
                around(side, high.x, high.y)},
               {left, right, right, left});
    }
  }
  compute_tangents(mesh);
  return mesh;
}

image::Image8 magenta_checker() {
  constexpr std::uint32_t kSquares = 8, kTexels = 8;
  image::Image8 image{kSquares * kTexels, kSquares * kTexels, {}};
  image.rgba.reserve(std::size_t{image.width} * image.height * 4);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const std::uint8_t level = (x / kTexels + y / kTexels) % 2 == 0 ? 255 : 0;
      for (const std::uint8_t byte : {level, std::uint8_t{0}, level, std::uint8_t{255}})
        image.rgba.push_back(byte);
    }
  }
  return image;
}

void add_built_in_grenade(Scene& scene) {
  if (scene.grenade) return;
  Material metal;
  metal.name = "built-in grenade";
  metal.base_color = glm::vec3(0.07f, 0.09f, 0.06f);
  metal.roughness = 0.5f;
  metal.metallic = 0.3f;
  scene.materials.push_back(std::move(metal));
  scene.meshes.push_back(grenade_mesh());
  scene.grenade = Object{"Grenade", static_cast<std::uint32_t>(scene.meshes.size() - 1),
                         static_cast<std::uint32_t>(scene.materials.size() - 1), glm::mat4(1), Role::ghost};
}

}  // namespace brume::scene
