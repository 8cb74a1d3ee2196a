#include <cmath>

#include "apps/cli/command.hpp"
#include "apps/cli/data_files.hpp"
#include "apps/cli/demo_picture.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/targets.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"
#include "film/playback.hpp"
#include "gpu/context.hpp"
#include "image/png.hpp"

namespace brume::cli {
namespace {

constexpr glm::uvec2 kPictureSize{1280, 720};
// Where the processor draws, the film takes most of the time. Each of these looks as good as full quality in
// a moving image: one ray per 2x2 pixels where the resolve test allows it, and a quarter of the light in the
// smoke updated by each frame.
constexpr glm::uvec2 kFilmSize{640, 360};
constexpr std::uint32_t kFramesPerSecond = 24;
constexpr std::uint32_t kFilmMarchScale = 2;
constexpr float kFilmLightUpdateFraction = 0.25f;
constexpr const char* kDefaultFolder = "out";

struct DemoOptions {
  std::string folder = kDefaultFolder, device, scenes;
};

void demo(const DemoOptions& options, CommonOptions& common) {
  const std::filesystem::path folder = to_path(options.folder);
  const auto picture = folder / "demo.png", film = folder / "demo.mp4";
  const std::filesystem::path timeline = scenes_folder(options.scenes) / "demo.toml";
  if (options.folder == kDefaultFolder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      throw Error(ErrorCode::bad_input, options.folder + ": cannot create the folder: " + error.message());
  }
  common.outputs.reads(timeline);
  common.outputs.writes("", picture, FileKind::png);
  common.outputs.writes("", film, FileKind::mp4);

  const scenario::Scenario scenario = scenario::load_scenario(timeline, {}).value_or_throw();
  common.outputs.reads(scenario::files_of(scenario));
  stop_if_interrupted();
  gpu::Context context({options.device, false});
  const double seconds = static_cast<double>(scenario.timeline.duration);
  {
    film::Playback playback(context, scenario, kPictureSize);
    image::save_png(picture, playback.draw(kPictureTime, 0)).value_or_throw();
    stop_if_interrupted();
    print(picture.string() + "\n");
    finish_output();  // It can be looked at while the film is made.
  }
  render::RendererOptions options_of_film{kFilmSize};
  options_of_film.smoke.march_scale = kFilmMarchScale;
  film::Playback playback(context, scenario, options_of_film);
  playback.set_light_update_fraction(kFilmLightUpdateFraction);
  const auto frames = static_cast<std::uint32_t>(std::ceil(seconds * kFramesPerSecond));
  write_film(film, {kFilmSize, {kFramesPerSecond, 1}, common.threads}, 0, frames - 1, common.outputs,
             [&](std::uint32_t i) { return playback.draw(static_cast<double>(i) / kFramesPerSecond, i); });
  print(film.string() + "\n");
}

}  // namespace

Command add_demo(CommandLine& program) {
  Command command = declare(program, "demo", "Renders an image and a film of smoke flooding a building.",
                            "  brume demo\n  brume demo --out pictures --device 0");
  auto options = std::make_shared<DemoOptions>();
  command.arguments
      .add_option("-o,--out", options->folder,
                  "Existing folder to write to; default: out, created if missing")
      .type_name("FOLDER");
  command.arguments
      .add_option("--scenes", options->scenes, "Folder of the demo's scene; default: the one it comes with")
      .type_name("FOLDER");
  declare_device(command.arguments, options->device);
  command.run = [options, common = command.common] { demo(*options, *common); };
  return command;
}

}  // namespace brume::cli
