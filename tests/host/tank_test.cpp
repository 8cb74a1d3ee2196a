// Tanks of spheres in a host's frames: over its surfaces, under the smoke.
#include "render/tank_picture.hpp"
#include "spheres/file.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/path_tracer/tank_fixture.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

constexpr float kFar = 1e6f;  // [m]: no surface

class TankTest : public HostedPair {
 protected:
  TankTest() {
    tank_ = reference::tank_of({40, 30, 20}, 0.1f);
    reference::pack_at_random(tank_, 400, {1.5f, 5}, 200, 90, 3);
    scene_ = reference::dark_scene();
    scene_.sky.ambient = glm::vec3(0.2f, 0.4f, 0.6f);
    scene_.bounces = 2;
    scene_.lights.push_back({{3, 4, 5}, {1, 0.5f, 0.25f}, 60, 0.2f, {}});
    camera_ = {{0.5f, 0.3f, 5}, {0, 0, 0}, 0.7f};
    make_sides(2, 1);
    make_tank();
  }
  ~TankTest() override { EXPECT_OK(brume_tank_destroy(shown_)); }

  void make_tank() {
    brume_tank_params params = brume_tank_defaults();
    for (int axis = 0; axis < 3; ++axis) params.size[axis] = tank_.size[axis];
    params.voxel = tank_.voxel;
    params.spheres = &tank_.spheres[0].center.x;
    params.colors = tank_.colors.data();
    params.sphere_count = tank_.spheres.size();
    ASSERT_OK(brume_tank_create(context_.get(), &params, &shown_));
    set_lighting();
  }
  void set_lighting() {
    brume_tank_lighting lighting = brume_tank_lighting_defaults();
    std::vector<brume_tank_light> lights;
    for (const scene::TankLight& light : scene_.lights) {
      const glm::vec3 intensity = light.intensity * light.color;
      lights.push_back(
          {point_of(light.position_world), light.radius, {intensity.r, intensity.g, intensity.b}});
    }
    lighting.lights = lights.data();
    lighting.light_count = lights.size();
    for (int c = 0; c < 3; ++c) {
      lighting.ambient[c] = scene_.sky.ambient[c];
      lighting.fog_color[c] = scene_.fog.color[c];
    }
    lighting.bounces = scene_.bounces;
    lighting.fog_extinction = scene_.fog.extinction;
    lighting.photons = scene_.photons;
    if (scene_.glass) {
      lighting.glass_index = scene_.glass->index;
      lighting.glass_position = point_of(scene_.glass->position_world);
      lighting.glass_radii = point_of(scene_.glass->radii);
    }
    ASSERT_OK(brume_tank_set_lighting(shown_, &lighting));
  }

  brume_shown_tank shown(std::uint32_t samples = 4, std::uint32_t view = BRUME_TANK_SPHERES) const {
    brume_shown_tank tank = brume_shown_tank_defaults(shown_);
    tank.samples = samples;
    tank.view = view;
    return tank;
  }

