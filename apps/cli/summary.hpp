// The facts that `brume info` reports of a file: as text and as JSON.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/json.hpp"
#include "scene/scene.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::cli {

/// The facts in order. docs/reference/command-line.md lists the keys.
class Summary {
 public:
  explicit Summary(const std::string& kind);
  void add(const std::string& key, const Json& value);
  void add(const std::string& key, const Json& value, const std::string& text);
  /// A value that the lines express in another way.
  void set(const std::string& key, const Json& value) { json_.set(key, value); }
  /// A line that JSON expresses in another way.
  void add_line(const std::string& name, const std::string& text);
  const Json& json() const { return json_; }
  const std::vector<std::pair<std::string, std::string>>& lines() const { return lines_; }

 private:
  Json json_;
  std::vector<std::pair<std::string, std::string>> lines_;
};

/// A name from a file, which may hold anything, on one line.
std::string printable(std::string name);
Json point_json(glm::vec3 p);
/// "1,0.5,-3", as arguments take it.
std::string point_text(glm::vec3 p);
/// A camera, `own` of the file or fitted, as --camera takes it.
void add_camera(Summary& summary, const scene::Camera& camera, bool own);
/// Size, voxel and place of a grid.
void add_layout(Summary& summary, const voxel::GridLayout& layout);

}  // namespace brume::cli
