// Overlay of the viewer.
#ifndef BRUME_UI_H
#define BRUME_UI_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindUiVertices, 0u);
SHARED_BINDING(kBindUiFont, 1u);

/// A vertex as Dear ImGui lays it out.
struct UiVertex {
  PackedVec2 position;  ///< In display coordinates.
  PackedVec2 uv;        ///< In the font atlas.
  uint colour;          ///< RGBA of 8 bits, sRGB, red lowest.
};
SHARED_SIZE(UiVertex, 20);

/// The display area that positions refer to.
struct UiConstants {
  vec2 origin;
  vec2 size;
};
SHARED_SIZE(UiConstants, 16);

SHARED_END
#endif
