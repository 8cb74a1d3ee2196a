// A tank by its painted voxels, with the light that was found for each of them: through lens and glass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/tank_over_air.glsl"
#include "lib/tank_voxels_main.glsl"
