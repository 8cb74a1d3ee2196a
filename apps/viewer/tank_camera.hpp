// How the mouse and the keys move the camera before a tank, and where its points are in the picture.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.hpp"
#include "spheres/tank.hpp"

namespace brume::viewer {

/// Around the target, which stays where it is in the picture: a mouse that was dragged by `drag`, in heights
/// of the picture, to the right and down. Never straight above or below the target.
scene::Camera orbited(const scene::Camera& camera, glm::vec2 drag);
/// Aside: what is at the target's distance moves with the mouse.
scene::Camera panned(const scene::Camera& camera, glm::vec2 drag);
/// Towards the target, a tenth of the distance with each notch of the wheel; away for negative ones.
scene::Camera zoomed(const scene::Camera& camera, double notches);
/// To the right, up and along the view [m].
scene::Camera glided(const scene::Camera& camera, const glm::vec3& steps);

/// Where a point of the world is in a picture of this size, from its top left corner; nothing for one that is
/// behind the near plane.
std::optional<glm::vec2> in_picture(const scene::Camera& camera, glm::vec2 size, const glm::vec3& world);
/// A point after a drag in the plane through it that is parallel to the picture: it is where the mouse is.
glm::vec3 dragged(const scene::Camera& camera, glm::vec2 drag, const glm::vec3& world);
/// The distance of a point along the view, no nearer than the near plane [m].
float depth_of(const scene::Camera& camera, const glm::vec3& world);

/// The distance along the view of the first sphere in the middle of the picture, or of the tank's middle
/// where there is none [m].
float distance_ahead(const scene::Camera& camera, const spheres::Tank& tank);

}  // namespace brume::viewer
