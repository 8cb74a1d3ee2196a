#include "tests/grids/bombs.hpp"

#include <cstring>
#include <functional>

#include "core/file.hpp"
#include "fuzz/brv_checks.hpp"
#include "grids/brv_file.hpp"
#include "grids/files/grid_files.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMost = UINT64_MAX, kMost32 = UINT32_MAX;

template <typename T>
T number_at(const Bytes& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, &bytes.at(offset), sizeof value);
  return value;
}

template <typename T>
Bytes planted(Bytes bytes, std::size_t offset, T value) {
  std::memcpy(&bytes.at(offset + sizeof value - 1) - (sizeof value - 1), &value, sizeof value);
  return bytes;
}

Bytes saved(const std::string& folder, const std::string& suffix, const Grid& grid) {
  const std::string path = folder + "/base" + suffix;
  save_grid_file(path, {{grid}, sample_metadata()}).value_or_throw();
  return read_file(path).value_or_throw();
}

// Grids of few bytes with more active voxels than the limits allow.
std::vector<std::pair<std::string, Grid>> huge_grids() {
  const Tile tile = huge_tile().tiles[0];
  const auto with_tiles = [&](int edge, int per_axis) {
    Grid grid = huge_tile();
    grid.tiles.clear();
    for (int z = 0; z < per_axis; ++z)
      for (int y = 0; y < per_axis; ++y)
        for (int x = 0; x < per_axis; ++x)
          grid.tiles.push_back(
              {glm::ivec3(x, y, z) * edge, static_cast<std::uint32_t>(edge), true, tile.value});
    return grid;
  };
  Grid corner = huge_tile();
  corner.tiles[0].origin = glm::ivec3(INT32_MAX - 4095);
  return {{"one tile of 69 billion voxels", huge_tile()},
          {"64 tiles of 69 billion voxels", with_tiles(4096, 4)},
          {"a tile in the last corner of index space", corner},
          {"8,000 tiles of two million voxels", with_tiles(128, 20)}};
}

std::vector<Bomb> bombs_of(const std::string& suffix,
                           const std::vector<std::pair<std::string, Bytes>>& list) {
  std::vector<Bomb> bombs;
  for (const auto& [name, bytes] : list) bombs.push_back({suffix + ": " + name, bytes});
  return bombs;
}

/// Reads a .vdb file, and notes where its numbers are.
class Vdb {
 public:
  explicit Vdb(const Bytes& bytes) : bytes_(bytes) {
    next_ = 8;
    version = place(4);
    next_ += 4 + 4 + 1 + 36;  // Of the library; offsets or not; an identifier.
    read_metadata(file_metadata);
    grid_count = place(4);
    unique_name = string();
    grid_type = string();
    instance_parent = string();
    grid_position = place(8), block_position = place(8);
    next_ += 8;  // Its end.
    next_ = number_at<std::uint64_t>(bytes, grid_position);
    compression = place(4);
    read_metadata(grid_metadata);
    map_type = string();
    // The root ends the topology: buffers, background, its entries, and one tile of a place, value and state.
    buffers = number_at<std::uint64_t>(bytes, block_position) - 33;
    tile_count = buffers + 8, child_count = buffers + 12;
  }

  struct MetadataAt {
    std::size_t count, name_length, type_length, value_length;
  };
  std::size_t version, grid_count, unique_name, grid_type, instance_parent, grid_position, block_position,
      compression, map_type, buffers, tile_count, child_count;
  MetadataAt file_metadata, grid_metadata;

 private:
  std::size_t place(std::size_t size) {
    next_ += size;
    return next_ - size;
  }
  // Where its length is.
  std::size_t string() {
    const std::size_t at = place(4);
    next_ += number_at<std::uint32_t>(bytes_, at);
    return at;
  }
  void read_metadata(MetadataAt& to) {
    to.count = place(4);
    for (std::uint32_t i = 0; i < number_at<std::uint32_t>(bytes_, to.count); ++i) {
      const std::size_t name = string(), type = string(), value = string();
      if (i == 0) to.name_length = name, to.type_length = type, to.value_length = value;
    }
  }

