#include "grids/brv_directory.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "core/checked.hpp"
#include "grids/bytes.hpp"
#include "grids/check.hpp"
#include "grids/metadata.hpp"

namespace brume::grids {
namespace {

using glm::ivec3;

constexpr std::uint64_t kOriginBytes = 12, kChunkBytes = 12, kTileBytes = kOriginBytes + 1;
constexpr std::uint8_t kHalf = 1, kActive = 0x80;

// Origins in units of bricks, axis after axis, each as the difference to the one before: mostly 0 and 1.
template <typename Cube>
void write_origins(ByteWriter& out, const std::vector<Cube>& cubes) {
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t last = 0;
    for (const Cube& cube : cubes) {
      const auto at = static_cast<std::uint32_t>(cube.origin[axis] / kBrickEdge);
      out.number(at - last);
      last = at;
    }
  }
}

// False where one does not fit into an index.
template <typename Cube>
bool read_origins(ByteReader& in, std::vector<Cube>& cubes) {
  constexpr std::int32_t kMost = INT32_MAX / kBrickEdge, kLeast = INT32_MIN / kBrickEdge;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t last = 0;
    for (Cube& cube : cubes) {
      last += in.number<std::uint32_t>();
      const auto at = static_cast<std::int32_t>(last);
      if (at < kLeast || at > kMost) return false;
      cube.origin[axis] = at * kBrickEdge;
    }
  }
  return true;
}

void write_value(ByteWriter& out, ValueType type, const Value& value) {
  out.raw(std::span(value).first(bytes_of(type)));
}

Value read_value(ByteReader& in, ValueType type) {
  Value value{};
  const auto bytes = in.raw(bytes_of(type));
  std::copy(bytes.begin(), bytes.end(), value.begin());
  return value;
}

void write_grid(ByteWriter& out, const BrvGrid& entry) {
  const Grid& grid = entry.grid;
  out.text(grid.name);
  out.number(static_cast<std::uint8_t>(grid.type));
  out.number(static_cast<std::uint8_t>(grid.grid_class));
  out.number(static_cast<std::uint8_t>(grid.saved_as_half ? kHalf : 0));
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) out.number(grid.world_from_index[column][row]);
  write_value(out, grid.type, grid.background);
  write_metadata(out, grid.metadata);
  out.number(std::uint64_t{grid.bricks.size()});
  out.number(entry.bricks_per_chunk);
  out.number(std::uint64_t{grid.tiles.size()});
  write_origins(out, grid.bricks);
  for (const BrvChunk& chunk : entry.chunks) out.number(chunk.stored_bytes);
  for (const BrvChunk& chunk : entry.chunks) out.number(chunk.checksum);
  write_origins(out, grid.tiles);
  for (const Tile& tile : grid.tiles)
    out.number(static_cast<std::uint8_t>(std::countr_zero(tile.edge) | (tile.active ? kActive : 0)));
  for (const Tile& tile : grid.tiles) write_value(out, grid.type, tile.value);
}

Result<void> read_head(ByteReader& in, Grid& grid) {
  grid.name = in.text();
  const auto type = in.number<std::uint8_t>(), grid_class = in.number<std::uint8_t>(),
             flags = in.number<std::uint8_t>();
  if (type < 1 || type > static_cast<std::uint8_t>(ValueType::vec3i))
    return damaged_brv("a type that is not one");
  if (grid_class > static_cast<std::uint8_t>(GridClass::staggered) || flags > kHalf)
    return damaged_brv("a class or flag that is not one");
  grid.type = static_cast<ValueType>(type);
  grid.grid_class = static_cast<GridClass>(grid_class);
  grid.saved_as_half = flags == kHalf;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) grid.world_from_index[column][row] = in.number<double>();
  grid.background = read_value(in, grid.type);
  grid.metadata = read_metadata(in);
  return {};
}

struct Counts {
  std::uint64_t bricks = 0, chunks = 0, tiles = 0;
};

