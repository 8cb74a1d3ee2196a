// A bright ball out of focus: its picture is that of the lens's opening, as large as the thin lens says.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "tests/render/tank_fixture.hpp"

namespace brume::render {
namespace {

// The ball is in the middle of the world, the camera before it. Places and sizes in the picture are on a
// plane at a distance of 1 m.
constexpr glm::uvec2 kLensSize{64, 64};
constexpr double kHalf = 0.16;  // of the picture
constexpr double kPixel = 2 * kHalf / kLensSize.x;
constexpr float kDistance = 1, kRadius = 0.03f, kAperture = 0.1f;
constexpr double kBright = 50;

/// Radius of the ball's picture when it is in focus.
const double kSharp = double{kRadius} / std::sqrt(1 - double{kRadius} * double{kRadius});
/// The lens and the ball are seen at angles of up to 0.1, whose cosines differ from 1 by up to 0.5 %: shapes
/// of the ball from the edge of the lens, 0.25 % of areas on average.
constexpr double kAngles = 0.005;

/// Its picture from n samples of each pixel: light in all, middle and squared extents.
struct Blob {
  Mean light, x, y, xx, yy, xy;
  std::vector<double> pixels;  ///< Mean radiance.
};

class TankLensTest : public TankPicturesTest {
 protected:
  static constexpr std::uint32_t kBatches = 32, kSamplesOfBatch = 16;

  TankLensTest() {
    // A size that is even: the ball is in the middle of it.
    tank_ = tank_of({16, 16, 16}, kRadius / 4);
    put(tank_, {8, 8, 8}, 4, kWhite);
    scene_ = dark_scene();
    scene_.bounces = 0;
    scene_.sky.ambient = glm::vec3(static_cast<float>(kBright));
  }
  /// With a lens that is focused at a distance.
  Blob blob(float focus, std::uint32_t blades, scene::LensPoints points) {
    scene_.lens_points = points;
    scene::Camera camera{{0, 0, kDistance}, {0, 0, 0}, static_cast<float>(2 * std::atan(kHalf))};
    camera.lens = {.aperture = kAperture, .focus = focus, .blades = blades};
    TankPicture picture(context(), runner(), tank_);
    begin(picture, scene_, tank_, camera, kLensSize);
    Blob blob;
    std::vector<glm::vec4> before(kLensSize.x * kLensSize.y, glm::vec4(0));
    for (std::uint32_t batch = 0; batch < kBatches; ++batch) {
      add_samples(picture, kSamplesOfBatch);
      const std::vector<glm::vec4> after = sums(picture);
      add_moments(blob, before, after);
      before = after;
    }
    for (const glm::vec4& sum : before) blob.pixels.push_back(double{sum.g} / (kBatches * kSamplesOfBatch));
    return blob;
  }

 private:
  static void add_moments(Blob& blob, std::span<const glm::vec4> before, std::span<const glm::vec4> after) {
    double light = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double weight = double{after[i].g} - double{before[i].g};
      const glm::dvec2 at = place(i);
      light += weight;
      x += weight * at.x, y += weight * at.y;
      xx += weight * at.x * at.x, yy += weight * at.y * at.y, xy += weight * at.x * at.y;
    }
    blob.light.add(light * kPixel * kPixel / kSamplesOfBatch);
    blob.x.add(x / light), blob.y.add(y / light);
    blob.xx.add(xx / light), blob.yy.add(yy / light), blob.xy.add(xy / light);
  }

 protected:
  /// The middle of a pixel.
  static glm::dvec2 place(std::size_t i) {
    return {(static_cast<double>(i % kLensSize.x) + 0.5) * kPixel - kHalf,
            kHalf - (static_cast<double>(i / kLensSize.x) + 0.5) * kPixel};
  }

