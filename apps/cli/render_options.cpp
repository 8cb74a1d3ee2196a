#include "apps/cli/render_options.hpp"

#include <span>

#include "apps/cli/command.hpp"
#include "apps/cli/tank_options.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"

namespace brume::cli {
namespace {

// The files that are known before any is read.
void declare_files(const RenderOptions& options, const Plan& plan, Outputs& outputs) {
  declare_input(outputs, to_path(options.input));
  outputs.reads(to_path(options.timeline));
  outputs.writes("--json", to_path(options.json), FileKind::json);
  outputs.writes("--checkpoint", to_path(options.reference.checkpoint), FileKind::checkpoint);
  const FileKind kind = target_file_kind(to_path(options.output));
  if (plan.flipbook) return declare_flipbook_files(*plan.flipbook, outputs);
  if (plan.kind != TargetKind::sequence) outputs.writes("-o", plain_name(to_path(options.output)), kind);
  // Without --frames the timeline decides how many there are.
  if (plan.kind == TargetKind::sequence && plan.frames) declare_frames(options, plan, *plan.frames, outputs);
  if (plan.kind == TargetKind::sequence && !plan.frames)
    check_writable(sequence_name(to_path(options.output), 0));
}

// Refuses options of the other mode.
void refuse_other_mode(const Arguments& arguments, const RenderOptions& options, const Plan& plan) {
  if (is_reference(options)) {
    for (const char* option :
         {"--march", "--raycast", "--temporal", "--step", "--resolve-error-scale", "--light-update-fraction",
          "--volume-memory", "--view", "--slice", "--device", "--bounces"})
      arguments.refuse(option, "is for --mode realtime");
    if (plan.kind != TargetKind::picture)
      arguments.refuse("--checkpoint", "is for a single picture; numbered frames have --resume");
    return;
  }
  if (options.temporal || options.light_update_fraction < 1)
    arguments.refuse("--samples", "cannot be combined with --temporal or --light-update-fraction");
  if (options.view != "none") arguments.refuse("--samples", "is for pictures; a debug view has one");
  for (const char* option :
       {"--noise", "--time-limit", "--max-bounces", "--clamp", "--matte", "--checkpoint"})
    arguments.refuse(option, "requires --mode reference");
}

image::Background parse_background(const RenderOptions& options, const Plan& plan) {
  if (options.background.empty()) return plan.has_layers ? image::Background::layer : image::Background::in;
  if (options.background == "layer" && !plan.has_layers)
    throw Error(ErrorCode::usage, "--background layer: requires an .exr file, which has layers");
  if (options.background == "none" && plan.kind == TargetKind::film)
    throw Error(ErrorCode::usage,
                "--background none: a film has no transparency; write numbered .png or .exr files");
  return options.background == "none"    ? image::Background::none
         : options.background == "layer" ? image::Background::layer
                                         : image::Background::in;
}

// Refuses options that would do nothing.
void refuse_idle(const Arguments& arguments, const RenderOptions& options, const Plan& plan) {
  refuse_other_mode(arguments, options, plan);
  // Options that the kind of output cannot follow.
  if (plan.flipbook) {
    for (const char* option : {"--time", "--temporal", "--light-update-fraction", "--view", "--checkpoint"})
      arguments.refuse(option, "is not for --flipbook");
    if (is_lit_by_sides(*plan.flipbook))
      arguments.refuse("--orbit",
                       "turns the camera under the light of six-way and normals; leave those maps out");
  } else if (plan.kind == TargetKind::picture) {
    const std::string needs = "requires a film (.mp4) or numbered frames, such as -o f_%04d.png";
    for (const char* option : {"--frames", "--fps", "--orbit"})
      arguments.refuse(option, needs + ", or --flipbook");
    for (const char* option : {"--temporal", "--light-update-fraction"}) arguments.refuse(option, needs);
  } else {
    arguments.refuse("--time", "is for a single image; use --frames");
  }
  if (options.orbit == 0.0) arguments.refuse("--orbit", "0 degrees are no turn; give 360 for a full one");
  if (plan.kind != TargetKind::sequence)
    for (const char* option : {"--resume", "--shard"})
      arguments.refuse(option, "requires numbered frames, such as -o f_%04d.png");
  // Options that another option makes idle.
  if (options.march == "full") arguments.refuse("--resolve-error-scale", "requires --march half or quarter");
  if (plan.has_layers) arguments.refuse("--view", "is for .png and .mp4; an .exr file has layers of its own");
  if (plan.layers && !plan.has_layers)
    arguments.refuse("--view", "shows no transparency; remove --background");
  if (plan.slice && !passes::has_slice(plan.view))
    arguments.refuse("--slice", "requires --view density, light or distance");
}

std::string list_views() {
  std::string names;
  for (const std::string_view name : std::span(passes::kDebugViewNames).subspan(1))
    names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

void declare_quality(const Arguments& arguments, RenderOptions& options) {
  // What is in the picture.
  arguments
      .add_option(
          "--background", options.background,
          "The sky: in the picture, in a layer of its own (.exr), or none, with transparency in its place; "
          "default: layer for .exr, else in")
      .one_of({"none", "layer", "in"})
      .type_name("FORM");
  // How smoke and volumes are drawn.
  arguments
      .add_option("--march", options.march,
                  "Smoke resolution: one ray per pixel, per 2x2 or per 4x4; default full")
      .one_of({"full", "half", "quarter"})
      .type_name("full|half|quarter");
  arguments
      .add_option("--raycast", options.raycast,
                  "Draw volumes one by one without cached light, in one of two forms; see docs/how/smoke.md")
      .one_of({"two-pass", "single-pass"})
      .type_name("FORM");
  arguments.add_flag(
      "--temporal", options.temporal,
      "Smooth the smoke and the edges of a film over its frames; a range draws the 32 before it, too");
  // How accurate they are.
  arguments
      .add_option("--step", options.step,
                  "Scale of the ray march step, 0.25 to 4: larger is faster and coarser; default 1")
      .range(0.25, 4.0)
      .type_name("X");
  arguments
      .add_option(
          "--resolve-error-scale", options.resolve_error_scale,
          "Scale of the error that --march half and quarter may interpolate over, 0.25 to 16; default 1")
      .range(0.25, 16.0)
      .type_name("X");
  arguments
      .add_option(
          "--light-update-fraction", options.light_update_fraction,
          "Fraction of the changed light in smoke that each frame of a film updates, 0.0625 to 1; default 1")
      .range(0.0625, 1.0)
      .type_name("X");
  declare_volume_memory(arguments, options.volume_memory);
}

void declare_camera(const Arguments& arguments, RenderOptions& options) {
  arguments
      .add_option(
          "--samples", options.samples,
          "Samples of a pixel: paths of --mode reference (default 64 without another limit), frames of "
          "--mode realtime (default 64 with an aperture or a shutter, else 1)")
      .range(1u, reference::kMostSamples)
      .type_name("N");
  arguments
      .add_option(
          "--shutter", options.shutter,
          "How long the shutter stays open, from the picture's time on [s]; default: as the timeline says")
      .range(0.0, 10.0)
      .type_name("S");
}

void declare_view(const Arguments& arguments, RenderOptions& options) {
  arguments
      .add_option("--camera", options.camera,
                  "\"px,py,pz tx,ty,tz fov\": position, target [m], vertical fov [degrees; default 60]")
      .type_name("CAMERA");
  arguments
      .add_option("--orbit", options.orbit,
                  "Angle by which the camera circles what it shows over the frames [degrees]: 360 is a full "
                  "turn, counter-clockwise from above")
      .range(-36000.0, 36000.0)
      .type_name("DEGREES");
  arguments.add_option("--view", options.view, "Debug view: " + list_views())
      .one_of({passes::kDebugViewNames.begin(), passes::kDebugViewNames.end()})
      .type_name("NAME");
  arguments
      .add_option("--slice", options.slice,
                  "Slice of --view density, light and distance; default: through the middle of the smoke")
      .type_name("AXIS=M");
}

}  // namespace

void declare_frames(const RenderOptions& options, const Plan& plan, FrameRange range, Outputs& outputs) {
  if (const auto part = part_of(range, plan.shard))
    outputs.writes_frames("-o", to_path(options.output), target_file_kind(to_path(options.output)),
                          part->first, part->last);
}

Plan make_plan(const Arguments& arguments, const RenderOptions& options, Outputs& outputs) {
  Plan plan;
  plan.kind = target_kind(to_path(options.output));
  plan.renderer.size_px = parse_size("--size", options.size);
  if (!options.raycast.empty()) {
    if (options.march != "full")
      throw Error(ErrorCode::usage, "--raycast: has a ray per pixel; remove --march");
    plan.renderer.smoke.raycast =
        options.raycast == "two-pass" ? passes::RaycastForm::two_pass : passes::RaycastForm::single_pass;
  }
  plan.renderer.smoke.march_scale = options.march == "full" ? 1 : options.march == "half" ? 2 : 4;
  plan.renderer.smoke.temporal = plan.renderer.antialias = options.temporal;
  plan.has_layers = target_file_kind(to_path(options.output)) == FileKind::exr;
  if (!options.flipbook.grid.empty()) {
    const glm::uvec2 tile_px = arguments.given("--size") ? plan.renderer.size_px : glm::uvec2(256);
    plan.flipbook = parse_flipbook(options.flipbook, tile_px, to_path(options.output));
    plan.renderer.size_px = plan.flipbook->layout.picture_px();
    arguments.refuse("--background", "is none in a flipbook");
  } else {
    for (const char* option :
         {"--flipbook-maps", "--flipbook-alpha", "--flipbook-gutter", "--flipbook-preset"})
      arguments.refuse(option, "requires --flipbook");
  }
  const image::Background background =
      plan.flipbook ? image::Background::none : parse_background(options, plan);
  if (plan.has_layers || background == image::Background::none)
    plan.layers = LayerForm{plan.has_layers || plan.flipbook, background};
  plan.renderer.smoke.record_entries = plan.layers.has_value();
  if (!options.camera.empty()) plan.camera = parse_camera("--camera", options.camera);
  plan.view = *passes::find_debug_view(options.view);
  if (!options.slice.empty()) plan.slice = parse_slice("--slice", options.slice);
  plan.rate = parse_rate("--fps", options.fps);
  plan.scene = parse_scene_options(options.scene);
  // Each frame of a film shows one of a sequence, unless the options differ.
  if (grids::is_grid_file(to_path(options.input)) && options.timeline.empty() &&
      !plan.scene.volume_frame_rate)
    plan.scene.volume_frame_rate = static_cast<float>(plan.rate.per_second());
  plan.scene.camera = plan.camera;
  // A ground by default would be before all of the transparency.
  if (background == image::Background::none && options.timeline.empty() &&
      !scenario::is_timeline(to_path(options.input)))
    plan.scene.has_ground = false;
  plan.scene.aspect =
      static_cast<float>(plan.renderer.size_px.x) / static_cast<float>(plan.renderer.size_px.y);
  if (!options.frames.empty()) plan.frames = parse_frames("--frames", options.frames);
  if (!options.shard.empty()) plan.shard = parse_shard("--shard", options.shard);
  refuse_idle(arguments, options, plan);
  if (plan.kind == TargetKind::film &&
      (plan.renderer.size_px.x % 2 != 0 || plan.renderer.size_px.y % 2 != 0)) {
    throw Error(ErrorCode::usage,
                "--size '" + options.size + "': the width and height of a film must be even");
  }
  declare_files(options, plan, outputs);
  return plan;
}

void declare_render(const Arguments& arguments, RenderOptions& options) {
  // Inputs and outputs.
  arguments.add_option("INPUT", options.input, "Timeline (.toml) or scene (.txt, .gltf, .glb, .obj)")
      .required()
      .type_name("");
  arguments
      .add_option("-o,--output", options.output,
                  "Output file: .png or .exr (numbers in layers), with %04d for a sequence, or .mp4")
      .required()
      .type_name("FILE");
  arguments.add_option("--timeline", options.timeline, "Timeline to play in the scene INPUT")
      .type_name("FILE");
  // Which times are drawn.
  arguments.add_option("--time", options.time, "Time of the image [s]; default: the end of the timeline")
      .range(0.0, 3600.0)
      .type_name("S");
  arguments.add_option("--frames", options.frames, "First and last frame; default: the whole timeline")
      .take_last()
      .type_name("A-B");
  arguments.add_flag("--resume", options.resume,
                     "Continue numbered frames: skip those that are complete and made from the same inputs");
  declare_shard(arguments, options.shard);
  arguments.add_option("--fps", options.fps, "Frames per second, such as 23.976 or 24000/1001; default 24")
      .take_last()
      .type_name("F");
  // How they are drawn.
  arguments.add_option("--size", options.size, "Image size [px]; default 1280x720")
      .take_last()
      .type_name("WxH");
  arguments
      .add_option("--mode", options.mode,
                  "realtime: on a GPU; reference: path-traced on the CPU, without approximations")
      .one_of({"realtime", "reference"})
      .type_name("MODE");
  declare_flipbook(arguments, options.flipbook);
  declare_camera(arguments, options);
  declare_reference(arguments, options.reference);
  declare_quality(arguments, options);
  declare_view(arguments, options);
  declare_scene_options(arguments, options.scene);
  declare_device(arguments, options.device);
  declare_json(arguments, options.json, "statistics");
}

}  // namespace brume::cli
