#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/tanks.hpp"
#include "apps/cli/units.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/number.hpp"
#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "palettes/choice.hpp"
#include "scenario/tank.hpp"
#include "scene/tank_options.hpp"
#include "scene/tank_scene.hpp"
#include "scene/text_reader.hpp"
#include "spheres/file.hpp"
#include "spheres/pack.hpp"

namespace brume::cli {
namespace {

struct SpheresBake {
  std::string output, size = "600x600x200", radius, palette = "batlow", json;
  std::string arrangement = scene::arrangement_name(spheres::PackOptions().arrangement);
  std::string coloring = scene::coloring_name(spheres::PackOptions().coloring);
  bool has_count = false;
  std::uint32_t seed = 0;
  std::optional<double> time_limit;
  spheres::PackOptions options;
  UnitOptions units;
};

/// The names of a choice, as scenes have them.
template <typename Choice>
std::vector<std::string> choice_names(std::uint32_t count, const char* (*name_of)(Choice)) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) names.emplace_back(name_of(Choice{i}));
  return names;
}

/// "1.5-16", or one number for both. What is no range is left to the check of all options.
glm::vec2 parse_radius(const std::string& text) {
  if (const auto both = parse_number(text)) return glm::vec2(static_cast<float>(*both));
  // Takes, of several dashes ("1e-3-2"), the one between two numbers.
  for (std::size_t dash = text.find('-', 1); dash != text.npos; dash = text.find('-', dash + 1)) {
    const auto least = parse_number(text.substr(0, dash)), largest = parse_number(text.substr(dash + 1));
    if (least && largest) return {static_cast<float>(*least), static_cast<float>(*largest)};
  }
  throw Error(ErrorCode::usage,
              "--radius: expected LEAST-LARGEST in voxels, such as 1.5-16, found '" + text + "'");
}

/// Options are named as the members that pack() reports.
Error as_option(const Failure& failure) {
  std::string option = "--" + failure.message.substr(0, failure.message.find(':'));
  const std::string why = failure.message.substr(option.size() - 2);
  std::replace(option.begin(), option.end(), '_', '-');
  return {failure.code, option + why};
}

