// Perceptually uniform colour ramps from dark to light, readable in greyscale and by the colour-blind.
//
// viridis, inferno, magma, plasma: Smith and van der Walt 2015 ("A Better Default Colormap for Matplotlib", data in the
// public domain, CC0). Every sixteenth entry of their tables of 256, interpolated linearly: at most 7/255 off.
#ifndef BRUME_RAMP_H
#define BRUME_RAMP_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kRampViridis = 0u;
SHARED_CONST uint kRampInferno = 1u;
SHARED_CONST uint kRampMagma = 2u;
SHARED_CONST uint kRampPlasma = 3u;
SHARED_CONST int kRampStops = 17;

/// 0xrrggbb, sRGB.
// clang-format off
SHARED_CONST uint kRamps[4][17] = {
  {0x440154u, 0x48186au, 0x472d7bu, 0x424086u, 0x3b528bu, 0x33638du, 0x2c728eu, 0x26818eu, 0x21908cu,
   0x1f9f88u, 0x28ae80u, 0x3ebc74u, 0x5dc963u, 0x82d34cu, 0xabdc32u, 0xd5e21au, 0xfde725u},
  {0x000004u, 0x0b0724u, 0x210c4au, 0x3c0965u, 0x57106du, 0x70196eu, 0x89226au, 0xa32b61u, 0xbb3755u,
   0xd14644u, 0xe35932u, 0xf1711eu, 0xf98d0au, 0xfcab0fu, 0xf9ca32u, 0xf2e865u, 0xfcffa4u},
  {0x000004u, 0x0a0822u, 0x1d1146u, 0x36106au, 0x50127cu, 0x691c81u, 0x822681u, 0x9c2e7fu, 0xb63779u,
   0xcf4170u, 0xe65163u, 0xf5695cu, 0xfb8761u, 0xfea571u, 0xfec387u, 0xfde0a2u, 0xfcfdbfu},
  {0x0d0887u, 0x310596u, 0x4c02a1u, 0x6600a7u, 0x7e03a8u, 0x9511a2u, 0xa92396u, 0xbb3587u, 0xcb4778u,
   0xd9596au, 0xe66c5cu, 0xf07f4fu, 0xf89441u, 0xfdab33u, 0xfdc328u, 0xf9dd25u, 0xf0f921u}};
// clang-format on

SHARED_FUNCTION vec3 ramp_stop(uint ramp, int stop) {
  uint word = kRamps[ramp][stop];
  return vec3(float(word >> 16u), float(word >> 8u & 255u), float(word & 255u)) / 255.0f;
}

/// The colour of x in [0, 1], clamped; encoded as sRGB.
SHARED_FUNCTION vec3 ramp_colour(uint ramp, float x) {
  float at = clamp(x, 0.0f, 1.0f) * float(kRampStops - 1);
  int stop = min(int(at), kRampStops - 2);
  return mix(ramp_stop(ramp, stop), ramp_stop(ramp, stop + 1), at - float(stop));
}

SHARED_END
#endif
