// Copies one of each struct that C++ and the shaders share, for tests/passes/shared_test.cpp to inspect and to run.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "probes.h"
#include "shared_structs.h"

layout(local_size_x = 1) in;
#define DECLARE(number, Type) Type values##number[2];
layout(scalar, binding = kBindProbeOut) buffer Structs { FOR_EACH_SHARED_STRUCT(DECLARE) };

void main() {
#define COPY(number, Type) values##number[1] = values##number[0];
  FOR_EACH_SHARED_STRUCT(COPY)
}
