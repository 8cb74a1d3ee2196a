// What `brume info` reports of a file: the same facts as text and as JSON.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/json.hpp"
#include "apps/command_line/outputs.hpp"
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

/// A scene file: counts, size, lights, and what `render` shows of it without a timeline: camera, grid and a
/// place for smoke; with `lists_objects` a line with the name of each object. Throws Error.
Summary scene_summary(const std::filesystem::path& path, bool lists_objects, Outputs& outputs);

/// A timeline: its events and, if its files exist, grid, doors and what happens to each smoke; otherwise a
/// warning or, with `check`, an Error (bad_input).
Summary timeline_summary(const std::filesystem::path& path, bool check, Outputs& outputs);

/// The grids of a volume file. Throws Error.
Summary volume_summary(const std::filesystem::path& path, Outputs& outputs);

}  // namespace brume::cli
