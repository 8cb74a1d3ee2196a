// The floating-point environment that results depend on: rounding to nearest, denormals kept, no traps. Hosts
// may have others in their threads.
#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace brume::api {

#if defined(__x86_64__)

/// While it lives, the thread and those that it starts have the default environment.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() : before_(_mm_getcsr()) {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(kDefault);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  ~DefaultFloatingPoint() {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(before_);
  }

 private:
  // Of MXCSR: exceptions that occurred; all exceptions masked, the rest 0.
  static constexpr unsigned kFlags = 0x3f, kDefault = 0x1f80;
  unsigned before_;
};

#else

class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  ~DefaultFloatingPoint() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_;
};

#endif

}  // namespace brume::api
