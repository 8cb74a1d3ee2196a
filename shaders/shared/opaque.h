// Where rays through media end: the transmittance below which nothing behind is seen.
#ifndef BRUME_OPAQUE_H
#define BRUME_OPAQUE_H
#include "shared/shim.h"
SHARED_BEGIN

/// The usual transmittance below which a ray ends: one step of 8 bits.
SHARED_CONST float kUsualOpaque = 0.004f;
/// What of a radiance too bright for the display may be cut, in display units before the tone curve.
SHARED_CONST float kLeastDisplayed = 1.0f / 1024.0f;
/// As bright as a light source at night is drawn, in display units.
SHARED_CONST float kSourceDisplayed = 256.0f;
/// What is at most this bright, in display units, can be cut by the usual transmittance unseen: the medium in front of
/// it is brighter.
SHARED_CONST float kBrightDisplayed = 2.0f;

/// Transmittance below which a ray ends: `usual` where what lies behind, radiance times exposure, is no brighter than
/// that, less where it is.
SHARED_FUNCTION float opaque_below(float usual, float displayed) {
  return displayed > kBrightDisplayed ? min(usual, kLeastDisplayed / displayed) : usual;
}

/// Transmittance below which steps may be longer: what they may be off by counts that much less, unless what lies
/// behind is brighter than a light source at night.
SHARED_FUNCTION float coarse_below(float opaque) {
  const float of_source = kLeastDisplayed / kSourceDisplayed;
  return opaque > 0.0f ? 0.25f * min(1.0f, opaque / of_source) : 0.25f;
}

SHARED_END
#endif
