#include "apps/cli/scene_options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "apps/cli/command.hpp"
#include "apps/command_line/parse.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "scenario/smoke_report.hpp"
#include "scene/daylight.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/options.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {
namespace {

// Settings of timelines, whose ranges their options have.
scene::OptionInfo grid_setting(const char* key) {
  return scene::info_of<scene::GridOptions>(key, [](auto& o, auto& v) { scene::visit_grid_options(o, v); });
}
scene::OptionInfo timeline_setting(const char* key) {
  return scene::info_of<scene::Timeline>(key, [](auto& o, auto& v) { scene::visit_timeline_options(o, v); });
}
scene::OptionInfo sun_setting(const char* key) {
  return scene::info_of<scene::SunOptions>(key, [](auto& o, auto& v) { scene::visit_sun_options(o, v); });
}
scene::OptionInfo volume_setting(const char* key) {
  return scene::info_of<scene::VolumeOptions>(key,
                                              [](auto& o, auto& v) { scene::visit_volume_options(o, v); });
}

std::optional<float> as_float(const std::optional<double>& value) {
  return value ? std::optional(static_cast<float>(*value)) : std::nullopt;
}

/// "FROM TO": two points.
scene::SmokeEvent parse_throw(const std::string& text) {
  const auto points = parse_points(text);
  if (points.size() != 2)
    throw Error(ErrorCode::usage, "--throw '" + text + "': expected two points, such as \"0,1.7,8 0,0,-2\"");
  return {0, parse_event_point("--throw", points[0]), parse_event_point("--throw", points[1])};
}

scene::SunOptions parse_sun(const std::string& text) {
  const auto angles = parse_numbers(text, 2);
  const scene::OptionInfo infos[] = {sun_setting("azimuth"), sun_setting("elevation")};
  const auto fits = [&](int i) { return (*angles)[i] >= infos[i].low && (*angles)[i] <= infos[i].high; };
  if (!angles || !fits(0) || !fits(1)) {
    const auto range = [&](int i) {
      return scene::shown(infos[i].low) + " to " + scene::shown(infos[i].high);
    };
    throw Error(ErrorCode::usage, "--sun '" + text + "': expected azimuth and elevation in degrees, " +
                                      range(0) + " and " + range(1) + ", such as 60,40");
  }
  scene::SunOptions sun{static_cast<float>((*angles)[0] * scene::kRadiansOfDegree),
                        static_cast<float>((*angles)[1] * scene::kRadiansOfDegree)};
  sun.irradiance *= scene::sunlight_fraction(sun.elevation);
  return sun;
}

/// "0:0,0.3:0.5,1:1"
std::vector<scene::OpacityPoint> parse_opacity(const std::string& text) {
  std::vector<scene::OpacityPoint> curve;
  std::string points = text + ",";
  for (std::size_t end = 0; (end = points.find(',')) != std::string::npos; points.erase(0, end + 1)) {
    std::string point = points.substr(0, end);
    std::ranges::replace(point, ':', ',');
    const auto numbers = parse_numbers(point, 2);
    if (!numbers)
      throw Error(ErrorCode::usage,
                  "--opacity '" + text + "': expected points position:opacity, such as 0:0,0.3:0,1:1");
    curve.push_back({static_cast<float>((*numbers)[0]), static_cast<float>((*numbers)[1])});
  }
  if (const auto fault = scene::fault_of(std::span(std::as_const(curve))))
    throw Error(ErrorCode::usage,
                "--opacity '" + text + "'" +
                    (fault->point ? " point " + std::to_string(*fault->point + 1) : std::string()) + ": " +
                    fault->what);
  return curve;
}

glm::vec2 parse_range(const std::string& text) {
  const auto numbers = parse_numbers(text, 2);
  if (!numbers)
    throw Error(ErrorCode::usage,
                "--range '" + text + "': expected the lowest and the highest value, such as 0,1500");
  const glm::vec2 range((*numbers)[0], (*numbers)[1]);
  if (const auto fault = scene::fault_of_range(range))
    throw Error(ErrorCode::usage, "--range '" + text + "': " + *fault);
  return range;
}

/// The options that are for a volume without a timeline.
void refuse_transfer(const scenario::FirstViewOptions& options, const std::string& reason) {
  for (const auto& [option, is_given] :
       {std::pair("--opacity", !options.opacity.empty()),
        std::pair("--color-map", !options.color_map.empty()), std::pair("--range", options.range.has_value()),
        std::pair("--density", !options.density.empty()), std::pair("--heat", !options.heat.empty()),
        std::pair("--kelvin", options.kelvin.has_value()),
        std::pair("--volume-fps", options.volume_frame_rate.has_value())})
    if (is_given) throw Error(ErrorCode::usage, std::string(option) + ": " + reason);
}

void apply_to_timeline(scene::Timeline& timeline, const scenario::FirstViewOptions& options) {
  if (options.smoke_size)
    throw Error(ErrorCode::usage,
                "--smoke-size is for a scene without a timeline; set [smoke] voxels in the timeline");
  refuse_transfer(options, "is for a volume without a timeline; set it in [[volume]] of the timeline");
  if (options.scale) timeline.scale = *options.scale;
  if (options.sun) timeline.sun = *options.sun;
  if (!options.has_ground) timeline.ground.reset();
  if (options.voxel) timeline.grid.voxel = *options.voxel;
  scene::replace_given(timeline, options.picture);
  if (!options.has_smoke) timeline.smokes.clear();
  timeline.smokes.insert(timeline.smokes.begin(), options.smokes.begin(), options.smokes.end());
}

void declare_transfer(const Arguments& arguments, SceneOptions& options) {
  // How values become colours and opacity.
  std::string names;
  for (const std::string_view name : scene::color_map_names())
    names += (names.empty() ? "" : ", ") + std::string(name);
  arguments.add_option("--color-map", options.color_map, "Colours of a volume's values: " + names)
      .type_name("NAME");
  arguments
      .add_option("--opacity", options.opacity,
                  "Opacity of a volume's values: points of position in the range and factor, each 0 to 1")
      .type_name("X:Y,X:Y");
  arguments
      .add_option("--range", options.range,
                  "Values that --color-map and --opacity span; default: all of the volume")
      .type_name("LOW,HIGH");
  // Which grids are drawn.
  arguments
      .add_option(
          "--density", options.density,
          "Grid of a volume that is dense; of vectors their lengths; default: the first of the usual names")
      .type_name("GRID");
  arguments
      .add_option(
          "--heat", options.heat,
          "Grid of a volume that glows, or none; default: the first of the usual names, where it burns")
      .type_name("GRID");
  // How they glow and play.
  arguments
      .add_option("--kelvin", options.kelvin,
                  "Temperature where that grid is 1; default: 1000, or 1 if its values are kelvin")
      .type_name("K")
      .range(volume_setting("kelvin").low, volume_setting("kelvin").high);
  arguments
      .add_option(
          "--volume-fps", options.volume_fps,
          "Frames per second of a sequence of volume files; default: one for each frame of a film, or 24")
      .type_name("F")
      .range(volume_setting("frame_rate").low, volume_setting("frame_rate").high);
}

// One line for everything that never happens because the timeline ends before.
void warn_of_end(const scene::Timeline& timeline) {
  const double end = double{timeline.duration};
  std::string late;
  const auto count = [&](const char* what, const auto& list) {
    const auto number =
        std::count_if(list.begin(), list.end(), [&](const auto& one) { return one.time > end; });
    if (number > 0)
      late += (late.empty() ? "" : ", ") + std::to_string(number) + " " + what + (number > 1 ? "s" : "");
  };
  count("camera key", timeline.camera);
  scene::for_each_event_list(timeline, [&](const char* type, const auto& events) {
    // Smokes have a line each.
    if (std::string_view(type) != "smoke") count(type, events);
  });
  if (!late.empty())
    log_warning("after the end of the timeline at " + scene::shown(end) + " s and not shown: " + late);
}

}  // namespace

