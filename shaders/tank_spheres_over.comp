// As tank_spheres.comp, over the surfaces of a frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/tank_over_surfaces.glsl"
#include "lib/tank_spheres_main.glsl"
