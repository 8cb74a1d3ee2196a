// The media of a frame that a march goes through together.
#ifndef BRUME_MEDIA_H
#define BRUME_MEDIA_H
#include "shared/shim.h"
SHARED_BEGIN

/// Bits of a set of media.
SHARED_CONST uint kMediumSmoke = 1u;
SHARED_CONST uint kMediumVolumes = 2u;
// Properties of volumes in view, never without kMediumVolumes.
SHARED_CONST uint kMediumHeat = 4u;  // one glows with heat
SHARED_CONST uint kMediumLit = 8u;   // one scatters light, or emits; else all only absorb
SHARED_CONST uint kMediumSun = 16u;  // a sun lights them
SHARED_CONST uint kMediumSeveral = 32u;   // there are more than one
SHARED_CONST uint kMediumTransfer = 64u;  // one has a transfer function
SHARED_CONST uint kMediumColors = 128u;   // one has a grid of colours
SHARED_CONST uint kMediumMasks = 256u;      // one has masks that glow
SHARED_CONST uint kMediumDisturbed = 512u;  // noise disturbs one
SHARED_CONST uint kMediumDense = 1024u;     // one is dense (VolumeInstance::is_dense)
// Noise within a voxel shadows the smoke (shared/light_side.h). Never without kMediumSmoke.
SHARED_CONST uint kMediumFineShadows = 2048u;
SHARED_CONST uint kMediumDetail = 4096u;  // its noise has detail (shared/erosion.h). Never without kMediumSmoke.
SHARED_CONST uint kMediumVolumeDetail = 8192u;  // a volume has (shared/volume_detail.h)
// How rays meet them: in a parallel view.
SHARED_CONST uint kRaysParallel = 16384u;
/// The media themselves.
SHARED_CONST uint kMediaPresent = kMediumSmoke | kMediumVolumes;
/// What optical depths depend on.
SHARED_CONST uint kMediaOfDepths = kMediaPresent | kMediumTransfer;
/// How the smoke is drawn, whatever else there is.
SHARED_CONST uint kMediaOfSmoke = kMediumFineShadows | kMediumDetail;
/// What says nothing about the media beside the smoke.
SHARED_CONST uint kMediaOfAnySmoke = kMediaOfSmoke | kRaysParallel;
/// Those that holes may be in.
SHARED_CONST uint kMediaWithHoles = kMediumSmoke;
/// Those that are drawn with tiles of noise, whatever their look.
SHARED_CONST uint kMediaWithNoise = kMediumDisturbed | kMediumVolumeDetail;
/// Those with which the albedo differs from point to point.
SHARED_CONST uint kMediaOfAlbedos = kMediumTransfer | kMediumColors;

SHARED_END
#endif
