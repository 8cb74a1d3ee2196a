#include "apps/cli/bake_inputs.hpp"

#include <algorithm>

#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/similar.hpp"
#include "image/image.hpp"
#include "scenario/world_triangles.hpp"

namespace brume::cli {

std::optional<glm::uvec3> parse_voxels(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const glm::uvec3 size(parse_grid("--size", text));
  if (glm::any(glm::equal(size, glm::uvec3(0))) ||
      glm::any(glm::greaterThan(size, glm::uvec3(image::kMaxAxis))))
    throw Error(ErrorCode::usage, "--size '" + text + "': expected 1 to 16384 voxels along x, y and z");
  return size;
}

std::optional<Box<double>> parse_box(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto points = parse_points(text);
  if (points.size() != 2)
    throw Error(ErrorCode::usage, "--box '" + text + "': expected two corners, such as \"-1,0,-1 1,2,1\"");
  const Box<double> box{glm::dvec3(parse_point("--box", points[0])),
                        glm::dvec3(parse_point("--box", points[1]))};
  if (!glm::all(glm::lessThan(box.low, box.high)))
    throw Error(ErrorCode::usage,
                "--box '" + text + "': is empty; the first corner is the lowest along each axis");
  return box;
}

std::vector<voxel::Triangle> triangles_of(const scene::Scene& scene) {
  std::vector<voxel::Triangle> triangles;
  for (const scene::Object& object : scene.objects) {
    const auto more = scenario::object_triangles(scene, object);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  return triangles;
}

std::vector<voxel::Triangle> triangles_of_object(const scene::Scene& scene, const std::string& file,
                                                 const std::string& option, const std::string& name) {
  std::vector<voxel::Triangle> triangles;
  std::vector<std::string> known;
  for (const scene::Object& object : scene.objects) {
    known.push_back(object.name);
    if (object.name != name) continue;
    const auto more = scenario::object_triangles(scene, object);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  if (std::ranges::find(known, name) == known.end())
    throw Error(ErrorCode::usage,
                option + " " + name + ": " + file + " has no such object" + suggestion(name, known, ""));
  return triangles;
}

Box<double> bounds_of(std::span<const voxel::Triangle> triangles) {
  Box<double> bounds{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (const voxel::Triangle& triangle : triangles)
    for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c}) {
      bounds.low = glm::min(bounds.low, glm::dvec3(corner));
      bounds.high = glm::max(bounds.high, glm::dvec3(corner));
    }
  return bounds;
}

Json to_json(const Box<double>& box) {
  const auto point = [](const glm::dvec3& p) { return Json::list({p.x, p.y, p.z}); };
  return {{"low", point(box.low)}, {"high", point(box.high)}};
}

}  // namespace brume::cli
