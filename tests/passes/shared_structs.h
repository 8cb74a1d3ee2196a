// All structs of shaders/shared, for C++ and GLSL: X(number, Type). SharedStructs.AllAreListed keeps the list complete.
#ifndef BRUME_SHARED_STRUCTS_H
#define BRUME_SHARED_STRUCTS_H
#include "shared/accumulate.h"
#include "shared/antialias.h"
#include "shared/average.h"
#include "shared/cloud.h"
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
  X(0, Affine) \
  X(1, AccumulateParams) \
  X(2, AccumulatedPixel) \
  X(3, BoundaryCell) \
  X(4, BrickLayout) \
  X(5, Camera) \
  X(6, CloudMotion) \
  X(7, CloudParams) \
  X(8, CloudShape) \
  X(9, DebugViewParams) \
  X(10, DisplayParams) \
  X(11, DrawConstants) \
  X(12, FrameConstants) \
  X(13, FrameMedia) \
  X(14, Hole) \
  X(15, HoleCellsParams) \
  X(16, HoleClusterLayout) \
  X(17, HoleCounters) \
  X(18, HoleListsParams) \
  X(19, HoleReach) \
  X(20, Impulse) \
  X(21, Light) \
  X(22, LightChange) \
  X(23, LightGather) \
  X(24, MarchList) \
  X(25, MaterialConstants) \
  X(26, MediaBox) \
  X(27, NoiseAdvectionParams) \
  X(28, NoiseParams) \
  X(29, PackedHole) \
  X(30, PackedReach) \
  X(31, Phase) \
  X(32, RayEnds) \
  X(33, RaycastDraw) \
  X(34, RaycastView) \
  X(35, RaycastVolume) \
  X(36, ShadowDraw) \
  X(37, ShadowRays) \
  X(38, ShadowView) \
  X(39, Sky) \
  X(40, SmokeLightParams) \
  X(41, SmokeLook) \
  X(42, SmokeShadowFace) \
  X(43, SmokeShadowParams) \
  X(44, SolidLayout) \
  X(45, TexelList) \
  X(46, UiConstants) \
  X(47, UiVertex) \
  X(48, UpscaleConstants) \
  X(49, Vertex) \
  X(50, VolumeInstance) \
  X(51, VolumeLayout) \
  X(52, VolumeLightParams) \
  X(53, VolumeLook) \
  X(54, VolumeSweep) \
  X(55, VolumeTransfer) \
  X(56, SliceTexture) \
  X(57, Particle) \
  X(58, ParticleList) \
  X(59, ParticleSystem) \
  X(60, Decal) \
  X(61, DecalParams) \
  X(62, VolumeEffect) \
  X(63, AverageConstants) \
  X(64, SphereBrick) \
  X(65, Glass) \
  X(66, TankLight) \
  X(67, TankCamera) \
  X(68, TankAir) \
  X(69, TankConstants) \
  X(70, SphereVoxelsParams) \
  X(71, TankSamples) \
  X(72, LightMap) \
  X(73, TankLightParams) \
  X(74, Photon) \
  X(75, PhotonGrid) \
  X(76, IndirectLayout) \
  X(77, SurfacePatch) \
  X(78, IndirectParams) \
  X(79, AntialiasParams) \
  X(80, SurfaceImportParams) \
  X(81, MediaLayerParams) \
  X(82, SurfaceShadowParams) \
  X(83, SurfaceNormalParams) \
  X(84, VolumeDetail) \
  X(85, PaneMaterial) \
  X(86, GlowFieldParams) \
  X(87, GlowCell) \
  X(88, EmitterSample) \
  X(89, EmitterRay) \
  X(90, SmokeMotionParams)
// clang-format on

#endif
