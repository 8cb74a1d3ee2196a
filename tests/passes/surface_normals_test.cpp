// Normals of a host's surfaces: decoded, and found from the depth, against double precision.
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "passes/surface_import.hpp"
#include "planning/device_camera.hpp"
#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

using Vectors = std::vector<glm::dvec3>;

class SurfaceNormalTest : public gpu::GpuTest {
 protected:
  static constexpr double kUnit = 1.0 / (1 << 24);      ///< Half a unit in the last place of 1.
  static constexpr double kHalfUnit = 1.0 / (1 << 10);  ///< The same of a half float, rounded or truncated.

  SurfaceNormalTest() : pass_(context()) { resize({33, 17}); }

  void resize(glm::uvec2 size) {
    size_ = size;
    planning::ViewSample jittered;
    jittered.pixel = {0.3f, -0.2f};
    camera_ = planning::device_camera({{1, 2, 3}, {0.4f, 1.5f, -0.3f}, 1.1f}, size, jittered);
    depth_.assign(std::size_t{size.x} * size.y, 0.05f);
  }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  glm::dvec3 direction() {
    const glm::dvec3 v(unit(), unit(), unit());
    const double length = glm::length(v);
    return length > 0.1 && length < 1 ? v / length : direction();
  }
  glm::dvec2 xy(std::size_t i) const {
    const glm::dvec2 ndc = (glm::dvec2(i % size_.x, i / size_.x) + 0.5) / glm::dvec2(size_) * 2.0 - 1.0;
    return glm::dvec2(camera_.shift) + glm::dvec2(ndc.x, -ndc.y);
  }
  glm::dvec3 ray(std::size_t i) const {
    return glm::dvec3(camera_.forward) + xy(i).x * glm::dvec3(camera_.right) +
           xy(i).y * glm::dvec3(camera_.up);
  }
  glm::dvec3 view_from_world(glm::dvec3 n) const {
    return {glm::dot(n, glm::normalize(glm::dvec3(camera_.right))),
            glm::dot(n, glm::normalize(glm::dvec3(camera_.up))), -glm::dot(n, glm::dvec3(camera_.forward))};
  }
  /// The depth of a plane through a point, at a pixel.
  double depth_of(glm::dvec3 normal, glm::dvec3 p_world, std::size_t i) const {
    const double along = glm::dot(normal, p_world - glm::dvec3(camera_.eye_world));
    return double{camera_.near_z} * glm::dot(normal, ray(i)) / along;
  }

  /// Normals and, in alpha, what decals read.
  std::vector<glm::vec4> import(const gpu::Image* image, std::uint32_t encoding, bool of_view,
                                bool alpha_receives) {
    GBuffer target = GBuffer::imported(context(), size_);
    target.add_imported_normals(context());
    target.depth = upload_image(context(), runner(), size_, VK_FORMAT_R32_SFLOAT, depth_);
    shared::FrameConstants frame{};
    frame.camera = camera_;
    frame.size_px = size_;
    const gpu::Buffer buffer = upload(std::vector{frame});
    runner().run([&](gpu::Recorder& recorder) {
      pass_.record(recorder, buffer, {image, encoding, of_view, alpha_receives},
                   {{0, 0}, glm::uvec2(target.depth.info().size)}, target);
    });
    return from_half(read_back<Half4>(target.normal_metallic));
  }
  std::vector<glm::vec4> import(const std::vector<glm::vec4>& texels, std::uint32_t encoding,
                                bool of_view = false, bool alpha_receives = false) {
    const gpu::Image image = upload_image(context(), runner(), size_, VK_FORMAT_R32G32B32A32_SFLOAT, texels);
    return import(&image, encoding, of_view, alpha_receives);
  }
  std::vector<glm::vec4> derive() { return import(nullptr, shared::kNormalsSigned, false, false); }

  /// The encoding of the public header, straight from its words.
  static glm::vec4 encoded(glm::dvec3 n, std::uint32_t encoding, double length, float alpha) {
    glm::dvec3 stored = length * n;
    if (encoding == shared::kNormalsUnsigned) stored = (n + 1.0) / 2.0;
    if (encoding >= shared::kNormalsOctahedral) {
      const glm::dvec3 on = n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
      stored = on;
      if (on.z < 0)
        stored = {(1 - std::abs(on.y)) * (on.x < 0 ? -1 : 1), (1 - std::abs(on.x)) * (on.y < 0 ? -1 : 1), 7};
      if (encoding == shared::kNormalsOctahedralUnsigned) stored = (stored + 1.0) / 2.0;
    }
    return {glm::vec3(stored), alpha};
  }

