// Volumes in a host's frames, and the shadows of all media on its surfaces.
#include <set>

#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "scene/options.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

namespace fs = std::filesystem;

class MediaTest : public HostedPair {
 protected:
  ~MediaTest() override {
    for (brume_volume* volume : volumes_) EXPECT_OK(brume_volume_destroy(volume));
  }

  /// A file with a cloud of a radius, and with `hot` a grid "temperature".
  fs::path cloud_file(const std::string& name, double radius, bool hot) {
    grids::GridFile file;
    const auto add = [&](const char* grid, double of_radius) {
      file.grids.push_back(grids::generate_cloud(
          {.kind = grids::CloudKind::sphere, .edge = 24, .voxel_size = 0.1, .radius = of_radius}));
      file.grids.back().name = grid;
    };
    add("density", radius);
    if (hot) add("temperature", radius / 2);
    grids::save_grid_file(folder_.path() / name, file).value_or_throw();
    return folder_.path() / name;
  }
  /// Shows a file in both; draw_both then has it.
  scene::VolumeOptions& add_volume(const fs::path& file) {
    scene::VolumeOptions options;
    options.file = file;
    options.extinction = 2;
    scenario_.timeline.volumes.push_back(options);
    return scenario_.timeline.volumes.back();
  }
  /// Loads what was added.
  void load_volumes() {
    scenario_.volumes = volumes::Volumes::load(scenario_.timeline.volumes).value_or_throw();
    for (const scene::VolumeOptions& options : scenario_.timeline.volumes) {
      const std::string file = options.file.string();
      brume_volume_params params = brume_volume_defaults();
      params.file = file.c_str();
      params.heat = options.heat.c_str();
      params.frame_rate = options.frame_rate;
      params.repeat = options.loop ? BRUME_REPEAT_LOOP : BRUME_REPEAT_NONE;
      params.wait_for_frame = 1;
      volumes_.push_back(nullptr);
      ASSERT_OK(brume_volume_create(context_.get(), &params, &volumes_.back()));
    }
  }
  /// The volumes of the timeline as the interface shows them.
  void show_volumes(brume_frame_params& params) {
    shown_.clear();
    for (std::size_t i = 0; i < volumes_.size(); ++i) {
      const scene::VolumeOptions& options = scenario_.timeline.volumes[i];
      brume_shown_volume shown = brume_shown_volume_defaults(volumes_[i]);
      const glm::mat4 world = volumes::world_from_file(options);
      shown.x_axis = point_of(glm::vec3(world[0]));
      shown.y_axis = point_of(glm::vec3(world[1]));
      shown.z_axis = point_of(glm::vec3(world[2]));
      shown.position = point_of(glm::vec3(world[3]));
      shown.seconds = params.seconds;
      shown.extinction = options.extinction;
      shown.kelvin = options.kelvin;
      shown_.push_back(shown);
    }
    params.volumes = shown_.data();
    params.volume_count = shown_.size();
  }

