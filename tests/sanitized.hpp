// Whether the tests run under a sanitizer, where each round of a random test takes about ten times as long.
#pragma once

namespace brume {

/// Tests that repeat one computation do so less often then: they look for accesses, overflows and races that
/// nearly every round would show. The rare results that many rounds find, they look for in the release build.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace brume
