// As march.comp, in frames of several volumes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
const bool kByBlocks = true;
#include "lib/march_main.glsl"
