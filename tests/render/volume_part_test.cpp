// A volume in parts, each on a renderer of its own, and the picture of the whole on one.
#include "film/volume_part.hpp"

#include "grids/generate.hpp"
#include "tests/render/volume_fixture.hpp"
#include "volume/parts.hpp"

namespace brume::render {
namespace {

class VolumePartTest : public VolumeFixture {
 protected:
  static constexpr glm::uvec2 kSize{61, 47};

  VolumePartTest() {
    grids::CloudSettings settings;
    settings.edge = 64;
    settings.octaves = 4;
    cloud_ = grids::make_brick_volume(grids::generate_cloud(settings)).value_or_throw();
    input_.environment.flashes = {sun_light({-1, -1.5f, -0.4f}, 6)};
    input_.environment.sky.ambient = glm::vec3(0.4f, 0.5f, 0.7f);
    planning::VolumeInput& volume = input_.volumes.emplace_back();
    volume.volume = cloud_.volume.get();
    volume.world_from_voxel = glm::mat4(cloud_.world_from_voxel);
    volume.look = {glm::vec3(0.95f, 0.9f, 0.8f), 8, glm::vec3(0), 0.3f, 1};
  }

  image::Image8 whole() {
    static Renderer renderer(context(), runner(), empty(), RendererOptions{kSize});
    renderer.draw(input_);
    image::Image8 picture{kSize.x, kSize.y, {}};
    for (const std::uint32_t texel : read_back<std::uint32_t>(renderer.targets().display))
      for (int shift = 0; shift < 32; shift += 8)
        picture.rgba.push_back(static_cast<std::uint8_t>(texel >> shift));
    return picture;
  }

  image::Image8 in_parts(std::uint32_t count) {
    const volume::Parts parts = volume::Parts::divide(*cloud_.volume, count).value_or_throw();
    std::vector<volume::SparseVolume> volumes;
    for (std::uint32_t i = 0; i < count; ++i) volumes.push_back(part_of_volume(*cloud_.volume, parts, i));
    while (renderers().size() < count)
      renderers().push_back(std::make_unique<film::VolumePartRenderer>(context(), runner(), empty(), kSize));
    std::vector<float> depths;
    for (std::uint32_t i = 0; i < count; ++i) {
      FrameInput input = input_;
      input.volumes.front().volume = &volumes[i];
      const std::vector<float> own = renderers()[i]->find_depths(input);
      if (depths.empty()) depths.resize(own.size());
      film::add_depths(depths, own);
    }
    std::vector<film::Pixels> pixels;
    for (std::uint32_t i = 0; i < count; ++i) pixels.push_back(renderers()[i]->march(depths));
    const glm::vec3 eye(glm::inverse(cloud_.world_from_voxel) *
                        glm::dvec4(glm::dvec3(input_.view.camera.position_world), 1));
    const std::vector<std::uint32_t> order = parts.order_from(eye);
    film::Pixels all = pixels[order.front()];
    for (std::size_t i = 1; i < order.size(); ++i) film::composite_behind(all, pixels[order[i]]);
    return renderers().front()->picture(all);
  }

  static int largest_difference(const image::Image8& a, const image::Image8& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
      largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
    return largest;
  }

  static const scene::Scene& empty() {
    static const scene::Scene scene;
    return scene;
  }
  /// One for each part, for all pictures: compiling their pipelines takes longer than those.
  static std::vector<std::unique_ptr<film::VolumePartRenderer>>& renderers() {
    static std::vector<std::unique_ptr<film::VolumePartRenderer>> all;
    return all;
  }
  static void TearDownTestSuite() { renderers().clear(); }

  grids::BrickVolume cloud_;
};

// Halves round what is exchanged: by 1/2048 of each value at most, below half of a step of a display.
TEST_F(VolumePartTest, PartsMakeThePictureOfTheWhole) {
  // From outside, through the cloud along an edge of bricks, and from within.
  for (const glm::vec3 eye : {glm::vec3(1, 2, 5), glm::vec3(-6, 0, 0.01f), glm::vec3(0.2f, 0.1f, 0.9f)}) {
    input_.view.camera = {eye, glm::vec3(0), 0.8f};
    const image::Image8 expected = whole();
    const auto [low, high] = std::ranges::minmax_element(expected.rgba);
    EXPECT_GT(*high - *low, 60) << "the picture shows something";
    for (const std::uint32_t count : {1u, 2u, 4u})
      EXPECT_LE(largest_difference(in_parts(count), expected), 1) << count << " parts";
  }
}

TEST_F(VolumePartTest, RefusesWhatCannotBeDivided) {
  input_.view.camera = {{1, 2, 5}, {0, 0, 0}, 0.8f};
  film::VolumePartRenderer renderer(context(), runner(), empty(), kSize);
  const auto refuses = [&](const FrameInput& input) { EXPECT_THROW(renderer.find_depths(input), Error); };
  FrameInput two = input_;
  two.volumes.push_back(two.volumes.front());
  refuses(two);
  FrameInput lit = input_;
  lit.environment.flashes.push_back(lit.environment.flashes.front());
  lit.environment.flashes.back().kind = shared::kLightPoint;
  lit.environment.flashes.back().range = 100;
  refuses(lit);
  FrameInput dense = input_;
  dense.volumes.front().voxel_depth = 100;
  refuses(dense);
  const scene::Scene floor = far_floor();
  EXPECT_THROW(film::VolumePartRenderer(context(), runner(), floor, kSize), Error);
}

TEST(Composite, IsThatOfTheStepsInBetween) {
  film::Pixels front{{0.2f, 0.1f, 0, 0.5f}};
  film::composite_behind(front, {{0.4f, 0.6f, 1, 0.25f}});
  EXPECT_EQ(front.front(), glm::vec4(0.4f, 0.4f, 0.5f, 0.125f));
}

}  // namespace
}  // namespace brume::render
