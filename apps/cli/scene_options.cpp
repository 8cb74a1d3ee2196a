#include "apps/cli/scene_options.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "apps/cli/parse.hpp"
#include "core/log.hpp"
#include "scenario/smoke_report.hpp"

namespace brume::cli {
namespace {

std::optional<float> as_float(const std::optional<double>& value) {
  return value ? std::optional(static_cast<float>(*value)) : std::nullopt;
}

/// "FROM TO": two points.
scene::SmokeEvent parse_throw(const std::string& text) {
  const std::size_t space = text.find(' ');
  if (space == std::string::npos || text.find(' ', space + 1) != std::string::npos)
    throw Error(ErrorCode::usage, "--throw '" + text + "': expected two points, such as \"0,1.7,8 0,0,-2\"");
  return {0, parse_point("--throw", text.substr(0, space)), parse_point("--throw", text.substr(space + 1))};
}

scenario::SunPosition parse_sun(const std::string& text) {
  float azimuth = 0, elevation = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%f,%f%c", &azimuth, &elevation, &end) != 2 || !std::isfinite(azimuth) ||
      !(elevation > 0 && elevation <= 90))
    throw Error(ErrorCode::usage,
                "--sun '" + text +
                    "': expected azimuth and elevation in degrees, the elevation above 0 and up "
                    "to 90, such as 60,40");
  constexpr float kRadians = std::numbers::pi_v<float> / 180;
  return {azimuth * kRadians, elevation * kRadians};
}

void apply_to_timeline(scene::Timeline& timeline, const scenario::FirstViewOptions& options) {
  if (options.scale || options.sun || options.smoke_size)
    throw Error(
        ErrorCode::usage,
        "--scale, --sun and --smoke-size are for a scene without a timeline; set them in the timeline");
  if (options.voxel) timeline.grid.voxel = *options.voxel;
  if (options.exposure) timeline.exposure = *options.exposure;
  if (options.tone) timeline.tone = *options.tone;
  timeline.smokes.insert(timeline.smokes.begin(), options.smokes.begin(), options.smokes.end());
}

void warn_of_smokes(const scenario::Scenario& scenario) {
  const auto reports = scenario::report_smokes(scenario).value_or_throw();
  for (std::size_t i = 0; i < reports.size(); ++i)
    if (const std::string warning = scenario::warning_of(reports[i], i + 1, scenario); !warning.empty())
      log_warning(warning);
}

}  // namespace

void declare_scene_options(const Arguments& arguments, SceneOptions& options) {
  arguments.add_option("--smoke", options.smokes, "Smoke that goes off at this point [m]; repeatable")
      .take_all()
      .type_name("X,Y,Z");
  arguments
      .add_option("--throw", options.throws,
                  "\"FROM TO\": grenade thrown from a point towards another [m]; repeatable")
      .take_all()
      .type_name("POINTS");
  arguments
      .add_option("--smoke-size", options.smoke_size,
                  "Diameter of the smoke [m]; default: a fifth of the view")
      .range(0.05, 1000.0)
      .type_name("M");
  arguments.add_option("--voxel", options.voxel, "Edge length of a voxel [m]; default: fits the smoke")
      .range(0.015625, 64.0)
      .type_name("M");
  arguments
      .add_option("--scale", options.scale,
                  "Metres per unit of the scene, such as 0.001 for millimetres; default: 1, "
                  "or what brings it between 1 m and 4 km")
      .range(1e-6, 1e6)
      .type_name("X");
  arguments.add_option("--sun", options.sun, "Azimuth from +z towards +x and elevation of the sun [degrees]")
      .type_name("AZ,EL");
  arguments
      .add_option("--tone", options.tone,
                  "Tone curve: neutral compresses highlights, standard clips them as Blender does; default: "
                  "the timeline's, "
                  "or neutral")
      .one_of({"neutral", "standard"})
      .type_name("neutral|standard");
  arguments.add_option("--exposure", options.exposure, "Exposure [EV]; default: the timeline's, or measured")
      .range(-20.0, 20.0)
      .type_name("EV");
}

std::vector<std::string> texts_of(const SceneOptions& options) {
  std::vector<std::string> texts = options.smokes;
  texts.push_back("throws");
  texts.insert(texts.end(), options.throws.begin(), options.throws.end());
  texts.push_back(options.sun);
  texts.push_back(options.tone);
  for (const std::optional<double>& number :
       {options.smoke_size, options.voxel, options.scale, options.exposure}) {
    char text[32] = "";
    if (number) std::snprintf(text, sizeof text, "%.17g", *number);  // to_string() has but 6 decimals
    texts.emplace_back(text);
  }
  return texts;
}

scenario::FirstViewOptions parse_scene_options(const SceneOptions& options) {
  scenario::FirstViewOptions parsed;
  parsed.scale = as_float(options.scale);
  parsed.voxel = as_float(options.voxel);
  parsed.smoke_size = as_float(options.smoke_size);
  parsed.exposure = as_float(options.exposure);
  if (!options.tone.empty())
    parsed.tone = options.tone == "standard" ? scene::ToneCurve::standard : scene::ToneCurve::neutral;
  if (!options.sun.empty()) parsed.sun = parse_sun(options.sun);
  for (const std::string& text : options.smokes) {
    const glm::vec3 place = parse_point("--smoke", text);
    parsed.smokes.push_back({0, place, place});
  }
  for (const std::string& text : options.throws) parsed.smokes.push_back(parse_throw(text));
  return parsed;
}

scenario::Scenario load_with_options(const std::string& input, const std::string& timeline,
                                     const scenario::FirstViewOptions& options) {
  const bool is_timeline = scenario::is_timeline(input);
  if (is_timeline && !timeline.empty())
    throw Error(ErrorCode::usage, "--timeline: " + input + " is already a timeline; name a scene");
  scenario::Scenario scenario = [&] {
    if (!is_timeline && timeline.empty()) return scenario::load_scenario(input, {}, options).value_or_throw();
    scene::Timeline read = scene::load_timeline(is_timeline ? input : timeline).value_or_throw();
    if (!is_timeline) read.scene = input;
    apply_to_timeline(read, options);
    return scenario::make_scenario(std::move(read), {}).value_or_throw();
  }();
  warn_of_smokes(scenario);
  return scenario;
}

}  // namespace brume::cli
