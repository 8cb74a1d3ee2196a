// What the viewer draws over a picture.
#ifndef BRUME_UI_H
#define BRUME_UI_H
#include "shared/shim.h"
SHARED_BEGIN

/// A vertex as Dear ImGui lays it out.
struct UiVertex {
  vec2 position;  ///< In the units of the display.
  vec2 uv;        ///< In the font's picture.
  uint colour;    ///< RGBA of 8 bits, sRGB, red lowest.
};
SHARED_SIZE(UiVertex, 20);

/// The display that the positions are in.
struct UiConstants {
  vec2 origin;
  vec2 size;
};
SHARED_SIZE(UiConstants, 16);

SHARED_END
#endif
