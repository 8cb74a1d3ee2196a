#include "scenario/doors.hpp"

#include <gtest/gtest.h>

#include "tests/scenario/two_rooms.hpp"

namespace brume::scenario {
namespace {

TEST(Doors, AreRecognizedByName) {
  for (const char* name :
       {"door", "Door", "DOOR_2", "front door", "door2", "door.001", "door-leaf", "door_leaf", "FrontDoor",
        "DoorRoom_E", "DumpsterDoorLeft_A", "garage_door 3", "outdoor door"})
    EXPECT_TRUE(is_door_name(name)) << name;
  for (const char* name : {"", "doo", "outdoor", "Outdoor", "doors", "doorway", "indoor_light",
                           "frame_front_door", "DoorFrame", "door frame", "LadderOutdoor"})
    EXPECT_FALSE(is_door_name(name)) << name;
}

TEST(Doors, OfASceneAreGroupedByNameWithBounds) {
  const Scenario scenario = two_rooms();
  const auto doors = doors_of(scenario.scene);
  ASSERT_EQ(doors.size(), 1u);
  EXPECT_EQ(doors[0].name, "door");
  EXPECT_EQ(doors[0].objects, (std::vector<std::uint32_t>{9, 10}));
  EXPECT_EQ(doors[0].bounds_world.low, glm::vec3(-0.02f, 0, -0.5f));
  EXPECT_EQ(doors[0].bounds_world.high, glm::vec3(0.02f, 2, 0.5f));
}

TEST(Doors, FollowTheTimeline) {
  scene::Timeline timeline;
  timeline.doors = {{1, "door", true, ""}, {1.5, "other", true, ""}, {2, "door", false, ""}};
  EXPECT_FALSE(is_open(timeline, "door", 0));
  EXPECT_TRUE(is_open(timeline, "door", 1));
  EXPECT_TRUE(is_open(timeline, "door", 1.99));
  EXPECT_FALSE(is_open(timeline, "door", 2));
  EXPECT_TRUE(is_open(timeline, "other", 5));
  EXPECT_FALSE(is_open(timeline, "none", 5));
}

}  // namespace
}  // namespace brume::scenario