  const Bytes& bytes_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<Bomb> vdb_bombs(const std::string& folder) {
  // A tile that is not active: what makes the file a bomb is what is planted.
  Grid grid = huge_tile();
  grid.tiles[0].active = false;
  const Bytes base = saved(folder, ".vdb", grid);
  const Vdb at(base);
  const auto word = [&](std::size_t offset, std::uint64_t value) {
    return planted(base, offset, static_cast<std::uint32_t>(value));
  };
  const auto position = [&](std::size_t offset, std::uint64_t value) { return planted(base, offset, value); };
  std::vector<std::pair<std::string, Bytes>> list{
      {"old version", word(at.version, 1)},
      {"number of metadata", word(at.file_metadata.count, kMost32)},
      {"length of a metadata's name", word(at.file_metadata.name_length, kMost32)},
      {"length of a metadata's type", word(at.file_metadata.type_length, kMost32)},
      {"length of a metadata's value", word(at.file_metadata.value_length, 0x7fffffff)},
      {"number of grids", word(at.grid_count, 0x7fffffff)},
      {"length of a grid's name", word(at.unique_name, kMost32)},
      {"length of a grid's type", word(at.grid_type, 0x7ffffff0)},
      {"length of an instance's name", word(at.instance_parent, kMost32)},
      {"position of a grid", position(at.grid_position, 1ull << 62)},
      {"negative position of a grid", position(at.grid_position, kMost)},
      {"number of a grid's metadata", word(at.grid_metadata.count, kMost32)},
      {"length of a grid's metadata", word(at.grid_metadata.value_length, 0x7fffffff)},
      {"length of a transform's type", word(at.map_type, kMost32)},
      {"number of root tiles", word(at.tile_count, kMost32)},
      {"number of root children", word(at.child_count, kMost32)},
      {"children instead of tiles", planted(word(at.tile_count, 0), at.child_count, std::uint32_t{1})},
  };
  for (const auto& [name, huge] : huge_grids()) list.emplace_back(name, saved(folder, ".vdb", huge));
  return bombs_of("vdb", list);
}

std::vector<Bomb> nvdb_bombs(const std::string& folder) {
  // Without checksum: what lies behind it must not be trusted either.
  constexpr std::size_t kMeta = 16, kGrid = kMeta + 176 + sizeof "density", kTree = kGrid + 672,
                        kRoot = kTree + 64, kTiles = kRoot + 64, kTile = 32;
  Grid grid = octant(smoke_grid("density", 11));
  grid.tiles = huge_tile().tiles;
  grid.tiles[0].active = false;
  grid.tiles[0].origin.x = 4096;  // Behind the entry with the children.
  const Bytes base = planted(saved(folder, ".nvdb", grid), kGrid + 8, kMost);
  const auto word = [&](std::size_t offset, std::uint64_t value) {
    return planted(base, offset, static_cast<std::uint32_t>(value));
  };
  const auto longer = [&](std::size_t offset, std::uint64_t value) { return planted(base, offset, value); };
  const auto half = [&](std::size_t offset, int value) {
    return planted(base, offset, static_cast<std::uint16_t>(value));
  };
  // The children of a lower node are behind its masks.
  const std::size_t lower = kTree + number_at<std::uint64_t>(base, kTree + 8), children = lower + 1088;
  std::size_t child = children;
  while (number_at<std::uint64_t>(base, child) == 0) child += 8;
  std::size_t other = child + 8;
  while (number_at<std::uint64_t>(base, other) == 0) other += 8;
  // Offsets are relative to the node.
  const Bytes shared = longer(other, number_at<std::uint64_t>(base, child));
  std::vector<std::pair<std::string, Bytes>> list{
      {"number of grids", half(12, 65535)},
      {"zip that is none", half(14, 1)},
      {"blosc that is none", half(14, 2)},
      {"compression that is none", half(14, 77)},
      {"size of a grid", longer(kMeta, 1ull << 40)},
      {"size of a grid beyond 63 bits", longer(kMeta, kMost)},
      {"length of a name", word(kMeta + 136, kMost32)},
      {"magic of a grid", longer(kGrid, 0)},
      {"version of a grid", word(kGrid + 16, kMost32)},
      {"size in a grid", longer(kGrid + 32, 1ull << 40)},
      {"place of blind data", longer(kGrid + 640, 1ull << 40)},
      {"number of blind data", word(kGrid + 648, kMost32)},
      {"place of the root", longer(kTree + 24, 1ull << 60)},
      {"place of leaves", longer(kTree, 1ull << 60)},
      {"place of leaves before the grid", longer(kTree, kMost - 1023)},
      {"number of leaves", word(kTree + 32, kMost32)},
      {"number of lower nodes", word(kTree + 36, kMost32)},
      {"number of upper nodes", word(kTree + 40, kMost32)},
      {"a leaf less", word(kTree + 32, number_at<std::uint32_t>(base, kTree + 32) - 1)},
      {"number of root tiles", word(kRoot + 24, kMost32)},
      {"root tile twice", longer(kTiles + kTile, number_at<std::uint64_t>(base, kTiles))},
      {"child of the root before it", longer(kTiles + 8, kMost - 7)},
      {"child of the root far away", longer(kTiles + 8, 1ull << 60)},
      {"child that is another's", shared},
      {"child between nodes", longer(child, number_at<std::uint64_t>(base, child) + 32)},
      {"child that is its parent", longer(child, kMost - 1023)},
  };
  for (const auto& [name, huge] : huge_grids()) list.emplace_back(name, saved(folder, ".nvdb", huge));
  return bombs_of("nvdb", list);
}

std::vector<Bomb> brv_bombs() {
  const Bytes base = encode_brv({{smoke_grid("density", 3)}, {}}).value_or_throw();
  const std::size_t trailer = base.size() - 40;
  // Offsets in a directory with one grid without name and metadata: docs/reference/formats.md.
  BrvDirectory empty;
  empty.grids.emplace_back();
  const Bytes directory = encode_brv_directory(empty);
  const auto forged = [&](std::size_t offset, auto value) {
    return forge_brv(planted(directory, offset, value), {});
  };
  constexpr std::size_t kName = 8, kCounts = 8 + 4 + 3 + 128 + 4 + 4;
  std::vector<std::pair<std::string, Bytes>> list{
      {"place of the directory", planted(base, trailer, std::uint64_t{1} << 63)},
      {"length of the directory", planted(base, trailer + 8, kMost)},
      {"number of metadata", forged(0, std::uint32_t{UINT32_MAX})},
      {"number of grids", forged(4, std::uint32_t{UINT32_MAX})},
      {"length of a name", forged(kName, std::uint32_t{UINT32_MAX})},
      {"number of bricks", forged(kCounts, std::uint64_t{1} << 40)},
      {"number of bricks beyond 64 bits of bytes", forged(kCounts, std::uint64_t{1} << 63)},
      {"no bricks per chunk", forged(kCounts + 8, std::uint32_t{0})},
      {"number of tiles", forged(kCounts + 12, std::uint64_t{1} << 40)},
      {"number of tiles beyond 64 bits of bytes", forged(kCounts + 12, kMost)},
  };
  for (const auto& [name, huge] : huge_grids())
    list.emplace_back(name, encode_brv({{huge}, {}}).value_or_throw());
  return bombs_of("brv", list);
}

}  // namespace brume::grids
