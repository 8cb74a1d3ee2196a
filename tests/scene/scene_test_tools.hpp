// Helpers of the loader tests.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "image/png.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"
#include "tests/log_lines.hpp"
#include "tests/work_folder.hpp"

namespace brume::scene {

/// A text with a mistake: where its message says that it is, and what else the message names.
struct Mistake {
  std::string text, place;
  std::vector<std::string> parts;
};
/// `error_of` returns the message of a text.
template <typename ErrorOf>
void expect_mistakes(ErrorOf error_of, const std::string& file, const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    const std::string message = error_of(mistake.text);
    EXPECT_TRUE(message.starts_with(file + ':' + mistake.place + ": ")) << mistake.text << '\n' << message;
    for (const std::string& part : mistake.parts)
      EXPECT_NE(message.find(part), std::string::npos) << mistake.text << '\n' << message;
  }
}

/// An image as the bytes of a PNG file.
inline std::vector<std::byte> png_of(const image::Image8& image) {
  const cli::WorkFolder folder;
  image::save_png(folder.path() / "image.png", image).value_or_throw();
  return read_file(folder.path() / "image.png").value_or_throw();
}

/// A cube from -1 to 1, faces counter-clockwise from outside, of quads.
inline const char* const kCubeObj =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

/// The volume that the object's triangles enclose: positive when they are counter-clockwise from outside
/// (divergence theorem).
inline double signed_volume(const Scene& scene, const Object& object) {
  const Mesh& mesh = scene.meshes[object.mesh];
  double volume = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    glm::dvec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 position = mesh.vertices[mesh.indices[i + k]].position;
      p[k] = glm::dvec3(glm::dmat4(object.world_from_mesh) * glm::dvec4(glm::dvec3(position), 1));
    }
    volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
  }
  return volume;
}

/// Checks the guarantees of every loader: valid indices, unit normals and tangents, finite numbers.
inline void expect_sound(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.vertices.size()) << mesh.name;
    for (const Vertex& vertex : mesh.vertices) {
      ASSERT_NEAR(glm::length(vertex.normal), 1, 1e-4) << mesh.name;
      ASSERT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1, 1e-4) << mesh.name;
      ASSERT_EQ(std::abs(vertex.tangent.w), 1) << mesh.name;
    }
  }
  std::vector<Object> objects = scene.objects;
  if (scene.grenade) objects.push_back(*scene.grenade);
  for (const Object& object : objects) {
    ASSERT_LT(object.mesh, scene.meshes.size()) << object.name;
    ASSERT_LT(object.material, scene.materials.size()) << object.name;
  }
  for (const Material& material : scene.materials) {
    for (const std::uint32_t image :
         {material.base_color_image, material.normal_image, material.roughness_image}) {
      ASSERT_TRUE(image == kNone || image < scene.images.size()) << material.name;
    }
  }
}

}  // namespace brume::scene
