// The code of docs/guides/views.md, which converts positions and directions of engines.
#pragma once

#include <brume/brume.h>

// Unreal Engine: centimetres, left-handed; x forward, y right, z up.
static inline brume_point from_unreal(double x, double y, double z) {
  const brume_point p = {(float)(y / 100), (float)(z / 100), (float)(-x / 100)};
  return p;
}
// Unity: metres, left-handed; x right, y up, z forward.
static inline brume_point from_unity(double x, double y, double z) {
  const brume_point p = {(float)x, (float)y, (float)-z};
  return p;
}
// Godot: metres, right-handed; x right, y up, z backward.
static inline brume_point from_godot(double x, double y, double z) {
  const brume_point p = {(float)x, (float)y, (float)z};
  return p;
}
