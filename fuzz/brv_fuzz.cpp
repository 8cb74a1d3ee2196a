// An arbitrary `.brv` file is rejected or gives valid grids. The bytes are also tried as a directory and
// chunks with right checksums: their length is in the first two bytes.
#include <cstdint>

#include "core/tasks.hpp"
#include "fuzz/brv_checks.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  brume::set_thread_count(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace brume::grids;
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  check_brv(bytes);
  if (size < 2) return 0;
  const std::size_t length = std::min<std::size_t>(data[0] + 256u * data[1], size - 2);
  const auto directory = bytes.subspan(2, length);
  check_brv(forge_brv({directory.begin(), directory.end()}, bytes.subspan(2 + length)));
  return 0;
}
