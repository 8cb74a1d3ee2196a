#include "scene/timeline.hpp"

#include <cmath>

#include "scene/files/obj.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/toml_table.hpp"
#include "scene/ray.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

constexpr const char* kHead = "version = 1\nscene = \"demo.gltf\"\n";

Result<Timeline> parse(const std::string& text) {
  return parse_timeline(text, "scenes/t.toml");
}

std::string error_of(const std::string& text) {
  const auto timeline = parse(text);
  if (timeline) return "no error";
  EXPECT_EQ(timeline.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(timeline.failure().message.find('\n'), std::string::npos);
  return timeline.failure().message;
}

std::string event(const std::string& type, const std::string& rest) {
  return "[[event]]\ntype = \"" + type + "\"\n" + rest + "\n";
}

TEST(Timeline, DefaultsAndRelativeScenePath) {
  const auto timeline = parse(kHead).value_or_throw();
  EXPECT_EQ(timeline.scene, std::filesystem::path("scenes/demo.gltf"));
  EXPECT_EQ(timeline.smoke.voxels, 1800u);
  EXPECT_EQ(timeline.duration, 4.0f);
  EXPECT_FALSE(timeline.grid.size);
}

TEST(Timeline, ReadsEverything) {
  const auto timeline = parse(std::string(kHead) + R"(duration = 5.5
exposure = -1
[grid]
voxel = 0.5
size = [120, 20, 120]
origin = [-30, 0, -30.5]
[smoke]
voxels = 900
bloom = 2
extinction = 4.5
albedo = [0.9, 0.8, 0.7]
anisotropy = -0.5
multiple_scattering = 0.5
erosion = 0.25
noise_size = 2
[sky]
zenith = [0, 0.1, 0.2]
horizon = [0.3, 0.4, 0.5]
ambient = [0.6, 0.7, 0.8]
stars = 2
[[camera]]
time = 0
position = [1, 2, 3]
target = [4, 5, 6]
fov = 45
[[event]]
type = "shot"
time = 2
from = [0, 1, 0]
toward = [0, 1, -1]
stay = 0.75
flash = 3
[[event]]
type = "shot"
time = 1.5
from = [0, 2, 0]
toward = [0, 1, -1]
[[event]]
type = "smoke"
time = 0.25
from = [0, 1, 5]
at = [0, 0, 0]
)")
                            .value_or_throw();
  EXPECT_EQ(timeline.duration, 5.5f);
  EXPECT_EQ(timeline.exposure, -1.0f);
  EXPECT_EQ(timeline.grid.size, glm::ivec3(120, 20, 120));
  EXPECT_EQ(timeline.grid.origin_world, glm::vec3(-30, 0, -30.5f));
  EXPECT_EQ(timeline.smoke.albedo, glm::vec3(0.9f, 0.8f, 0.7f));
  EXPECT_EQ(timeline.smoke.multiple_scattering, 0.5f);
  EXPECT_EQ(timeline.sky.ambient, glm::vec3(0.6f, 0.7f, 0.8f));
  EXPECT_EQ(timeline.sky.stars, 2.0f);
  ASSERT_EQ(timeline.camera.size(), 1u);
  EXPECT_NEAR(timeline.camera[0].camera.vertical_fov, 0.785398f, 1e-5f);
  ASSERT_EQ(timeline.shots.size(), 2u);
  EXPECT_EQ(timeline.shots[0].time, 1.5) << "by time";
  EXPECT_EQ(timeline.shots[1].times.stay, 0.75f);
  EXPECT_EQ(timeline.shots[1].times.reach, 0.25f);
  EXPECT_EQ(timeline.shots[0].flash, 25.0f);
  EXPECT_EQ(timeline.shots[1].flash, 3.0f);
  ASSERT_EQ(timeline.smokes.size(), 1u);
  EXPECT_EQ(timeline.smokes[0].from_world, glm::vec3(0, 1, 5));
}

TEST(Timeline, SmokeHasEitherAnAnisotropyOrDroplets) {
  const auto drops = parse(std::string(kHead) + "[smoke]\ndroplet = 8\n").value_or_throw();
  EXPECT_EQ(drops.smoke.droplet, 8.0f);
  const auto neither = parse(std::string(kHead)).value_or_throw();
  EXPECT_EQ(neither.smoke.droplet, std::nullopt);
}

TEST(Timeline, NonAsciiOnlyInCommentsAndTexts) {
  const auto timeline = parse("version = 1 # \xc9\x8c\nscene = \"a\\\"\xc9\x8c.gltf\" # '\xc9\x8c\n");
  ASSERT_TRUE(timeline) << timeline.failure().message;
  EXPECT_EQ(timeline->scene, std::filesystem::path("scenes/a\"\xc9\x8c.gltf"));
}

TEST(Timeline, ReadsTheLifetimeOfASmoke) {
  const auto usual = parse(kHead), chosen = parse(std::string(kHead) + "[smoke]\nhold = 2\ndissolve = 0.5\n");
  ASSERT_TRUE(usual && chosen);
  EXPECT_EQ(usual->smoke.hold, 18.0f);
  EXPECT_EQ(usual->smoke.dissolve, 3.0f);
  EXPECT_EQ(chosen->smoke.hold, 2.0f);
  EXPECT_EQ(chosen->smoke.dissolve, 0.5f);
}

TEST(Timeline, ReadsBlastsMovesEditsAndDoors) {
  const auto timeline =
      parse(kHead + event("blast", "time = 3\nat = [1, 2, 3]\nradius = 4\nremaining = 0.5\nflash = 0") +
            event("blast", "time = 1\nat = [0, 0, 0]\nrefill_rim = 1\nrefill_middle = 2") +
            event("move", "time = 2\nbody = \"runner\"\nto = [4, 0, -1]") +
            event("edit", "time = 5\nlow = [0, 0, 0]\nhigh = [1, 2, 3]\nsolid = false") +
            event("door", "time = 6\nobject = \"front door\"\nopen = true"))
          .value_or_throw();
  ASSERT_EQ(timeline.blasts.size(), 2u);
  EXPECT_EQ(timeline.blasts[0].time, 1);  // sorted by time
  EXPECT_EQ(timeline.blasts[0].radius, 5.0f);
  EXPECT_EQ(timeline.blasts[0].refill_middle, 2.0f);
  EXPECT_EQ(timeline.blasts[1].at_world, glm::vec3(1, 2, 3));
  EXPECT_EQ(timeline.blasts[1].remaining, 0.5f);
  EXPECT_EQ(timeline.blasts[0].flash, 250.0f);
  EXPECT_EQ(timeline.blasts[1].flash, 0.0f);
  ASSERT_EQ(timeline.moves.size(), 1u);
  EXPECT_EQ(timeline.moves[0].body, "runner");
  EXPECT_EQ(timeline.moves[0].to_world, glm::vec3(4, 0, -1));
  ASSERT_EQ(timeline.edits.size(), 1u);
  EXPECT_EQ(timeline.edits[0].high_world, glm::vec3(1, 2, 3));
  EXPECT_FALSE(timeline.edits[0].solid);
  ASSERT_EQ(timeline.doors.size(), 1u);
  EXPECT_EQ(timeline.doors[0].object, "front door");
  EXPECT_TRUE(timeline.doors[0].open);
  EXPECT_EQ(timeline.doors[0].place, "scenes/t.toml:30:10");
}

TEST(Timeline, ReadsShotShapesAndTexts) {
  const auto timeline = parse(std::string(kHead) + R"([smoke]
hole_rim = 0.02
[[event]]
type = "shot"
time = 1
from = [0, 1, 0]
toward = [0, 1, -1]
shape = "mask"
mask = "masks/star.png"
roll = 90
[[event]]
type = "shot"
time = 1
from = [0, 1, 0]
toward = [0, 1, -1]
shape = "box"
[[event]]
type = "text"
time = 3
text = "BRUME \u00e9"
from = [0, 1, 4]
toward = [0, 1, -1]
[[event]]
type = "text"
time = 2
text = "a"
from = [0, 1, 4]
toward = [0, 1, -1]
size = 0.75
font = "fonts/some.ttf"
spacing = 0.25
interval = 0.125
stay = 5
roll = -45
)")
                            .value_or_throw();
  EXPECT_EQ(timeline.smoke.hole_rim, 0.02f);
  ASSERT_EQ(timeline.shots.size(), 2u);
  EXPECT_EQ(timeline.shots[0].shape, ShotShape::mask);
  EXPECT_EQ(timeline.shots[0].mask, std::filesystem::path("scenes/masks/star.png"));
  EXPECT_NEAR(timeline.shots[0].roll, 1.5707963f, 1e-6f);
  EXPECT_EQ(timeline.shots[1].shape, ShotShape::box);
  ASSERT_EQ(timeline.texts.size(), 2u);
  const TextEvent& text = timeline.texts[0];
  EXPECT_EQ(text.time, 2) << "by time";
  EXPECT_EQ(text.text, "a");
  EXPECT_EQ(text.from_world, glm::vec3(0, 1, 4));
  EXPECT_EQ(text.toward_world, glm::vec3(0, 1, -1));
  EXPECT_EQ(text.size, 0.75f);
  EXPECT_EQ(text.font, std::filesystem::path("scenes/fonts/some.ttf"));
  EXPECT_EQ(text.spacing, 0.25f);
  EXPECT_EQ(text.interval, 0.125f);
  EXPECT_EQ(text.times.stay, 5);
  EXPECT_EQ(text.times.reach, 0.25f);
  EXPECT_NEAR(text.roll, -0.7853982f, 1e-6f);
  EXPECT_EQ(timeline.texts[1].text, "BRUME \xc3\xa9");
  EXPECT_TRUE(timeline.texts[1].font.empty());
}

/// Each kind of mistake, in full.
TEST(Timeline, MessagesOfMistakes) {
  const auto in_smoke = [](const std::string& line) { return error_of(kHead + ("[smoke]\n" + line)); };
  const std::string place = "scenes/t.toml:4:";
  EXPECT_EQ(in_smoke("droplet = 51"), place + "11: \"droplet\": expected a number from 0.1 to 50, found 51");
  EXPECT_EQ(in_smoke("droplet = 8\nanisotropy = 0.3"),
            place + "11: \"droplet\": cannot be combined with \"anisotropy\"; remove one of them");
  EXPECT_EQ(in_smoke("  blooom = 5"),
            place + "3: unknown key \"blooom\" in [smoke]; did you mean \"bloom\"?");
  EXPECT_EQ(
      error_of(kHead + event("burst", "time = 1")).find(place + "8: \"type\": expected \"smoke\", \"shot\""),
      0u);
  EXPECT_EQ(error_of(kHead + event("move", "time = 1\nto = [0, 0, 0]")),
            "scenes/t.toml:3:1: [[event]] lacks the key \"body\"");
  EXPECT_EQ(error_of(kHead + std::string("[grid]\nsize = [0, 1, 1]")),
            place + "9: \"size\": expected a whole number from 1 to 4096, found 0");
  EXPECT_EQ(error_of(kHead + std::string("[sky]\nzenith = [1, 2]")),
            place + "10: \"zenith\": expected three numbers, like [0.0, 1.0, 2.0]");
}

TEST(Timeline, MistakesNamePlaceKeyAndKind) {
  const auto after_head = [](const std::string& text) { return error_of(kHead + text); };
  const std::string aimed = "time = 1\nfrom = [0, 1, 0]\ntoward = [0, 1, -1]\n";
  const std::string mask = aimed + "shape = \"mask\"\n";
  const std::string key = "[[camera]]\ntime = 1\nposition = [0,0,0]\ntarget = [0,0,1]\n";
  std::vector<Mistake> mistakes{
      {"durration = 5", "3:1", {"unknown key \"durration\"", "\"duration\"?"}},
      {event("shot", aimed + "radios = 1"), "8:1", {"unknown key \"radios\"", "\"radius\"?"}},
      {"[grid]\nvoxel = 0", "4:9", {"\"voxel\": expected a number from", "found 0"}},
      {"[grid]\nsize = [1, 1000000, 1]", "4:12", {"\"size\": expected a whole number from", "found 1000000"}},
      {"duration = nan", "3:12", {"\"duration\": expected a number from", "found nan"}},
      {"duration = \"long\"", "3:12", {"\"duration\": expected a number from"}},
      {"[smoke]\ndissolve = 0", "4:12", {"\"dissolve\": expected a number from", "found 0"}},
      {"smoke = 1", "3:9", {"expected a table [smoke]"}},
      {"event = [1]", "3:9", {"expected tables [[event]]"}},
      {event("smoke", "time = 1\nfrom = [0,0,0]"), "3:1", {"lacks the key \"at\""}},
      {key + key, "8:8", {"\"time\": expected a later time"}},
      {event("shot", aimed + "shape = \"star\""), "8:9", {"\"shape\": expected \"cylinder\""}},
      {event("shot", mask), "3:1", {"lacks the key \"mask\""}},
      {event("shot", aimed + "mask = \"a.png\""), "8:8", {"\"mask\": belongs to shape"}},
      {event("text", aimed), "3:1", {"lacks the key \"text\""}},
      {event("text", aimed + "text = \"\""), "8:8", {"\"text\": expected 1 to 1024 bytes"}},
      {event("text", aimed + "text = \"" + std::string(1025, 'a') + "\""), "8:8", {"1 to 1024 bytes"}},
      {event("text", aimed + "text = \"a\"\nfont = \"/usr/a.ttf\""), "9:8", {"\"font\"", "below the folder"}},
      {event("text", "time = 1\nfrom = [0, 1, 0]\ntoward = [0, 1, 0]\ntext = \"a\""), "7:10", {"\"toward\""}},
      {event("blast", "time = 1\nat = [0, 0, 0]\nrefill_rim = 6"), "3:1", {"\"refill_middle\"", "no less"}},
      {event("edit", "time = 1\nlow = [0, 5, 0]\nhigh = [1, 2, 3]\nsolid = true"),
       "7:8",
       {"\"high\"", "\"low\""}},
      {event("edit", "time = 1\nlow = [0, 0, 0]\nhigh = [1, 2, 3]\nsolid = 1"),
       "8:9",
       {"\"solid\"", "true or"}},
      {event("door", "time = 1\nobject = \"a\"\nopened = true"), "3:1", {"lacks the key \"open\""}}};
  for (const std::string name : {"../a.png", "/a.png", "a/../../b.png", "C:\\\\a.png"})
    mistakes.push_back(
        {event("shot", mask + "mask = \"" + name + "\""), "9:8", {"\"mask\"", "below the folder"}});
  expect_mistakes(after_head, "scenes/t.toml", mistakes);
  expect_mistakes(error_of, "scenes/t.toml",
                  {{"scene = \"a.obj\"", "1:1", {"lacks the key \"version\""}},
                   {"version = 2\nscene = \"a.obj\"", "1:11", {}},
                   {"version = 1", "1:1", {"lacks the key \"scene\""}},
                   {"version = \xc9\x8c 1", "1:11", {"expected ASCII"}},
                   {"scene = \"\"\"x\"\"\"\" \xc9\x8c", "1:18", {"expected ASCII"}},
                   {"scene = '''\n'' \xc9\x8c'''", "2:4", {"expected ASCII"}}});
  EXPECT_TRUE(error_of("version = 1\nscene = \n").starts_with("scenes/t.toml:2:"));
}

TEST(Timeline, AnUnknownDoorSuggestsTheNearestObject) {
  const auto timeline = parse(kHead + event("door", "time = 6\nobject = \"frontdor\"\nopen = true"));
  ASSERT_TRUE(timeline);
  Scene scene;
  scene.objects.resize(3);
  scene.objects[0].name = "floor";
  scene.objects[1].name = "front door";
  EXPECT_EQ(check_objects(*timeline, scene).failure().message,
            "scenes/t.toml:6:10: the scene has no object \"frontdor\"; did you mean \"front door\"?");
  scene.objects[2].name = "frontdor";
  EXPECT_TRUE(check_objects(*timeline, scene));
  EXPECT_EQ(check_objects(*timeline, Scene()).failure().message,
            "scenes/t.toml:6:10: the scene has no object \"frontdor\"");
}

Timeline path_of(std::initializer_list<CameraKey> keys) {
  Timeline timeline;
  timeline.camera = keys;
  return timeline;
}

CameraKey key(double time, glm::vec3 position, float fov = 1.0f) {
  return {time, {position, position + glm::vec3(0, 0, -1), fov}};
}

TEST(CameraPath, PassesThroughItsKeysAndStaysAtTheEnds) {
  const Timeline timeline = path_of({key(1, {0, 0, 0}), key(2, {5, 1, 0}), key(4, {6, 3, 0})});
  for (const CameraKey& at : timeline.camera)
    EXPECT_LT(glm::distance(camera_at(timeline, {}, at.time).position_world, at.camera.position_world),
              1e-6f);
  EXPECT_EQ(camera_at(timeline, {}, -5).position_world, glm::vec3(0));
  EXPECT_EQ(camera_at(timeline, {}, 99).position_world, glm::vec3(6, 3, 0));
  EXPECT_EQ(camera_at(timeline, {}, std::nan("")).position_world, glm::vec3(0));
  EXPECT_EQ(camera_at(Timeline(), {{1, 2, 3}, {0, 0, 0}, 1}, 0).position_world, glm::vec3(1, 2, 3));
}

TEST(CameraPath, UniformMotionStaysUniformBetweenInnerKeys) {
  // Keys on a line at uneven times, all at 2 m/s: the spans between inner keys are straight and even.
  const Timeline timeline = path_of(
      {key(0, {0, 0, 0}), key(1, {2, 0, 0}), key(1.5, {3, 0, 0}), key(4, {8, 0, 0}), key(5, {10, 0, 0})});
  for (double time = 1; time <= 4; time += 0.125)
    EXPECT_NEAR(camera_at(timeline, {}, time).position_world.x, 2 * time, 1e-5) << time;
}

TEST(CameraPath, SpeedIsContinuous) {
  const Timeline timeline = path_of({key(0, {0, 0, 0}, 0.5f), key(0.3, {5, -1, 0}, 1.5f),
                                     key(2, {6, 3, 1}, 1.4f), key(2.5, {-1, 3, 2}, 0.6f)});
  const auto slope = [&](double from, double to) {
    return (glm::dvec3(camera_at(timeline, {}, to).position_world) -
            glm::dvec3(camera_at(timeline, {}, from).position_world)) /
           (to - from);
  };
  constexpr double h = 1e-3;
  for (const CameraKey& at : timeline.camera) {
    // Both one-sided slopes differ from the speed by at most h/2 times the acceleration (below 500 here).
    EXPECT_LT(glm::distance(slope(at.time - h, at.time), slope(at.time, at.time + h)), 500 * h) << at.time;
  }
}

TEST(CameraPath, TheFieldOfViewNeverOvershoots) {
  const Timeline timeline = path_of({key(0, {0, 0, 0}, 0.1f), key(1, {1, 0, 0}, 3.0f),
                                     key(1.1, {2, 0, 0}, 3.0f), key(2, {3, 0, 0}, 0.02f)});
  for (double time = 0; time <= 2; time += 0.001) {
    const float fov = camera_at(timeline, {}, time).vertical_fov;
    EXPECT_GE(fov, 0.02f - 1e-6f);
    EXPECT_LE(fov, 3.0f + 1e-6f);
  }
}

TEST(Timeline, MoreVolumesThanAFrameShowsAreRefusedWithTheirPlace) {
  std::string text = "version = 1\nscene = \"a.obj\"\n";
  for (std::size_t i = 0; i < kMostVolumes; ++i) text += "[[volume]]\nfile = \"a.vdb\"\n";
  EXPECT_EQ(parse_timeline(text, "t.toml")->volumes.size(), kMostVolumes);
  const auto refused = parse_timeline(text + "[[volume]]\nfile = \"a.vdb\"\n", "t.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.failure().message, "t.toml:68:8: [[volume]]: expected at most 32 of them");
}

TEST(Timeline, HasAToneCurve) {
  const auto parse = [](const std::string& tone) {
    return parse_timeline("version = 1\nscene = \"a.obj\"\n" + tone, "t.toml");
  };
  EXPECT_EQ(parse("")->tone, ToneCurve::neutral);
  EXPECT_EQ(parse("tone = \"neutral\"")->tone, ToneCurve::neutral);
  EXPECT_EQ(parse("tone = \"standard\"")->tone, ToneCurve::standard);
  const auto wrong = parse("tone = \"filmic\"");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.failure().message.find("expected \"neutral\" or \"standard\""), std::string::npos);
}

TEST(FirstHit, IsTheNearestBeforeTheRay) {
  const auto scene = parse_obj_scene(kCubeObj, "cube.obj", MemoryFiles());
  ASSERT_TRUE(scene);
  const auto hit = first_hit(*scene, {0.25f, 0.5f, 5}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_LT(glm::distance(*hit, glm::vec3(0.25f, 0.5f, 1)), 1e-5f);
  EXPECT_FALSE(first_hit(*scene, {0, 0, 5}, {0, 0, 1})) << "behind the ray";
  EXPECT_FALSE(first_hit(*scene, {3, 0, 5}, {0, 0, -1})) << "beside the cube";
}

}  // namespace
}  // namespace brume::scene
