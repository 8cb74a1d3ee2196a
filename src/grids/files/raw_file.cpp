#include "grids/files/raw_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/checked.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"
#include "grids/check.hpp"
#include "grids/files/json.hpp"
#include "grids/suffix.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;
using glm::i64vec3;
using glm::ivec3;

constexpr const char* kArrayFormat = "brume raw volume";
constexpr int kArrayVersion = 1;
constexpr int kFarthest =
    1 << 29;  // Farthest coordinate of an origin; the end of an array then fits an index.
constexpr std::array kClasses{"unknown", "level set", "fog volume", "staggered"};

/// Contents of a description.
struct ArrayDescription {
  std::string raw, name = "density";
  GridClass grid_class = GridClass::unknown;
  ivec3 size{0}, origin{0};
  float background = 0;
  glm::dmat4 world_from_index{1};
};

// False unless the value is what the key takes.
bool set_member(ArrayDescription& to, const std::string& key, const Json& value) {
  if (key == "format") return value == kArrayFormat;
  if (key == "version") return value == kArrayVersion;
  if (key == "type") return value == "float32";
  if (key == "raw" || key == "name") {
    if (!value.is_string()) return false;
    (key == "raw" ? to.raw : to.name) = value.get<std::string>();
    // In the same folder: a description may come from elsewhere.
    return key == "name" || (!to.raw.empty() && to_path(to.raw).filename() == to_path(to.raw));
  }
  if (key == "class") {
    const auto found = std::find(kClasses.begin(), kClasses.end(), value);
    if (found == kClasses.end()) return false;
    to.grid_class = static_cast<GridClass>(found - kClasses.begin());
    return true;
  }
  if (key == "size" || key == "origin") {
    const bool is_size = key == "size";
    const auto v = to_integers(value, is_size ? 1 : -kFarthest, is_size ? 2 * kFarthest : kFarthest);
    if (v) (is_size ? to.size : to.origin) = *v;
    return v.has_value();
  }
  if (key == "background") {
    if (value.is_number()) to.background = value.get<float>();
    return value.is_number() && std::isfinite(to.background);
  }
  if (key == "world_from_index") {
    const auto m = to_transform(value);
    if (m) to.world_from_index = *m;
    return m.has_value();
  }
  return false;
}

Result<ArrayDescription> read_description(const fs::path& path) {
  const auto json = read_json_object(path);
  if (!json) return json.failure();
  if (!json->contains("format")) return bad_description(path, "describes no volume: \"format\" is missing");
  if (const Json& format = json->at("format"); format.is_string() && format != kArrayFormat)
    return bad_description(path, "describes no volume, but a file of the format " + format.dump());
  ArrayDescription description;
  for (const auto& [key, value] : json->items())
    if (!set_member(description, key, value))
      return bad_description(path, "\"" + key + "\" is unknown or has a wrong value");
  for (const char* key : {"version", "raw", "size"})
    if (!json->contains(key)) return bad_description(path, std::string("\"") + key + "\" is missing");
  return description;
}

std::size_t index_in(const ArrayDescription& d, ivec3 at) {
  const glm::u64vec3 p(at), n(d.size);
  return static_cast<std::size_t>(p.x + n.x * (p.y + n.y * p.z));
}

float float_at(std::span<const std::byte> bytes, std::size_t index) {
  float value;
  std::memcpy(&value, &bytes[4 * index], sizeof value);
  return value;
}

bool same_bits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// The brick at an index, unless all of its voxels are background.
void add_brick(Grid& grid, const ArrayDescription& d, std::span<const std::byte> array, ivec3 origin) {
  Brick brick{origin};
  std::array<float, kBrickVoxels> values;
  values.fill(d.background);
  bool any = false;
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const auto v = static_cast<int>(voxel);
    const ivec3 at = origin + ivec3(v % 8, v / 8 % 8, v / 64) - d.origin;
    if (glm::any(glm::lessThan(at, ivec3(0))) || glm::any(glm::greaterThanEqual(at, d.size))) continue;
    values[voxel] = float_at(array, index_in(d, at));
    if (same_bits(values[voxel], d.background)) continue;
    brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    any = true;
  }
  if (!any) return;
  grid.bricks.push_back(brick);
  const auto bytes = std::as_bytes(std::span(values));
  grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
}

// The bytes of an array; nothing when 64 bits cannot hold them.
std::optional<std::uint64_t> array_bytes(i64vec3 size) {
  const auto voxels = checked_mul(static_cast<std::uint64_t>(size.x), static_cast<std::uint64_t>(size.y),
                                  static_cast<std::uint64_t>(size.z));
  return voxels ? checked_mul(*voxels, sizeof(float)) : std::nullopt;
}

// Copies the part of a cube that lies in the array, value by value.
template <typename ValueAt>
void paste(std::vector<float>& array, const ArrayDescription& d, ivec3 origin, int edge,
           const ValueAt& value_at) {
  const i64vec3 low = i64vec3(origin) - i64vec3(d.origin);
  const i64vec3 from = glm::max(low, i64vec3(0)), to = glm::min(low + i64vec3(edge), i64vec3(d.size));
  for (std::int64_t z = from.z; z < to.z; ++z)
    for (std::int64_t y = from.y; y < to.y; ++y)
      for (std::int64_t x = from.x; x < to.x; ++x)
        array[index_in(d, ivec3(x, y, z))] = value_at(ivec3(i64vec3(x, y, z) - low));
}

