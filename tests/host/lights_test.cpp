// A renderer whose lights or triangles are replaced draws what one that had them from the start draws.
#include <array>
#include <numeric>

#include "gpu/read_back.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

class LightsTest : public YardTest {
 protected:
  static constexpr glm::uvec2 kPicture{32, 18};

  LightsTest() : YardTest(gpu::kUsualHost, kPicture) {}
  void make_yard() {
    make({32, 16, 32}, 0.25f);
    smoke(1, {3, 0.6f, 3}, 500, 100);
    advance(40);
  }
  /// A renderer with lights and walls that shadow them: a triangle of each three points.
  brume_renderer* renderer_of(const std::vector<brume_light>& lights,
                              const std::vector<brume_point>& walls = {{2, 0, 4}, {4, 0, 4}, {3, 4, 4}}) {
    const std::vector<std::uint32_t> indices = indices_of(walls);
    brume_renderer_params params = brume_renderer_defaults();
    params.width = kPicture.x;
    params.height = kPicture.y;
    params.lights = lights.data();
    params.light_count = lights.size();
    params.points = walls.data();
    params.point_count = walls.size();
    params.indices = indices.data();
    params.index_count = indices.size();
    brume_renderer* renderer = nullptr;
    EXPECT_OK(brume_renderer_create(device_, &params, &renderer));
    return renderer;
  }
  static std::vector<std::uint32_t> indices_of(const std::vector<brume_point>& walls) {
    std::vector<std::uint32_t> indices(walls.size());
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  /// The smoke of a frame, half floats.
  std::vector<std::uint64_t> picture_of(brume_renderer* renderer) {
    const gpu::Buffer copy = gpu::readback_buffer(gpu_, VkDeviceSize{8} * kPicture.x * kPicture.y);
    draw({1, 2, 1}, {1, -0.2f, 1}, 0.7, [&](brume_frame_params& params) {
      params.jitter_index = 0;
      params.bounces = 1;
      ASSERT_OK(brume_renderer_record(renderer, field_, &params));
      VkImage image = VK_NULL_HANDLE;
      ASSERT_OK(brume_renderer_smoke(renderer, &image, nullptr));
      host_.copy(params.commands, image, {kPicture.x, kPicture.y}, copy.handle());
    });
    host_.wait();
    const auto texels = gpu::values_of<std::uint64_t>(copy);
    return {texels.begin(), texels.end()};
  }
};

TEST_F(LightsTest, AreReplaced) {
  make_yard();
  const std::vector<brume_light> one{{BRUME_LIGHT_POINT, {4, 3, 3}, {0, -1, 0}, {3, 3, 2}, 0, 1}},
      several{{BRUME_LIGHT_SUN, {0, 0, 0}, {0.3f, -1, -0.4f}, {2, 2, 2}, 0, 1},
              {BRUME_LIGHT_SPOT, {3, 3, 6}, {0, -0.5f, -1}, {9, 1, 1}, 0.3f, 0.8f},
              {BRUME_LIGHT_POINT, {1, 3, 1}, {0, -1, 0}, {1, 4, 1}, 0, 1}},
      none;
  brume_renderer* const changed = renderer_of(one);
  std::vector<std::uint64_t> before = picture_of(changed);
  for (const std::vector<brume_light>* lights : {&several, &none, &one}) {
    ASSERT_OK(brume_renderer_set_lights(changed, lights->data(), lights->size()));
    const std::vector<std::uint64_t> after = picture_of(changed);
    brume_renderer* const made = renderer_of(*lights);
    EXPECT_EQ(after, picture_of(made)) << lights->size() << " lights";
    EXPECT_NE(after, before);
    EXPECT_OK(brume_renderer_destroy(made));
    before = after;
  }
  EXPECT_OK(brume_renderer_destroy(changed));
}

TEST_F(LightsTest, TheirTrianglesAreReplaced) {
  make_yard();
  const std::vector<brume_light> lights{{BRUME_LIGHT_POINT, {4, 3, 3}, {0, -1, 0}, {3, 3, 2}, 0, 1},
                                        {BRUME_LIGHT_SUN, {0, 0, 0}, {0.3f, -1, -0.4f}, {2, 2, 2}, 0, 1}};
  const std::vector<brume_point> one{{2, 0, 4}, {4, 0, 4}, {3, 4, 4}}, none,
      roof{{0, 3, 0}, {8, 3, 0}, {8, 3, 8}, {0, 3, 0}, {8, 3, 8}, {0, 3, 8}};
  brume_renderer* const changed = renderer_of(lights, one);
  std::vector<std::uint64_t> before = picture_of(changed);
  for (const std::vector<brume_point>* walls : {&roof, &none, &one}) {
    const std::vector<std::uint32_t> indices = indices_of(*walls);
    ASSERT_OK(
        brume_renderer_set_triangles(changed, walls->data(), walls->size(), indices.data(), indices.size()));
    // The lights that are given at the same time count, too, in any order.
    ASSERT_OK(brume_renderer_set_lights(changed, lights.data(), lights.size()));
    const std::vector<std::uint64_t> after = picture_of(changed);
    brume_renderer* const made = renderer_of(lights, *walls);
    EXPECT_EQ(after, picture_of(made)) << walls->size() << " points";
    EXPECT_NE(after, before);
    EXPECT_OK(brume_renderer_destroy(made));
    before = after;
  }
  EXPECT_OK(brume_renderer_destroy(changed));
}

TEST_F(LightsTest, TrianglesAreRefusedAsThoseOfANewRenderer) {
  make_yard();
  const std::array<brume_point, 2> points{{{0, 0, 0}, {1, 1, 1}}};
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  const auto set = [&](const brume_point* from, std::size_t index_count) {
    return brume_renderer_set_triangles(renderer_, from, points.size(), indices.data(), index_count);
  };
  expect_refused(set(points.data(), 2), BRUME_ERROR_ARGUMENT, "multiple of 3");
  expect_refused(set(nullptr, 3), BRUME_ERROR_ARGUMENT, "`points` is null");
  expect_refused(set(points.data(), 3), BRUME_ERROR_ARGUMENT, "an index is 2, beyond the last point");
}

TEST_F(LightsTest, AreRefusedAsThoseOfANewRenderer) {
  make_yard();
  const brume_light nowhere{BRUME_LIGHT_POINT, {NAN, 0, 0}, {0, -1, 0}, {1, 1, 1}, 0, 1};
  expect_refused(brume_renderer_set_lights(renderer_, nullptr, 1), BRUME_ERROR_ARGUMENT, "`lights` is null");
  expect_refused(brume_renderer_set_lights(renderer_, &nowhere, 1025), BRUME_ERROR_ARGUMENT, "at most 1024");
  expect_refused(brume_renderer_set_lights(renderer_, &nowhere, 1), BRUME_ERROR_ARGUMENT, "light.position");
}

}  // namespace
}  // namespace brume::host
