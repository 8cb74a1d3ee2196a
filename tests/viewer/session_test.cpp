// A session without a window: its clock, its actions, its recording.
#include "apps/viewer/session.hpp"

#include <gtest/gtest.h>

#include "scene/files/timeline_writer.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    write_room(folder_);
    session_ = open("room.toml", false);
  }
  std::unique_ptr<Session> open(const std::string& name, bool play) const {
    return Session::create(scenario::load_scenario(folder_.path() / name, {}).value_or_throw(), play)
        .value_or_throw();
  }

  void advance(double frame_seconds) {
    session_->seek(session_->seconds() + session_->passing(frame_seconds));
  }

  cli::WorkFolder folder_;
  std::unique_ptr<Session> session_;
  const glm::vec3 eye_{0.5f, 1.6f, 3.2f};
  const glm::vec3 ahead_ = glm::normalize(glm::vec3(-0.05f, -0.1f, -1));
};

TEST_F(SessionTest, ActionsHappenAtTheNextTick) {
  advance(0.1);
  const double now = session_->seconds();
  ASSERT_TRUE(session_->throw_smoke(eye_, ahead_));
  const auto& smokes = session_->live().scenario().timeline.smokes;
  ASSERT_EQ(smokes.size(), 1u);
  EXPECT_GT(smokes[0].time, now);
  EXPECT_LE(smokes[0].time, now + Session::kTick);
  EXPECT_EQ(std::fmod(smokes[0].time, Session::kTick), 0);
}

TEST_F(SessionTest, TimeStopsWhilePausedAndSlowsForLongFrames) {
  session_->set_paused(true);
  const double before = session_->seconds();
  advance(0.1);
  EXPECT_EQ(session_->seconds(), before);
  session_->step(3);
  EXPECT_EQ(session_->simulation().world().tick(), 4u);
  session_->step(-2);
  EXPECT_EQ(session_->simulation().world().tick(), 2u);
  session_->set_paused(false);
  advance(10);
  EXPECT_NEAR(session_->seconds(), 2 * Session::kTick + Session::kLongestFrame, 1e-6);
}

TEST_F(SessionTest, ActionsAreRecordedAndReplayToTheSameState) {
  Weapons weapons;
  weapons.text.text = "HI";
  ASSERT_TRUE(session_->throw_smoke(eye_, ahead_));
  for (int i = 0; i < 90; ++i) advance(1.0 / 60);
  ASSERT_TRUE(session_->shoot(eye_, ahead_, weapons));
  ASSERT_TRUE(session_->set_off("blast", eye_, ahead_, weapons));  // of the same tick
  weapons.kind = ShotKind::word;
  ASSERT_TRUE(session_->shoot(eye_, ahead_, weapons));
  advance(0.2);
  weapons.kind = ShotKind::glyph;
  ASSERT_TRUE(session_->shoot(eye_, ahead_, weapons));
  ASSERT_TRUE(session_->use_door(eye_));
  scene::Camera camera;
  for (int i = 0; i < 60; ++i) {
    advance(1.0 / 60);
    camera.position_world.x += 0.01f;
    session_->record_camera(camera);
  }
  const auto path = folder_.path() / "made.toml";
  ASSERT_TRUE(scene::save_timeline(path, session_->recording()));
  const auto again = open("made.toml", true);
  again->seek(session_->seconds());
  EXPECT_EQ(again->simulation().world().tick(), session_->simulation().world().tick());
  EXPECT_EQ(again->simulation().world().state_hash(), session_->simulation().world().state_hash());
  EXPECT_GT(session_->simulation().world().state().clouds.size(), 0u);
  // About eight keys per second, all on the path of the camera.
  const scene::Timeline recording = session_->recording();
  EXPECT_GE(recording.camera.size(), 6u);
  EXPECT_LE(recording.camera.size(), 10u);
}

TEST_F(SessionTest, ScrubbingKeepsTheCameraPath) {
  scene::Camera camera;
  for (int i = 0; i < 120; ++i) {
    advance(1.0 / 60);
    camera.position_world.x += 0.01f;
    session_->record_camera(camera);
  }
  const std::size_t keys = session_->recording().camera.size();
  session_->scrub(0.5);
  EXPECT_TRUE(session_->paused());
  ASSERT_TRUE(session_->follows_path());
  EXPECT_NEAR(session_->path_camera(0.5).position_world.x, 0.3f, 0.02f);
  EXPECT_EQ(session_->recording().camera.size(), keys);
}

TEST_F(SessionTest, ShootsLettersOneByOne) {
  Weapons weapons;
  weapons.kind = ShotKind::glyph;
  weapons.text.text =
      "A \xc3\x84"
      "B";
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(session_->shoot(eye_, ahead_, weapons));
  std::vector<std::string> letters;
  for (const auto& text : session_->live().scenario().timeline.texts) letters.push_back(text.text);
  EXPECT_EQ(letters, (std::vector<std::string>{"A", "\xc3\x84", "B", "A"}));
}

TEST_F(SessionTest, DoorsOpenAndShut) {
  const auto hidden = [&] { return session_->simulation().hidden_objects().size(); };
  EXPECT_EQ(hidden(), 0u);
  EXPECT_EQ(session_->use_door(eye_).value_or_throw(), "opened: Door");
  advance(0.1);
  EXPECT_EQ(hidden(), 1u);
  EXPECT_EQ(session_->use_door(eye_).value_or_throw(), "closed: Door");
  advance(0.1);
  EXPECT_EQ(hidden(), 0u);
}

TEST_F(SessionTest, RewindingKeepsAllActions) {
  ASSERT_TRUE(session_->throw_smoke(eye_, ahead_));
  advance(0.25);
  const std::uint64_t then = session_->simulation().world().state_hash();
  const double seconds = session_->seconds();
  session_->rewind();
  EXPECT_EQ(session_->seconds(), Session::kFirstTime);
  EXPECT_EQ(session_->recording().smokes.size(), 1u);
  session_->seek(seconds);
  EXPECT_EQ(session_->simulation().world().state_hash(), then);
}

TEST_F(SessionTest, EmptyingRemovesAllActionsAndKeepsSettings) {
  const std::uint64_t before = session_->simulation().world().state_hash();
  ASSERT_TRUE(session_->throw_smoke(eye_, ahead_));
  advance(0.25);
  ASSERT_NE(session_->simulation().world().state_hash(), before);
  scene::Timeline settings = session_->live().scenario().timeline;
  settings.exposure = 2;
  ASSERT_TRUE(session_->set_settings(settings));
  ASSERT_TRUE(session_->empty());
  EXPECT_EQ(session_->simulation().world().state_hash(), before);
  EXPECT_EQ(session_->recording().smokes.size(), 0u);
  EXPECT_EQ(session_->recording().exposure, 2);
}

TEST_F(SessionTest, FailuresAreOneLine) {
  const auto thrown = session_->throw_smoke(glm::vec3(0, 50, 0), glm::vec3(0, 1, 0));
  ASSERT_FALSE(thrown);
  EXPECT_EQ(thrown.failure().message.find('\n'), std::string::npos);
  Weapons weapons;
  weapons.kind = ShotKind::picture;
  EXPECT_FALSE(session_->shoot(eye_, ahead_, weapons));
  weapons.picture = folder_.path() / "none.png";
  EXPECT_FALSE(session_->shoot(eye_, ahead_, weapons));
  EXPECT_EQ(session_->recording().shots.size(), 0u);
}

}  // namespace
}  // namespace brume::viewer
