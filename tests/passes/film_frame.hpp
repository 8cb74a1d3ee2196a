// Frames of a film without a scene, for passes that continue from frame to frame.
#pragma once

#include "shared/frame.h"

namespace brume::passes {

constexpr glm::uvec2 kFrameSize{33, 17};

/// A box of smoke from -10 m on along each axis, 20 m deep, before a camera at (x, 0, 8) that looks along -z.
inline shared::FrameConstants frame_at(float x) {
  shared::FrameConstants frame{};
  frame.camera.eye_world = {x, 0, 8};
  frame.camera.near_z = 0.05f;
  frame.camera.forward = {0, 0, -1};
  frame.camera.right = {0.8f, 0, 0};
  frame.camera.up = {0, 0.4f, 0};
  // Rows: x / 0.8, -y / 0.4, 0.05, distance along the view axis.
  frame.camera.clip_from_world = glm::mat4(0);
  frame.camera.clip_from_world[0] = {1 / 0.8f, 0, 0, 0};
  frame.camera.clip_from_world[1] = {0, -1 / 0.4f, 0, 0};
  frame.camera.clip_from_world[2] = {0, 0, 0, -1};
  frame.camera.clip_from_world[3] = {-x / 0.8f, 0, 0.05f, 8};
  frame.smoke.voxel_size = 0.5f;
  frame.smoke.origin_world = glm::vec3(-10);
  frame.smoke.bounds_max = {400, 40, 40};
  frame.size_px = kFrameSize;
  frame.look.extinction = 1;
  return frame;
}

}  // namespace brume::passes