  /// Draws tanks over surfaces whose distances along the camera's axis `distance_of` has; what the interface
  /// drew.
  template <std::invocable<glm::ivec2> DistanceOf>
  Pixels draw(std::vector<brume_shown_tank> tanks, DistanceOf distance_of,
              const brume_field* field = nullptr) {
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      upload_depth(distance_of);
      recording_->end();
      host_->wait_for_compute(commands);
      brume_frame_params params = frame_of(scenario_, 1);
      params.commands = commands;
      params.frame_number = frame;
      params.completed_frame = completed;
      params.camera.position = point_of(camera_.position_world);
      params.camera.forward = point_of(camera_.target_world - camera_.position_world);
      params.camera.up = point_of(camera_.up_world);
      params.camera.vertical_fov = camera_.vertical_fov;
      params.depth.view = depth_.view();
      params.depth.layout = depth_.last_use.get(*gpu_).layout;
      params.jitter_index = jitter_index_;
      params.tanks = tanks.data();
      params.tank_count = tanks.size();
      ASSERT_OK(brume_renderer_record(smoke_->renderer, field, &params));
      VkImage image = VK_NULL_HANDLE;
      ASSERT_OK(brume_renderer_smoke(smoke_->renderer, &image, nullptr));
      copies_.push_back(readback_buffer(*gpu_));
      host_->copy(commands, image, {kSize.x, kSize.y}, copies_.back().handle());
    });
    host_->wait();
    return pixels_of(copies_.back());
  }
  Pixels draw(std::vector<brume_shown_tank> tanks, float distance = kFar) {
    return draw(std::move(tanks), [&](glm::ivec2) { return distance; });
  }

  /// The picture of the tank alone, behind which all has the radiance `behind`.
  Pixels reference(std::uint32_t samples, scene::TankView view, const glm::vec3& behind) {
    scene::TankScene scene = scene_;
    scene.sky.zenith = scene.sky.horizon = behind;
    scene.view = view;
    std::optional<render::TankPicture> picture;
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      picture.emplace(*gpu_, *recording_, tank_);
      const planning::TankPlan plan = planning::plan_tank(scene, tank_, 0, kSize, camera_);
      picture->set_photons(spheres::trace_light_paths(
          tank_, spheres::list_bricks(tank_), planning::light_path_scene(plan), {.count = scene.photons}));
      picture->show(plan, planning::plan_tank_display(scene, kSize));
      picture->record(recording_->recorder(), {samples});
      copies_.push_back(readback_buffer(*gpu_));
      recording_->recorder().read_back(picture->sampler().radiance(), copies_.back());
      recording_->end();
    });
    host_->wait();
    return pixels_of(copies_.back());
  }
  /// Expects that what the interface drew, over that radiance, is the tank's picture: halves that are rounded
  /// or truncated three times, of the layer, in it and in the picture, each by 2^-10 of itself at most.
  static void expect_over(const Pixels& layer, const glm::vec3& behind, const Pixels& picture) {
    for (std::size_t i = 0; i < layer.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double over = layer[i][c] + layer[i].a * double{behind[c]};
        EXPECT_NEAR(over, picture[i][c], 3 * over / 1024 + 1e-6) << "pixel " << i << ", " << c;
      }
  }

  template <typename DistanceOf>
  void upload_depth(DistanceOf distance_of) {
    if (depth_.handle() == VK_NULL_HANDLE) {
      gpu::ImageInfo info;
      info.format = VK_FORMAT_R32_SFLOAT;
      info.size = {kSize, 1};
      info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
      depth_ = gpu::Image(*gpu_, info);
      nearest_.emplace(*gpu_, gpu::SamplerInfo{VK_FILTER_NEAREST});
    }
    std::vector<float> depths;
    for (int y = 0; y < static_cast<int>(kSize.y); ++y)
      for (int x = 0; x < static_cast<int>(kSize.x); ++x) {
        const float distance = distance_of(glm::ivec2(x, y));
        depths.push_back(distance < kFar ? planning::kNearPlane / distance : 0);
      }
    const gpu::Recorder::Region all{std::as_bytes(std::span(depths)), {}, {kSize, 1}};
    recording_->recorder().upload(depth_, std::span(&all, 1));
    recording_->recorder().prepare_for_draws({gpu::sampled(depth_, *nearest_)});
  }
  void TearDown() override {
    host_->wait();
    depth_ = {};
    nearest_.reset();
    HostedPair::TearDown();
  }

  spheres::Tank tank_;
  scene::TankScene scene_;
  scene::Camera camera_;
  std::uint32_t jitter_index_ = 0;
  api::Context context_;
  brume_tank* shown_ = nullptr;
  gpu::Image depth_;
  std::optional<gpu::Sampler> nearest_;
};

TEST_F(TankTest, IsThePictureOfTheTankOverWhatIsBehind) {
  const glm::vec3 behind(0.3f, 0.2f, 0.1f);
  for (const bool foggy : {false, true}) {
    if (foggy) scene_.fog = {0.3f, {0.2f, 0.3f, 0.5f}};
    set_lighting();
    const Pixels layer = draw({shown(4)});
    expect_over(layer, behind, reference(4, scene::TankView::spheres, behind));
    // Not all of it is behind, nor all before it.
    const auto clear = std::ranges::count_if(layer, [](const glm::dvec4& pixel) { return pixel.a > 0.9; });
    EXPECT_GT(clear, 200);
    EXPECT_LT(clear, 2000);
  }
}

TEST_F(TankTest, IsItsPictureThroughGlassAndByVoxels) {
  const glm::vec3 behind(0.1f, 0.2f, 0.3f);
  scene_.glass = scene::TankGlass{{0, 0, 1.8f}, {0.9f, 0.7f, 0.4f}, 1.5f, {}};
  scene_.photons = 4096;
  set_lighting();
  expect_over(draw({shown(4)}), behind, reference(4, scene::TankView::spheres, behind));
  expect_over(draw({shown(3, BRUME_TANK_VOXELS)}), behind, reference(3, scene::TankView::voxels, behind));
  scene_.glass.reset();
  set_lighting();
  expect_over(draw({shown(3, BRUME_TANK_VOXELS)}), behind, reference(3, scene::TankView::voxels, behind));
}