// What the grid takes, unless it is more than its file holds or the limits allow.
Result<Counts> read_counts(ByteReader& in, BrvGrid& entry, std::uint64_t& memory, const GridLimits& limits) {
  Counts counts;
  counts.bricks = in.number<std::uint64_t>();
  entry.bricks_per_chunk = in.number<std::uint32_t>();
  counts.tiles = in.number<std::uint64_t>();
  if (!in.ok()) return damaged_brv("it is truncated");
  if (entry.bricks_per_chunk < 1 || entry.bricks_per_chunk > kMaxBricksPerChunk)
    return damaged_brv(std::to_string(entry.bricks_per_chunk) + " bricks per chunk");
  counts.chunks =
      counts.bricks / entry.bricks_per_chunk + (counts.bricks % entry.bricks_per_chunk != 0 ? 1 : 0);
  const std::size_t value = bytes_of(entry.grid.type);
  const auto bricks = checked_mul(counts.bricks, kOriginBytes),
             chunks = checked_mul(counts.chunks, kChunkBytes),
             tiles = checked_mul(counts.tiles, kTileBytes + value);
  const auto some = bricks && chunks ? checked_add(*bricks, *chunks) : std::nullopt;
  const auto all = some && tiles ? checked_add(*some, *tiles) : std::nullopt;
  if (!all || *all > in.remaining()) return damaged_brv("its counts are larger than the file");
  // No overflow: the counts are smaller than the directory.
  memory += counts.bricks * (sizeof(Brick) + kBrickVoxels * value) + counts.tiles * sizeof(Tile);
  if (auto fits = check_memory(memory, limits); !fits) return fits.failure();
  return counts;
}

Result<void> read_grid(ByteReader& in, BrvGrid& entry, std::uint64_t& memory, std::uint64_t& next_chunk,
                       const GridLimits& limits) {
  Grid& grid = entry.grid;
  if (auto head = read_head(in, grid); !head) return head;
  const auto counts = read_counts(in, entry, memory, limits);
  if (!counts) return counts.failure();

  // Bricks and where their chunks are.
  grid.bricks.resize(static_cast<std::size_t>(counts->bricks));
  if (!read_origins(in, grid.bricks)) return damaged_brv("a brick lies outside of index space");
  entry.chunks.resize(static_cast<std::size_t>(counts->chunks));
  for (BrvChunk& chunk : entry.chunks) {
    chunk.offset = next_chunk;
    chunk.stored_bytes = in.number<std::uint32_t>();
    next_chunk += chunk.stored_bytes;
  }
  for (BrvChunk& chunk : entry.chunks) chunk.checksum = in.number<std::uint64_t>();

  // Tiles.
  grid.tiles.resize(static_cast<std::size_t>(counts->tiles));
  if (!read_origins(in, grid.tiles)) return damaged_brv("a tile lies outside of index space");
  for (Tile& tile : grid.tiles) {
    const auto code = in.number<std::uint8_t>();
    tile.edge = 1u << (code & 31);
    tile.active = (code & kActive) != 0;
    if ((code & ~kActive) > 31) return damaged_brv("a tile of an edge that is not one");
  }
  for (Tile& tile : grid.tiles) tile.value = read_value(in, grid.type);
  if (!in.ok()) return damaged_brv("its directory is truncated");
  if (auto layout = check_layout(grid); !layout) return damaged_brv(layout.failure().message);
  return check_active(grid, limits);
}

}  // namespace

Failure damaged_brv(const std::string& what) {
  return {ErrorCode::bad_input, "a damaged .brv file: " + what};
}

std::size_t raw_brick_bytes(ValueType type) {
  return sizeof(Brick::active) + kBrickVoxels * bytes_of(type);
}

std::vector<std::byte> encode_brv_directory(const BrvDirectory& directory) {
  ByteWriter out;
  write_metadata(out, directory.metadata);
  out.number(static_cast<std::uint32_t>(directory.grids.size()));
  for (const BrvGrid& grid : directory.grids) write_grid(out, grid);
  return out.bytes();
}

Result<BrvDirectory> decode_brv_directory(std::span<const std::byte> bytes, std::uint64_t chunks_begin,
                                          std::uint64_t chunks_end, const GridLimits& limits) {
  ByteReader in(bytes);
  BrvDirectory directory;
  directory.metadata = read_metadata(in);
  const auto grids = in.number<std::uint32_t>();
  std::uint64_t memory = 0, next_chunk = chunks_begin;
  for (std::uint32_t i = 0; i < grids && in.ok(); ++i) {
    BrvGrid& grid = directory.grids.emplace_back();
    if (auto read = read_grid(in, grid, memory, next_chunk, limits); !read) return read.failure();
  }
  if (!in.ok() || in.remaining() != 0) return damaged_brv("its directory is truncated or too long");
  if (next_chunk != chunks_end) return damaged_brv("its chunks do not fill the space before the directory");
  return directory;
}

}  // namespace brume::grids
