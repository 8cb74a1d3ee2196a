// Bindings of the shaders that only tests run.
#ifndef BRUME_PROBES_H
#define BRUME_PROBES_H
#include "shared/photons.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindProbeIn, 48u);
SHARED_BINDING(kBindProbeOut, 49u);
SHARED_BINDING(kBindProbeIn2, 50u);
SHARED_BINDING(kBindProbeOut2, 51u);
SHARED_BINDING(kBindProbeIn3, 52u);

/// A point of a sphere where photons are gathered.
struct PhotonQuery {
  vec4 sphere;
  vec3 at;
  uint id;
  PhotonGrid grid;
  float extinction;
  float padding SHARED_ZERO;
};

SHARED_END
#endif
