// A game without a window: undo and redo, the start, falls, the help.
#include "apps/viewer/game.hpp"

#include <gtest/gtest.h>

#include "tests/viewer/foggy_room.hpp"

namespace brume::viewer {
namespace {

class GameTest : public testing::Test {
 protected:
  GameTest() { write_foggy_room(folder_); }

  std::unique_ptr<Session> session(const std::string& name) const {
    return Session::create(scenario::load_scenario(folder_.path() / name, {}).value_or_throw(), false)
        .value_or_throw();
  }
  Game& start(const std::string& name = "room.toml") {
    game_.emplace(session(name), Choices(), [this](const std::string& line) { lines_.push_back(line); });
    return *game_;
  }
  void act(Action action) { game_->act(action, ahead_); }
  void advance(double seconds) {
    game_->session().seek(game_->session().seconds() + seconds);
    game_->move({}, seconds);
  }
  std::uint64_t state() const { return game_->session().simulation().world().state_hash(); }
  const scene::Timeline& timeline() const { return game_->session().live().scenario().timeline; }

  cli::WorkFolder folder_;
  std::optional<Game> game_;
  std::vector<std::string> lines_;
  const glm::vec3 ahead_ = glm::normalize(glm::vec3(-0.05f, -0.1f, -1));
};

TEST_F(GameTest, UndoesAndRedoesActions) {
  start();
  act(kThrowSmoke);
  advance(0.5);
  const std::uint64_t thrown = state();
  act(event_action("blast"));
  EXPECT_EQ(timeline().blasts.size(), 1u);
  advance(0.25);
  const std::uint64_t blown = state();

  act(Action::undo);
  EXPECT_EQ(lines_.back(), "undone: explosion");
  EXPECT_EQ(timeline().blasts.size(), 0u);
  EXPECT_EQ(timeline().smokes.size(), 1u);
  act(Action::undo);
  EXPECT_EQ(timeline().smokes.size(), 0u);
  const auto untouched = session("room.toml");
  untouched->seek(game_->session().seconds());
  EXPECT_EQ(state(), untouched->simulation().world().state_hash());
  act(Action::undo);
  EXPECT_EQ(lines_.back(), "nothing to undo");

  act(Action::redo);
  act(Action::redo);
  EXPECT_EQ(lines_.back(), "redone: explosion");
  EXPECT_EQ(state(), blown);
  game_->session().seek(game_->session().seconds() - 0.25);
  EXPECT_EQ(state(), thrown);
  act(Action::redo);
  EXPECT_EQ(lines_.back(), "nothing to redo");
}

TEST_F(GameTest, ANewActionDropsWhatCouldBeRedone) {
  start();
  act(kThrowSmoke);
  act(Action::undo);
  act(kShoot);
  act(Action::redo);
  EXPECT_EQ(lines_.back(), "nothing to redo");
  EXPECT_EQ(timeline().smokes.size(), 0u);
  EXPECT_EQ(timeline().shots.size(), 1u);
}

TEST_F(GameTest, ADraggedSettingIsOneStepToUndo) {
  start();
  const scene::SmokeOptions before = timeline().smoke;
  for (std::uint32_t voxels = 901; voxels < 905; ++voxels) {
    scene::Timeline settings = timeline();
    settings.smoke.voxels = voxels;
    game_->change_settings("smoke", settings);
    ASSERT_EQ(timeline().smoke.voxels, voxels);
  }
  game_->settle();
  game_->choices().weapons.shot.radius = 0.5f;
  game_->setting_changed("bullets");
  act(Action::undo);  // settles by itself
  EXPECT_EQ(lines_.back(), "undone: bullets");
  EXPECT_EQ(game_->choices().weapons.shot.radius, scene::ShotEvent().radius);
  EXPECT_EQ(timeline().smoke.voxels, 904u);
  act(Action::undo);
  EXPECT_EQ(timeline().smoke, before);
  act(Action::redo);
  EXPECT_EQ(timeline().smoke.voxels, 904u);
}

TEST_F(GameTest, TheLookAndTheGridsOfAVolumeCanBeUndone) {
  start("foggy.toml");
  const auto set = [&](auto change) {
    scene::Timeline settings = timeline();
    change(settings.volumes[0]);
    game_->change_settings("volume", std::move(settings));
    game_->settle();
  };
  set([](auto& volume) { volume.opacity = {{0, 0}, {1, 1}}; });
  set([](auto& volume) { volume.density = "fuel"; });
  const auto shown = [&] {
    const scenario::Scenario& scenario = game_->session().live().scenario();
    return scenario.volumes->at(scenario.timeline.volumes, 0)[0].frame->density.high;
  };
  EXPECT_EQ(shown(), 0.25f);
  set([](auto& volume) { volume.density = "fule"; });
  EXPECT_NE(lines_.back().find("did you mean \"fuel\"?"), std::string::npos);
  EXPECT_EQ(timeline().volumes[0].density, "fuel");
  act(Action::undo);
  EXPECT_EQ(lines_.back(), "undone: volume");
  EXPECT_EQ(shown(), 0.5f);
  EXPECT_EQ(timeline().volumes[0].opacity.size(), 2u);
  act(Action::undo);
  EXPECT_TRUE(timeline().volumes[0].opacity.empty());
  act(Action::redo);
  act(Action::redo);
  EXPECT_EQ(shown(), 0.25f);
}

TEST_F(GameTest, FieldOfViewAndLensCanBeUndone) {
  start();
  const float before = game_->player().camera().vertical_fov;
  scene::Camera camera = game_->player().camera();
  camera.vertical_fov = 0.5f;
  camera.lens = {0.02f, 3, 5};
  camera.shutter = 0.01f;
  game_->player().set_optics(optics_of(camera));
  game_->setting_changed("field of view");
  act(kThrowSmoke);
  act(Action::undo);
  EXPECT_EQ(game_->player().camera().vertical_fov, 0.5f);
  EXPECT_EQ(game_->player().camera().lens, camera.lens);
  act(Action::undo);
  EXPECT_EQ(game_->player().camera().vertical_fov, before);
  EXPECT_EQ(game_->player().camera().lens, scene::Lens());
}

TEST_F(GameTest, RewindingKeepsActionsAndRemovingThemCanBeUndone) {
  start();
  act(kThrowSmoke);
  advance(0.5);
  act(Action::rewind);
  EXPECT_EQ(game_->session().seconds(), Session::kFirstTime);
  EXPECT_EQ(timeline().smokes.size(), 1u);
  act(Action::empty);
  EXPECT_EQ(timeline().smokes.size(), 0u);
  act(Action::undo);
  EXPECT_EQ(lines_.back(), "undone: all actions removed");
  EXPECT_EQ(timeline().smokes.size(), 1u);
}

TEST_F(GameTest, StartsFlyingWithoutAFloorBelow) {
  folder_.write("outside.toml",
                "version = 1\nscene = \"room.txt\"\n[grid]\nvoxel = 0.25\n[[camera]]\ntime = 0.0\n"
                "position = [30.0, 12.0, 30.0]\ntarget = [0.0, 1.0, 0.0]\nfov = 70.0\n");
  start("outside.toml");
  EXPECT_TRUE(game_->player().flying());
  ASSERT_FALSE(lines_.empty());
  EXPECT_NE(lines_.back().find("G walks"), std::string::npos);
  const glm::vec3 eye = game_->player().camera().position_world;
  act(Action::fly);
  EXPECT_TRUE(game_->player().flying());
  EXPECT_EQ(lines_.back(), "still flying: there is no floor below");
  advance(0.2);
  EXPECT_EQ(game_->player().camera().position_world, eye);
  EXPECT_FALSE(start().player().flying());
}

TEST(PlayerTest, AFallOffTheLevelEndsWhereItBegan) {
  // A table of 2 x 2 m, 5 m above the bottom of the grid.
  voxel::BitGrid grid({glm::ivec3(32), 0.25f, glm::vec3(0)});
  for (int x = 12; x < 20; ++x)
    for (int z = 12; z < 20; ++z) grid.set({x, 19, z}, true);
  Player player;
  scene::Camera camera;
  camera.position_world = {4, 5 + scenario::WalkerOptions().eye, 4};
  camera.target_world = camera.position_world + glm::vec3(0, 0, -1);
  player.start(grid, camera);
  ASSERT_FALSE(player.flying());
  Input forward;
  forward.held[static_cast<std::size_t>(Action::forward)] = true;
  bool fell = false;
  for (int frame = 0; frame < 200 && !fell; ++frame) fell = !player.move(forward, grid, 1.0 / 30);
  EXPECT_TRUE(fell);
  const glm::vec3 feet = player.camera().position_world - glm::vec3(0, scenario::WalkerOptions().eye, 0);
  EXPECT_NEAR(feet.y, 5, 0.01f);
  EXPECT_GT(feet.z, 2.7f);
  for (int frame = 0; frame < 30; ++frame) EXPECT_TRUE(player.move({}, grid, 1.0 / 30));
}

TEST_F(GameTest, TheHelpPausesAndResumes) {
  start();
  act(Action::help);
  EXPECT_TRUE(game_->session().paused());
  act(Action::help);
  EXPECT_FALSE(game_->session().paused());
  act(Action::pause);
  act(Action::help);
  act(Action::help);
  EXPECT_TRUE(game_->session().paused());
}

TEST_F(GameTest, AFileThatIsDroppedIsShot) {
  start();
  game_->choose_picture("mask.PNG");
  game_->settle();
  EXPECT_EQ(game_->choices().weapons.picture, "mask.PNG");
  EXPECT_EQ(game_->choices().weapons.kind, ShotKind::picture);
  game_->choose_picture("level.glb");
  EXPECT_NE(lines_.back().find("level.glb: expected a PNG or JPEG"), std::string::npos);
  EXPECT_EQ(game_->choices().weapons.picture, "mask.PNG");
  act(Action::undo);
  EXPECT_EQ(game_->choices().weapons.picture, "");
}

TEST_F(GameTest, FileListShowsFoldersAndImages) {
  folder_.write("b.png", "");
  folder_.write("a.JPG", "");
  FileList list(folder_.path(), {".png", ".jpg"});
  list.refresh();
  EXPECT_EQ(list.folders(), (std::vector<std::string>{"..", "Meshes", "Textures"}));
  EXPECT_EQ(list.files(), (std::vector<std::string>{"a.JPG", "b.png"}));
  list.open(list.folder() / "Meshes");
  EXPECT_TRUE(list.files().empty());
  list.open(list.folder() / "..");
  EXPECT_EQ(list.files().size(), 2u);
  list.open(folder_.path() / "none");
  EXPECT_EQ(list.folders(), std::vector<std::string>{".."});
}

}  // namespace
}  // namespace brume::viewer