/// Chooses how many spheres there are if the command line does not. Fails for options out of range, and where
/// not even spheres of the least radius fit by their volume alone.
void check_pack(spheres::PackOptions& options, bool has_count) {
  if (const auto checked = spheres::check_options(options); !checked) throw as_option(checked.failure());
  if (options.radius.x < static_cast<float>(scene::kLeastRadius))
    throw Error(ErrorCode::usage, "--radius: from " + scene::shown(double{options.radius.x}) +
                                      " voxels; expected at least " + scene::shown(scene::kLeastRadius));
  if (!has_count) options.count = spheres::default_count(options);
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

/// A number that the command line does not give is what there is room for.
void warn_of_fewer(const SpheresBake& bake, std::size_t packed, bool timed_out) {
  if (packed == bake.options.count || !(bake.has_count || timed_out)) return;
  log_warning(std::to_string(packed) + " of " + std::to_string(bake.options.count) + " spheres are packed: " +
              (timed_out ? "--time-limit ended it"
                         : "there is no room for more; give a larger --size or a smaller --radius"));
}

void bake_spheres(SpheresBake bake, const Arguments& arguments, Outputs& outputs) {
  // Files and options.
  const Stopwatch watch;
  outputs.reads(to_path(palettes::file_of_choice(bake.palette)));
  expect_suffix("-o", bake.output, {".spheres"});
  outputs.writes("-o", to_path(bake.output), FileKind::spheres);
  outputs.writes("--json", to_path(bake.json), FileKind::json);
  spheres::PackOptions& options = bake.options;
  options.arrangement =
      scene::choice_of(bake.arrangement, scene::kArrangements, scene::arrangement_name).value_or_throw();
  options.coloring =
      scene::choice_of(bake.coloring, scene::kColorings, scene::coloring_name).value_or_throw();
  if (options.arrangement != spheres::Arrangement::noise && options.coloring != spheres::Coloring::noise)
    arguments.refuse("--noise-size", "is for --arrangement noise and --coloring noise");
  options.size = glm::uvec3(parse_grid("--size", bake.size));
  options.radius = bake.radius.empty() ? spheres::default_radius(options.size) : parse_radius(bake.radius);
  check_pack(options, bake.has_count);
  options.seed = bake.seed;
  auto colors = scenario::palette_colors(bake.palette, "oklab");
  if (!colors) throw Error(colors.failure().code, "--palette: " + colors.failure().message);
  options.palette = std::move(*colors);

  // The tank.
  const auto is_over = [&] { return bake.time_limit && watch.seconds() >= *bake.time_limit; };
  const auto packed = spheres::pack(options, [&] { return is_interrupted() || is_over(); });
  if (!packed) throw as_option(packed.failure());
  stop_if_interrupted();
  const bool timed_out = packed->spheres.size() < options.count && is_over();
  warn_of_fewer(bake, packed->spheres.size(), timed_out);
  const double seconds = watch.seconds(), cpu_seconds = watch.cpu_seconds();
  spheres::save_tank(to_path(bake.output), *packed).value_or_throw();

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
  const std::size_t count = packed->spheres.size();
  std::snprintf(text, sizeof text, "%zu %s of radius %.3g to %.3g %s %.1f %% of the tank, in %.3g s\n", count,
                count == 1 ? "sphere" : "spheres", double{facts.least}, double{facts.largest},
                count == 1 ? "fills" : "fill", 100 * facts.fill, seconds);
  print(text);
}

/// The numbers, with the limits that scenes have.
void add_numbers(const Arguments& arguments, spheres::PackOptions& options) {
  struct Number {
    const char *key, *option, *help, *placeholder;
  };
  static constexpr Number kNumbers[] = {
      {"voxel", "--voxel", "Edge of a voxel [m]; default 0.0025", "M"},
      {"spheres", "--count", "Spheres; default 65535, fewer in a small tank", "N"},
      {"distribution", "--distribution", "Number of spheres falls with the radius to this power; default 3",
       "X"},
      {"noise_size", "--noise-size", "Size of the noise's features [voxels]; default 120", "X"},
      {"opacity", "--opacity",
       "Of all spheres; default 1: opaque; below, a medium of which one voxel blocks this much light", "X"}};
  // Ranges come from the scene's options: one place states them.
  std::size_t added = 0;
  scene::visit_pack_options(options, [&](const scene::OptionInfo& info, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    using Limit = std::conditional_t<std::is_same_v<Member, float>, double, Member>;
    for (const Number& number : kNumbers) {
      if (std::string_view(number.key) != info.key) continue;
      ++added;
      arguments.add_option(number.option, member, number.help)
          .range(static_cast<Limit>(info.low), static_cast<Limit>(info.high))
          .type_name(number.placeholder);
    }
  });
  BRUME_ASSERT(added == std::size(kNumbers), std::to_string(added));
}

void add_spheres_options(const Arguments& arguments, SpheresBake& bake) {
  arguments.add_option("--size", bake.size, "Voxels of the tank; default 600x600x200").type_name("XxYxZ");
  add_numbers(arguments, bake.options);
  // Where spheres are tried.
  arguments
      .add_option("--radius", bake.radius,
                  "Least and largest radius [voxels]; default 1.5-16, less in a tank that is smaller")
      .type_name("A-B");
  arguments
      .add_option(
          "--arrangement", bake.arrangement,
          "random, largest_first (default), noise (strands and caves) or coral (grows from the floor)")
      .one_of(choice_names(scene::kArrangements, scene::arrangement_name))
      .type_name("NAME");
  // What colours they take.
  arguments
      .add_option("--coloring", bake.coloring,
                  "Which of the palette's colours: random (default), by radius, by height, or by noise")
      .one_of(choice_names(scene::kColorings, scene::coloring_name))
      .type_name("NAME");
  arguments
      .add_option("--palette", bake.palette,
                  "Colours: NAME or FILE (.gpl, .json), and the part that is used; default batlow (see brume "
                  "palettes)")
      .type_name("NAME:A-B");
  // What decides the result.
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
  const Arguments& arguments = command.arguments;
  arguments.add_option("-o,--output", bake->output, "Tank to write (.spheres)").required().type_name("FILE");
  add_spheres_options(arguments, *bake);
  declare_units(arguments, bake->units, "numbered tanks, such as tank_%04d.spheres; it is added to the seed");
  declare_json(arguments, bake->json);
  command.run = [bake, arguments, common = command.common] {
    bake->has_count = arguments.given("--count");
    run_units(arguments, bake->units, *common, {"", "-o", bake->output, FileKind::spheres, {}},
              [&](const Unit& unit, Outputs& outputs) {
                if (unit.number) arguments.refuse("--time-limit", "is for a single tank");
                SpheresBake one = *bake;
                one.output = unit.output;
                one.seed += unit.number.value_or(0);
                bake_spheres(one, arguments, outputs);
              });
  };
  return command;
}

}  // namespace brume::cli
