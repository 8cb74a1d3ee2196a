// Parsers of argument values. Each throws Error (usage), which names the option, the expected form and an
// example.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "passes/debug_view.hpp"
#include "scene/scene.hpp"

namespace brume::cli {

/// "1280x720", each side in [1, image::kMaxAxis].
glm::uvec2 parse_size(const std::string& option, const std::string& text);

/// "120x20x120": integers in [0, 2^31 - 1].
glm::ivec3 parse_grid(const std::string& option, const std::string& text);

/// `count` finite numbers with commas between them, such as "60,40"; nothing for anything else. Blanks around
/// commas do not count, here and below.
std::optional<std::vector<double>> parse_numbers(const std::string& text, std::size_t count);

/// The texts of a list of points and numbers with blanks between them: "0,1,5", "0,1, 0" and "60" of
/// "0,1,5  0,1, 0 60". A comma after a point does not count.
std::vector<std::string> parse_points(const std::string& text);

/// "-30,0,2.5": three finite numbers.
glm::vec3 parse_point(const std::string& option, const std::string& text);

/// The same within scene::kFarthestEvent, the space of the simulation.
glm::vec3 parse_event_point(const std::string& option, const std::string& text);

/// "px,py,pz tx,ty,tz fov": position, target [m] and the vertical field of view [degrees, (0, 180); default
/// 60].
scene::Camera parse_camera(const std::string& option, const std::string& text);

/// "y=1.5": the axis that the slice is perpendicular to, x, y or z, and its position along it [m].
passes::ViewSlice parse_slice(const std::string& option, const std::string& text);

/// "0-119": the first and the last frame, each in [0, 10^6], first <= last.
struct FrameRange {
  std::uint32_t first = 0, last = 0;
};
FrameRange parse_frames(const std::string& option, const std::string& text);

/// "1.5-6": begin and end [s] within [0, 3600], begin < end.
struct TimeRange {
  double begin = 0, end = 0;
};
TimeRange parse_times(const std::string& option, const std::string& text);

}  // namespace brume::cli
