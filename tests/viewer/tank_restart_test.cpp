// Samples of a tank are added up only while nothing that they show changes: after any change, the picture is
// that of a renderer that has never shown anything else.
#include <functional>

#include "apps/viewer/tank_refiner.hpp"
#include "film/tank_playback.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace brume::viewer {
namespace {

constexpr glm::uvec2 kRestarted(24, 16);
/// More than a batch of light paths is good for.
constexpr std::uint32_t kRestartSamples = film::TankPhotons::kSamplesOfBatch + 2;

spheres::Tank small_tank() {
  spheres::Tank tank{{40, 40, 24}, 0.01f, {}, {}};
  tank.spheres = {{{12, 12, 12}, 10}, {{29, 13, 11}, 7}, {{13, 30, 13}, 8}, {{30, 29, 12}, 9}};
  tank.colors = {0xff80c0ff, 0xffffb040, 0x30f0f0f0, 0xff60d060};
  return tank;
}

/// Every setting that can show in a picture does.
scene::TankScene full_scene() {
  scene::TankScene scene;
  scene.photons = 70000;  // the window shows fewer first
  scene.fog = {0.5f, {0.1f, 0.2f, 0.3f}};
  scene.lights = {{{0.3f, 0.4f, 0.8f}, {1, 0.8f, 0.6f}, 2, 0.1f},
                  {{-0.4f, 0.2f, 0.5f}, {0.5f, 0.7f, 1}, 1, 0.05f}};
  scene.lights[1].keys = {{1, {-0.4f, 0.2f, 0.5f}}, {3, {-0.2f, 0.3f, 0.6f}}};
  scene.glass = scene::TankGlass{{0.05f, 0, 0.3f}, {0.12f, 0.1f, 0.08f}, 1.5f};
  scene::CameraKey key;
  key.camera = {{0.2f, 0.1f, 0.8f}, {0, 0, 0}, 0.6f};
  key.camera.lens = {.aperture = 0.02f, .focus = 0.5f, .blades = 6};
  scene.camera = {key};
  return scene;
}

class TankRestartPictures : public gpu::GpuTest {
 protected:
  class Picture {
   public:
    explicit Picture(const spheres::Tank& tank) : tank_(tank), picture_(context(), runner(), tank) {}
    /// Shows all samples of a scene; returns whether the picture has begun again.
    bool show(const scene::TankScene& scene, double seconds) {
      TankState state(scene, planning::size_of(tank_));
      state.seek(seconds);
      const bool begins = picture_.show(plan_picture(state, tank_, kRestarted),
                                        planning::plan_tank_display(scene, kRestarted));
      photons_.update(picture_, tank_, false);  // the window shows a preview first
      film::add_samples(runner(), picture_, photons_, tank_, kRestartSamples, {});
      runner().run([&](gpu::Recorder& recorder) { picture_.record(recorder, {}); });
      return begins;
    }
    std::vector<glm::vec4> sums() const { return read_back<glm::vec4>(picture_.sampler().sum()); }
    std::vector<glm::u8vec4> shown() const { return read_back<glm::u8vec4>(picture_.display()); }

   private:
    const spheres::Tank& tank_;
    render::TankPicture picture_;
    film::TankPhotons photons_;
  };

