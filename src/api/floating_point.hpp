// The floating-point environment that results depend on: rounding to nearest, denormals kept, no traps. Hosts
// may have others in their threads.
#pragma once

#include <cfenv>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace brume::api {

/// While it lives, the thread and those that it starts have the default environment.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() : changed_(!is_default()) {
    if (!changed_) return;
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  ~DefaultFloatingPoint() {
    if (changed_) std::fesetenv(&before_);
  }

 private:
  /// Quick to find on x86-64, where to set it takes as long as a short call.
  static bool is_default() {
#if defined(__x86_64__)
    // MXCSR but for the exceptions that occurred, and the control word of the x87 unit (long double).
    unsigned short control = 0;
    asm volatile("fnstcw %0" : "=m"(control));
    return (_mm_getcsr() & ~0x3fu) == 0x1f80u && control == 0x37f;
#else
    return false;
#endif
  }

  bool changed_;
  std::fenv_t before_;
};

}  // namespace brume::api