void declare_size_options(const Arguments& arguments, SceneOptions& options) {
  arguments.add_option("--voxel", options.voxel, "Edge length of a voxel [m]; default: fits the smoke")
      .range(grid_setting("voxel").low, grid_setting("voxel").high)
      .type_name("M");
  arguments
      .add_option("--scale", options.scale,
                  "Metres per unit of the scene, such as 0.001 for millimetres; default: 1, "
                  "or what brings it between 1 m (glTF: 0.25 m) and 4 km")
      .range(timeline_setting("scale").low, timeline_setting("scale").high)
      .type_name("X");
}

void declare_scene_options(const Arguments& arguments, SceneOptions& options) {
  arguments
      .add_option("--smoke", options.smokes,
                  "Smoke that goes off at this point [m]; repeatable; none: no smoke")
      .take_all()
      .type_name("X,Y,Z");
  arguments
      .add_option("--throw", options.throws,
                  "\"FROM TO\": grenade thrown from a point towards another [m]; repeatable")
      .take_all()
      .type_name("POINTS");
  declare_level_options(arguments, options);
}

void declare_level_options(const Arguments& arguments, SceneOptions& options) {
  // Smoke and the grid that it fills.
  arguments
      .add_option("--smoke-size", options.smoke_size,
                  "Diameter of the smoke [m]; default: a fifth of the view")
      .range(0.05, 1000.0)
      .type_name("M");
  declare_size_options(arguments, options);
  // Surroundings and light.
  arguments.add_option("--sun", options.sun, "Azimuth from +z towards +x and elevation of the sun [degrees]")
      .type_name("AZ,EL");
  arguments
      .add_option("--ground", options.ground,
                  "Ground to the horizon: auto, below a volume or a scene without a camera, or none; "
                  "default: auto, of "
                  "a timeline its own")
      .one_of({"auto", "none"})
      .type_name("FORM");
  // How pictures are exposed.
  arguments
      .add_option("--tone", options.tone,
                  "Tone curve: neutral compresses highlights, standard clips them as Blender does; default: "
                  "the timeline's, "
                  "or neutral")
      .one_of({"neutral", "standard"})
      .type_name("neutral|standard");
  arguments.add_option("--exposure", options.exposure, "Exposure [EV]; default: the timeline's, or measured")
      .range(timeline_setting("exposure").low, timeline_setting("exposure").high)
      .type_name("EV");
  arguments
      .add_option("--bounces", options.bounces,
                  "Indirect light: how often surfaces and smoke pass light on to each other, 8 is enough; "
                  "default: the timeline's, or 0, never")
      .range(0u, scene::kMostBounces)
      .type_name("N");
  declare_transfer(arguments, options);
}

