// Compares the decals of timelines with ray-traced occlusion, at several times each, and prints the
// differences as JSON (bench/decals/comparison.hpp).
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "bench/decals/comparison.hpp"

namespace {

using namespace brume;

constexpr const char* kUsage =
    "decal_comparison --size WIDTHxHEIGHT --rays N --times N [--pictures FOLDER] TIMELINE.toml...\n"
    "Renders each timeline at 0, 1, 2, ... s, with the same camera and objects in all. PNG files of the "
    "first\n"
    "timeline go to FOLDER.\n";

[[noreturn]] void usage(const std::string& problem) {
  std::fprintf(stderr, "decal_comparison: %s\n%s", problem.c_str(), kUsage);
  std::exit(static_cast<int>(ErrorCode::usage));
}

int number(std::string_view name, std::string_view text, int least, int most) {
  int value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < least || value > most)
    usage(std::string(name) + " '" + std::string(text) + "': expected a whole number in [" +
          std::to_string(least) + ", " + std::to_string(most) + "]");
  return value;
}

struct Options {
  glm::uvec2 size_px{320, 180};
  int rays = 1024, times = 1;
  std::filesystem::path pictures;
  std::vector<std::filesystem::path> timelines;
};

Options read_options(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word.substr(0, 2) != "--") {
      options.timelines.emplace_back(word);
      continue;
    }
    if (++i == count) usage(std::string(word) + ": expected a value");
    const std::string_view value = words[i];
    if (word == "--size") {
      const std::size_t x = value.find('x');
      if (x == value.npos) usage("--size: expected WIDTHxHEIGHT");
      options.size_px = {number(word, value.substr(0, x), 1, 4096),
                         number(word, value.substr(x + 1), 1, 4096)};
    } else if (word == "--rays") {
      options.rays = number(word, value, 1, 1 << 20);
    } else if (word == "--times") {
      options.times = number(word, value, 1, 3600);
    } else if (word == "--pictures") {
      options.pictures = value;
    } else {
      usage("unknown option " + std::string(word));
    }
  }
  if (options.timelines.empty()) usage("expected a timeline");
  return options;
}

nlohmann::json json_of(const decals::Differences& differences) {
  nlohmann::json json;
  for (std::size_t part = 0; part < differences.size(); ++part) {
    const decals::Difference& one = differences[part];
    const double count = static_cast<double>(std::max<std::size_t>(one.pixels, 1));
    json[decals::kPartNames[part]] = {{"pixels", one.pixels},
                                      {"rmse", std::sqrt(one.sum_of_squares / count)},
                                      {"mean", one.sum / count},
                                      {"max", one.largest},
                                      {"reference", one.sum_of_reference / count}};
  }
  return json;
}

nlohmann::json compare_all(const Options& options) {
  gpu::Context context(gpu::ContextOptions{});
  gpu::CommandRunner runner(context);
  std::vector<std::vector<float>> references;  // by time, for all timelines
  nlohmann::json results = nlohmann::json::array();
  for (const std::filesystem::path& path : options.timelines) {
    const scenario::Scenario scenario = scenario::load_scenario(path, {}).value_or_throw();
    decals::ViewRenderer renderer(context, runner, scenario, options.size_px);
    decals::Differences sum;
    nlohmann::json poses = nlohmann::json::array();
    for (int time = 0; time < options.times; ++time) {
      const decals::View view = renderer.draw(time);
      const auto index = static_cast<std::size_t>(time);
      if (index == references.size()) references.push_back(decals::trace(scenario, time, view, options.rays));
      const decals::Differences differences = decals::compare(scenario, time, view, references[index]);
      for (std::size_t part = 0; part < sum.size(); ++part) sum[part].add(differences[part]);
      poses.push_back(json_of(differences));
      if (&path != &options.timelines.front() || options.pictures.empty()) continue;
      const std::string number = std::to_string(time);
      const std::string name = "pose_" + std::string(number.size() < 2 ? "0" : "") + number + ".png";
      decals::save_picture(options.pictures / name, options.size_px, view, references[index])
          .value_or_throw();
    }
    results.push_back({{"timeline", path.filename().string()}, {"poses", poses}, {"sum", json_of(sum)}});
    std::fprintf(stderr, "decal_comparison: %s\n", path.filename().c_str());
  }
  return results;
}

}  // namespace

int main(int count, char** words) {
  const Options options = read_options(count, words);
  try {
    std::printf("%s\n", compare_all(options).dump(1).c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "decal_comparison: %s\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
