// An arbitrary `.vxl` file is rejected or gives a valid grid. The checksum is fixed up, because otherwise
// nothing beyond it would be reached; the bytes are also tried as the payload, compressed into a zstd frame.
#include <zstd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/hash.hpp"
#include "voxel/vxl_file.hpp"

namespace {

constexpr std::size_t kHeaderBytes = 80, kLengthAt = 72, kChecksumBytes = 8;

void read(std::vector<std::byte> bytes) {
  const std::uint64_t length = bytes.size() - kHeaderBytes;
  std::memcpy(bytes.data() + kLengthAt, &length, sizeof length);
  const std::uint64_t checksum = brume::hash_bytes(bytes);
  const auto* raw = reinterpret_cast<const std::byte*>(&checksum);
  bytes.insert(bytes.end(), raw, raw + kChecksumBytes);
  const auto contents = brume::voxel::decode_vxl(bytes, std::nullopt);
  if (!contents || !*contents) return;
  // Accepted contents must be consistent: written again they are read again.
  const auto again = brume::voxel::decode_vxl(brume::voxel::encode_vxl(**contents, 1), 1);
  if (!again || !*again || !((*again)->planes == (*contents)->planes)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  static_cast<void>(brume::voxel::decode_vxl({bytes, size}, std::nullopt));
  if (size < kHeaderBytes) return 0;
  read({bytes, bytes + size});

  std::vector<std::byte> packed(bytes, bytes + kHeaderBytes);
  packed.resize(kHeaderBytes + ZSTD_compressBound(size - kHeaderBytes));
  const std::size_t got = ZSTD_compress(packed.data() + kHeaderBytes, packed.size() - kHeaderBytes,
                                        bytes + kHeaderBytes, size - kHeaderBytes, 1);
  if (ZSTD_isError(got)) std::abort();
  packed.resize(kHeaderBytes + got);
  read(std::move(packed));
  return 0;
}