void declare_volume_memory(const Arguments& arguments, std::uint32_t& mebibytes) {
  arguments
      .add_option("--volume-memory", mebibytes,
                  "Device memory for volumes [MiB]: larger ones are shown at a lower resolution; default: "
                  "3/4 of all")
      .range(1u, 1u << 20)
      .type_name("MIB");
}

std::vector<std::string> to_texts(const SceneOptions& options) {
  std::vector<std::string> texts = options.smokes;
  texts.push_back("throws");
  texts.insert(texts.end(), options.throws.begin(), options.throws.end());
  texts.push_back(options.sun);
  texts.push_back(options.ground);
  for (const std::string& text :
       {options.tone, options.opacity, options.color_map, options.range, options.density, options.heat})
    texts.push_back(text);
  for (const std::optional<double>& number : {options.smoke_size, options.voxel, options.scale,
                                              options.exposure, options.kelvin, options.volume_fps}) {
    char text[32] = "";
    if (number) std::snprintf(text, sizeof text, "%.17g", *number);  // to_string() has but 6 decimals
    texts.emplace_back(text);
  }
  texts.push_back(options.bounces ? std::to_string(*options.bounces) : "");
  return texts;
}

scenario::FirstViewOptions parse_scene_options(const SceneOptions& options) {
  scenario::FirstViewOptions parsed;
  parsed.scale = as_float(options.scale);
  parsed.voxel = as_float(options.voxel);
  parsed.smoke_size = as_float(options.smoke_size);
  parsed.picture.exposure = as_float(options.exposure);
  parsed.picture.bounces = options.bounces;
  // Texts that name a choice.
  if (!options.tone.empty())
    parsed.picture.tone = options.tone == "standard" ? scene::ToneCurve::standard : scene::ToneCurve::neutral;
  parsed.has_ground = options.ground != "none";
  if (!options.sun.empty()) parsed.sun = parse_sun(options.sun);
  if (!options.opacity.empty()) parsed.opacity = parse_opacity(options.opacity);
  if (!options.range.empty()) parsed.range = parse_range(options.range);
  parsed.density = options.density;
  parsed.heat = options.heat;
  parsed.kelvin = as_float(options.kelvin);
  parsed.volume_frame_rate = as_float(options.volume_fps);
  // Checks that concern several options.
  parsed.color_map.name = options.color_map;
  if (const auto fault = scene::fault_of(parsed.color_map))
    throw Error(ErrorCode::usage, "--color-map: " + fault->what);
  if (options.smokes.size() > 1 && std::ranges::count(options.smokes, "none") > 0)
    throw Error(ErrorCode::usage,
                "--smoke none: cannot be combined with another --smoke; remove one of them");
  parsed.has_smoke = options.smokes != std::vector<std::string>{"none"};
  // Smoke that is there at once, and smoke that is thrown.
  for (const std::string& text : options.smokes) {
    if (!parsed.has_smoke) break;
    const glm::vec3 place = parse_event_point("--smoke", text);
    parsed.smokes.push_back({0, place, place});
  }
  for (const std::string& text : options.throws) parsed.smokes.push_back(parse_throw(text));
  return parsed;
}

