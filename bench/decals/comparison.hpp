// What decals darken against what rays find: the occlusion of surfaces around an object that moves.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "gpu/recorder.hpp"
#include "scenario/scenario.hpp"

namespace brume::decals {

/// Which pixels a number is of. Sky and objects that move are in none.
enum class Part { all, inside, ceiling_and_floor, wall, oblique, rim, outside };
/// Inside of the first decal's box are `ceiling_and_floor`, whose normals are at most 26 degrees (0.9) off
/// its up or down, `wall`, at most 17 degrees (0.3) off its horizon, and `oblique`, all others; `rim` is
/// where the decal fades out.
constexpr std::array<const char*, 7> kPartNames{"all",     "inside", "up_down", "wall",
                                                "oblique", "rim",    "outside"};

/// Statistics of decal minus reference.
struct Difference {
  std::size_t pixels = 0;
  double sum = 0, sum_of_squares = 0, largest = 0;
  double sum_of_reference = 0;  ///< What there is to be found.
  void add(double decal, double reference);
  void add(const Difference& other);
};
using Differences = std::array<Difference, kPartNames.size()>;

/// One view of the object: each pixel of an image, rows from the top.
struct View {
  /// Per pixel; what is not compared has the kind `sky` or `moves`.
  enum class Kind : std::uint8_t { sky, moves, surface };
  std::vector<Kind> kinds;
  std::vector<glm::dvec3> positions_world, normals;
  std::vector<float> decal;  ///< The occlusion that the renderer reads.
};

/// Renders a scenario at a time [s] and reads back what decals darken. Each call starts a film of its own.
class ViewRenderer {
 public:
  /// All must outlive it.
  ViewRenderer(gpu::Context& context, gpu::CommandRunner& runner, const scenario::Scenario& scenario,
               glm::uvec2 size_px);
  ~ViewRenderer();
  View draw(double seconds);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// What the object of the first decal's carrier, where it is at a time, hides from the surfaces of a view.
/// Throws bad_input where there is none.
std::vector<float> trace(const scenario::Scenario& scenario, double seconds, const View& view, int rays);

/// Compares the pixels of a view.
Differences compare(const scenario::Scenario& scenario, double seconds, const View& view,
                    const std::vector<float>& reference);

/// Writes reference, decal, and four times their difference side by side: what remains of the light, sky and
/// moving objects blue; of the difference red where the decal is darker, blue where it is brighter.
Result<void> save_picture(const std::filesystem::path& path, glm::uvec2 size_px, const View& view,
                          const std::vector<float>& reference);

}  // namespace brume::decals
