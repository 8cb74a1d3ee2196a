// The camera and the clock of a frame as the shaders read them.
#pragma once

#include "scene/scene.hpp"
#include "shared/frame.h"

namespace brume::render {

constexpr float kNearPlane = 0.05f;  // [m]

/// `camera` for a picture of this size. A view straight up or down is legal.
shared::Camera device_camera(const scene::Camera& camera, glm::uvec2 size_px);

}  // namespace brume::render