  struct Row {
    const char* name;
    std::function<void(scene::TankScene&)> change;
    bool spheres, voxels;  // whether the picture of spheres, and that of voxels, is another one
    bool begins = true;
    double seconds = 0;
  };
  static std::vector<Row> rows();
};

std::vector<TankRestartPictures::Row> TankRestartPictures::rows() {
  using S = scene::TankScene;
  const auto camera = [](S& s) -> scene::Camera& { return s.camera[0].camera; };
  return {
      {"position", [=](S& s) { camera(s).position_world.x += 0.01f; }, true, true},
      {"target", [=](S& s) { camera(s).target_world.y += 0.01f; }, true, true},
      {"fov", [=](S& s) { camera(s).vertical_fov += 0.01f; }, true, true},
      {"aperture", [=](S& s) { camera(s).lens.aperture += 0.01f; }, true, true},
      {"pinhole", [=](S& s) { camera(s).lens.aperture = 0; }, true, true},
      {"focus", [=](S& s) { camera(s).lens.focus += 0.1f; }, true, true},
      {"blades", [=](S& s) { camera(s).lens.blades = 5; }, true, true},
      {"lens points", [](S& s) { s.lens_points = scene::LensPoints::rejection; }, true, true},
      {"light's position", [](S& s) { s.lights[0].position_world.y += 0.1f; }, true, true},
      {"light's color", [](S& s) { s.lights[0].color.g = 0.5f; }, true, true},
      {"light's intensity", [](S& s) { s.lights[0].intensity *= 1.1f; }, true, true},
      {"light's radius", [](S& s) { s.lights[0].radius *= 1.5f; }, true, false},
      {"light's time", [](S&) {}, true, true, true, 2},
      {"one light", [](S& s) { s.lights.pop_back(); }, true, true},
      {"another light",
       [](S& s) {
         s.lights.push_back({{0.1f, 0.5f, 0.3f}});
       },
       true, true},
      {"no light", [](S& s) { s.lights.clear(); }, true, true},
      {"glass's position", [](S& s) { s.glass->position_world.x += 0.02f; }, true, true},
      {"glass's radii", [](S& s) { s.glass->radii.y += 0.02f; }, true, true},
      {"glass's index", [](S& s) { s.glass->index = 1.6f; }, true, true},
      {"no glass", [](S& s) { s.glass.reset(); }, true, true},
      {"fog's extinction", [](S& s) { s.fog.extinction = 1; }, true, true},
      {"fog's color", [](S& s) { s.fog.color.r = 0.3f; }, true, true},
      {"zenith", [](S& s) { s.sky.zenith.g = 1; }, true, true},
      {"horizon", [](S& s) { s.sky.horizon.g = 1; }, true, true},
      {"ambient", [](S& s) { s.sky.ambient.g = 1; }, true, true},
      {"bounces", [](S& s) { s.bounces = 1; }, true, false},
      {"photons", [](S& s) { s.photons = 30000; }, true, false},
      {"no photons", [](S& s) { s.photons = 0; }, true, false},
      {"lighting", [](S& s) { s.lighting = scene::TankLighting::exact; }, false, true},
      {"view",
       [](S& s) {
         s.view = s.view == scene::TankView::voxels ? scene::TankView::spheres : scene::TankView::voxels;
       },
       true, true},
      {"exposure", [](S& s) { s.exposure = 1; }, false, false, false},
      {"tone", [](S& s) { s.tone = scene::ToneCurve::standard; }, false, false, false},
      {"dither", [](S& s) { s.dither = 0; }, false, false, false},
      {"samples", [](S& s) { s.samples = 7; }, false, false, false},
      {"stars", [](S& s) { s.sky.stars = 1; }, false, false, false},
  };
}

TEST_F(TankRestartPictures, AfterAnyChangeAreThoseOfANewRenderer) {
  const spheres::Tank tank = small_tank();
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    const bool is_voxels = view == scene::TankView::voxels;
    scene::TankScene still = full_scene();
    still.view = view;
    Picture picture(tank);
    EXPECT_TRUE(picture.show(still, 0));
    EXPECT_FALSE(picture.show(still, 0));
    const auto sums = picture.sums();
    const auto shown = picture.shown();
    for (const Row& row : rows()) {
      SCOPED_TRACE(testing::Message() << row.name << (is_voxels ? ", voxels" : ", spheres"));
      scene::TankScene changed = still;
      row.change(changed);
      EXPECT_EQ(picture.show(changed, row.seconds), row.begins);
      Picture other(tank);
      other.show(changed, row.seconds);
      EXPECT_TRUE(picture.sums() == other.sums());
      EXPECT_TRUE(picture.shown() == other.shown());
      EXPECT_EQ(picture.sums() != sums, is_voxels ? row.voxels : row.spheres);
      // And back.
      EXPECT_EQ(picture.show(still, 0), row.begins);
      EXPECT_TRUE(picture.sums() == sums);
      EXPECT_TRUE(picture.shown() == shown);
    }
  }
}

}  // namespace
}  // namespace brume::viewer