  spheres::Tank tank_;
  scene::TankScene scene_;
};

/// Squared extent along an axis of a regular polygon, or below 3 edges of a disk, with a circumscribed circle
/// of radius 1: that of a triangle of its middle and an edge, over all of its turns.
double squared_extent(std::uint32_t blades) {
  if (blades < 3) return 0.25;
  const double half_wedge = kPi / blades;
  return (2 + std::cos(2 * half_wedge)) / 12;
}

/// How far a point is from such a polygon with a corner at (0, 1), off a corner at least so far; below 0
/// inside.
double distance_outside(std::uint32_t blades, const glm::dvec2& at) {
  if (blades < 3) return glm::length(at) - 1;
  double distance = -1e9;
  for (std::uint32_t i = 0; i < blades; ++i) {
    const double angle = kPi / blades * (2 * i + 1);
    distance = std::max(distance, at.x * std::sin(angle) + at.y * std::cos(angle) - std::cos(kPi / blades));
  }
  return distance;
}

double area_of(std::uint32_t blades) {
  return blades < 3 ? kPi : 0.5 * blades * std::sin(2 * kPi / blades);
}

TEST_F(TankLensTest, ABallOutOfFocusIsAsLargeAsTheThinLensSays) {
  // Before and behind it: upside down, and not.
  for (const float focus : {0.5f, 4.0f})
    for (const std::uint32_t blades : {0u, 5u, 6u}) {
      SCOPED_TRACE(testing::Message() << "focus " << focus << ", blades " << blades);
      const Blob found = blob(focus, blades, scene::LensPoints::remap);
      // Signed: a point p of the lens sees it at p (1 / focus - 1 / distance).
      const double scale = double{kAperture} * (1 / double{focus} - 1 / double{kDistance});
      const double circle = std::abs(scale);
      EXPECT_NEAR(found.light.value(), kBright * kPi * kSharp * kSharp,
                  4 * found.light.error() + kAngles * found.light.value());
      // Those of the opening, of the ball and of a pixel add up.
      const double extent =
          circle * circle * squared_extent(blades) + kSharp * kSharp / 4 + kPixel * kPixel / 12;
      for (const Mean* mean : {&found.xx, &found.yy}) {
        EXPECT_NEAR(mean->value(), extent, 4 * mean->error() + kAngles * extent);
        EXPECT_LT(4 * mean->error(), 0.02 * extent * kLooser);
      }
      EXPECT_NEAR(found.xy.value(), 0, 4 * found.xy.error() + kAngles * extent);
      for (const Mean* mean : {&found.x, &found.y}) EXPECT_NEAR(mean->value(), 0, 4 * mean->error() + 1e-6);

      // The shape, with its corners where they are to be.
      const double plateau = kBright * kPi * kSharp * kSharp / (area_of(blades) * circle * circle);
      const double margin = kSharp * (1 + kAngles) + kPixel * std::numbers::sqrt2 / 2;
      double inside = 0, count = 0;
      for (std::size_t i = 0; i < found.pixels.size(); ++i) {
        const double distance = circle * distance_outside(blades, place(i) / scale);
        if (distance > margin) {
          EXPECT_EQ(found.pixels[i], 0) << i;
        }
        if (distance > -margin) continue;
        EXPECT_GT(found.pixels[i], 0) << i;
        inside += found.pixels[i];
        ++count;
      }
      // Whether a sample meets the ball is random.
      const double hits = count * kBatches * kSamplesOfBatch * plateau / kBright;
      EXPECT_NEAR(inside / count, plateau, plateau * (4 / std::sqrt(hits) + kAngles));
      EXPECT_GT(count, 30);
    }
}

TEST_F(TankLensTest, BothSamplersShowTheSame) {
  for (const std::uint32_t blades : {0u, 5u, 6u}) {
    SCOPED_TRACE(blades);
    const Blob remap = blob(0.5f, blades, scene::LensPoints::remap);
    const Blob rejection = blob(0.5f, blades, scene::LensPoints::rejection);
    const auto expect_same = [](const Mean& a, const Mean& b) {
      EXPECT_NEAR(a.value(), b.value(), 4 * std::hypot(a.error(), b.error()));
    };
    expect_same(remap.light, rejection.light);
    expect_same(remap.x, rejection.x);
    expect_same(remap.y, rejection.y);
    expect_same(remap.xx, rejection.xx);
    expect_same(remap.yy, rejection.yy);
    expect_same(remap.xy, rejection.xy);
    // They are not the same points.
    EXPECT_NE(remap.pixels, rejection.pixels);
  }
}

}  // namespace
}  // namespace brume::render
