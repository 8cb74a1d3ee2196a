// Volumes at several resolutions: what they look like, and how they arrive on the device.
#include <unistd.h>

#include <bit>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "core/log.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "render/volume_room.hpp"
#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

class VolumeResolutionTest : public VolumePictures<VolumeResolutionTest> {
 public:
  static constexpr glm::uvec2 kSize{81, 61};

 protected:
  VolumeResolutionTest() {
    input_.view.camera = {{0, 0, 9}, {0, 0, 0}, 0.7f};
    input_.environment.sky.ambient = glm::vec3(0.4f, 0.5f, 0.7f);
    input_.environment.flashes = {sun_light({-1, -1.5f, -0.4f}, 6)};
  }
  std::vector<std::uint32_t> draw() {
    renderer().draw(input_);
    return read_back<std::uint32_t>(renderer().targets().display);
  }
  /// Mean difference of all colours of two images [of 255].
  static double difference(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int shift = 0; shift < 24; shift += 8)
        sum += std::abs(static_cast<int>(a[i] >> shift & 255) - static_cast<int>(b[i] >> shift & 255));
    return sum / (3.0 * static_cast<double>(a.size()));
  }
  static planning::VolumeInput cloud_input(const grids::BrickVolume& cloud) {
    planning::VolumeInput input;
    input.volume = cloud.volume.get();
    input.world_from_voxel = glm::mat4(cloud.world_from_voxel);
    input.look = {glm::vec3(0.95f), 8 * cloud.unit, glm::vec3(0), 0.3f, 1};
    return input;
  }
  static grids::Grid cloud_grid(std::uint32_t edge) {
    grids::CloudSettings settings;
    settings.edge = edge;
    settings.voxel_size = 4.0 / edge;
    settings.radius = 1.1;
    settings.edge_width = 2 * settings.voxel_size;
    return grids::generate_cloud(settings);
  }
};

// Extinction is per metre, whatever the size of a voxel.
TEST_F(VolumeResolutionTest, HalfTheResolutionKeepsTheLook) {
  const grids::Grid grid = cloud_grid(64);
  const grids::BrickVolume fine = grids::make_brick_volume(grid).value_or_throw();
  const grids::BrickVolume half =
      grids::make_brick_volume(grid, {fine.volume->slot_count() / 2}).value_or_throw();
  ASSERT_EQ(half.level, 1);
  const auto empty = draw();
  input_.volumes = {cloud_input(fine)};
  const auto a = draw();
  input_.volumes = {cloud_input(half)};
  const auto b = draw();
  EXPECT_GT(difference(a, empty), 10) << "a cloud is in view";
  EXPECT_LT(difference(a, b), 2);
  RecordProperty("mean_difference_of_255", std::to_string(difference(a, b)));
}

// Through the centre of a sphere of radius R whose density rises to 1 over a depth w, an optical depth of
// sigma (2 R - w) / |M^-1 d|, for any affine M.
TEST_F(VolumeResolutionTest, ASphereHasItsOpticalDepthUnderAnyTransform) {
  grids::CloudSettings settings;
  settings.kind = grids::CloudKind::sphere;
  settings.edge = 64;
  settings.voxel_size = 1;
  settings.radius = 26;
  settings.edge_width = 4;
  const grids::BrickVolume sphere =
      grids::make_brick_volume(grids::generate_cloud(settings)).value_or_throw();
  const glm::vec3 middle(32);  // [voxels]
  std::mt19937 random(17);
  std::uniform_real_distribution<float> draw_number(-1, 1);
  const auto vector = [&] {
    return glm::vec3(draw_number(random), draw_number(random), draw_number(random));
  };
  for (int i = 0; i < 24; ++i) {
    // Turned, scaled by 1 : 5 at most, every second one sheared, every third one mirrored.
    glm::mat4 matrix = glm::rotate(glm::mat4(1), 3 * draw_number(random), glm::normalize(vector()));
    glm::mat4 shear(1);
    if (i % 2 == 1) {
      shear[1][0] = 0.6f * draw_number(random);
      shear[2][0] = 0.6f * draw_number(random);
      shear[2][1] = 0.6f * draw_number(random);
    }
    glm::vec3 scale = 0.06f * glm::exp(0.8f * vector());
    if (i % 3 == 2) scale.x = -scale.x;
    matrix = matrix * shear * glm::scale(glm::mat4(1), scale) * glm::translate(glm::mat4(1), -middle);
    const glm::vec3 eye = 12.0f * glm::normalize(vector() + 0.01f);
    input_.view.camera = {eye, glm::vec3(0), 0.7f};
    const double chord =
        (2 * settings.radius - settings.edge_width) /
        glm::length(glm::inverse(glm::dmat3(glm::mat3(matrix))) * glm::dvec3(glm::normalize(eye)));
    // A transmittance of 0.1 is 1700 steps of its half float.
    const double sigma = 2.3 / chord;
    input_.volumes = {{sphere.volume.get(), matrix, {}, {}}};
    input_.volumes[0].look = {glm::vec3(0), static_cast<float>(sigma), glm::vec3(0.1f), 0, 0};
    double sum = 0;
    constexpr std::uint32_t kJitters = 4;
    for (input_.view.frame_index = 0; input_.view.frame_index < kJitters; ++input_.view.frame_index) {
      draw();
      sum -= std::log(double{media_of(renderer())[kSize.x * (kSize.y / 2) + kSize.x / 2].w});
    }
    EXPECT_NEAR(sum / kJitters, 2.3, 0.005 * 2.3) << "transform " << i;
  }
}

