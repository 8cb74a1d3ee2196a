// The same for surfaces that do not glow, into a G-buffer whose emission is black.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/gbuffer_surface.glsl"

void main() {
  write_surface();
}
