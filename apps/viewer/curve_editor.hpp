// An opacity curve and a colour map that are drawn and dragged.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/transfer.hpp"

namespace brume::viewer {

// Places are (position, opacity). A curve stays valid (scene::fault_of): it has 2 to kMostPoints points,
// their positions do not fall, and all numbers are in [0, 1].

/// The point nearest to a place, if it is no farther than `reach` along each axis.
std::optional<std::size_t> point_near(std::span<const scene::OpacityPoint> curve, glm::vec2 place,
                                      glm::vec2 reach);
/// Inserts a point and returns its index; nullopt, with nothing changed, for a curve of kMostPoints.
std::optional<std::size_t> add_point(std::vector<scene::OpacityPoint>& curve, glm::vec2 place);
/// Moves a point as far as its neighbours let it.
void move_point(std::vector<scene::OpacityPoint>& curve, std::size_t point, glm::vec2 place);
/// False, with nothing changed, for a curve of two points.
bool remove_point(std::vector<scene::OpacityPoint>& curve, std::size_t point);

/// What is drawn behind a curve.
struct CurveBackdrop {
  std::span<const std::uint64_t> histogram;  ///< How often values occur, in bins of equal width.
  glm::vec2 histogram_range{0, 1};           ///< Positions of its ends.
  glm::vec2 values{0, 1};                    ///< At the positions 0 and 1.
};
/// Lays out the editor: a click adds a point, a drag moves it, a right click removes it. Returns whether the
/// curve changed.
bool edit_curve(const char* label, std::vector<scene::OpacityPoint>& curve, const CurveBackdrop& backdrop);

// The same for the points of a colour map; a new point has the colour that the map has there.
std::optional<std::size_t> add_color(std::vector<scene::ColorPoint>& points, float at);
void move_color(std::vector<scene::ColorPoint>& points, std::size_t point, float at);
bool remove_color(std::vector<scene::ColorPoint>& points, std::size_t point);
/// The points of a map of points; of any other map but an empty one, a few points that approximate it.
std::vector<scene::ColorPoint> points_of(const scene::ColorMap& map);

/// Draws a colour map as a bar.
void draw_color_map(const scene::ColorMap& map);
/// Lays out the editor of a map of points: the bar, whose points are edited as in edit_curve, and the
/// colour of the point that was clicked last. Returns whether a point changed.
bool edit_color_map(const char* label, std::vector<scene::ColorPoint>& points);

}  // namespace brume::viewer
