// Copies one of each struct that C++ and the shaders share, for tests/passes/shared_test.cpp to inspect and to run.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "probes.h"
#include "shared_structs.h"

layout(local_size_x = 1) in;
#define DECLARE(number, Type) layout(align = 16) Type from##number; layout(align = 16) Type to##number;
layout(scalar, binding = kBindProbeOut) buffer Structs { FOR_EACH_SHARED_STRUCT(DECLARE) };

void main() {
#define COPY(number, Type) to##number = from##number;
  FOR_EACH_SHARED_STRUCT(COPY)
}