  /// How far the normal of a plane may be off at a pixel. Depths round by a unit of themselves, and so does
  /// each sum of them, of which second differences choose a side: any side of a plane will do. A slope is the
  /// difference of two: 3 units of the largest depth, times half of the size in a derivative, and 4 units of
  /// itself more for its products. What remains along the axis of the view is a sum with both. The length of
  /// the vector divides that; half floats store it.
  double bound_of_plane(std::size_t i, glm::dvec3 normal, double largest) const {
    const glm::dvec2 half_size = 0.5 * glm::dvec2(size_);
    const double across = glm::length(glm::dvec3(camera_.right)),
                 upwards = glm::length(glm::dvec3(camera_.up));
    const double depth{depth_[i]};
    const double length =
        depth / std::abs(glm::dot(normal, ray(i)));  // of the vector before its normalization
    const double off_x = half_size.x * 3 * kUnit * largest + 8 * kUnit * length * across;
    const double off_y = half_size.y * 3 * kUnit * largest + 8 * kUnit * length * upwards;
    const double off_along =
        std::abs(xy(i).x) * off_x + std::abs(xy(i).y) * off_y + 16 * kUnit * (depth + 4 * length);
    const double off = std::hypot(off_x / across, off_y / upwards, off_along) / length;
    return 2 * off + 8 * kUnit + kHalfUnit;
  }

  SurfaceNormalPass pass_;
  glm::uvec2 size_{1};
  shared::Camera camera_{};
  std::vector<float> depth_;
  std::mt19937 random_{5};
};

// Floats round what is stored by a unit, and the octahedron's z, at most 1, is what it lacks of 1: 4 units,
// divided by the length of the vector, at least 1 / sqrt(3). The rest is a normalization and a rotation.
TEST_F(SurfaceNormalTest, AreThoseOfTheHostInEachEncoding) {
  for (const std::uint32_t encoding : {shared::kNormalsSigned, shared::kNormalsUnsigned,
                                       shared::kNormalsOctahedral, shared::kNormalsOctahedralUnsigned})
    for (const bool of_view : {false, true}) {
      Vectors normals;
      std::vector<glm::vec4> texels;
      for (std::size_t i = 0; i < depth_.size(); ++i) {
        normals.push_back(direction());
        if (i < 6) normals.back() = glm::dvec3(i / 2 == 0, i / 2 == 1, i / 2 == 2) * (i % 2 ? -1.0 : 1.0);
        texels.push_back(encoded(of_view ? view_from_world(normals.back()) : normals.back(), encoding,
                                 std::exp2(8 * unit()), 0.25f));
      }
      const std::vector<glm::vec4> imported = import(texels, encoding, of_view);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        EXPECT_LT(glm::length(glm::dvec3(imported[i]) - normals[i]), kHalfUnit + 64 * kUnit)
            << encoding << ' ' << of_view << ' ' << i;
        EXPECT_FALSE(shared::moves_of(imported[i].a));
      }
    }
}

TEST_F(SurfaceNormalTest, AlphaChoosesWhatReceivesDecals) {
  std::vector<glm::vec4> texels;
  for (std::size_t i = 0; i < depth_.size(); ++i)
    texels.push_back({0, 1, 0, i % 3 == 0 ? 0.0f : 0.001f * static_cast<float>(i)});
  const std::vector<glm::vec4> chosen = import(texels, shared::kNormalsSigned, false, true);
  const std::vector<glm::vec4> all = import(texels, shared::kNormalsSigned, false, false);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    EXPECT_EQ(shared::moves_of(chosen[i].a), i % 3 == 0) << i;
    EXPECT_FALSE(shared::moves_of(all[i].a)) << i;
  }
}

TEST_F(SurfaceNormalTest, ThatAreNoneAreThoseOfTheDepth) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec4> wrong{{0, 0, 0, 1},     {kNan, 0, 1, 1},   {0, kInf, 0, 1},
                                     {1, 1, -kInf, 1}, {1e-20f, 0, 0, 1}, {3e38f, 3e38f, 0, 1}};
  std::vector<glm::vec4> texels;
  for (std::size_t i = 0; i < depth_.size(); ++i) texels.push_back(wrong[i % wrong.size()]);
  EXPECT_EQ(import(texels, shared::kNormalsSigned, true, true), derive());
  for (const glm::vec4& normal : derive()) EXPECT_NEAR(glm::length(glm::vec3(normal)), 1, 0.002);
}

