// An arbitrary `.vxl` file is rejected or gives a valid grid. The checksum is fixed up, because otherwise
// nothing beyond it would be reached; the bytes are also tried as the payload, compressed into a zstd frame.
#include <zstd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/hash.hpp"
#include "vxl/file.hpp"

namespace {

constexpr std::size_t kVersionAt = 8, kLengthAt = 72, kChecksumBytes = 8;

/// The bytes before the payload: files with roles have counts of them.
std::size_t head_bytes(const std::uint8_t* bytes, std::size_t size) {
  return size > kVersionAt && bytes[kVersionAt] == brume::vxl::kRolesVersion ? 88 : 80;
}

void read(std::vector<std::byte> bytes, std::size_t head) {
  const std::uint64_t length = bytes.size() - head;
  std::memcpy(bytes.data() + kLengthAt, &length, sizeof length);
  const std::uint64_t checksum = brume::hash_bytes(bytes);
  const auto* raw = reinterpret_cast<const std::byte*>(&checksum);
  bytes.insert(bytes.end(), raw, raw + kChecksumBytes);
  const auto contents = brume::vxl::decode(bytes, std::nullopt);
  if (!contents || !*contents) return;
  // Accepted contents must be consistent: written again they are read again.
  const auto again = brume::vxl::decode(brume::vxl::encode(**contents, 1), 1);
  if (!again || !*again || !((*again)->planes == (*contents)->planes)) std::abort();
  const brume::voxel::Solids before((*contents)->grid, (*contents)->roles),
      after((*again)->grid, (*again)->roles);
  if (before.sight.count_solid() != after.sight.count_solid() ||
      before.bodies.count_solid() != after.bodies.count_solid())
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  static_cast<void>(brume::vxl::decode({bytes, size}, std::nullopt));
  const std::size_t head = head_bytes(data, size);
  if (size < head) return 0;
  read({bytes, bytes + size}, head);

  std::vector<std::byte> packed(bytes, bytes + head);
  packed.resize(head + ZSTD_compressBound(size - head));
  const std::size_t got =
      ZSTD_compress(packed.data() + head, packed.size() - head, bytes + head, size - head, 1);
  if (ZSTD_isError(got)) std::abort();
  packed.resize(head + got);
  read(std::move(packed), head);
  return 0;
}
