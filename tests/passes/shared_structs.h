// All structs of shaders/shared, for C++ and GLSL: X(number, Type). SharedStructs.AllAreListed keeps the list complete.
#ifndef BRUME_SHARED_STRUCTS_H
#define BRUME_SHARED_STRUCTS_H
#include "shared/accumulate.h"
#include "shared/average.h"
#include "shared/cloud.h"
#include "shared/dda.h"
#include "shared/debug_view.h"
#include "shared/decal.h"
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
#include "shared/optics.h"
#include "shared/particles.h"
#include "shared/phase.h"
#include "shared/photons.h"
#include "shared/raycast.h"
#include "shared/resolve.h"
#include "shared/scattering.h"
#include "shared/sky_light.h"
#include "shared/slice_texture.h"
#include "shared/smoke_light.h"
#include "shared/smoke_shadow.h"
#include "shared/smoke_volume.h"
#include "shared/solid_volume.h"
#include "shared/spheres.h"
#include "shared/tank.h"
#include "shared/tank_light.h"
#include "shared/ui.h"
#include "shared/upscale.h"
#include "shared/volume.h"
#include "shared/volume_light.h"

// clang-format off
#define FOR_EACH_SHARED_STRUCT(X) \
  X(0, AccumulateParams) \
  X(1, AccumulatedPixel) \
  X(2, BoundaryCell) \
  X(3, BrickLayout) \
  X(4, Camera) \
  X(5, CloudMotion) \
  X(6, CloudParams) \
  X(7, CloudShape) \
  X(8, Dda) \
  X(9, DebugViewParams) \
  X(82, DisplayParams) \
  X(10, DrawConstants) \
  X(11, FrameConstants) \
  X(12, FrameMedia) \
  X(13, Hole) \
  X(14, HoleCellsParams) \
  X(15, HoleClusterLayout) \
  X(16, HoleCounters) \
  X(17, HoleCut) \
  X(18, HoleListsParams) \
  X(19, HoleOpening) \
  X(20, HoleReach) \
  X(21, Impulse) \
  X(22, Light) \
  X(23, LightChange) \
  X(24, LightGather) \
  X(25, ManyFit) \
  X(26, ManyScatterings) \
  X(27, MarchList) \
  X(28, MaterialConstants) \
  X(29, MediaBox) \
  X(30, NoiseAdvectionParams) \
  X(31, NoiseParams) \
  X(32, PackedHole) \
  X(33, PackedReach) \
  X(34, Phase) \
  X(35, RayEnds) \
  X(36, RaycastDraw) \
  X(37, RaycastView) \
  X(38, RaycastVolume) \
  X(39, ShadowDraw) \
  X(40, ShadowRays) \
  X(41, ShadowView) \
  X(42, Sky) \
  X(43, SmokeLightParams) \
  X(44, SmokeLook) \
  X(45, SmokeShadowFace) \
  X(46, SmokeShadowParams) \
  X(47, SolidLayout) \
  X(48, TexelList) \
  X(49, UiConstants) \
  X(50, UiVertex) \
  X(51, UpscaleConstants) \
  X(52, Vertex) \
  X(53, VolumeColors) \
  X(54, VolumeHeat) \
  X(55, VolumeInstance) \
  X(56, VolumeLayout) \
  X(57, VolumeLightParams) \
  X(58, VolumeLook) \
  X(59, VolumeSweep) \
  X(60, VolumeTransfer) \
  X(61, SliceTexture) \
  X(62, Particle) \
  X(63, ParticleList) \
  X(64, ParticleSystem) \
  X(65, Decal) \
  X(66, DecalParams) \
  X(67, VolumeEffect) \
  X(68, AverageConstants) \
  X(69, SphereBrick) \
  X(70, Glass) \
  X(71, TankLight) \
  X(72, TankCamera) \
  X(73, TankAir) \
  X(74, TankConstants) \
  X(75, SphereVoxelsParams) \
  X(76, TankSamples) \
  X(77, LightMap) \
  X(78, TankLightParams) \
  X(79, NearestIds) \
  X(80, Photon) \
  X(81, PhotonGrid)
// clang-format on

#endif
