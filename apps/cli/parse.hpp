// The small languages of the arguments. Each function throws Error (usage) that names the option, what was
// expected and an example.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "passes/debug_view.hpp"
#include "scene/scene.hpp"

namespace brume::cli {

/// "1280x720", each side in [1, image::kMaxAxis].
glm::uvec2 parse_size(const std::string& option, const std::string& text);

/// "120x20x120": whole numbers of 0 and more, at most 2^31 - 1.
glm::ivec3 parse_grid(const std::string& option, const std::string& text);

/// "-30,0,2.5": three finite numbers.
glm::vec3 parse_point(const std::string& option, const std::string& text);

/// "px,py,pz tx,ty,tz fov": position, target [m] and the vertical field of view [degrees, (0, 180)].
scene::Camera parse_camera(const std::string& option, const std::string& text);

/// "y=1.5": across x, y or z, and where along it [m].
passes::ViewSlice parse_slice(const std::string& option, const std::string& text);

/// "0-119": the first and the last frame, each in [0, 10^6], the first not above the last.
struct FrameRange {
  std::uint32_t first = 0, last = 0;
};
FrameRange parse_frames(const std::string& option, const std::string& text);

/// "1.5-6": from a time to a later one [s], within [0, 3600].
struct TimeRange {
  double begin = 0, end = 0;
};
TimeRange parse_times(const std::string& option, const std::string& text);

}  // namespace brume::cli
