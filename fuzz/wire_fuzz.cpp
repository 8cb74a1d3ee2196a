// Packets from anywhere to a receiver, in any order.
#include "fuzz/wire_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brume::wire::check_packets(std::as_bytes(std::span(data, size)));
  return 0;
}
