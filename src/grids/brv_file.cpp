#include "grids/brv_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/hash.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "grids/bytes.hpp"
#include "grids/check.hpp"

namespace brume::grids {
namespace {

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

constexpr std::array<char, 8> kMagic{'B', 'R', 'U', 'M', 'E', 'B', 'R', 'V'};
constexpr std::array<char, 8> kEndMagic{'B', 'R', 'V', 'I', 'N', 'D', 'E', 'X'};
constexpr std::size_t kHeaderBytes = 16, kTrailerBytes = 40;
/// zstd's densest block expands 4 bytes to 128 KiB.
constexpr std::uint64_t kMaxGrowth = 32768;
/// A directory takes 12 bytes for a brick before compression, and the brick takes a part of its chunk.
constexpr std::uint64_t kDirectoryGrowth = 64, kLeastDirectory = 1 << 20;
constexpr std::size_t kChunksAtOnce = 64;

// Compressed, or as they are where that is no longer.
Bytes pack(View raw, int level) {
  if (level == 0) return {raw.begin(), raw.end()};
  Bytes packed(ZSTD_compressBound(raw.size()));
  const std::size_t length = ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), level);
  if (ZSTD_isError(length))
    throw Error(ErrorCode::internal, std::string("zstd: ") + ZSTD_getErrorName(length));
  if (length >= raw.size()) return {raw.begin(), raw.end()};
  packed.resize(length);
  return packed;
}

// Whether bytes of this length may hold so many.
bool may_unpack(std::uint64_t stored, std::uint64_t raw) {
  return stored <= raw && raw / kMaxGrowth <= stored;
}

bool unpack(View stored, std::span<std::byte> raw) {
  if (stored.size() == raw.size()) {
    std::copy(stored.begin(), stored.end(), raw.begin());
    return true;
  }
  return ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size()) == raw.size();
}

// Bytes of each of the numbers that a value consists of.
std::size_t number_bytes(ValueType type) {
  switch (type) {
    case ValueType::float64:
    case ValueType::int64:
    case ValueType::vec3d:
      return 8;
    case ValueType::boolean:
    case ValueType::mask:
      return 1;
    default:
      return 4;
  }
}

// Byte b of every number, then byte b + 1: the exponents of neighbours are alike, their last bits are not.
void split_bytes(View numbers, std::size_t size, std::span<std::byte> planes) {
  const std::size_t count = numbers.size() / size;
  for (std::size_t b = 0; b < size; ++b)
    for (std::size_t i = 0; i < count; ++i) planes[b * count + i] = numbers[i * size + b];
}

void join_bytes(View planes, std::size_t size, std::span<std::byte> numbers) {
  const std::size_t count = numbers.size() / size;
  for (std::size_t b = 0; b < size; ++b)
    for (std::size_t i = 0; i < count; ++i) numbers[i * size + b] = planes[b * count + i];
}

Bytes encode_chunk(const Grid& grid, std::size_t first, std::size_t count, int level) {
  const std::size_t masks = count * sizeof(Brick::active), brick = kBrickVoxels * bytes_of(grid.type);
  Bytes raw(masks + count * brick);
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&raw[i * sizeof(Brick::active)], grid.bricks[first + i].active.data(), sizeof(Brick::active));
  split_bytes(std::span(grid.values).subspan(first * brick, count * brick), number_bytes(grid.type),
              std::span(raw).subspan(masks));
  return pack(raw, level);
}

std::uint64_t checksum_of(View header, View directory, View place) {
  return hash_bytes(place, hash_bytes(directory, hash_bytes(header)));
}

Bytes header_bytes() {
  ByteWriter out;
  out.raw(std::as_bytes(std::span(kMagic)));
  out.number(kBrvVersion);
  out.number(std::uint32_t{0});
  return out.bytes();
}

bool begins_with(View bytes, std::span<const char> magic) {
  const auto raw = std::as_bytes(magic);
  return bytes.size() >= raw.size() && std::equal(raw.begin(), raw.end(), bytes.begin());
}

// The end of the file: where the directory is.
struct Trailer {
  std::uint64_t offset = 0, stored_bytes = 0, raw_bytes = 0, checksum = 0;
};

