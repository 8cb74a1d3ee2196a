// What a pane does with light: a thin sheet, of which light passes a part straight on, tinted (docs/how/light.md).
#ifndef BRUME_PANE_H
#define BRUME_PANE_H
#include "shared/shim.h"
SHARED_BEGIN

/// As scene::Material has it.
struct PaneMaterial {
  float opacity;
  float transmission;
  float blended;  // 1: alpha multiplies the opacity and the reflection; 0: it does neither
};
SHARED_SIZE(PaneMaterial, 12);

/// How much glass there is at a point of this alpha.
SHARED_FUNCTION float pane_weight(PaneMaterial pane, float alpha) { return pane.blended > 0.0f ? alpha : 1.0f; }

/// What passes of the light that is not reflected.
SHARED_FUNCTION vec3 pane_tint(PaneMaterial pane, float weight, vec3 color) {
  const float colored = pane.opacity * weight;
  return vec3(1.0f - colored) + colored * pane.transmission * color;
}

/// What is scattered of it.
SHARED_FUNCTION vec3 pane_albedo(PaneMaterial pane, float weight, vec3 color) {
  return pane.opacity * weight * (1.0f - pane.transmission) * color;
}

/// What is reflected of the light from a direction, by its cosine: Schlick's Fresnel for an index of 1.5.
SHARED_FUNCTION float pane_reflectance(float weight, float cosine) {
  const float grazing = 1.0f - min(max(cosine, 0.0f), 1.0f), grazing2 = grazing * grazing;
  return weight * (0.04f + 0.96f * grazing2 * grazing2 * grazing);
}

SHARED_END
#endif
