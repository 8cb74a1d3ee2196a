// An arbitrary `.spheres` file is rejected or gives a valid tank.
#include <cstdint>

#include "fuzz/spheres_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brume::spheres::check_tank_input({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
