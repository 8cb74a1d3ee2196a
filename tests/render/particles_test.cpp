// Volumes by particles in whole frames.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

class ParticleFramesTest : public VolumePictures<ParticleFramesTest> {
 public:
  static constexpr glm::uvec2 kSize{61, 37};

 protected:
  ParticleFramesTest() {
    input_.view.camera = {{0, 0, 9}, {0, 0, 0}, 0.9f};
    grids::DenseGrid mask;
    mask.size = {4, 4, 4};
    mask.values.assign(64, 1);
    input_.slices =
        std::make_shared<const grids::DenseVolumes>(1, std::make_shared<const grids::DenseVolume>(1, mask));
  }
  static planning::ParticleInput cube(glm::vec3 centre) {
    planning::ParticleInput input;
    input.world_from_uvw =
        glm::translate(glm::mat4(1), centre - 1.0f) * glm::scale(glm::mat4(1), glm::vec3(2));
    input.tints[0] = {4, 2, 1};
    return input;
  }
  struct Image {
    std::vector<glm::vec4> radiance;
    std::vector<glm::u8vec4> display;
    bool operator==(const Image&) const = default;
  };
  Image draw() {
    renderer().draw(input_);
    Image image;
    image.radiance = passes::from_half(read_back<passes::Half4>(renderer().targets().radiance));
    image.display = read_back<glm::u8vec4>(renderer().targets().display);
    return image;
  }
};

TEST_F(ParticleFramesTest, AddToTheImageAndLeaveNothingBehind) {
  const Image without = draw();
  input_.particles = {cube({0, 0, 0})};
  const Image with = draw();
  double added = 0;
  for (std::size_t i = 0; i < with.radiance.size(); ++i) {
    const glm::vec3 more = glm::vec3(with.radiance[i]) - glm::vec3(without.radiance[i]);
    ASSERT_GE(std::min({more.x, more.y, more.z}), 0);
    added += double{more.x};
  }
  EXPECT_GT(added, 100);
  EXPECT_NE(with.display, without.display);
  EXPECT_EQ(draw(), with);
  input_.particles = {cube({0, 0, 0}), cube({0, 0, 40})};  // one behind the eye
  EXPECT_EQ(draw(), with);
  input_.particles.clear();
  EXPECT_EQ(draw(), without);
}

// The floor is 30 m below; the cube above it is visible, the one below is not.
TEST_F(ParticleFramesTest, AreHiddenByTheFloor) {
  input_.view.camera = {{0, -20, 0}, {0, -35, 0.1f}, 0.9f};
  const Image without = draw();
  input_.particles = {cube({0, -35, 0})};
  EXPECT_EQ(draw(), without);
  input_.particles = {cube({0, -27, 0})};
  EXPECT_NE(draw(), without);
}

TEST_F(ParticleFramesTest, TheViewOfOverdrawLeavesNoTrace) {
  input_.particles = {cube({0, 0, 0})};
  const Image image = draw();
  input_.debug.view = planning::DebugView::overdraw;
  const Image view = draw();
  EXPECT_NE(view.display, image.display);
  float most = 0;
  for (const glm::vec4& quads : view.radiance) {
    EXPECT_EQ(quads.x, std::round(quads.x));
    most = std::max(most, quads.x);
  }
  EXPECT_GT(most, 10);
  EXPECT_EQ(view.radiance[0].x, 0);
  input_.debug.view = planning::DebugView::none;
  EXPECT_EQ(draw(), image);
  // Without particles no pixel has quads.
  input_.particles.clear();
  input_.debug.view = planning::DebugView::overdraw;
  for (const glm::vec4& quads : draw().radiance) EXPECT_EQ(quads, glm::vec4(0));
}

TEST_F(ParticleFramesTest, OfNoVolumeAreRefused) {
  input_.particles = {cube({0, 0, 0})};
  input_.particles[0].slices = 1;
  EXPECT_THROW(draw(), Error);
  input_.particles[0].slices = 0;
  draw();
}

}  // namespace
}  // namespace brume::render
