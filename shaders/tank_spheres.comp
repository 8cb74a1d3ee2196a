// A tank by paths of light: exact spheres, through lens and glass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/tank_over_air.glsl"
#include "lib/tank_spheres_main.glsl"