Result<Trailer> read_trailer(View file) {
  if (!begins_with(file, kMagic)) return Failure{ErrorCode::bad_input, "not a .brv file"};
  if (file.size() < kHeaderBytes + kTrailerBytes) return damaged_brv("it is truncated");
  ByteReader header(file.subspan(kMagic.size(), 8));
  if (const auto version = header.number<std::uint32_t>(); version != kBrvVersion)
    return Failure{ErrorCode::bad_input, "a .brv file of version " + std::to_string(version) + ", not " +
                                             std::to_string(kBrvVersion)};
  if (header.number<std::uint32_t>() != 0) return damaged_brv("unknown flags");
  const View end = file.last(kTrailerBytes);
  if (!begins_with(end.last(kEndMagic.size()), kEndMagic)) return damaged_brv("it is truncated");
  ByteReader in(end);
  Trailer trailer;
  for (std::uint64_t* field : {&trailer.offset, &trailer.stored_bytes, &trailer.raw_bytes, &trailer.checksum})
    *field = in.number<std::uint64_t>();
  return trailer;
}

void decode_chunks(View file, BrvGrid& entry, std::span<Brick> bricks, std::span<std::byte> values,
                   const GridLimits& limits, std::optional<Failure>& failure) {
  std::mutex mutex;
  const std::size_t brick = kBrickVoxels * bytes_of(entry.grid.type);
  Progress job("read", entry.chunks.size());
  parallel_for(entry.chunks.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !limits.is_stopped(); ++i) {
      const std::size_t first = entry.first_brick(i), count = entry.brick_count(i);
      const auto read = read_brv_chunk(file, entry, i, bricks.subspan(first, count),
                                       values.subspan(first * brick, count * brick));
      job.advance();
      if (read) continue;
      const std::lock_guard lock(mutex);
      failure = read.failure();
    }
  });
}

}  // namespace

Result<void> BrvWriter::write(View bytes) {
  written_ += bytes.size();
  return sink_(bytes);
}

Result<void> BrvWriter::begin() {
  return written_ > 0 ? Result<void>() : write(header_bytes());
}

Result<void> BrvWriter::add(const Grid& grid) {
  BRUME_ASSERT(options_.bricks_per_chunk >= 1 && options_.bricks_per_chunk <= kMaxBricksPerChunk,
               std::to_string(options_.bricks_per_chunk));
  if (auto valid = check_grid(grid); !valid) return valid;
  if (auto begun = begin(); !begun) return begun;
  BrvGrid& entry = directory_.grids.emplace_back();
  entry.bricks_per_chunk = options_.bricks_per_chunk;

  // Compress some chunks at a time over all threads, and write them in order.
  const std::size_t per_chunk = options_.bricks_per_chunk;
  const std::size_t chunks = (grid.bricks.size() + per_chunk - 1) / per_chunk;
  std::array<Bytes, kChunksAtOnce> packed;
  Progress job("write", chunks);
  for (std::size_t first = 0; first < chunks; first += kChunksAtOnce) {
    const std::size_t count = std::min(kChunksAtOnce, chunks - first);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t brick = (first + i) * per_chunk;
        packed[i] = encode_chunk(grid, brick, std::min(per_chunk, grid.bricks.size() - brick),
                                 options_.compression_level);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      entry.chunks.push_back({written_, static_cast<std::uint32_t>(packed[i].size()), hash_bytes(packed[i])});
      if (auto done = write(packed[i]); !done) return done;
      job.advance();
    }
  }

  // The directory holds the rest.
  Grid& head = entry.grid;
  head.name = grid.name;
  head.type = grid.type;
  head.grid_class = grid.grid_class;
  head.saved_as_half = grid.saved_as_half;
  head.world_from_index = grid.world_from_index;
  head.background = grid.background;
  head.metadata = grid.metadata;
  head.bricks = grid.bricks;
  head.tiles = grid.tiles;
  return {};
}

Result<void> BrvWriter::finish(const std::vector<Metadata>& file_metadata) {
  if (auto begun = begin(); !begun) return begun;
  directory_.metadata = file_metadata;
  const Bytes raw = encode_brv_directory(directory_);
  const Bytes stored = pack(raw, std::max(options_.compression_level, 1));
  ByteWriter trailer;
  trailer.number(written_);
  trailer.number(std::uint64_t{stored.size()});
  trailer.number(std::uint64_t{raw.size()});
  trailer.number(checksum_of(header_bytes(), stored, trailer.bytes()));
  trailer.raw(std::as_bytes(std::span(kEndMagic)));
  if (auto done = write(stored); !done) return done;
  return write(trailer.bytes());
}

Result<std::vector<std::byte>> encode_brv(const GridFile& file, const BrvOptions& options) {
  Bytes bytes;
  BrvWriter writer(
      [&](View more) {
        bytes.insert(bytes.end(), more.begin(), more.end());
        return Result<void>();
      },
      options);
  for (const Grid& grid : file.grids)
    if (auto added = writer.add(grid); !added) return added.failure();
  if (auto finished = writer.finish(file.metadata); !finished) return finished.failure();
  return bytes;
}

