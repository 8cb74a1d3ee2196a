// A picture that becomes more exact with every sample.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.hpp"
#include "image/image.hpp"
#include "reference/path_tracer.hpp"
#include "scenario/lens_openings.hpp"
#include "scene/options.hpp"
#include "scene/scene.hpp"
#include "shared/frame.h"

namespace brume::reference {

/// A camera at one time of the shutter.
struct Eye {
  shared::Camera camera{};
  float aperture = 0;  ///< Radius of the lens [m].
  float focus = 1;     ///< Distance along the view axis that is sharp [m], > 0.
};
Eye make_eye(const scene::Camera& camera, glm::uvec2 size_px);

struct RenderSettings {
  glm::uvec2 size_px{0};  ///< At most kMostPixels.
  /// At equal steps while the shutter is open, at least one.
  std::vector<Eye> eyes;
  std::uint32_t blades = 0;                        ///< scene::Lens::blades.
  const scenario::LensOpening* opening = nullptr;  ///< In the place of blades; null: none.
  PathLimits limits;
  std::uint32_t samples = 0;  ///< Most per pixel, up to kMostSamples; 0: without end.
  /// Standard error of a tile's pixels relative to its mean at which it is done; 0: never.
  float noise = 0;
};

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;
using scene::kMostSamples;

/// The samples of a picture so far. Its state after n samples of a tile is the same bit by bit for any number
/// of threads, and whether or not it was saved and loaded in between.
class Render {
 public:
  /// Finds what one path along a ray finds, from any thread, with the numbers of a sampler alone.
  using Trace = std::function<PathSample(const Ray&, Sampler&)>;

  /// `scene` must outlive it. Throws resource_limit for more than kMostPixels.
  Render(const Scene& scene, const RenderSettings& settings);
  /// The same of anything that paths are traced in; `limits` are left to `trace`.
  Render(Trace trace, const RenderSettings& settings);

  /// Adds at least a sample to each pixel that needs more, in about `seconds`; true where none does. Returns
  /// early, with a valid state, soon after `stopped` returns true, which any thread may call: samples of
  /// tiles that are not complete by then are dropped.
  bool advance(double seconds, const std::function<bool()>& stopped);

  /// The fraction of the pixels that have no sample yet: they are black.
  double without_samples() const;
  /// Mean samples of the pixels.
  double samples() const;
  /// The largest error of the tiles (RenderSettings::noise); infinite before two samples.
  double error() const;
  /// Mean radiance of each pixel, rows from the top.
  std::vector<glm::vec4> radiance() const;
  /// The numbers of all pixels (docs/how/path-tracer.md).
  image::LayeredImage layers() const;

  /// Writes all samples, with a key of what they are samples of.
  Result<void> save(const std::filesystem::path& path, std::uint64_t key) const;
  /// Goes on from a saved state. Fails with bad_input for a file that is none, is damaged, or has another
  /// key, size or limits.
  Result<void> load(const std::filesystem::path& path, std::uint64_t key);

 private:
  /// Sums over the samples of a pixel.
  struct Sums {
    glm::dvec3 seen{0}, single{0}, multiple{0};
    glm::dvec3 background{0};  ///< What is seen by paths that met nothing.
    double squares = 0;        ///< Squared luminance.
    glm::vec3 albedo{0}, normal{0};
    float depth = 0, hits = 0;  ///< Along the view axis, of paths that met a surface.
    float clear = 0;            ///< Paths that met neither a surface nor a medium.
    float passed = 0;           ///< Paths that met no medium before the surface.
  };
  static_assert(sizeof(Sums) == 144);
  struct Tile {
    glm::uvec2 low, end;  // [px]
    std::uint32_t samples = 0;
    bool done = false;
  };

  void sample(Tile& tile, const std::function<bool()>& stopped);
  void add_paths(const Tile& tile, const std::function<bool()>& stopped);
  void finish(Tile& tile) const;
  double error_of(const Tile& tile) const;
  Ray eye_ray(glm::uvec2 pixel, Sampler& sampler) const;
  std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y} * settings_.size_px.x + x;
  }
  template <typename Visit>
  void for_each_pixel(const Visit& visit) const;

  Trace trace_;
  RenderSettings settings_;
  std::vector<Sums> sums_;
  std::vector<Tile> tiles_;
};

}  // namespace brume::reference