TEST_F(TankTest, AFileIsTheSameAsItsArrays) {
  const Pixels arrays = draw({shown()});
  const cli::WorkFolder folder;
  const std::string file = (folder.path() / "tank.spheres").string();
  spheres::save_tank(file, tank_).value_or_throw();
  EXPECT_OK(brume_tank_destroy(shown_));
  brume_tank_params params = brume_tank_defaults();
  params.file = file.c_str();
  ASSERT_OK(brume_tank_create(context_.get(), &params, &shown_));
  set_lighting();
  EXPECT_EQ(draw({shown()}), arrays);
}

TEST_F(TankTest, SurfacesHideIt) {
  const Pixels whole = draw({shown()});
  EXPECT_EQ(draw({shown()}, 20), whole) << "a wall behind it";
  for (const glm::dvec4& pixel : draw({shown()}, 1)) EXPECT_EQ(pixel, glm::dvec4(0, 0, 0, 1)) << "before it";
  // Half of the picture.
  const auto half = draw({shown()}, [](glm::ivec2 px) { return px.x < 32 ? 1.0f : 20.0f; });
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_EQ(half[i], i % kSize.x < 32 ? glm::dvec4(0, 0, 0, 1) : whole[i]) << "pixel " << i;
}

TEST_F(TankTest, AWallThroughItHidesWhatIsBehindTheWall) {
  // The box is 2 m deep around the origin, which is about 5 m away; the wall shows more, the farther it is.
  double hidden = 0;
  for (const float distance : {3.9f, 4.5f, 5.0f, 5.5f, 6.2f}) {
    double seen = 0;
    for (const glm::dvec4& pixel : draw({shown()}, distance)) seen += 1 - pixel.a;
    EXPECT_GE(seen, hidden) << distance;
    hidden = seen;
  }
  EXPECT_GT(hidden, 300);
}

TEST_F(TankTest, SamplesOfFramesThatContinueAreThoseOfOne) {
  const Pixels one = draw({shown(12)});
  brume_shown_tank tank = shown(4);
  tank.continues_previous = 1;
  jitter_index_ = 4096;  // the same as 0: that of the first frame counts
  draw({shown(4)});
  for (const std::uint32_t jitter : {7u, 9u}) {
    jitter_index_ = jitter;
    const Pixels more = draw({tank});
    EXPECT_EQ(more == one, jitter == 9u) << jitter;
  }
  // Anything else begins again.
  camera_.position_world.x += 0.1f;
  jitter_index_ = 0;
  const Pixels moved = draw({tank});
  EXPECT_EQ(moved, draw({shown(4)}));
  jitter_index_ = 1;
  EXPECT_NE(moved, draw({shown(4)})) << "the noise of another frame";
}

TEST_F(TankTest, TurnedMovedAndScaledWithTheCameraItLooksTheSame) {
  const Pixels before = draw({shown(16)});
  const glm::vec3 x = glm::normalize(glm::vec3(1, 2, 3)), y = glm::normalize(glm::vec3(-2, 1, 0)),
                  z = glm::cross(x, y), moved(20, -3, 7);
  constexpr float kScale = 2.5f;
  const auto world = [&](const glm::vec3& p) { return kScale * (p.x * x + p.y * y + p.z * z) + moved; };
  brume_shown_tank tank = shown(16);
  tank.x_axis = point_of(kScale * x);
  tank.y_axis = point_of(kScale * y);
  tank.z_axis = point_of(kScale * z);
  tank.position = point_of(moved);
  camera_.position_world = world(camera_.position_world);
  camera_.target_world = world(camera_.target_world);
  camera_.up_world = y;
  const Pixels after = draw({tank});
  // Rounding moves rays by about 10^-6 of the picture: a path that meets the rim of a sphere may change.
  std::size_t apart = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const glm::dvec4 change = glm::abs(before[i] - after[i]);
    apart += std::max({change.r, change.g, change.b, change.a}) > 0.01;
  }
  EXPECT_LT(apart, before.size() / 100);
}

