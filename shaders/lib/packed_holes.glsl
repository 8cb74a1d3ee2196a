// A hole from its buffer, read in rows of 16 bytes: six loads instead of 24. Signs tell what needs no more rows: the radius
// is negative where the hole opens or closes somewhere, or has a mask; its length where it is round (passes::HoleRows).
// Needs `frame` and `vec4 hole_rows[]`.
#ifndef HOLE_ROWS_GLSL
#define HOLE_ROWS_GLSL
#include "shared/hole_reach.h"

Hole hole_from_rows(uint i) {
  const vec4 a = hole_rows[6u * i], b = hole_rows[6u * i + 1u], c = hole_rows[6u * i + 2u];
  const vec4 d = hole_rows[6u * i + 3u], e = hole_rows[6u * i + 4u], f = hole_rows[6u * i + 5u];
  return Hole(a.xyz, abs(a.w), b.xyz, abs(b.w), c.xyz, c.w, d.xyz, d.w, e.x, e.y, e.z, floatBitsToUint(e.w), f.xy, f.zw);
}

/// Its reach (shared/hole_reach.h), which stand behind all holes.
HoleReach reach_from_rows(uint i) {
  const vec4 a = hole_rows[6u * frame.holes.count + 2u * i], b = hole_rows[6u * frame.holes.count + 2u * i + 1u];
  return HoleReach(a.xyz, a.w, b.xyz, b.w);
}

#endif
