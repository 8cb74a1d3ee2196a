// Whether a program of tests repeats something as often as it can.
#pragma once

#include <cstdlib>
#include <string_view>

namespace brume {

/// `what`: "faults", "frames" or "calls"; brume_thorough_test (cmake/BrumeTests.cmake) sets it for an entry
/// of CTest that takes minutes.
inline bool is_thorough(std::string_view what) {
  const char* const named = std::getenv("BRUME_THOROUGH");
  return named != nullptr && named == what;
}

}  // namespace brume
