// What the reader of .brv files guarantees for arbitrary bytes: used by the fuzzer and by the tests.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "grids/brv_file.hpp"
#include "grids/bytes.hpp"
#include "grids/check.hpp"

namespace brume::grids {

/// Small, to keep runs short.
inline constexpr GridLimits kFuzzLimits{.bytes = 1 << 22, .active_voxels = 1ull << 40, .seconds = 1};

/// A file with this directory, not compressed, after these chunks, whose checksums are right: without them,
/// nothing beyond would be reached.
inline std::vector<std::byte> forge_brv(std::vector<std::byte> directory, std::span<const std::byte> chunks) {
  constexpr std::uint64_t kBegin = 16;
  if (auto read = decode_brv_directory(directory, kBegin, kBegin + chunks.size(), kFuzzLimits)) {
    for (BrvGrid& grid : read->grids)
      for (BrvChunk& chunk : grid.chunks)
        chunk.checksum =
            hash_bytes(chunks.subspan(static_cast<std::size_t>(chunk.offset - kBegin), chunk.stored_bytes));
    directory = encode_brv_directory(*read);
  }
  ByteWriter out;
  out.raw(std::as_bytes(std::span("BRUMEBRV", 8)));
  out.number(kBrvVersion);
  out.number(std::uint32_t{0});
  const std::uint64_t header = hash_bytes(out.bytes());
  out.raw(chunks);
  ByteWriter place;
  place.number(kBegin + chunks.size());
  place.number(std::uint64_t{directory.size()});
  place.number(std::uint64_t{directory.size()});
  out.raw(directory);
  out.raw(place.bytes());
  out.number(hash_bytes(place.bytes(), hash_bytes(directory, header)));
  out.raw(std::as_bytes(std::span("BRVINDEX", 8)));
  return out.bytes();
}

/// Reads a file. What is accepted must be valid and within the limits, and gives the same grids when it is
/// written and read again.
inline void check_brv(std::span<const std::byte> bytes) {
  const auto file = decode_brv(bytes, kFuzzLimits);
  if (!file) return;
  std::uint64_t memory = 0;
  for (const Grid& grid : file->grids) {
    const auto valid = check_grid(grid);
    BRUME_ASSERT(valid, valid.failure().message);
    memory += memory_of(grid);
    static_cast<void>(active_bounds(grid));
    BRUME_ASSERT(count_active(grid) <= kFuzzLimits.active_voxels, "active voxels");
  }
  BRUME_ASSERT(memory <= kFuzzLimits.bytes, std::to_string(memory));
  const BrvOptions options{.compression_level = 0};
  const auto again = encode_brv(*file, options);
  BRUME_ASSERT(again, again.failure().message);
  const auto reread = decode_brv(*again, kFuzzLimits);
  BRUME_ASSERT(reread, reread.failure().message);
  BRUME_ASSERT(encode_brv(*reread, options).value_or_throw() == *again, "grids change");
}

/// An input of the fuzzer: as a file, and as a directory and chunks with right checksums, where the first two
/// bytes are the length of the directory.
inline void check_brv_input(std::span<const std::byte> bytes) {
  check_brv(bytes);
  if (bytes.size() < 2) return;
  const std::size_t length =
      std::min(std::to_integer<std::size_t>(bytes[0]) + 256 * std::to_integer<std::size_t>(bytes[1]),
               bytes.size() - 2);
  const auto directory = bytes.subspan(2, length);
  check_brv(forge_brv({directory.begin(), directory.end()}, bytes.subspan(2 + length)));
}

}  // namespace brume::grids