/// A large volume, its preview, and how it arrives.
class StreamingTest : public VolumeResolutionTest {
 protected:
  StreamingTest() {
    input_.volumes = {cloud_input(fine_)};
    input_.volumes[0].preview = preview_.volume.get();
    input_.volumes[0].world_from_preview = glm::mat4(preview_.world_from_voxel);
  }
  const grids::BrickVolume fine_ = grids::make_brick_volume(cloud_grid(96)).value_or_throw();
  const grids::BrickVolume preview_ = grids::make_preview(fine_, 60);
};

TEST_F(StreamingTest, EndsAtThePictureOfAllAtOnce) {
  Renderer streamed(context(), runner(), far_floor(), RendererOptions{kSize});
  const auto all_at_once = draw();
  const auto draw_streamed = [&] {
    streamed.draw(input_);
    return read_back<std::uint32_t>(streamed.targets().display);
  };
  input_.quality.volume_upload_bytes = 256 << 10;
  std::vector<double> differences;
  do {
    ASSERT_LT(differences.size(), 100u);
    differences.push_back(difference(draw_streamed(), all_at_once));
  } while (streamed.streams_volumes());
  EXPECT_GT(differences.size(), 3u);
  EXPECT_GT(differences.front(), 0) << "a preview at first";
  for (const double one : differences) EXPECT_LT(one, 6) << "a cloud from the first frame on";
  EXPECT_EQ(draw_streamed(), all_at_once) << "bit for bit";
}

// While the camera turns, every frame is that of the preview or of the whole volume.
TEST_F(StreamingTest, AMovingCameraNeverMeetsABrickThatIsMissing) {
  // As close as this, most of the cloud is out of view.
  const auto camera = [](int frame) {
    const float angle = 0.35f * static_cast<float>(frame / 3);
    const glm::vec3 eye(2.1f * std::sin(angle), 0.3f, 2.1f * std::cos(angle));
    return scene::Camera{eye, 0.6f * glm::vec3(eye.z, 0, -eye.x), 0.4f};
  };
  Renderer streamed(context(), runner(), far_floor(), RendererOptions{kSize});
  int fine = 0, coarse = 0;
  for (int frame = 0; frame < 18; ++frame) {
    input_.view.camera = camera(frame);
    input_.quality.volume_upload_bytes = 40 << 10;
    const planning::FramePlan plan = streamed.plan(input_);
    runner().run([&](gpu::Recorder& recorder) { streamed.record_frame(recorder, plan); });
    std::vector<passes::Half4> transmittance = read_back<passes::Half4>(streamed.media());
    const bool shows_preview = plan.residency[0].shows_preview;
    (shows_preview ? coarse : fine) += 1;

    // The same volume alone, without another resolution.
    planning::VolumeInput shown = planning::shown_volume(input_.volumes[0], shows_preview);
    shown.preview = nullptr;
    FrameInput expected = input_;
    expected.volumes = {shown};
    renderer().draw(expected);
    const std::vector<glm::vec4> pixels = media_of(renderer());
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      sum += std::abs(double{passes::from_half(transmittance[i]).w} - double{pixels[i].w});
    // Filtering rounds coordinates by the size of the atlas, which previews share.
    EXPECT_LT(sum / static_cast<double>(pixels.size()), 1e-4) << "frame " << frame;
  }
  EXPECT_GT(fine, 3);
  EXPECT_GT(coarse, 3);
}

// A room with place for less than a file: a coarser level, one warning, a picture.
TEST_F(VolumeResolutionTest, AFileLargerThanTheDeviceIsShownCoarser) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("brume_resolution_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  grids::save_grid_file(folder / "cloud.brv", {{cloud_grid(96)}, {}}).value_or_throw();
  std::vector<std::string> warnings;
  set_log_callback([&](LogLevel, const std::string& line) { warnings.push_back(line); });
  const scenario::Scenario scenario = scenario::load_scenario(folder / "cloud.brv", {}).value_or_throw();
  scenario.volumes->limit(volume_room(context(), 1 << 20)).value_or_throw();
  set_log_callback({});
  std::filesystem::remove_all(folder);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("cloud.brv: grid density is shown at 1/2 of its resolution, off by"),
            std::string::npos)
      << warnings[0];
  film::Playback playback(context(), scenario, kSize);
  playback.draw(0, 0);
}

TEST_F(VolumeResolutionTest, TheRoomOfADeviceHoldsWhatAnAtlasOfItTakes) {
  const volumes::VolumeRoom room = volume_room(context());
  const int most = static_cast<int>(context().limits().maxImageDimension3D) / shared::kBrickTexels;
  for (const std::uint64_t slots : {std::uint64_t{1}, room.bricks / 3, room.bricks, room.bricks * 7 / 6}) {
    const glm::ivec3 atlas = passes::tight_atlas(slots, most);
    EXPECT_LE(std::max({atlas.x, atlas.y, atlas.z}), most);
    EXPECT_TRUE(std::has_single_bit(unsigned(atlas.x)) && std::has_single_bit(unsigned(atlas.y)));
    const glm::u64vec3 edges(atlas);
    EXPECT_GE(edges.x * edges.y * edges.z, slots);
    if (slots > 1u << 17) {
      EXPECT_LE(edges.x * edges.y * edges.z, slots + slots / 16);
    }
  }
  EXPECT_THROW(passes::tight_atlas(std::uint64_t{1} << 40, most), Error);
  EXPECT_LE(2000 * room.bricks, context().max_allocation_bytes());
  EXPECT_LE(4 * room.pages, context().limits().maxStorageBufferRange);
  const volumes::VolumeRoom little = volume_room(context(), 64u << 20);
  EXPECT_LE(2000 * little.bricks, 64u << 20);
}

}  // namespace
}  // namespace brume::render
