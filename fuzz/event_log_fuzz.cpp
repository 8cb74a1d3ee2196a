// An event log from anywhere: refused, or one that a world takes.
#include "fuzz/wire_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brume::wire::check_event_log(std::as_bytes(std::span(data, size)));
  return 0;
}
