// Points of an opacity curve: whatever is done to them, the curve stays valid.
#include "apps/viewer/curve_editor.hpp"

#include <gtest/gtest.h>

#include <random>

namespace brume::viewer {
namespace {

using Curve = std::vector<scene::OpacityPoint>;

TEST(CurveEditor, FindsTheNearestPointWithinReach) {
  const Curve curve{{0, 0}, {0.5f, 0.5f}, {0.52f, 0.5f}, {1, 1}};
  EXPECT_EQ(point_near(curve, {0.515f, 0.5f}, glm::vec2(0.05f)), 2u);
  EXPECT_EQ(point_near(curve, {0.5f, 0.54f}, glm::vec2(0.05f)), 1u);
  EXPECT_EQ(point_near(curve, {0.5f, 0.54f}, glm::vec2(0.05f, 0.01f)), std::nullopt);
}

TEST(CurveEditor, APointMovesBetweenItsNeighbours) {
  Curve curve{{0, 0}, {0.4f, 0.5f}, {1, 1}};
  move_point(curve, 1, {1.5f, 2});
  EXPECT_EQ(curve[1], (scene::OpacityPoint{1, 1}));
  move_point(curve, 0, {0.25f, -1});
  EXPECT_EQ(curve[0], (scene::OpacityPoint{0.25f, 0}));
  move_point(curve, 1, {0.1f, 0.5f});
  EXPECT_EQ(curve[1], (scene::OpacityPoint{0.25f, 0.5f})) << "a step";
}

TEST(CurveEditor, AnyEditsLeaveAValidCurve) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(-0.2f, 1.2f);
  Curve curve{{0, 0}, {1, 1}};
  for (int edit = 0; edit < 3000; ++edit) {
    const glm::vec2 place(draw(random), draw(random));
    const std::size_t point = random() % curve.size(), before = curve.size();
    switch (random() % (edit < 1500 ? 3 : 4)) {
      case 0:
      case 1: {
        const auto added = add_point(curve, place);
        EXPECT_EQ(added.has_value(), before < scene::kMostPoints);
        EXPECT_TRUE(!added || curve[*added].at == std::clamp(place.x, 0.0f, 1.0f));
        break;
      }
      case 2:
        move_point(curve, point, place);
        break;
      default:
        EXPECT_EQ(remove_point(curve, point), before > 2);
    }
    ASSERT_FALSE(scene::fault_of(std::span(std::as_const(curve)))) << edit;
  }
  while (remove_point(curve, 0)) {
  }
  EXPECT_EQ(curve.size(), 2u);
}

TEST(CurveEditor, ColoursStayValidAndANewOneChangesNothing) {
  scene::ColorMap map{"", points_of({"cool-warm", {}})};
  ASSERT_FALSE(fault_of(map));
  EXPECT_EQ(points_of(map), map.points);
  const glm::dvec3 before = scene::color_at(map, 0.3);
  EXPECT_EQ(add_color(map.points, 0.3f), 3u);
  EXPECT_LT(glm::length(scene::color_at(map, 0.3) - before), 1e-6);
  move_color(map.points, 3, 2);
  EXPECT_EQ(map.points[3].at, map.points[4].at);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(-0.2f, 1.2f);
  for (int edit = 0; edit < 500; ++edit) {
    if (edit % 2 == 0) add_color(map.points, draw(random));
    move_color(map.points, random() % map.points.size(), draw(random));
    if (edit % 3 == 0) remove_color(map.points, random() % map.points.size());
    ASSERT_FALSE(fault_of(map)) << edit;
  }
  while (remove_color(map.points, 0)) {
  }
  EXPECT_EQ(map.points.size(), 2u);
}

}  // namespace
}  // namespace brume::viewer
