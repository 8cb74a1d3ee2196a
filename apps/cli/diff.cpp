#include <cmath>
#include <optional>
#include <sstream>

#include "apps/cli/command.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"
#include "image/decode.hpp"
#include "image/metrics.hpp"
#include "image/png.hpp"

namespace brume::cli {
namespace {

struct DiffOptions {
  std::string reference, test, map, json;
  std::optional<double> fail_above, psnr_below;
};

std::string size_of(const image::Image8& picture) {
  return std::to_string(picture.width) + "x" + std::to_string(picture.height);
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(6);
  // A whole number but for the rounding of floats is one.
  constexpr double kRounding = 1e-4;
  text << (std::abs(value - std::round(value)) < kRounding ? std::round(value) : value);
  return text.str();
}

// Colour and alpha differences are in units of 1/255, the step of an 8-bit channel.
struct Comparison {
  image::Difference colours;
  double alpha_max = 0, psnr = 0, ssim = 0, flip = 0;
  image::Plane flip_map;
  double worst() const { return std::max(colours.max, alpha_max); }
};

Comparison compare(const image::Image8& reference, const image::Image8& test) {
  const Progress job("compare");
  Comparison result;
  result.colours = image::difference(image::encoded_colours(reference), image::encoded_colours(test));
  for (double* value : {&result.colours.max, &result.colours.mean, &result.colours.rmse}) *value *= 255;
  result.alpha_max = 255 * image::difference(image::alphas(reference), image::alphas(test)).max;
  result.psnr = image::psnr(result.colours.rmse, 255);
  result.ssim = image::ssim(image::luma(reference), image::luma(test), 1);
  stop_if_interrupted();
  result.flip_map = image::flip(reference, test);
  for (const float value : result.flip_map.values) result.flip += double{value};
  result.flip /= static_cast<double>(result.flip_map.values.size());
  return result;
}

// Why the comparison fails by the thresholds; nothing: it passes.
std::optional<std::string> failure_of(const DiffOptions& options, const Comparison& c) {
  const std::string both = options.reference + " and " + options.test + " ";
  if (options.fail_above && c.worst() > *options.fail_above)
    return both + "differ by " + number(c.worst()) + " of 255, more than --fail-above " +
           number(*options.fail_above);
  if (options.psnr_below && c.psnr < *options.psnr_below)
    return both + "agree to " + number(c.psnr) + " dB, less than --psnr-below " + number(*options.psnr_below);
  return std::nullopt;
}

Json to_json(const DiffOptions& options, const image::Image8& picture, const Comparison& c) {
  // The PSNR of equal images is infinite, which JSON cannot express.
  return {{"reference", options.reference},
          {"test", options.test},
          {"size", Json::list({picture.width, picture.height})},
          {"max", c.colours.max},
          {"mean", c.colours.mean},
          {"rmse", c.colours.rmse},
          {"alpha_max", c.alpha_max},
          {"psnr", std::isfinite(c.psnr) ? Json(c.psnr) : Json(nullptr)},
          {"ssim", c.ssim},
          {"flip", c.flip},
          {"passed", !failure_of(options, c)}};
}

std::string to_text(const Comparison& c) {
  return "max    " + number(c.colours.max) + " of 255\nmean   " + number(c.colours.mean) + "\nrmse   " +
         number(c.colours.rmse) + "\nalpha  " + number(c.alpha_max) + " maximum\npsnr   " + number(c.psnr) +
         " dB\nssim   " + number(c.ssim) + "\nflip   " + number(c.flip) + "\n";
}

void diff(const DiffOptions& options, Outputs& outputs) {
  if (!options.map.empty()) expect_suffix("-o", options.map, {".png"});
  outputs.reads({to_path(options.reference), to_path(options.test)});
  outputs.writes("-o", to_path(options.map), FileKind::png);
  outputs.writes("--json", to_path(options.json), FileKind::json);
  const image::Image8 reference = image::load_image(to_path(options.reference)).value_or_throw();
  const image::Image8 test = image::load_image(to_path(options.test)).value_or_throw();
  if (reference.width != test.width || reference.height != test.height) {
    throw Error(ErrorCode::comparison_failed, options.test + ": expected " + size_of(reference) +
                                                  " texels as in " + options.reference + ", found " +
                                                  size_of(test));
  }
  const Comparison comparison = compare(reference, test);
  stop_if_interrupted();
  if (!options.map.empty())
    image::save_png(to_path(options.map), image::heat_map(comparison.flip_map)).value_or_throw();
  if (!options.json.empty()) write_json(options.json, to_json(options, reference, comparison));
  if (options.json != "-") print(to_text(comparison));
  if (const auto failure = failure_of(options, comparison))
    throw Error(ErrorCode::comparison_failed, *failure);
}

}  // namespace

Command add_diff(CommandLine& program) {
  Command command =
      declare(program, "diff", "Measures the difference of two images and maps where it is visible.",
              "  brume diff reference.png test.png\n"
              "  brume diff reference.png test.png -o map.png --json -\n"
              "  brume diff reference.png test.png --psnr-below 38   # exit code 7 below 38 dB");
  auto options = std::make_shared<DiffOptions>();
  const Arguments& arguments = command.arguments;
  arguments.add_option("REFERENCE", options->reference, "Reference image, .png or .jpg")
      .required()
      .type_name("");
  arguments.add_option("TEST", options->test, "Image to compare with it").required().type_name("");
  // What to do with the difference.
  arguments
      .add_option("-o,--output", options->map, "Write the FLIP error map, from black to pale yellow: .png")
      .type_name("FILE");
  arguments
      .add_option("--fail-above", options->fail_above, "Fail if any channel differs by more than N [0, 255]")
      .range(0.0, 255.0)
      .type_name("N");
  arguments.add_option("--psnr-below", options->psnr_below, "Fail if the PSNR is below DB [dB]")
      .range(0.0, 200.0)
      .type_name("DB");
  declare_json(arguments, options->json, "the metrics");
  command.run = [options, common = command.common] { diff(*options, common->outputs); };
  return command;
}

}  // namespace brume::cli
