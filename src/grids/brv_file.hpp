// The .brv container of volume grids: zstd chunks with checksums, and a directory that gives random access to
// bricks. docs/reference/formats.md describes every byte.
//
// Files are untrusted: lengths and counts are checked in 64 bits against the file and the limits before
// anything is allocated. The same grids give the same bytes on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "grids/brv_directory.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// The version of the format. Files of any other version are refused.
inline constexpr std::uint32_t kBrvVersion = 1;

struct BrvOptions {
  /// Level of zstd; 0 stores the bytes as they are, for a pipe.
  int compression_level = 3;
  /// 1 to kMaxBricksPerChunk. More compress better, fewer are read faster one by one.
  std::uint32_t bricks_per_chunk = 16;
};

/// Writes a file from front to back, grid after grid: only one must be in memory.
class BrvWriter {
 public:
  using Sink = std::function<Result<void>(std::span<const std::byte>)>;
  /// Passes all bytes to `sink`, in order.
  explicit BrvWriter(Sink sink, const BrvOptions& options = {}) : sink_(std::move(sink)), options_(options) {}

  /// Fails with bad_input as check_grid does, and as the sink.
  Result<void> add(const Grid& grid);
  /// Writes what ends the file.
  Result<void> finish(const std::vector<Metadata>& file_metadata);

 private:
  Result<void> begin();
  Result<void> write(std::span<const std::byte> bytes);

  Sink sink_;
  BrvOptions options_;
  BrvDirectory directory_;
  std::uint64_t written_ = 0;
};

/// The whole file in memory. Fails with bad_input as check_grid does.
Result<std::vector<std::byte>> encode_brv(const GridFile& file, const BrvOptions& options = {});

/// Reads a whole file from memory, over all threads. Fails with bad_input for any damage, resource_limit
/// beyond the limits. With `choice` reads those grids alone; fails as it does.
Result<GridFile> decode_brv(std::span<const std::byte> bytes, const GridLimits& limits = {},
                            const GridChoice& choice = {});

/// Reads the directory of a file, whose chunks read_brv_chunk then reads in any order. Fails as decode_brv.
Result<BrvDirectory> open_brv(std::span<const std::byte> file, const GridLimits& limits = {});

/// Reads chunk `number` of a grid: the active masks of its bricks into `bricks`, brick_count(number) of them,
/// and their values into `values`. Fails with bad_input for any damage. May be called from several threads.
Result<void> read_brv_chunk(std::span<const std::byte> file, const BrvGrid& grid, std::size_t number,
                            std::span<Brick> bricks, std::span<std::byte> values);

}  // namespace brume::grids
