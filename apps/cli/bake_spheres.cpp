#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/console.hpp"
#include "apps/cli/json.hpp"
#include "apps/cli/number.hpp"
#include "apps/cli/parse.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/tanks.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "scenario/tank.hpp"
#include "spheres/file.hpp"
#include "spheres/pack.hpp"

namespace brume::cli {
namespace {

struct SpheresBake {
  std::string output, size = "600x600x200", radius, arrangement, coloring, palette = "batlow", json;
  std::uint32_t seed = 0;
  std::optional<double> time_limit;
  spheres::PackOptions options;
};

const std::vector<std::string> kArrangements{"random", "largest-first", "noise", "coral"};
const std::vector<std::string> kColorings{"random", "radius", "height", "noise"};

/// The value whose name stands in its place of `names`.
template <typename Choice>
Choice choice_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<Choice>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// "1.5-16", or one number for both. What is no range is left to the check of all options.
glm::vec2 parse_radius(const std::string& text) {
  if (const auto both = number_of(text)) return glm::vec2(static_cast<float>(*both));
  // Of several dashes, "1e-3-2", the one between two numbers.
  for (std::size_t dash = text.find('-', 1); dash != text.npos; dash = text.find('-', dash + 1)) {
    const auto least = number_of(text.substr(0, dash)), largest = number_of(text.substr(dash + 1));
    if (least && largest) return {static_cast<float>(*least), static_cast<float>(*largest)};
  }
  throw Error(ErrorCode::usage,
              "--radius: expected LEAST-LARGEST in voxels, such as 1.5-16, found '" + text + "'");
}

/// A range of radii that the tank has room for.
glm::vec2 default_radius(const glm::uvec3& size) {
  const float most = static_cast<float>(std::min({size.x, size.y, size.z})) / 2;
  const glm::vec2 radius = spheres::PackOptions().radius;
  return {std::min(radius.x, most / 2), std::min(radius.y, most)};
}

/// Options are named as the members that pack() reports.
Error as_option(const Failure& failure) {
  std::string option = "--" + failure.message.substr(0, failure.message.find(':'));
  const std::string why = failure.message.substr(option.size() - 2);
  std::replace(option.begin(), option.end(), '_', '-');
  return {failure.code, option + why};
}

/// Fails where not even spheres of the least radius fit by their volume alone.
void refuse_more_than_the_tank(const spheres::PackOptions& options) {
  const glm::dvec3 size(options.size);
  const double voxels = size.x * size.y * size.z;
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(double{options.radius.x}, 3);
  if (!(options.count * volume > voxels)) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "--count: %u spheres of at least radius %g have %.3g times the volume of the tank; at most %.0f "
      "have less",
      options.count, double{options.radius.x}, options.count * volume / voxels, std::floor(voxels / volume));
  throw Error(ErrorCode::usage, text);
}

void warn_of_fewer(const SpheresBake& bake, std::size_t packed, bool timed_out) {
  if (packed == bake.options.count) return;
  log_warning(std::to_string(packed) + " of " + std::to_string(bake.options.count) + " spheres are packed: " +
              (timed_out ? "--time-limit ended it"
                         : "there is no room for more; give a larger --size or a smaller --radius"));
}

void bake_spheres(SpheresBake bake, const Arguments& arguments, Outputs& outputs) {
  // Options and outputs.
  const Stopwatch watch;
  spheres::PackOptions& options = bake.options;
  options.arrangement = choice_of<spheres::Arrangement>(kArrangements, bake.arrangement);
  options.coloring = choice_of<spheres::Coloring>(kColorings, bake.coloring);
  if (options.arrangement != spheres::Arrangement::noise && options.coloring != spheres::Coloring::noise)
    arguments.refuse("--noise-size", "is for --arrangement noise and --coloring noise");
  options.size = glm::uvec3(parse_grid("--size", bake.size));
  options.radius = bake.radius.empty() ? default_radius(options.size) : parse_radius(bake.radius);
  options.seed = bake.seed;
  auto colors = scenario::palette_colors(bake.palette, "oklab");
  if (!colors) throw Error(colors.failure().code, "--palette: " + colors.failure().message);
  options.palette = std::move(*colors);
  expect_suffix("-o", bake.output, {".spheres"});
  outputs.writes("-o", bake.output, FileKind::spheres);
  outputs.writes("--json", bake.json, FileKind::json);

  // The tank. With radii that do not fit into it, the check of all options comes first.
  const float most = static_cast<float>(std::min({options.size.x, options.size.y, options.size.z})) / 2;
  if (options.radius.x > 0 && options.radius.y <= most) refuse_more_than_the_tank(options);
  const auto is_over = [&] { return bake.time_limit && watch.seconds() >= *bake.time_limit; };
  const auto packed = spheres::pack(options, [&] { return is_interrupted() || is_over(); });
  if (!packed) throw as_option(packed.failure());
  stop_if_interrupted();
  const bool timed_out = packed->spheres.size() < options.count && is_over();
  warn_of_fewer(bake, packed->spheres.size(), timed_out);
  const double seconds = watch.seconds(), cpu_seconds = watch.cpu_seconds();
  spheres::save_tank(bake.output, *packed).value_or_throw();

  // The result.
  const TankFacts facts = facts_of(*packed);
  if (!bake.json.empty()) {
    const glm::uvec3 n = options.size;
    write_json(bake.json,
               {{"output", bake.output},
                {"size", Json::list({n.x, n.y, n.z})},
                {"voxel_size", options.voxel},
                {"arrangement", bake.arrangement},
                {"coloring", bake.coloring},
                {"count", options.count},
                {"spheres", packed->spheres.size()},
                {"timed_out", timed_out},
                {"radius", Json{{"min", facts.least}, {"median", facts.median}, {"max", facts.largest}}},
                {"fill", facts.fill},
                {"milliseconds", 1000 * seconds},
                {"cpu_milliseconds", 1000 * cpu_seconds}});
  }
  if (bake.json == "-") return;
  char text[160];
  std::snprintf(text, sizeof text, "%zu spheres of radius %.3g to %.3g fill %.1f %% of the tank, in %.3g s\n",
                packed->spheres.size(), double{facts.least}, double{facts.largest}, 100 * facts.fill,
                seconds);
  print(text);
}

void add_spheres_options(const Arguments& arguments, SpheresBake& bake) {
  spheres::PackOptions& options = bake.options;
  arguments.add_option("--size", bake.size, "Voxels of the tank; default 600x600x200").type_name("XxYxZ");
  arguments.add_option("--voxel", options.voxel, "Edge of a voxel [m]; default 0.0025")
      .range(1e-6, 1e6)
      .type_name("M");
  arguments.add_option("--count", options.count, "Spheres; default 65535")
      .range(1u, spheres::kMostSpheres)
      .type_name("N");
  arguments
      .add_option("--radius", bake.radius,
                  "Least and largest radius [voxels]; default 1.5-16, less in a tank that is smaller")
      .type_name("A-B");
  arguments
      .add_option("--distribution", options.distribution,
                  "Number of spheres falls with the radius to this power; default 3")
      .range(0.0, 8.0)
      .type_name("X");
  arguments
      .add_option(
          "--arrangement", bake.arrangement,
          "random, largest-first (default), noise (strands and caves) or coral (grows from the floor)")
      .one_of(kArrangements)
      .type_name("NAME");
  arguments
      .add_option("--coloring", bake.coloring,
                  "Which of the palette's colours: random (default), by radius, by height, or by noise")
      .one_of(kColorings)
      .type_name("NAME");
  arguments
      .add_option("--noise-size", options.noise_size, "Size of the noise's features [voxels]; default 120")
      .range(1.0, 65536.0)
      .type_name("X");
  arguments
      .add_option(
          "--opacity", options.opacity,
          "Of all spheres; default 1: opaque; below, a medium of which one voxel blocks this much light")
      .range(0.0, 1.0)
      .type_name("X");
  arguments
      .add_option("--palette", bake.palette,
                  "Colours: NAME or FILE (.gpl, .json), and the part that is used; default batlow (see brume "
                  "palettes)")
      .type_name("NAME:A-B");
  arguments.add_option("--seed", bake.seed, "Seed of places, radii and colours; default 0")
      .range(0u, 4294967295u)
      .type_name("N");
  arguments
      .add_option("--time-limit", bake.time_limit,
                  "Stop after this time [s] with what is packed; the result then depends on the machine")
      .range(0.001, 1e6)
      .type_name("S");
}

}  // namespace

Command add_bake_spheres(CommandLine& program) {
  Command command =
      declare(program, "bake spheres", "Packs spheres that do not overlap into a tank.",
              "  brume bake spheres -o tank.spheres\n"
              "  brume bake spheres -o reef.spheres --size 300x300x100 --count 8000 --arrangement coral\n"
              "  brume bake spheres -o haze.spheres --radius 2-30 --distribution 2 --opacity 0.1 --json -");
  auto bake = std::make_shared<SpheresBake>();
  bake->arrangement = "largest-first";
  bake->coloring = "random";
  const Arguments& arguments = command.arguments;
  arguments.add_option("-o,--output", bake->output, "Tank to write (.spheres)").required().type_name("FILE");
  add_spheres_options(arguments, *bake);
  declare_json(arguments, bake->json);
  command.run = [bake, arguments, common = command.common] {
    bake_spheres(*bake, arguments, common->outputs);
  };
  return command;
}

}  // namespace brume::cli
