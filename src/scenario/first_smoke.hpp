// Where the smoke of a scene without a timeline goes off, so that it is seen and hides no subject.
#pragma once

#include "scene/scene.hpp"

namespace brume::scenario {

/// What the smoke is placed for.
struct SmokeView {
  scene::Camera camera;
  float aspect = 16.0f / 9.0f;  ///< Width / height of the image.
  bool is_fixed = false;        ///< The camera will not be fitted to the smoke: the smoke has to be in view.
  bool is_of_scene = false;     ///< The camera is the scene's own, which shows what lies in the scene.
};

/// What is in the middle of the view: the nearest surface there, or where the view enters the bounds of the
/// level if it passes through a gap and out behind.
glm::vec3 subject_point(const scene::Scene& scene, const scene::Camera& camera);

/// On the floor before the subject; where it would not be seen there, nearer to the camera, beside the
/// subject, or in the air. Where it would hide a small scene from the camera of that, beside it, if that is
/// in view. `diameter`: of the grown smoke [m].
glm::vec3 choose_smoke_place(const scene::Scene& scene, const SmokeView& view, float diameter);

/// Whether most of a grown smoke at this place is neither behind something solid, nor beyond the level's
/// bounds as the camera sees them, nor out of view for a fixed camera.
bool is_smoke_seen(const scene::Scene& scene, const SmokeView& view, glm::vec3 place_world, float diameter);

}  // namespace brume::scenario
