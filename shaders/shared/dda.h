// Visits every cell of a regular grid along a ray, one call per step, without branches: after Amanatides & Woo 1987
// ("A Fast Voxel Traversal Algorithm for Ray Tracing").
//
// Plane k of an axis is crossed at t = (k - origin) * inverse: one multiplication of the plane's integer, never a sum
// of steps, so errors do not grow along the ray. A cell is visited when the ray spends a positive length of t in it:
// its last entering plane is crossed before its first leaving one.
// - Where planes of two axes are crossed at the same t (an edge, a corner), both steps are taken at once; cells that
//   the ray only touches are not visited.
// - A ray that runs along a plane, in it, belongs to the cell above the plane: cell i is [i, i + 1) there.
#ifndef BRUME_DDA_H
#define BRUME_DDA_H
#include "shared/shim.h"
SHARED_BEGIN

/// A ray in a box of cells. It has ended when t >= t_end.
struct Dda {
  vec3 origin;    // in units of which a cell edge has `cell_size`
  vec3 inverse;   // 1 / direction, at most 1e30 in size
  ivec3 stride;   // +1 or -1
  ivec3 leaving;  // 1 where the stride is +1: cell + leaving is the plane through which the ray leaves
  ivec3 crossed;  // 1 for the axes of the planes that the last step crossed
  ivec3 cell;     // that contains the ray up to dda_leave
  int cell_size;
  float t;      // where it entered the cell
  float t_end;  // where it leaves the box
};
SHARED_LOCAL(Dda);

/// Where the ray crosses the low planes of a cell.
SHARED_FUNCTION vec3 dda_plane_t(Dda d, ivec3 cell) {
  return (vec3(cell * d.cell_size) - d.origin) * d.inverse;
}

/// Where the ray leaves its cell, per axis.
SHARED_FUNCTION vec3 dda_leave(Dda d) {
  return dda_plane_t(d, d.cell + d.leaving);
}

SHARED_FUNCTION float dda_min(vec3 v) {
  return min(v.x, min(v.y, v.z));
}

SHARED_FUNCTION float dda_max(vec3 v) {
  return max(v.x, max(v.y, v.z));
}

/// 1 / x with a sign for zero, and small enough to multiply without infinities.
SHARED_FUNCTION float dda_inverse(float x) {
  return abs(x) > 1e-30f ? 1.0f / x : (x < 0.0f ? -1e30f : 1e30f);
}

/// Advances to the next cell.
SHARED_FUNCTION Dda dda_step(Dda d) {
  vec3 leave = dda_leave(d);
  d.t = dda_min(leave);
  d.crossed = ivec3(step(leave, vec3(d.t)));
  d.cell += d.stride * d.crossed;
  return d;
}

/// The ray from `origin` along `direction` (any length but 0; finite) for t in [t_begin, t_end), in the box
/// of the cells low .. high - 1, each a cube of edge `cell_size`. Planes and origin within 2^20, else cells
/// of zero length may be visited too. The first cell contains the ray just after it enters the box, or just after
/// t_begin.
SHARED_FUNCTION Dda dda_begin(vec3 origin, vec3 direction, ivec3 low, ivec3 high, int cell_size,
                              float t_begin, float t_end) {
  Dda d;
  d.origin = origin;
  d.inverse = vec3(dda_inverse(direction.x), dda_inverse(direction.y), dda_inverse(direction.z));
  d.leaving = ivec3(step(vec3(0.0f), d.inverse));
  d.stride = 2 * d.leaving - ivec3(1);
  d.cell_size = cell_size;

  // The box: t where the last of the entering planes is crossed, and the first of the leaving ones.
  vec3 at_low = dda_plane_t(d, low), at_high = dda_plane_t(d, high);
  vec3 enter = min(at_low, at_high), leave = max(at_low, at_high);
  d.t = max(t_begin, dda_max(enter));
  d.t_end = min(t_end, dda_min(leave));
  d.crossed = ivec3(step(vec3(d.t), enter));

  // The cell at t: an estimate, corrected along each axis until t lies between its planes.
  d.cell = low;
  if (d.t < d.t_end) {
    vec3 at = floor((origin + direction * d.t) / float(cell_size));
    d.cell = ivec3(clamp(at, vec3(low), vec3(high - ivec3(1))));
    ivec3 ahead = ivec3(1), behind = ivec3(1);
    while (ahead.x + ahead.y + ahead.z > 0) {
      ahead = ivec3(step(dda_leave(d), vec3(d.t)));
      d.cell += d.stride * ahead;
    }
    while (behind.x + behind.y + behind.z > 0) {
      behind = ivec3(1) - ivec3(step(dda_plane_t(d, d.cell + ivec3(1) - d.leaving), vec3(d.t)));
      d.cell -= d.stride * behind;
    }
  }
  return d;
}

SHARED_END
#endif
