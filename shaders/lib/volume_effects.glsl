// What few volumes have (shared/volume.h).
#ifndef VOLUME_EFFECTS_GLSL
#define VOLUME_EFFECTS_GLSL
#include "shared/volume.h"

layout(scalar, binding = kBindVolumeEffects) readonly buffer VolumeEffects { VolumeEffect volume_effects[]; };

#endif
