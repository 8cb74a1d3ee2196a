// The smoke that remains after a blast, in double precision (docs/how/simulation.md): a front runs
// outward, clears everything behind it quickly, and the smoke refills from the rim first.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/events.hpp"

namespace brume::reference {

inline double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// Remaining density, of 255, at a distance [m] from a blast in the open, `age` seconds after it.
inline double blast_left(const sim::Blast& blast, double distance, double age) {
  const double radius = blast.radius / 1024.0, share = distance / radius;
  if (share > 1.2) return 255;  // the effect fades over a fifth of the radius more
  const double since = age - distance / (blast.speed / 1024.0);
  const double refill = std::lerp(blast.refill_middle_ms, blast.refill_rim_ms, std::min(share, 1.0)) / 1000;
  double cleared = smooth(since / 0.05);
  if (since > 0.05) cleared = 1 - std::pow(smooth((since - 0.05) / refill), 1.8);
  if (share > 1) cleared *= smooth((1.2 - share) / 0.2);
  return 255 - (255.0 - blast.remaining) * cleared;
}

}  // namespace brume::reference
