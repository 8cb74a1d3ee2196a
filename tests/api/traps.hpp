// Traps for floating-point numbers: they end a program that computes what is not exact.
#pragma once

#if defined(_WIN32)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace brume::api {

#if defined(_WIN32)
inline constexpr unsigned kNoTraps = _MM_MASK_INEXACT | _MM_MASK_UNDERFLOW;

/// Nearly every operation of this thread then traps.
inline void set_traps() {
  _mm_setcsr(_mm_getcsr() & ~kNoTraps);
}
inline bool has_traps() {
  return (_mm_getcsr() & kNoTraps) == 0;
}
#else
inline constexpr int kTraps = FE_INEXACT | FE_UNDERFLOW;

/// Nearly every operation of this thread then traps.
inline void set_traps() {
  ::feenableexcept(kTraps);
}
inline bool has_traps() {
  return ::fegetexcept() == kTraps;
}
#endif

}  // namespace brume::api
