// All structs of shaders/shared, for C++ and GLSL: X(number, Type). SharedStructs.AllAreListed keeps the list complete.
#ifndef BRUME_SHARED_STRUCTS_H
#define BRUME_SHARED_STRUCTS_H
#include "shared/accumulate.h"
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
#include "shared/volume_light.h"

// clang-format off
#define FOR_EACH_SHARED_STRUCT(X) \
  X(0, AccumulateParams)   \
  X(1, AccumulatedPixel)   \
  X(2, BoundaryCell)       \
  X(3, BrickLayout)        \
  X(4, Camera)             \
  X(5, CloudMotion)        \
  X(6, Dda)                \
  X(7, DebugViewParams)    \
  X(8, DrawConstants)      \
  X(9, FrameConstants)     \
  X(10, FrameMedia)        \
  X(11, Hole)              \
  X(12, HoleCellsParams)   \
  X(13, HoleClusterLayout) \
  X(14, HoleCounters)      \
  X(15, HoleCut)           \
  X(16, HoleListsParams)   \
  X(17, HoleOpening)       \
  X(18, HoleReach)         \
  X(19, Impulse)           \
  X(20, Light)             \
  X(21, LightChange)       \
  X(22, LightGather)       \
  X(23, ManyFit)           \
  X(24, ManyScatterings)   \
  X(25, MarchList)         \
  X(26, MaterialConstants) \
  X(27, NoiseAdvectionParams) \
  X(28, NoiseParams)       \
  X(29, PackedHole)        \
  X(30, PackedReach)       \
  X(31, Phase)             \
  X(32, RayEnds)           \
  X(33, ShadowDraw)        \
  X(34, ShadowRays)        \
  X(35, ShadowView)        \
  X(36, Sky)               \
  X(37, SmokeLightParams)  \
  X(38, SmokeLook)         \
  X(39, SmokeShadowFace)   \
  X(40, SmokeShadowParams) \
  X(41, SolidLayout)       \
  X(42, TexelList)         \
  X(43, UiConstants)       \
  X(44, UiVertex)          \
  X(45, UpscaleConstants)  \
  X(46, Vertex)            \
  X(47, VolumeHeat)        \
  X(48, VolumeInstance)    \
  X(49, VolumeLayout)      \
  X(50, VolumeLightParams) \
  X(51, VolumeLook)        \
  X(52, VolumeSweep)
// clang-format on

#endif
