// All structs of shaders/shared, for C++ and GLSL: X(number, Type). SharedStructs.AllAreListed keeps the list complete.
#ifndef BRUME_SHARED_STRUCTS_H
#define BRUME_SHARED_STRUCTS_H
#include "shared/accumulate.h"
#include "shared/cloud.h"
#include "shared/dda.h"
#include "shared/debug_view.h"
#include "shared/display.h"
#include "shared/erosion.h"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/hole.h"
#include "shared/hole_clusters.h"
#include "shared/hole_reach.h"
#include "shared/light.h"
#include "shared/noise.h"
#include "shared/noise_advection.h"
#include "shared/phase.h"
#include "shared/raycast.h"
#include "shared/resolve.h"
#include "shared/scattering.h"
#include "shared/sky_light.h"
#include "shared/smoke_light.h"
#include "shared/smoke_shadow.h"
#include "shared/smoke_volume.h"
#include "shared/solid_volume.h"
#include "shared/ui.h"
#include "shared/upscale.h"
#include "shared/volume.h"

// clang-format off
#define FOR_EACH_SHARED_STRUCT(X) \
  X(0, AccumulateParams)      \
  X(1, AccumulatedPixel)      \
  X(2, BoundaryCell)          \
  X(3, Camera)                \
  X(4, CloudMotion)           \
  X(5, Dda)                   \
  X(6, DebugViewParams)       \
  X(7, DrawConstants)         \
  X(8, FrameConstants)        \
  X(9, Hole)                  \
  X(10, HoleCellsParams)      \
  X(11, HoleClusterLayout)    \
  X(12, HoleCounters)         \
  X(13, HoleCut)              \
  X(14, HoleListsParams)      \
  X(15, HoleOpening)          \
  X(16, HoleReach)            \
  X(17, Impulse)              \
  X(18, Light)                \
  X(19, LightChange)          \
  X(20, LightGather)          \
  X(21, ManyFit)              \
  X(22, ManyScatterings)      \
  X(23, MarchList)            \
  X(24, MaterialConstants)    \
  X(25, NoiseAdvectionParams) \
  X(26, NoiseParams)          \
  X(27, PackedHole)           \
  X(28, PackedReach)          \
  X(29, Phase)                \
  X(30, RayEnds)              \
  X(31, ShadowDraw)           \
  X(32, ShadowRays)           \
  X(33, ShadowView)           \
  X(34, Sky)                  \
  X(35, SmokeLightParams)     \
  X(36, SmokeLook)            \
  X(37, SmokeShadowFace)      \
  X(38, SmokeShadowParams)    \
  X(39, SolidLayout)          \
  X(40, TexelList)            \
  X(41, UiConstants)          \
  X(42, UiVertex)             \
  X(43, Vertex)               \
  X(44, VolumeLayout)         \
  X(45, BrickLayout)          \
  X(46, FrameMedia)           \
  X(47, VolumeInstance)       \
  X(48, VolumeLook)           \
  X(49, UpscaleConstants)     \
  X(50, CloudShape)           \
  X(51, CloudParams)          \
  X(52, RaycastView)          \
  X(53, RaycastVolume)        \
  X(54, RaycastDraw)
// clang-format on

#endif
