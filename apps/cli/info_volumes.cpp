#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "apps/cli/atlas_options.hpp"
#include "apps/cli/info.hpp"
#include "apps/cli/volumes.hpp"
#include "grids/files/cut_sides.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/grid.hpp"
#include "grids/metadata.hpp"
#include "volumes/volume_frame.hpp"

namespace brume::cli {
namespace {

using grids::Grid;
using grids::kBrickVoxels;
using grids::ValueType;

constexpr std::size_t kBins = 16;

/// The distribution of the values of a grid's active voxels; of vectors, of their lengths.
struct Values {
  bool any = false;       ///< Whether one is a number.
  std::uint64_t odd = 0;  ///< Voxels that are NaN, infinite or beyond 1e30.
  double low = 0, high = 0;
  std::array<std::uint64_t, kBins> histogram{};  ///< Voxels in equal parts of [low, high].
};

// As grids::BrickVolume::odd.
bool is_odd(double value) {
  return !(std::abs(value) <= 1e30);
}

Values values_of(const Grid& grid) {
  Values values{
      false, 0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), {}};
  for_each_active(grid, [&](const grids::ActiveValue& active) {
    const double value = grids::to_number(grid.type, active.value);
    if (is_odd(value)) {
      values.odd += active.count();
      return;
    }
    values.any = true;
    values.low = std::min(values.low, value);
    values.high = std::max(values.high, value);
  });
  if (!values.any) return values;
  const double range = values.high - values.low;
  for_each_active(grid, [&](const grids::ActiveValue& active) {
    const double value = grids::to_number(grid.type, active.value);
    if (is_odd(value)) return;
    const double part = range > 0 ? (value - values.low) / range * kBins : 0;
    values.histogram[std::min(static_cast<std::size_t>(part), kBins - 1)] += active.count();
  });
  return values;
}

// One character per bin, as dark as it is full.
std::string histogram_text(const Values& values) {
  constexpr std::string_view kShades = " .:-=+*#%@";
  const std::uint64_t most = *std::max_element(values.histogram.begin(), values.histogram.end());
  std::string text;
  for (const std::uint64_t count : values.histogram) {
    const double part = static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(most, 1));
    // What is not empty is visible.
    const auto shade = static_cast<std::size_t>(std::ceil(part * static_cast<double>(kShades.size() - 1)));
    text += kShades[shade];
  }
  return "[" + text + "]";
}

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string vector_text(const glm::dvec3& v) {
  return format("%.6g", v.x) + "," + format("%.6g", v.y) + "," + format("%.6g", v.z);
}

Json vector_json(const glm::dvec3& v) {
  return Json::list({v.x, v.y, v.z});
}

Json box_json(const Box<double>& box) {
  return Json{{"min", vector_json(box.low)}, {"max", vector_json(box.high)}};
}

std::string box_text(const Box<double>& box) {
  return vector_text(box.low) + " to " + vector_text(box.high);
}

// Around the corners of a box in index space.
Box<double> in_world(const Grid& grid, const Box<double>& box) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box<double> world{glm::dvec3(kFar), glm::dvec3(-kFar)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                        corner & 4 ? box.high.z : box.low.z);
    const glm::dvec3 p(grid.world_from_index * glm::dvec4(at, 1));
    world.low = glm::min(world.low, p);
    world.high = glm::max(world.high, p);
  }
  return world;
}

Json metadata_json(const std::vector<grids::Metadata>& metadata) {
  Json json = Json::object();
  for (const grids::Metadata& entry : metadata) json.set(entry.name, to_text(entry));
  return json;
}

Json transform_json(const Grid& grid) {
  Json columns = Json::list({});
  for (int column = 0; column < 4; ++column)
    columns.push_back(vector_json(glm::dvec3(grid.world_from_index[column])));
  return columns;
}