TEST_F(SurfaceNormalTest, OfDepthAreThoseOfPlanes) {
  for (const glm::uvec2 size :
       {glm::uvec2(33, 17), glm::uvec2(2, 2), glm::uvec2(64, 3), glm::uvec2(640, 360)}) {
    resize(size);
    for (int planes = 0; planes < 6;) {
      const glm::dvec3 through = glm::dvec3(camera_.eye_world) + 6.0 * glm::dvec3(camera_.forward);
      glm::dvec3 normal = direction();
      if (glm::dot(normal, glm::dvec3(camera_.forward)) > 0) normal = -normal;
      float least = 1, largest = 0;
      for (std::size_t i = 0; i < depth_.size(); ++i) {
        depth_[i] = static_cast<float>(depth_of(normal, through, i));
        least = std::min(least, depth_[i]);
        largest = std::max(largest, depth_[i]);
      }
      if (!(least > 1e-4f)) continue;  // its horizon is in view
      ++planes;
      const std::vector<glm::vec4> derived = derive();
      double worst = 0;
      for (std::size_t i = 0; i < depth_.size(); ++i) {
        const double bound = bound_of_plane(i, normal, double{largest});
        EXPECT_LT(glm::length(glm::dvec3(derived[i]) - normal), bound) << size.x << ' ' << planes << ' ' << i;
        worst = std::max(worst, bound);
      }
      EXPECT_LT(worst, 0.02) << size.x << ' ' << planes;
    }
  }
}

// In a parallel view distances are affine over a plane. They round by two units, divided by the width of a
// pixel.
TEST_F(SurfaceNormalTest, OfDepthAreThoseOfPlanesInAParallelView) {
  scene::Camera view{{1, 2, 3}, {0.4f, 1.5f, -0.3f}};
  view.frustum = {-3, 4, -2, 1};
  camera_ = planning::device_camera(view, size_, {}, planning::Projection::parallel);
  const glm::dvec3 forward(camera_.forward), right(camera_.right), up(camera_.up);
  for (int planes = 0; planes < 12;) {
    glm::dvec3 normal = direction();
    if (glm::dot(normal, forward) > 0) normal = -normal;
    double nearest = 1e9, farthest = 0;
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      const glm::dvec3 from_plane = xy(i).x * right + xy(i).y * up - 6.0 * forward;
      const double z = -glm::dot(normal, from_plane) / glm::dot(normal, forward);
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
      depth_[i] = static_cast<float>(double{camera_.near_z} / z);
    }
    if (nearest < 0.2 || farthest > 100) continue;
    ++planes;
    const glm::dvec2 pixel = 2.0 * glm::dvec2(glm::length(right), glm::length(up)) / glm::dvec2(size_);
    const double off = 6 * kUnit * farthest * std::hypot(1 / pixel.x, 1 / pixel.y);
    const std::vector<glm::vec4> derived = derive();
    for (std::size_t i = 0; i < depth_.size(); ++i)
      EXPECT_LT(glm::length(glm::dvec3(derived[i]) - normal), off + 64 * kUnit + kHalfUnit)
          << planes << ' ' << i;
  }
}

// Also in the pixels at an edge: each takes the side of its own plane. Surfaces are three pixels wide or
// more.
TEST_F(SurfaceNormalTest, OfDepthKeepToTheirSideOfAnEdge) {
  const glm::dvec3 eye(camera_.eye_world), forward(camera_.forward), right(camera_.right), up(camera_.up);
  const Vectors through{eye + 5.0 * forward, eye + 5.0 * forward - 0.4 * right, eye + 7.0 * forward};
  const Vectors normals{glm::normalize(-forward + 0.3 * right + 0.5 * up),
                        glm::normalize(-forward - 0.7 * right + 0.2 * up),
                        glm::normalize(-0.6 * forward + 0.7 * up)};
  std::vector<std::size_t> of;
  float largest = 0;
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    const std::size_t x = i % size_.x, y = i / size_.x;
    of.push_back(x < 9 ? 0 : y < 8 ? 1 : 2);
    depth_[i] = static_cast<float>(depth_of(normals[of[i]], through[of[i]], i));
    ASSERT_GT(depth_[i], 0);
    largest = std::max(largest, depth_[i]);
  }
  const std::vector<glm::vec4> derived = derive();
  for (std::size_t i = 0; i < depth_.size(); ++i)
    EXPECT_LT(glm::length(glm::dvec3(derived[i]) - normals[of[i]]),
              bound_of_plane(i, normals[of[i]], double{largest}))
        << i;
}

TEST_F(SurfaceNormalTest, OfDepthFaceTheCameraWhereNothingIsAround) {
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(9, 9)}) {
    resize(size);
    depth_.assign(depth_.size(), 0.0f);
    const std::size_t middle = depth_.size() / 2;
    depth_[middle] = 0.02f;
    const glm::dvec3 normal(derive()[middle]);
    EXPECT_LT(glm::length(normal + glm::dvec3(camera_.forward)), kHalfUnit + 64 * kUnit);
  }
}

}  // namespace
}  // namespace brume::passes