Result<BrvDirectory> open_brv(View file, const GridLimits& limits) {
  // Where the directory is.
  const auto trailer = read_trailer(file);
  if (!trailer) return trailer.failure();
  const std::uint64_t end = file.size() - kTrailerBytes;
  if (trailer->offset < kHeaderBytes || trailer->offset > end ||
      trailer->stored_bytes != end - trailer->offset)
    return damaged_brv("its directory lies elsewhere");
  const View stored = file.subspan(static_cast<std::size_t>(trailer->offset),
                                   static_cast<std::size_t>(trailer->stored_bytes));
  const View place = file.subspan(static_cast<std::size_t>(end), 24);
  if (checksum_of(file.first(kHeaderBytes), stored, place) != trailer->checksum)
    return damaged_brv("the checksum of its directory is wrong");

  // The directory.
  if (!may_unpack(stored.size(), trailer->raw_bytes) ||
      trailer->raw_bytes > std::max(kLeastDirectory, kDirectoryGrowth * file.size()))
    return damaged_brv("a directory of an impossible length");
  if (auto fits = check_memory(trailer->raw_bytes, limits); !fits) return fits.failure();
  Bytes raw(static_cast<std::size_t>(trailer->raw_bytes));
  if (!unpack(stored, raw)) return damaged_brv("its directory does not unpack");
  return decode_brv_directory(raw, kHeaderBytes, trailer->offset, limits);
}

Result<void> read_brv_chunk(View file, const BrvGrid& entry, std::size_t number, std::span<Brick> bricks,
                            std::span<std::byte> values) {
  const std::size_t count = entry.brick_count(number), masks = count * sizeof(Brick::active);
  BRUME_ASSERT(bricks.size() == count && masks + values.size() == count * raw_brick_bytes(entry.grid.type),
               std::to_string(number));
  const BrvChunk& chunk = entry.chunks[number];
  const View stored = file.subspan(static_cast<std::size_t>(chunk.offset), chunk.stored_bytes);
  if (hash_bytes(stored) != chunk.checksum) return damaged_brv("the checksum of a chunk is wrong");
  Bytes raw(masks + values.size());
  if (!may_unpack(stored.size(), raw.size()) || !unpack(stored, raw))
    return damaged_brv("a chunk does not unpack");
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(bricks[i].active.data(), &raw[i * sizeof(Brick::active)], sizeof(Brick::active));
  join_bytes(View(raw).subspan(masks), number_bytes(entry.grid.type), values);
  if (entry.grid.type == ValueType::boolean &&
      std::any_of(values.begin(), values.end(), [](std::byte value) { return value > std::byte{1}; }))
    return damaged_brv("a boolean is neither 0 nor 1");
  return {};
}

Result<GridFile> decode_brv(View bytes, const GridLimits& limits, const GridChoice& choice) {
  auto directory = open_brv(bytes, limits);
  if (!directory) return directory.failure();
  if (choice) {
    std::vector<const Grid*> heads;
    for (const BrvGrid& grid : directory->grids) heads.push_back(&grid.grid);
    const auto chosen = choice(heads);
    if (!chosen) return chosen.failure();
    std::vector<BrvGrid> grids;
    for (std::size_t i = 0; i < directory->grids.size(); ++i)
      if (std::ranges::find(*chosen, i) != chosen->end()) grids.push_back(std::move(directory->grids[i]));
    directory->grids = std::move(grids);
  }

  // Every chunk must be able to hold what it claims, before memory is taken for all.
  for (const BrvGrid& grid : directory->grids)
    for (std::size_t i = 0; i < grid.chunks.size(); ++i)
      if (!may_unpack(grid.chunks[i].stored_bytes, grid.brick_count(i) * raw_brick_bytes(grid.grid.type)))
        return damaged_brv("a chunk of an impossible length");

  GridFile file;
  file.metadata = std::move(directory->metadata);
  for (BrvGrid& entry : directory->grids) {
    // Chunks are counted by the bricks of the grid, which stay in place.
    Bytes values(entry.grid.bricks.size() * kBrickVoxels * bytes_of(entry.grid.type));
    std::optional<Failure> failure;
    decode_chunks(bytes, entry, entry.grid.bricks, values, limits, failure);
    if (failure) return *failure;
    if (limits.is_stopped()) return Failure{ErrorCode::internal, "stopped"};
    entry.grid.values = std::move(values);
    if (auto active = check_active(entry.grid, limits); !active) return active.failure();
    file.grids.push_back(std::move(entry.grid));
  }
  return file;
}

}  // namespace brume::grids