scenario::Scenario load_with_options(const std::string& input, const std::string& timeline,
                                     const scenario::FirstViewOptions& options) {
  if (!grids::is_grid_file(to_path(input)))
    expect_suffix("", input,
                  {".txt", ".gltf", ".glb", ".obj", ".toml", ".vdb", ".nvdb", ".brv", ".json", ".spheres"});
  if (grids::is_grid_file(to_path(input)) && options.smoke_size)
    throw Error(ErrorCode::usage, "--smoke-size is for a scene; " + input + " is a volume");
  if (!grids::is_grid_file(to_path(input)) && !scenario::is_timeline(to_path(input)))
    refuse_transfer(options, "is for a volume; " + input + " is a scene");
  if (!timeline.empty()) expect_suffix("--timeline", timeline, {".toml"});
  const bool is_timeline = scenario::is_timeline(to_path(input));
  if (is_timeline && !timeline.empty())
    throw Error(ErrorCode::usage, "--timeline: " + input + " is already a timeline; name a scene");
  scenario::Scenario scenario = [&] {
    if (!is_timeline && timeline.empty())
      return scenario::load_scenario(to_path(input), {}, options).value_or_throw();
    scene::Timeline read = scene::load_timeline(to_path(is_timeline ? input : timeline)).value_or_throw();
    if (!is_timeline) read.scene = to_path(input);
    apply_to_timeline(read, options);
    return scenario::make_scenario(std::move(read), {}).value_or_throw();
  }();
  return scenario;
}

Json report_timeline(const scenario::Scenario& scenario, const std::vector<scenario::SmokeReport>& smokes) {
  const auto point = [](glm::vec3 p) { return Json::list({p.x, p.y, p.z}); };
  Json list = Json::list({});
  for (std::size_t i = 0; i < smokes.size(); ++i) {
    const scenario::SmokeReport& smoke = smokes[i];
    if (const std::string warning = scenario::warning_of(smoke, i + 1, scenario); !warning.empty())
      log_warning(warning);
    list.push_back({{"place", point(smoke.at_world)},
                    {"time", smoke.time},
                    {"voxels", smoke.voxels},
                    {"budget", smoke.budget},
                    {"fault", scenario::name_of(smoke.fault)},
                    {"works_at", smoke.works_at ? point(*smoke.works_at) : Json(nullptr)},
                    {"defined_at", smoke.place}});
  }
  warn_of_end(scenario.timeline);
  return list;
}

}  // namespace brume::cli
