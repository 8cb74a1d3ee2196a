#include "wire/bytes.hpp"

namespace brume::wire {

void ByteWriter::raw(std::span<const std::byte> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

}  // namespace brume::wire
