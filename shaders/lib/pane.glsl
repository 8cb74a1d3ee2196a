// A fragment of a pane (shared/pane.h).
#ifndef PANE_GLSL
#define PANE_GLSL
#include "lib/camera.glsl"
#include "lib/material.glsl"

struct Pane {
  vec3 position_world;
  vec3 view;    // unit, towards the eye
  vec3 normal;  // unit, on the side of the eye
  float distance;  // from the eye [m]
  float weight;    // how much glass there is
  vec3 albedo;
  vec3 passes;  // fraction of the light from behind
};

/// Discards what is cut out.
Pane pane_here() {
  const vec4 base = base_color_here();
  const PaneMaterial material = draw.material.pane;
  if (base.a < draw.material.alpha_cutoff) discard;
  const vec3 ray = camera_ray(frame.camera, gl_FragCoord.xy, frame.size_px);
  const vec3 along = view_distance(frame.camera, gl_FragCoord.z) * ray;
  Pane pane;
  pane.position_world = frame.camera.eye_world + along;
  pane.distance = length(along);
  pane.view = -along / pane.distance;
  pane.normal = normal_here();
  pane.weight = pane_weight(material, base.a);
  pane.albedo = pane_albedo(material, pane.weight, base.rgb);
  pane.passes = pane_tint(material, pane.weight, base.rgb) *
                (1.0 - pane_reflectance(pane.weight, dot(pane.normal, pane.view)));
  return pane;
}

#endif
