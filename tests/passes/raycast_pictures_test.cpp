// The images of docs/how/smoke.md: checks their contents, and writes them if BRUME_PICTURES names a folder.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "grids/generate.hpp"
#include "image/png.hpp"
#include "tests/passes/raycast_fixture.hpp"

namespace brume::passes {
namespace {

constexpr int kEdge = 128;  // voxels along the cube of the cloud

SparseVolume cloud() {
  grids::CloudSettings settings;
  settings.edge = kEdge;
  settings.voxel_size = 0.05;
  settings.edge_width = 0.1;
  const grids::Grid grid = grids::generate_cloud(settings);
  return make_volume(
      glm::ivec3(kEdge / 8), [](glm::ivec3) { return true; },
      [&](glm::ivec3 v) {
        const auto brick = grids::find_brick(grid, v >> 3 << 3);
        if (!brick) return 0.0f;
        const glm::ivec3 in = v & 7;
        float value = 0;
        std::memcpy(&value,
                    grid.values_of(*brick).data() +
                        static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z)) * sizeof value,
                    sizeof value);
        return value;
      });
}

/// The sRGB curve, clipped at 1.
std::uint8_t encoded(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return static_cast<std::uint8_t>(
      std::lround(255 * (c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f)));
}

class RaycastPicturesTest : public RaycastFixture {
 protected:
  RaycastPicturesTest() : RaycastFixture({320, 240}) {
    camera_ = {{7.5f, 4, 8.5f}, {0, -0.3f, 0}, 0.8f};
    light_.to_sun = glm::normalize(glm::vec3(-0.5f, 0.7f, 0.45f));
    light_.sun_irradiance = 11.0f * glm::vec3(1, 0.9f, 0.75f);
    light_.ambient = glm::vec3(0.17f, 0.21f, 0.3f);
    steps_.light_samples = 24;
  }
  template <typename Colour>
  void keep(const char* name, Colour colour_of) const {
    const char* folder = std::getenv("BRUME_PICTURES");
    if (!folder) return;
    image::Image8 image{size_.x, size_.y, {}};
    for (std::size_t i = 0; i < std::size_t{size_.x} * size_.y; ++i) {
      const glm::u8vec3 colour = colour_of(i);
      image.rgba.insert(image.rgba.end(), {colour.x, colour.y, colour.z, 255});
    }
    image::save_png(std::filesystem::path(folder) / name, image).value_or_throw();
  }
  /// Positions from 0 to 1 along the box, as colours.
  void keep_surface(const char* name, const std::vector<glm::vec4>& surface) const {
    keep(name, [&](std::size_t i) {
      return glm::u8vec3(glm::round(glm::vec3(surface[i]) / float(kEdge) * 255.0f));
    });
  }
};

TEST_F(RaycastPicturesTest, ShowIntervalSurfacesAndTheCloud) {
  const SparseVolume volume = cloud();
  const Placed placed{&volume,
                      glm::translate(glm::scale(glm::mat4(1), glm::vec3(0.05f)), glm::vec3(-0.5f * kEdge)),
                      {glm::vec3(0.95f), 6, {}, 0, 0}};
  const auto two = draw(RaycastForm::two_pass, {placed}), single = draw(RaycastForm::single_pass, {placed});
  const IntervalSurfaces& surfaces = pass(RaycastForm::two_pass).surfaces();
  const auto entries = read_back<glm::vec4>(surfaces.entries), exits = read_back<glm::vec4>(surfaces.exits);
  keep_surface("raycast_entries.png", entries);
  keep_surface("raycast_exits.png", exits);
  const auto over_sky = [&](std::size_t i) {
    const float height = 1 - static_cast<float>(i / size_.x) / static_cast<float>(size_.y);
    const glm::vec3 sky = glm::mix(glm::vec3(0.55f, 0.62f, 0.7f), glm::vec3(0.12f, 0.25f, 0.5f), height);
    const glm::vec3 c = glm::vec3(two[i]) + two[i].w * sky;
    return glm::u8vec3(encoded(c.x), encoded(c.y), encoded(c.z));
  };
  keep("raycast_cloud.png", over_sky);

  // The middle of the image enters through the front and leaves through the back; its corners miss the box.
  const std::size_t middle = size_.x * (size_.y / 2) + size_.x / 2;
  EXPECT_EQ(entries[0], exits[0]);
  EXPECT_EQ(two[0], glm::vec4(0, 0, 0, 1));
  EXPECT_GT(glm::length(glm::vec3(entries[middle] - exits[middle])), kEdge);
  EXPECT_EQ(two[middle].w, 0) << "the cloud is opaque in its middle";
  double apart = 0;
  for (std::size_t i = 0; i < two.size(); ++i)
    for (int c = 0; c < 4; ++c) apart = std::max(apart, std::abs(double{two[i][c]} - double{single[i][c]}));
  EXPECT_LE(apart, 1.0 / 255);
}

}  // namespace
}  // namespace brume::passes
