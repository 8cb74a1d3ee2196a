// All structs of shaders/shared, for C++ and GLSL: X(number, Type). SharedStructs.AllAreListed keeps the list complete.
#ifndef BRUME_SHARED_STRUCTS_H
#define BRUME_SHARED_STRUCTS_H
#include "shared/accumulate.h"
#include "shared/antialias.h"
#include "shared/average.h"
#include "shared/cloud.h"
#include "shared/dda.h"
#include "shared/debug_view.h"
#include "shared/decal.h"
#include "shared/display.h"
#include "shared/erosion.h"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/glow_field.h"
#include "shared/hole.h"
#include "shared/hole_clusters.h"
#include "shared/hole_reach.h"
#include "shared/indirect_light.h"
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
#include "shared/smoke_motion.h"
#include "shared/smoke_shadow.h"
#include "shared/smoke_volume.h"
#include "shared/solid_volume.h"
#include "shared/spheres.h"
#include "shared/surface_import.h"
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
  X(10, DisplayParams) \
  X(11, DrawConstants) \
  X(12, FrameConstants) \
  X(13, FrameMedia) \
  X(14, Hole) \
  X(15, HoleCellsParams) \
  X(16, HoleClusterLayout) \
  X(17, HoleCounters) \
  X(18, HoleCut) \
  X(19, HoleListsParams) \
  X(20, HoleOpening) \
  X(21, HoleReach) \
  X(22, Impulse) \
  X(23, Light) \
  X(24, LightChange) \
  X(25, LightGather) \
  X(26, ManyFit) \
  X(27, ManyScatterings) \
  X(28, MarchList) \
  X(29, MaterialConstants) \
  X(30, MediaBox) \
  X(31, NoiseAdvectionParams) \
  X(32, NoiseParams) \
  X(33, PackedHole) \
  X(34, PackedReach) \
  X(35, Phase) \
  X(36, RayEnds) \
  X(37, RaycastDraw) \
  X(38, RaycastView) \
  X(39, RaycastVolume) \
  X(40, ShadowDraw) \
  X(41, ShadowRays) \
  X(42, ShadowView) \
  X(43, Sky) \
  X(44, SmokeLightParams) \
  X(45, SmokeLook) \
  X(46, SmokeShadowFace) \
  X(47, SmokeShadowParams) \
  X(48, SolidLayout) \
  X(49, TexelList) \
  X(50, UiConstants) \
  X(51, UiVertex) \
  X(52, UpscaleConstants) \
  X(53, Vertex) \
  X(54, VolumeColors) \
  X(55, VolumeHeat) \
  X(56, VolumeInstance) \
  X(57, VolumeLayout) \
  X(58, VolumeLightParams) \
  X(59, VolumeLook) \
  X(60, VolumeSweep) \
  X(61, VolumeTransfer) \
  X(62, SliceTexture) \
  X(63, Particle) \
  X(64, ParticleList) \
  X(65, ParticleSystem) \
  X(66, Decal) \
  X(67, DecalParams) \
  X(68, VolumeEffect) \
  X(69, AverageConstants) \
  X(70, SphereBrick) \
  X(71, Glass) \
  X(72, TankLight) \
  X(73, TankCamera) \
  X(74, TankAir) \
  X(75, TankConstants) \
  X(76, SphereVoxelsParams) \
  X(77, TankSamples) \
  X(78, LightMap) \
  X(79, TankLightParams) \
  X(80, NearestIds) \
  X(81, Photon) \
  X(82, PhotonGrid) \
  X(83, IndirectLayout) \
  X(84, SurfacePatch) \
  X(85, IndirectParams) \
  X(86, AntialiasParams) \
  X(87, SurfaceImportParams) \
  X(88, MediaLayerParams) \
  X(89, SurfaceShadowParams) \
  X(90, SurfaceNormalParams) \
  X(91, VolumeDetail) \
  X(92, PaneMaterial) \
  X(93, GlowFieldParams) \
  X(94, GlowCell) \
  X(95, EmitterSample) \
  X(96, EmitterRay) \
  X(97, SmokeMotionParams)
// clang-format on

#endif
