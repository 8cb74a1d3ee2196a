#include "apps/cli/summary.hpp"

#include <cstdio>

namespace brume::cli {

Summary::Summary(const std::string& kind) : json_(Json::object()) {
  add("kind", kind);
}

void Summary::add(const std::string& key, const Json& value) {
  json_.set(key, value);
  lines_.emplace_back(key, value.text());
}

void Summary::add(const std::string& key, const Json& value, const std::string& text) {
  json_.set(key, value);
  lines_.emplace_back(key, text);
}

void Summary::add_line(const std::string& name, const std::string& text) {
  lines_.emplace_back(name, text);
}

Json point_json(glm::vec3 p) {
  return Json::list({p.x, p.y, p.z});
}

std::string printable(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  return name;
}

std::string point_text(glm::vec3 p) {
  char text[96];
  std::snprintf(text, sizeof text, "%.5g,%.5g,%.5g", double{p.x}, double{p.y}, double{p.z});
  return text;
}

void add_layout(Summary& summary, const voxel::GridLayout& layout) {
  const glm::ivec3 n = layout.size;
  summary.add("grid", Json::list({n.x, n.y, n.z}),
              std::to_string(n.x) + "x" + std::to_string(n.y) + "x" + std::to_string(n.z) + " voxels");
  summary.add("voxel_size", layout.voxel_size);
  const glm::vec3 high = layout.origin_world + glm::vec3(n) * layout.voxel_size;
  summary.add("origin", point_json(layout.origin_world),
              point_text(layout.origin_world) + " to " + point_text(high) + " m");
}

void add_camera(Summary& summary, const scene::Camera& camera, bool own) {
  const double degrees = double{camera.vertical_fov} * 180 / std::numbers::pi;
  char fov[32];
  std::snprintf(fov, sizeof fov, "%.4g", degrees);
  summary.add("camera",
              Json{{"from_file", own},
                   {"position", point_json(camera.position_world)},
                   {"target", point_json(camera.target_world)},
                   {"fov_degrees", degrees}},
              std::string(own ? "of the file" : "fitted") + ": --camera \"" +
                  point_text(camera.position_world) + " " + point_text(camera.target_world) + " " + fov +
                  "\"");
}

}  // namespace brume::cli
