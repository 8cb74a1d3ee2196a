// A replay file from anywhere: refused, or one that plays.
#include "fuzz/wire_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brume::wire::check_replay(std::as_bytes(std::span(data, size)));
  return 0;
}
