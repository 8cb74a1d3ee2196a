// Noise below the voxels of a volume, which wears away its thin parts.
#include "shared/volume_detail.h"
#include "planning/media_plan.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

class VolumeDetailTest : public VolumePictures<VolumeDetailTest> {
 public:
  static constexpr glm::uvec2 kSize{256, 256};  // pixels of 0.7 cm
  static constexpr float kExtinction = 0.5f;    // [1/m]

 protected:
  VolumeDetailTest() { input_.view.camera = {{0, 0, 9}, {0, 0, 0}, 0.2f}; }

  /// A block of 4 m around the origin, which all of the view's rays cross along z.
  planning::VolumeInput worn(const volume::SparseVolume& values, const scene::VolumeDetail& noise,
                             float time = 0) const {
    planning::VolumeInput volume;
    volume.volume = &values;
    volume.look.extinction = kExtinction;
    const float voxel = 4 / values.layout().bounds_max.x;
    volume.world_from_voxel = glm::mat4(voxel);
    volume.world_from_voxel[3] = glm::vec4(-2, -2, -2, 1);
    volume.detail = {glm::inverse(volume.world_from_voxel), noise, 1, time};
    return volume;
  }
  std::vector<float> depths() {
    std::vector<float> depths;
    for (const glm::vec4& pixel : draw()) depths.push_back(-std::log(std::max(pixel.a, 1e-6f)));
    return depths;
  }
};

double mean_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += double{value};
  return sum / static_cast<double>(values.size());
}

TEST_F(VolumeDetailTest, LeavesWhatIsDensest) {
  const volume::SparseVolume dense = block(glm::ivec3(2));
  input_.volumes = {worn(dense, {})};
  const std::vector<float> plain = depths();
  input_.volumes = {worn(dense, {0.8f, 0.5f, {}})};
  EXPECT_EQ(depths(), plain);
}

// Of thinner values noise leaves holes and whole parts, on average what light in the volume counts with.
TEST_F(VolumeDetailTest, WearsAwayWhatIsThin) {
  double before = 1;
  for (const float value : {0.7f, 0.4f, 0.2f}) {
    const volume::SparseVolume thin = block(glm::ivec3(4), value);
    const scene::VolumeDetail noise{0.9f, 0.3f, {}};
    input_.volumes = {worn(thin, {})};
    const std::vector<float> plain = depths();
    input_.volumes = {worn(thin, noise)};
    const std::vector<float> left = depths();
    ASSERT_EQ(left.size(), plain.size());
    float least = 1e3f, most = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      EXPECT_LE(left[i], plain[i] + 4e-3f) << "halves of the transmittance";
      least = std::min(least, left[i] / plain[i]);
      most = std::max(most, left[i] / plain[i]);
    }
    EXPECT_GT(most - least, 0.1f) << "it shows";
    const shared::VolumeDetail detail = planning::volume_detail(input_.volumes[0]);
    const double fraction = mean_of(left) / mean_of(plain);
    // The view crosses some 6 x 6 x 13 billows of a deviation of about 0.4: three times 0.4 / sqrt(470), and
    // 0.04 of the mean itself (erosion_test.cpp).
    EXPECT_NEAR(fraction, double{shared::mean_volume_fraction(detail, value)}, 0.095) << value;
    EXPECT_LT(fraction, before);
    before = fraction;
  }
}

TEST_F(VolumeDetailTest, DriftsInTime) {
  const volume::SparseVolume thin = block(glm::ivec3(2), 0.4f);
  const scene::VolumeDetail drifting{0.9f, 0.5f, {0, 1, 0}};
  input_.volumes = {worn(thin, drifting)};
  const std::vector<float> first = depths();
  EXPECT_EQ(depths(), first);
  input_.volumes = {worn(thin, drifting, 0.1f)};
  EXPECT_NE(depths(), first);
  // A tile is four billows: after as long it is where it was.
  input_.volumes = {worn(thin, drifting, 2)};
  EXPECT_EQ(depths(), first);
  input_.volumes = {worn(thin, {0.9f, 0.5f, {}}, 0.1f)};
  EXPECT_EQ(depths(), first) << "it stands";
}

// Several volumes, each with its own.
TEST_F(VolumeDetailTest, IsThatOfItsVolume) {
  const volume::SparseVolume thin = block(glm::ivec3(2), 0.4f);
  input_.volumes = {worn(thin, {})};
  const double plain = mean_of(depths());
  input_.volumes = {worn(thin, {0.9f, 0.1f, {}})};
  const double left = mean_of(depths());
  input_.volumes = {worn(thin, {}), worn(thin, {0.9f, 0.1f, {}})};
  EXPECT_NEAR(mean_of(depths()), plain + left, 0.02 * plain);
}

// Seen from where a billow is narrower than a pixel, the noise is gone, and its mean remains.
TEST_F(VolumeDetailTest, FadesWithDistance) {
  const volume::SparseVolume thin = block(glm::ivec3(2), 0.4f);
  const scene::VolumeDetail fine{0.9f, 0.002f, {}};
  input_.volumes = {worn(thin, {})};
  const std::vector<float> plain = depths();
  input_.volumes = {worn(thin, fine)};
  const std::vector<float> left = depths();
  for (std::size_t i = 0; i < left.size(); ++i)
    EXPECT_NEAR(left[i] / plain[i], left[0] / plain[0], 0.02f) << i;
}

}  // namespace
}  // namespace brume::render