glm::dvec3 voxel_size(const Grid& grid) {
  const glm::dmat3 axes(grid.world_from_index);
  return {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
}

/// The layout of a slice atlas; nullopt: another kind of volume.
std::optional<grids::SliceLayout> atlas_layout(const std::filesystem::path& path) {
  const std::vector<std::filesystem::path> files = grids::files_of(path).value_or_throw();
  if (files.front().extension() != ".json") return std::nullopt;
  return grids::read_slice_layout(files.front()).value_or_throw();
}

/// The axis of the world, with its sign, that a side in index space faces most: "+y".
std::string side_name(const Grid& grid, std::size_t side) {
  const glm::dvec3 out =
      (side % 2 == 0 ? -1.0 : 1.0) * glm::dvec3(grid.world_from_index[static_cast<int>(side / 2)]);
  const glm::dvec3 size = glm::abs(out);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return std::string(out[axis] < 0 ? "-" : "+") + "xyz"[axis];
}

/// Where a density ends abruptly.
std::vector<std::string> cut_at(const Grid& grid) {
  std::vector<std::string> names;
  const bool has_density = grid.type == ValueType::float32 || grid.type == ValueType::float64;
  if (!has_density || is_level_set(grid)) return names;
  const grids::Sides sides = grids::cut_sides(grid);
  for (std::size_t side = 0; side < sides.size(); ++side)
    if (sides[side] >= grids::kCutSide) names.push_back(side_name(grid, side));
  return names;
}

std::string class_text(const Grid& grid) {
  const std::string name = name_of(grid.grid_class);
  const bool is_lost = grid.grid_class == grids::GridClass::unknown && is_level_set(grid);
  return is_lost ? name + " class, taken as a level set by its values" : name;
}

Json add_grid(Summary& summary, const Grid& grid) {
  const std::uint64_t active = count_active(grid);
  const Box<double> bounds = active_bounds(grid);
  const Values values = values_of(grid);

  // As text.
  summary.add_line("", "");
  summary.add_line(printable(grid.name), std::string(name_of(grid.type)) + ", " + class_text(grid) +
                                             (grid.saved_as_half ? ", saved in half precision" : ""));
  summary.add_line("  active", std::to_string(active) + " voxels; " + std::to_string(grid.bricks.size()) +
                                   " bricks, " + std::to_string(grid.tiles.size()) + " tiles");
  if (active > 0) {
    summary.add_line("  index", box_text(bounds));
    summary.add_line("  world", box_text(in_world(grid, bounds)));
  }
  summary.add_line("  voxel size", vector_text(voxel_size(grid)));
  if (values.any)
    summary.add_line("  values", format("%.6g", values.low) + " " + histogram_text(values) + " " +
                                     format("%.6g", values.high));
  if (values.odd > 0)
    summary.add_line("  not finite", std::to_string(values.odd) +
                                         (values.odd == 1 ? " voxel: NaN, infinite or beyond 1e30"
                                                          : " voxels: NaN, infinite or beyond 1e30"));
  const std::vector<std::string> cut = cut_at(grid);
  std::string at;
  for (const std::string& name : cut) at += (at.empty() ? "" : ", ") + name;
  if (!cut.empty()) summary.add_line("  cut off", at + ": ends abruptly there, as at a wall of its domain");
  // Without the statistics of the file, which the lines above give.
  for (const grids::Metadata& entry : grid.metadata)
    if (entry.name.rfind("file_", 0) != 0)
      summary.add_line("  " + printable(entry.name), printable(to_text(entry)));
  summary.add_line("  memory", format("%.1f MiB", static_cast<double>(memory_of(grid)) / (1 << 20)));

  // As JSON.
  Json histogram = Json::list({});
  for (const std::uint64_t count : values.histogram) histogram.push_back(count);
  Json json{{"name", grid.name},
            {"type", name_of(grid.type)},
            {"class", name_of(grid.grid_class)},
            {"saved_as_half", grid.saved_as_half},
            {"active_voxels", active},
            {"bricks", grid.bricks.size()},
            {"tiles", grid.tiles.size()},
            {"index_bounds", active > 0 ? box_json(bounds) : Json(nullptr)},
            {"world_bounds", active > 0 ? box_json(in_world(grid, bounds)) : Json(nullptr)},
            {"voxel_size", vector_json(voxel_size(grid))},
            {"world_from_index", transform_json(grid)},
            {"min", values.any ? Json(values.low) : Json(nullptr)},
            {"max", values.any ? Json(values.high) : Json(nullptr)},
            {"not_finite", values.odd},
            {"cut_sides", cut},
            {"histogram", histogram},
            {"memory_bytes", memory_of(grid)}};
  json.set("metadata", metadata_json(grid.metadata));
  return json;
}

}  // namespace

Summary volume_summary(const std::filesystem::path& path, Outputs& outputs) {
  const grids::GridFile file = load_volumes(path, outputs);
  Summary summary("volumes");
  if (const auto layout = atlas_layout(path)) {
    summary.add("slices", to_text(*layout) + " in " + std::to_string(layout->rows()) +
                              (layout->rows() == 1 ? " row" : " rows") + ", padding " +
                              std::to_string(layout->padding));
    summary.add("axes", grids::to_text(layout->axes),
                grids::to_text(layout->axes) + " (right, down, next tile)");
  }
  Json list = Json::list({});
  for (const Grid& grid : file.grids) list.push_back(add_grid(summary, grid));
  summary.set("grids", list);
  if (const auto shown = volumes::shown_grids(file)) {
    summary.add_line("", "");
    summary.add("shown", *shown);
  }
  summary.set("metadata", metadata_json(file.metadata));
  return summary;
}

}  // namespace brume::cli