  /// Whether the shadows of the first frame are those of its radiance; the second one has no smoke.
  ///
  /// Of a surface behind media of radiance o and transmittance a, in the light of one light, the renderer
  /// shows p = o + a t p0: p0 without smoke, t of the light through it. All are stored as halves, o and a
  /// before they are used: devices round or truncate, so that p and p0 are off by at most u = 2^-10 of
  /// themselves, and (p - o) / (a p0) is t within (u p / (a p0) + u t) / (1 - u). The interface's t is off by
  /// u t. Floats add less than a hundredth of that.
  void expect_shadows() const {
    const Pixels media = pixels_of(copies_[0]), lit = pixels_of(radiances_[0]),
                 clear = pixels_of(radiances_[1]), shadows = pixels_of(shadows_[0]);
    int compared = 0, shadowed = 0, outside = 0;
    for (std::size_t i = 0; i < media.size(); ++i) {
      const glm::dvec4 through = media[i], given = shadows[i];
      EXPECT_EQ(glm::dvec3(given.y, given.z, given.w), glm::dvec3(1)) << "of no light";
      const double p = lit[i].r, p0 = clear[i].r;
      outside += p0 == 0 && given.x == 1;
      if (p0 < 0.01 || through.a < 0.05) continue;
      constexpr double kRound = 1 / 1024.0;
      const double t = (p - through.r) / (through.a * p0);
      const double off = kRound * (p / (through.a * p0) + t) / (1 - kRound) + kRound * given.x;
      EXPECT_NEAR(given.x, t, 1.01 * off) << "pixel " << i;
      ++compared;
      shadowed += t < 0.95;
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(shadowed, 20);
    EXPECT_GT(outside, 20) << "beyond the ground";
  }

  cli::WorkFolder folder_;
  api::Context context_;
  std::vector<brume_volume*> volumes_;
  std::vector<brume_shown_volume> shown_;
};

TEST_F(MediaTest, VolumesAreThoseOfTheRenderer) {
  const fs::path cloud = cloud_file("cloud.brv", 1, false), fire = cloud_file("fire.brv", 0.8, true);
  add_volume(cloud).position_world = {-3, 1, 1};
  scene::VolumeOptions& second = add_volume(cloud);
  second.position_world = {4, 1.5f, 2};
  second.rotation = {20, 30, 40};
  second.scale = 1.5f;
  scene::VolumeOptions& hot = add_volume(fire);
  hot.position_world = {0, 1, 3};
  hot.kelvin = 1900;
  hot.heat = "temperature";
  load_volumes();
  make_sides(2, 1);
  change_params_ = [&](brume_frame_params& params) { show_volumes(params); };
  draw_both(3.5, 1);
  // Without a level and smoke.
  shows_field_ = false;
  change_input_ = [](planning::FrameInput& input) {
    input.smoke = {};
    input.level.voxels = {};
  };
  draw_both(3.5, 1);
  host_->wait();
  const Texels in_smoke = expect_same(0), alone = expect_same(1);
  EXPECT_GT(most_apart(in_smoke, alone), 0.3);
  EXPECT_GT(std::set(alone.begin(), alone.end()).size(), 30u) << "volumes are in view";
}

TEST_F(MediaTest, VolumesAtHalfResolutionAreThoseOfTheRenderer) {
  scene::VolumeOptions& volume = add_volume(cloud_file("cloud.brv", 1, false));
  volume.position_world = {-3, 1, 1};
  load_volumes();
  make_sides(2, 2);
  change_params_ = [&](brume_frame_params& params) { show_volumes(params); };
  draw_both(2.0, 2);
  host_->wait();
  const Texels drawn = expect_same(0);
  EXPECT_GT(std::set(drawn.begin(), drawn.end()).size(), 30u);
}

TEST_F(MediaTest, SequencesShowTheFrameOfTheirTime) {
  for (int i = 0; i < 3; ++i) cloud_file("frame_" + std::to_string(i) + ".brv", 0.5 + 0.25 * i, false);
  scene::VolumeOptions& sequence = add_volume(folder_.path() / "frame_%d.brv");
  sequence.position_world = {0, 1, 4};
  sequence.frame_rate = 2;
  sequence.loop = true;
  load_volumes();
  make_sides(3, 1);
  change_params_ = [&](brume_frame_params& params) { show_volumes(params); };
  for (const double seconds : {0.0, 0.5, 1.5}) draw_both(seconds, 1);
  host_->wait();
  std::vector<Texels> frames;
  for (std::size_t i = 0; i < 3; ++i) frames.push_back(expect_same(i));
  EXPECT_GT(most_apart(frames[0], frames[1]), 0.1);
}

TEST_F(MediaTest, VolumesAreDescribedAndRefused) {
  const std::string file = cloud_file("cloud.brv", 1, true).string();
  std::vector<std::string> log;
  brume_context_params settings = brume_context_defaults();
  settings.log_user = &log;
  settings.log = [](void* user, brume_result result, const char* line) {
    static_cast<std::vector<std::string>*>(user)->push_back(std::string(brume_result_name(result)) + " " +
                                                            line);
  };
  const api::Context logged(settings);
  brume_volume_params params = brume_volume_defaults();
  params.file = file.c_str();
  params.heat = "temperature";
  params.max_bytes = 20'000;
  volumes_.push_back(nullptr);
  ASSERT_OK(brume_volume_create(logged.get(), &params, &volumes_.back()));
  ASSERT_EQ(log.size(), 2u) << "of density and heat";
  EXPECT_EQ(log[0].find("BRUME_OK " + file), 0u) << log[0];
  EXPECT_NE(log[0].find("of its resolution"), std::string::npos) << log[0];
  brume_volume_info info{};
  ASSERT_OK(brume_volume_describe(volumes_.back(), &info));
  EXPECT_EQ(info.has_heat, 1u);
  EXPECT_EQ(info.density, 1);
  EXPECT_GT(info.halvings, 0u) << "density and heat have 10 bricks of 2,000 bytes";
  // A sphere of 1 m, whose edge is 0.1 m soft, in voxels of 0.2 m and more and a filter of as much.
  EXPECT_LT(info.low.x, -0.9f);
  EXPECT_GT(info.low.x, -2.4f);

  brume_volume* volume = nullptr;
  const auto refused = [&](brume_result expected, const char* words) {
    expect_refused(brume_volume_create(context_.get(), &params, &volume), expected, words);
    EXPECT_EQ(volume, nullptr);
  };
  params.density = "nothing";
  refused(BRUME_ERROR_DATA, "nothing");
  params.density = nullptr;
  params.repeat = 9;
  refused(BRUME_ERROR_ARGUMENT, "repeat");
  params.repeat = 0;
  params.frame_rate = NAN;
  refused(BRUME_ERROR_ARGUMENT, "frame_rate");
  params.frame_rate = 24;
  params.heat = "flame";
  refused(BRUME_ERROR_DATA, "flame");
  params = brume_volume_defaults();
  refused(BRUME_ERROR_ARGUMENT, "file");
  params.file = "/nowhere/cloud.brv";
  refused(BRUME_ERROR_DATA, "/nowhere/cloud.brv");
  params.no_processes = 1;
  refused(BRUME_ERROR_DATA, "/nowhere/cloud.brv");
  params.file = "/nowhere/cloud.vdb";
  refused(BRUME_ERROR_ARGUMENT, "no_processes");
}

TEST_F(MediaTest, LooksAreRefusedBeyondTheRangesOfTimelines) {
  add_volume(cloud_file("cloud.brv", 1, true));
  load_volumes();
  make_sides(1, 1);
  brume_frame_params params = frame_of(scenario_, 1);
  params.frame_number = 1;
  params.depth.view = reinterpret_cast<VkImageView>(1);
  show_volumes(params);
  const auto refused = [&](const std::string& words, float& member, const scene::OptionInfo& info) {
    const float before = member;
    for (const float bad : {std::nextafter(static_cast<float>(info.low), -INFINITY),
                            std::nextafter(static_cast<float>(info.high), INFINITY), NAN}) {
      member = bad;
      expect_refused(brume_renderer_record(smoke_->renderer, smoke_->field.get(), &params),
                     BRUME_ERROR_ARGUMENT, words);
    }
    member = before;
  };
  host_->frame([&](VkCommandBuffer commands, std::uint64_t, std::uint64_t) {
    params.commands = commands;
    brume_shown_volume& shown = shown_[0];
    for (const auto& [key, member] :
         {std::pair("extinction", &shown.extinction), std::pair("anisotropy", &shown.anisotropy),
          std::pair("multiple_scattering", &shown.multiple_scattering),
          std::pair("emission", &shown.emission), std::pair("kelvin", &shown.kelvin)})
      refused(std::string("volume 0: `") + key + "` must be from ", *member,
              scene::info_of<scene::VolumeOptions>(
                  key, [](auto& o, auto& v) { scene::visit_volume_options(o, v); }));
    brume_smoke_look& look = params.look;
    for (const auto& [key, member] :
         {std::pair("anisotropy", &look.anisotropy),
          std::pair("multiple_scattering", &look.multiple_scattering), std::pair("erosion", &look.erosion),
          std::pair("noise_size", &look.noise_size), std::pair("hole_rim", &look.hole_rim),
          std::pair("swirl", &look.swirl), std::pair("rise", &look.rise)})
      refused(std::string("`look.") + key + "` must be from ", *member,
              scene::info_of<scene::SmokeOptions>(
                  key, [](auto& o, auto& v) { scene::visit_smoke_options(o, v); }));
  });
}

TEST_F(MediaTest, ShadowsAreThoseOfTheRenderersSurfaces) {
  scenario_.timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0), 0};
  // From above, and thin: the ground in its shadow is seen through it.
  scenario_.camera = {{-6, 9, 5}, {-6, 0, 0}, 0.8f};
  scenario_.timeline.smoke.extinction = 0.5f;
  reads_shadows_ = true;
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  // Along the normal of the ground: the renderer looks a little above it, to which only the sun is the same.
  sun.direction_world = {0, -1, 0};
  sun.intensity = glm::vec3(3);
  scenario_.scene.lights = {sun};
  reads_radiance_ = true;
  const brume_light flash = {BRUME_LIGHT_POINT, {-7, 2.5f, 2}, {0, 0, 0}, {20, 20, 20}, 0, 0};
  for (const bool by_flash : {false, true}) {
    if (by_flash) scenario_.scene.lights[0].intensity = glm::vec3(0);
    make_sides(2, 1);
    change_params_ = [&](brume_frame_params& params) {
      params.lights = by_flash ? &flash : nullptr;
      params.light_count = by_flash ? 1 : 0;
      params.shadow_lights[0] = by_flash ? 1 : 0;
      params.shadow_light_count = 1;
    };
    const auto lit = [&](planning::FrameInput& input) {
      if (by_flash)
        input.environment.flashes = {{glm::vec3(-7, 2.5f, 2), shared::light_range(20), glm::vec3(20),
                                      shared::kLightPoint, glm::vec3(0), 0, 0, shared::kShadowByVoxels, 0,
                                      0}};
    };
    change_input_ = lit;
    draw_both(2.5, 1);
    change_input_ = [&](planning::FrameInput& input) {
      lit(input);
      input.smoke.volume = nullptr;
    };
    draw_both(2.5, 1);
    host_->wait();
    expect_shadows();
    TearDown();
    host_.reset();
  }
}

}  // namespace
}  // namespace brume::host
