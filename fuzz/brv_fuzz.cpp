// An arbitrary `.brv` file is rejected or gives valid grids.
#include <cstdint>

#include "core/tasks.hpp"
#include "fuzz/brv_checks.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  brume::set_thread_count(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brume::grids::check_brv_input({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