std::vector<float> dense(const Grid& grid, const ArrayDescription& d) {
  std::vector<float> array(index_in(d, d.size - 1) + 1, d.background);
  for (const Tile& tile : grid.tiles)
    paste(array, d, tile.origin, static_cast<int>(tile.edge), [&](ivec3) { return float_at(tile.value, 0); });
  for (std::size_t i = 0; i < grid.bricks.size(); ++i)
    paste(array, d, grid.bricks[i].origin, kBrickEdge, [&](ivec3 at) {
      return float_at(grid.values_of(i), static_cast<std::size_t>(at.x + 8 * (at.y + 8 * at.z)));
    });
  return array;
}

std::string to_text(const ArrayDescription& d) {
  const Json json{{"format", kArrayFormat},
                  {"version", kArrayVersion},
                  {"raw", d.raw},
                  {"type", "float32"},
                  {"name", d.name},
                  {"class", kClasses.at(static_cast<std::size_t>(d.grid_class))},
                  {"size", {d.size.x, d.size.y, d.size.z}},
                  {"origin", {d.origin.x, d.origin.y, d.origin.z}},
                  {"background", d.background},
                  {"world_from_index", to_json(d.world_from_index)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

fs::path raw_path_of(const fs::path& json) {
  fs::path path = json;
  return path.replace_extension(".raw");
}

bool is_raw_description(const fs::path& path) {
  return lower_suffix(path) == ".json";
}

Result<fs::path> read_raw_path(const fs::path& json) {
  const auto description = read_description(json);
  if (!description) return description.failure();
  return json.parent_path() / to_path(description->raw);
}

Result<GridFile> load_raw(const fs::path& json, const GridLimits& limits) {
  const auto d = read_description(json);
  if (!d) return d.failure();

  // The array, of exactly this length.
  const auto length = array_bytes(i64vec3(d->size));
  if (!length || *length > limits.bytes)
    return Failure{ErrorCode::resource_limit, json.string() + ": its array is larger than the limit of " +
                                                  std::to_string(limits.bytes >> 20) + " MiB"};
  const fs::path raw = json.parent_path() / to_path(d->raw);
  const auto array = read_file(raw, limits.bytes);
  if (!array) return array.failure();
  if (array->size() != *length)
    return bad_description(raw, "has " + std::to_string(array->size()) + " bytes; " + json.string() +
                                    " describes " + std::to_string(*length));

  // Bricks.
  GridFile file;
  Grid& grid = file.grids.emplace_back();
  grid.name = d->name;
  grid.grid_class = d->grid_class;
  grid.world_from_index = d->world_from_index;
  std::memcpy(grid.background.data(), &d->background, sizeof d->background);
  const ivec3 low = d->origin & ~(kBrickEdge - 1), end = d->origin + d->size;
  for (int z = low.z; z < end.z; z += kBrickEdge)
    for (int y = low.y; y < end.y; y += kBrickEdge) {
      for (int x = low.x; x < end.x; x += kBrickEdge) add_brick(grid, *d, *array, {x, y, z});
      // Bricks of a thin array take more than the array.
      if (auto fits = check_memory(memory_of(grid), limits); !fits)
        return Failure{fits.failure().code, json.string() + ": " + fits.failure().message};
    }
  if (auto valid = check_grid(grid); !valid) return bad_description(json, valid.failure().message);
  return file;
}

Result<void> save_raw(const fs::path& json, const Grid& grid, const GridLimits& limits) {
  if (grid.type != ValueType::float32)
    return bad_description(
        json, "grid \"" + grid.name + "\" is " + name_of(grid.type) + "; a raw file holds float32");
  // An array holds the whole box around the active voxels, however few there are.
  const Box<double> bounds = active_bounds(grid);
  if (bounds.low.x > bounds.high.x)
    return bad_description(json, "grid \"" + grid.name + "\" has no active voxels");
  const i64vec3 low(bounds.low + 0.5), size = i64vec3(bounds.high + 0.5) - low;
  const auto length = array_bytes(size);
  if (!length || *length > limits.bytes)
    return Failure{ErrorCode::resource_limit,
                   json.string() + ": the box around the active voxels of grid \"" + grid.name +
                       "\" is larger than the limit of " + std::to_string(limits.bytes >> 20) +
                       " MiB; write a .brv or .vdb file"};
  // Write the array before its description: a description alone would describe nothing.
  ArrayDescription d;
  const fs::path raw = raw_path_of(json);
  d.raw = raw.filename().string();
  d.name = grid.name;
  d.grid_class = grid.grid_class;
  d.size = ivec3(size);
  d.origin = ivec3(low);
  d.background = float_at(grid.background, 0);
  d.world_from_index = grid.world_from_index;
  const std::vector<float> array = dense(grid, d);
  if (auto written = write_file_atomic(raw, std::as_bytes(std::span(array))); !written) return written;
  return write_file_atomic(json, to_text(d));
}

}  // namespace brume::grids