TEST_F(TankTest, TheNearerOneIsBeforeTheFartherOne) {
  brume_shown_tank near = shown(), far = shown();
  far.position = {0.4f, 0.2f, -6};
  const auto one = draw({near}), both = draw({near, far}), turned = draw({far, near});
  EXPECT_EQ(both, turned) << "their order does not matter";
  const auto behind = draw({far});
  for (std::size_t i = 0; i < one.size(); ++i)
    for (int c = 0; c < 4; ++c) {
      // Halves: the layers so far and their sum.
      const double over = (c < 3 ? one[i][c] : 0) + one[i].a * behind[i][c];
      EXPECT_NEAR(both[i][c], over, 3 * over / 1024 + 1e-6) << "pixel " << i;
    }
}

TEST_F(TankTest, SmokeIsBeforeItAndBehindIt) {
  tank_ = reference::tank_of({40, 30, 20}, 0.1f);
  reference::put(tank_, {20, 15, 10}, 10, reference::kWhite);
  EXPECT_OK(brume_tank_destroy(shown_));
  make_tank();
  smoke_->advance_to(2);
  camera_ = {{-6, 1.2f, 6}, {-6, 0.7f, 0}, 0.8f};
  const glm::vec3 forward = glm::normalize(camera_.target_world - camera_.position_world);
  const auto smoke_over = [&](float distance, float scale) {
    brume_shown_tank tank = shown(2);
    tank.x_axis = {scale, 0, 0};
    tank.y_axis = {0, scale, 0};
    tank.z_axis = {0, 0, scale};
    tank.position = point_of(camera_.position_world + distance * forward);
    return std::pair(draw(
                         {tank}, [](glm::ivec2) { return kFar; }, smoke_->field.get()),
                     draw({tank}, [](glm::ivec2) { return kFar; }));
  };
  // Close to the eye no smoke is before it: where nothing is seen through it, it is as without smoke. At its
  // rim the middle of a pixel may miss it.
  const auto [close, close_clear] = smoke_over(0.6f, 0.1f);
  int covered = 0;
  for (std::size_t i = 0; i < close.size(); ++i) {
    const std::size_t row = kSize.x;
    if (i % row == 0 || i % row == row - 1 || i < row || i + row >= close.size()) continue;
    if (close_clear[i].a + close_clear[i - 1].a + close_clear[i + 1].a + close_clear[i - row].a +
            close_clear[i + row].a >
        0)
      continue;
    ++covered;
    EXPECT_EQ(close[i], close_clear[i]) << "pixel " << i;
  }
  EXPECT_GT(covered, 100);
  // Far away smoke covers some of it.
  const auto [away, away_clear] = smoke_over(12, 2);
  int dimmed = 0;
  for (std::size_t i = 0; i < away.size(); ++i) {
    EXPECT_LE(away[i].a, away_clear[i].a);
    dimmed += away_clear[i].a == 0 && away[i] != away_clear[i];
  }
  EXPECT_GT(dimmed, 30);
}

TEST_F(TankTest, RefusesWhatIsNone) {
  brume_tank* tank = nullptr;
  const auto create = [&](auto change) {
    brume_tank_params params = brume_tank_defaults();
    params.spheres = &tank_.spheres[0].center.x;
    params.colors = tank_.colors.data();
    params.sphere_count = 1;
    params.size[0] = params.size[1] = params.size[2] = 40;
    change(params);
    return brume_tank_create(context_.get(), &params, &tank);
  };
  EXPECT_EQ(create([](auto& p) { p.size[1] = 0; }), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(create([](auto& p) { p.size[1] = 4096; }), BRUME_ERROR_LIMIT);
  EXPECT_EQ(create([](auto& p) { p.size[0] = p.size[1] = p.size[2] = 2048; }), BRUME_ERROR_LIMIT);
  EXPECT_EQ(create([](auto& p) { p.voxel = NAN; }), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(create([](auto& p) { p.size[0] = 1; }), BRUME_ERROR_ARGUMENT) << brume_last_error();
  EXPECT_NE(std::string(brume_last_error()).find("sphere 1 is not inside"), std::string::npos);
  EXPECT_EQ(create([](auto& p) { p.file = "nowhere.spheres", p.sphere_count = 0; }), BRUME_ERROR_DATA);
  EXPECT_EQ(create([](auto& p) { p.file = "nowhere.spheres"; }), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(create([](auto& p) { p.colors = nullptr; }), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(tank, nullptr);
  ASSERT_OK(create([](auto& p) { p.sphere_count = 0; }));
  for (const glm::dvec4& pixel : draw({brume_shown_tank_defaults(tank)}))
    ASSERT_EQ(pixel, glm::dvec4(0, 0, 0, 1)) << "an empty tank";
  EXPECT_OK(brume_tank_destroy(tank));
}

}  // namespace
}  // namespace brume::host
