// Writes the radiance that a volume scatters once as a PFM file of floats
// (bench/peers/single_scattering.hpp).
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#include "bench/peers/single_scattering.hpp"
#include "core/file.hpp"
#include "grids/files/grid_files.hpp"

namespace {

using namespace brume;

constexpr const char* kUsage =
    "volume_reference CLOUD.brv OUT.pfm --size WIDTHxHEIGHT --eye X,Y,Z --target X,Y,Z --fov DEGREES\n"
    "                 --to-sun X,Y,Z --extinction PER_METRE (--points 1..4 | --step METRES)\n";

/// Ends with code 2.
[[noreturn]] void usage(const std::string& problem) {
  std::fprintf(stderr, "volume_reference: %s\n%s", problem.c_str(), kUsage);
  std::exit(static_cast<int>(ErrorCode::usage));
}

/// The numbers of an option, separated by a character.
class Options {
 public:
  Options(int count, char** words) {
    for (int i = 0; i < count; i += 2) {
      if (std::string_view(words[i]).substr(0, 2) != "--" || i + 1 == count)
        usage(std::string("expected --NAME VALUE, found '") + words[i] + "'");
      values_[words[i]] = words[i + 1];
    }
  }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  template <std::size_t kCount>
  std::array<double, kCount> numbers(const std::string& name, char separator, double least, double most) {
    const auto found = values_.find(name);
    if (found == values_.end()) usage(name + " is missing");
    std::array<double, kCount> result{};
    const char *at = found->second.data(), *const end = at + found->second.size();
    for (std::size_t i = 0; i < kCount; ++i) {
      if (i > 0 && (at == end || *at++ != separator)) fail(name, kCount, least, most);
      const auto read = std::from_chars(at, end, result[i]);
      if (read.ec != std::errc() || !(result[i] >= least && result[i] <= most))
        fail(name, kCount, least, most);
      at = read.ptr;
    }
    if (at != end) fail(name, kCount, least, most);
    values_.erase(found);
    return result;
  }
  double number(const std::string& name, double least, double most) {
    return numbers<1>(name, ',', least, most)[0];
  }
  glm::dvec3 point(const std::string& name) {
    const auto p = numbers<3>(name, ',', -1e9, 1e9);
    return {p[0], p[1], p[2]};
  }
  /// All have been read.
  void finish() const {
    if (!values_.empty()) usage("unknown option " + values_.begin()->first);
  }

 private:
  [[noreturn]] void fail(const std::string& name, std::size_t count, double least, double most) {
    char range[80];
    std::snprintf(range, sizeof range, "%zu number%s in [%g, %g]", count, count > 1 ? "s" : "", least, most);
    usage(name + " '" + values_[name] + "': expected " + range);
  }
  std::map<std::string, std::string> values_;
};

peers::SingleScattering read_scene(Options& options) {
  peers::SingleScattering scene;
  const auto size = options.numbers<2>("--size", 'x', 1, 16384);
  scene.width = static_cast<std::uint32_t>(size[0]);
  scene.height = static_cast<std::uint32_t>(size[1]);
  scene.eye = options.point("--eye");
  scene.target = options.point("--target");
  scene.fov = glm::radians(options.number("--fov", 0.01, 179));
  scene.to_sun = options.point("--to-sun");
  scene.extinction = options.number("--extinction", 0, 1e9);
  const glm::dvec3 forward = scene.target - scene.eye;
  if (glm::length(scene.to_sun) == 0 || glm::length(glm::cross(forward, glm::dvec3(0, 1, 0))) == 0)
    usage("--to-sun must have a length, and the view must not be along y");
  scene.to_sun = glm::normalize(scene.to_sun);
  return scene;
}

/// Portable float map: one channel, rows from the bottom, little-endian.
Result<void> save_pfm(const char* file, const peers::SingleScattering& scene,
                      const peers::Radiances& values) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = "Pf\n" + std::to_string(scene.width) + " " + std::to_string(scene.height) + "\n-1.0\n";
  for (std::size_t row = scene.height; row-- > 0;)
    bytes.append(reinterpret_cast<const char*>(&values[row * scene.width]), sizeof(float) * scene.width);
  return write_file_atomic(file, bytes);
}

int fail(const std::string& file, const Failure& failure) {
  std::fprintf(stderr, "volume_reference: %s: %s\n", file.c_str(), failure.message.c_str());
  return static_cast<int>(failure.code);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) usage("expected a volume and an image");
  Options options(argc - 3, argv + 3);
  const peers::SingleScattering scene = read_scene(options);
  const bool by_steps = options.has("--step");
  const double value = by_steps ? options.number("--step", 1e-9, 1e9) : options.number("--points", 1, 4);
  options.finish();

  const auto file = grids::load_grid_file(argv[1]);
  if (!file) return fail(argv[1], file.failure());
  if (file->grids.size() != 1) return fail(argv[1], {ErrorCode::bad_input, "expected one grid"});
  const auto field = peers::DenseField::from(file->grids[0]);
  if (!field) return fail(argv[1], field.failure());
  const peers::Radiances values = by_steps ? peers::integrate_steps(*field, scene, value)
                                           : peers::integrate_cells(*field, scene, static_cast<int>(value));
  if (const auto saved = save_pfm(argv[2], scene, values); !saved) return fail(argv[2], saved.failure());
  return 0;
}
