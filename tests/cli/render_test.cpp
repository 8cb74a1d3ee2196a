#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <map>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

constexpr const char* kTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 1.0\n"
    "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\nat = [0.0, 0.5, -1.0]\n";

class Render : public RoomTest {
 protected:
  Render() { folder_.write("room.toml", kTimeline); }
  Outcome render(const Arguments& more, const RunOptions& options = {}) const {
    return run({"render", "room.toml"}, more, options);
  }
  Outcome render_well(const Arguments& more) const { return run_well({"render", "room.toml"}, more); }
  Json json_of_render(const Arguments& more) const { return json_of({"render", "room.toml"}, more); }
};

TEST_F(Render, ImagesAreReproducibleAndDependOnTheCamera) {
  for (const char* name : {"a.png", "b.png"}) {
    const Outcome run = render_well({"-o", name, "--size", "64x36", "--time", "0.8", "--json", "-"});
    EXPECT_EQ(run.error, "");
    const Json statistics = Json::parse(run.out);
    EXPECT_EQ(statistics["frames"], 1);
    EXPECT_NE(statistics["device"], "");
  }
  EXPECT_EQ(png("a.png").width, 64u);
  EXPECT_EQ(png("a.png").height, 36u);
  EXPECT_EQ(png("a.png").rgba, png("b.png").rgba);
  render_well({"-o", "c.png", "--size", "64x36", "--time", "0.8", "--smoke", "0.5,1.5,-0.5", "--camera",
               "1.5,1,1.5 -1,1,-1 60"});
  EXPECT_NE(png("c.png").rgba, png("a.png").rgba);
}

TEST_F(Render, QualityOptionsTakeEffectWithinTheirRange) {
  for (const char* step : {"1", "2"})
    render_well({"-o", std::string(step) + ".png", "--size", "64x36", "--time", "0.8", "--step", step});
  render_well({"-o", "usual.png", "--size", "64x36", "--time", "0.8"});
  EXPECT_EQ(png("1.png").rgba, png("usual.png").rgba);
  EXPECT_NE(png("2.png").rgba, png("usual.png").rgba);
  for (const char* step : {"0.2", "4.5", "nan"})
    EXPECT_EQ(render({"-o", "no.png", "--step", step}).exit_code, 2) << step;
  for (const char* option : {"--resolve-error-scale", "--light-update-fraction"})
    for (const char* value : {"0.01", "17", "nan"})
      EXPECT_EQ(render({"-o", "no.png", option, value}).exit_code, 2) << option << value;
}

TEST_F(Render, BouncesStandInForThoseOfTheTimeline) {
  folder_.write("lit.toml", std::string("bounces = 2\n") + kTimeline);
  const auto draw = [&](const std::string& timeline, const std::string& name, const Arguments& more) {
    run_well({"render", timeline, "-o", name, "--size", "64x36", "--time", "0.8"}, more);
    return png(name).rgba;
  };
  const auto none = draw("room.toml", "none.png", {}), two = draw("lit.toml", "two.png", {});
  EXPECT_NE(none, two);
  EXPECT_EQ(draw("room.toml", "given.png", {"--bounces", "2"}), two);
  EXPECT_EQ(draw("lit.toml", "off.png", {"--bounces", "0"}), none);
  for (const char* bad : {"17", "-1", "1.5", "many"})
    expect_failure(folder_, {"render", "room.toml", "-o", "bad.png", "--bounces", bad}, 2, {"--bounces"});
  expect_failure(folder_, {"render", "room.toml", "-o", "bad.png", "--bounces", "2", "--mode", "reference"},
                 2, {"--bounces", "is for --mode realtime"});
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "bad.png"));
}

TEST_F(Render, DebugViewsAndSlices) {
  const Arguments small{"--size", "48x27", "--time", "0.8"};
  const auto draw = [&](const std::string& name, const Arguments& more) {
    render_well(joined(joined(more, {"-o", name}), small));
    return png(name).rgba;
  };
  const auto depth = draw("depth.png", {"--view", "depth"});
  EXPECT_NE(depth, draw("solid.png", {"--view", "solid"}));
  EXPECT_NE(draw("low.png", {"--view", "density", "--slice", "y=0.4"}),
            draw("high.png", {"--view", "density", "--slice", "y=1.1"}));
}

TEST_F(Render, ViewsOfSmokeAreRefusedWithoutSmoke) {
  run_well({"bake", "pyroclastic", "--edge", "16", "-o", "puff.brv"});
  for (const char* view : {"distance", "density", "light", "holes", "bricks"}) {
    const Outcome volume = run({"render", "puff.brv", "-o", "no.png", "--scale", "10", "--view", view});
    EXPECT_EQ(volume.exit_code, 2);
    EXPECT_EQ(volume.error, "brume: --view " + std::string(view) +
                                ": shows smoke, and puff.brv has none; volumes are in --view steps\n");
    EXPECT_EQ(render({"-o", "no.png", "--view", view, "--smoke", "none"}).exit_code, 2);
  }
  for (const char* view : {"steps", "solid", "depth"})
    run_well({"render", "puff.brv", "-o", "a.png", "--size", "32x18", "--view", view});
}

TEST_F(Render, InvalidViewsAndSlices) {
  const auto refused = [&](const Arguments& more, const std::string& part) {
    expect_failure(folder_, joined({"render", "room.toml", "-o", "a.png", "--size", "32x18"}, more), 2,
                   {part});
  };
  refused({"--view", "voxels"}, "solid");
  refused({"--slice", "y=1"}, "--view density");
  refused({"--view", "depth", "--slice", "y=1"}, "--view density");
  for (const char* slice : {"y", "w=1", "y=", "y=1m", "=1", "y=nan"})
    refused({"--view", "density", "--slice", slice}, "--slice '" + std::string(slice) + "'");
}

TEST_F(Render, ImageSequence) {
  render_well({"-o", "p_%03d.png", "--frames", "2-4", "--fps", "10", "--size", "32x18"});
  EXPECT_EQ(folder_.files(), (Arguments{"p_002.png", "p_003.png", "p_004.png", "room.obj", "room.toml"}));
}

TEST_F(Render, TheSameTimeIsTheSameImage) {
  const auto draw = [&](const Arguments& more) { render_well(joined(more, {"--size", "48x27"})); };
  draw({"-o", "still.png", "--time", "0.5"});
  draw({"-o", "a_%d.png", "--fps", "8", "--frames", "3-4"});
  draw({"-o", "b_%d.png", "--fps", "48/2", "--frames", "12-12"});
  for (const char* name : {"a_4.png", "b_12.png"}) EXPECT_EQ(png(name).rgba, png("still.png").rgba) << name;
  EXPECT_NE(png("a_3.png").rgba, png("still.png").rgba);
}

// A range draws what its frames depend on.
TEST_F(Render, TemporalRangesEqualThoseOfTheWholeFilm) {
  const Arguments film{"--fps", "16", "--size", "48x27", "--temporal"};
  for (const Arguments& range :
       {Arguments{"-o", "a_%d.png", "--frames", "0-9"}, {"-o", "b_%d.png", "--frames", "8-9"}})
    render_well(joined(range, film));
  for (const char* frame : {"8", "9"})
    EXPECT_EQ(png("a_" + std::string(frame) + ".png").rgba, png("b_" + std::string(frame) + ".png").rgba);
}

TEST_F(Render, RatesOfTelevisionAreExact) {
  const auto rate_of = [&](const char* option) {
    render_well({"-o", "film.mp4", "--fps", option, "--frames", "0-1", "--size", "16x16"});
    // The media header's time scale and the duration of one sample.
    const std::string bytes = *read_text_file(folder_.path() / "film.mp4");
    const auto number = [&](std::size_t at) {
      std::uint32_t value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
      return value;
    };
    return static_cast<double>(number(bytes.find("mdhd") + 16)) / number(bytes.find("stts") + 16);
  };
  EXPECT_EQ(rate_of("23.976"), 24000.0 / 1001);
  EXPECT_EQ(rate_of("30000/1001"), 30000.0 / 1001);
  EXPECT_EQ(rate_of("25"), 25.0);
  EXPECT_EQ(folder_.files(), (Arguments{"film.mp4", "room.obj", "room.toml"}));
}

TEST_F(Render, WarnsOfTimesAfterTheEnd) {
  const Outcome still = render_well({"-o", "a.png", "--time", "9", "--size", "16x16"});
  EXPECT_EQ(still.error, "brume: warning: --time 9: is after the end of the timeline at 1 s\n");
  const Outcome frames = render({"-o", "a_%d.png", "--frames", "30-30", "--size", "16x16"});
  EXPECT_EQ(frames.error,
            "brume: warning: --frames 30-30: the last is at 1.25 s, after the end of the timeline at 1 s\n");
}

TEST_F(Render, SceneWithoutATimeline) {
  run_well({"render", "room.obj", "-o", "a.png", "--size", "32x18", "--smoke", "0,1,-1"});
  run_well({"render", "room.obj", "--timeline", "room.toml", "-o", "b.png", "--size", "32x18"});
}

// The film has no name while it is written: a program called ffmpeg says that the real one starts.
// Smoke far beside a small room is in its grid; a throw ends there, too.
TEST_F(Render, SmokeIsWhereItIsRequested) {
  for (const Arguments& smoke : {Arguments{"--smoke", "-30,0.3,-3"},
                                 {"--throw", "-20,2,-3 -30,0.3,-3"},
                                 {"--smoke", "-30,0.3,-3", "--voxel", "0.1"}}) {
    const Outcome run =
        run_well({"render", "room.obj", "-o", "far.png", "--size", "64x36", "--json", "-"}, smoke);
    EXPECT_EQ(run.error, "");
    EXPECT_EQ(Json::parse(run.out)["smokes"][0]["fault"], "none") << run.out;
  }
}

// The default ground, in the lower corners, is at most 60 % of white (153) and no darker than a third.
TEST_F(Render, TheGroundIsAsBrightBehindAnySubject) {
  for (const char* color : {"0.005", "0.2", "0.9"}) {
    folder_.write("car.mtl", std::string("newmtl m\nKd ") + color + ' ' + color + ' ' + color + '\n');
    std::string box = "mtllib car.mtl\nusemtl m\n";
    for (int i = 0; i < 8; ++i)
      box += "v " + std::to_string(4 * (i & 1)) + ' ' + std::to_string(1.4 * (i >> 1 & 1)) + ' ' +
             std::to_string(1.8 * (i >> 2)) + '\n';
    folder_.write("car.obj", box + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    run_well({"render", "car.obj", "-o", "car.png", "--size", "64x36"});
    const image::Image8 picture = png("car.png");
    for (const std::size_t corner : {std::size_t{64 * 35}, std::size_t{64 * 36 - 1}}) {
      EXPECT_LE(picture.rgba[4 * corner + 1], 153) << color;
      EXPECT_GE(picture.rgba[4 * corner + 1], 85) << color;
    }
  }
}

TEST_F(Render, WithoutSmoke) {
  for (const char* input : {"room.obj", "room.toml"}) {
    const Outcome run =
        run_well({"render", input, "-o", "none.png", "--size", "64x36", "--smoke", "none", "--json", "-"});
    EXPECT_EQ(run.error, "");
    EXPECT_EQ(Json::parse(run.out)["smokes"].size(), 0u) << run.out;
  }
  EXPECT_EQ(render({"-o", "no.png", "--smoke", "none", "--smoke", "0,1,0"}).exit_code, 2);
}

TEST_F(Render, LeavesNothingWhenAFilmIsInterrupted) {
  const char* path = std::getenv("PATH");
  std::filesystem::create_directory(folder_.path() / "bin");
  const auto ffmpeg =
      folder_.path() / folder_.write("bin/ffmpeg", "#!/bin/sh\n: > started\nPATH=" + std::string(path) +
                                                       " exec ffmpeg \"$@\"\n");
  std::filesystem::permissions(ffmpeg, std::filesystem::perms::owner_all);
  const auto before = folder_.files();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
    RunOptions interrupt;
    interrupt.environment = {{"PATH", (folder_.path() / "bin").string() + ":" + path}};
    interrupt.signal = signal;
    interrupt.signal_when = [&] { return std::filesystem::exists(folder_.path() / "started"); };
    const Outcome run = render({"-o", "long.mp4", "--frames", "0-100000", "--size", "640x360"}, interrupt);
    EXPECT_EQ(run.exit_code, 128 + signal) << run.error;
    if (signal != SIGKILL) {
      EXPECT_NE(run.error.find("brume: interrupted after "), std::string::npos) << run.error;
      EXPECT_NE(run.error.find("long.mp4 is not written"), std::string::npos) << run.error;
    }
    ASSERT_TRUE(std::filesystem::remove(folder_.path() / "started"));
    EXPECT_EQ(folder_.files(), before);
  }
}

// The files of the folder with their contents.
std::map<std::string, std::string> contents(const WorkFolder& folder) {
  std::map<std::string, std::string> all;
  for (const std::string& name : folder.files()) all[name] = *read_text_file(folder.path() / name);
  return all;
}

TEST_F(Render, AnInterruptedSequenceSaysHowToContinue) {
  const Arguments whole{"-o", "f_%02d.png", "--frames", "2-9", "--size", "32x18"};
  RunOptions process;  // Its frames name the program.
  process.own_process = true;
  ASSERT_EQ(render(whole, process).exit_code, 0);
  const auto expected = contents(folder_);
  for (const char* name : {"f_04.png", "f_05.png", "f_06.png", "f_07.png", "f_08.png", "f_09.png"})
    std::filesystem::remove(folder_.path() / name);
  Arguments again = joined(whole, {"--resume"});
  RunOptions interrupt;
  interrupt.signal = SIGTERM;
  interrupt.signal_when = [&] { return std::filesystem::exists(folder_.path() / "f_06.png"); };
  interrupt.signal_before_call = true;
  const Outcome run = render(again, interrupt);
  ASSERT_EQ(run.exit_code, 6) << run.error;
  const std::size_t there = folder_.files().size() - 2;
  EXPECT_EQ(run.error, "brume: frames 4-9: missing\nbrume: interrupted; " + std::to_string(there) +
                           " of 8 frames written; continue with --resume or --frames " +
                           std::to_string(2 + there) + "-9\n");

  const Outcome rest = render(joined(again, {"--json", "-"}), process);
  ASSERT_EQ(rest.exit_code, 0) << rest.error;
  EXPECT_EQ(Json::parse(rest.out)["frames"], 8 - there);
  EXPECT_EQ(contents(folder_), expected);
}

TEST_F(Render, ResumeRendersDamagedAndOtherFramesAgain) {
  const Arguments whole{"-o", "f_%d.png", "--frames", "0-5", "--size", "16x16", "--resume", "--json", "-"};
  std::string reasons;
  const auto drawn = [&](const Arguments& arguments) {
    const Outcome run = render_well(arguments);
    reasons = run.error;
    return Json::parse(run.out)["frames"].get<int>();
  };
  EXPECT_EQ(drawn(whole), 6);
  EXPECT_EQ(drawn(whole), 0);
  const auto expected = contents(folder_);

  const std::string& frame = expected.at("f_1.png");
  folder_.write("f_1.png", frame.substr(0, frame.size() - 4));
  folder_.write("f_2.png", expected.at("f_3.png"));
  std::string damaged = expected.at("f_3.png");
  damaged[damaged.size() / 2] ^= 1;
  folder_.write("f_3.png", damaged);
  // Damage beside the pixels: the checksum before the end's 12 bytes, and bytes after the end.
  damaged = expected.at("f_4.png");
  damaged[damaged.size() - 16] ^= 1;
  folder_.write("f_4.png", damaged);
  folder_.write("f_5.png", expected.at("f_5.png") + std::string(50, '\0'));
  EXPECT_EQ(drawn(whole), 5);
  EXPECT_EQ(reasons,
            "brume: frame 1: truncated; made again\nbrume: frame 2: of another number; made again\nbrume: "
            "frames 3-5: damaged; made again\n");
  EXPECT_EQ(contents(folder_), expected);

  // Other settings or another scene make other frames.
  const Arguments other = joined(whole, {"--step", "2"});
  EXPECT_EQ(drawn(other), 6);
  EXPECT_EQ(reasons, "brume: frames 0-5: of other settings; made again\n");
  folder_.write("room.obj", room_obj() + "# changed\n");
  EXPECT_EQ(drawn(other), 6);
  EXPECT_EQ(reasons, "brume: frames 0-5: of other inputs; made again\n");
  EXPECT_EQ(render({"-o", "a.png", "--resume"}).exit_code, 2);
}

TEST_F(Render, NumbersInLayers) {
  EXPECT_EQ(json_of_render({"-o", "a.exr", "--size", "33x17", "--time", "0.8"})["frames"], 1);
  const Json parts = json_of({"info", "a.exr"})["parts"];
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0]["width"], 33);
  EXPECT_EQ(parts[0]["height"], 17);
  std::map<std::string, std::string> layers;
  for (const auto& layer : parts[0]["layers"]) layers[layer["name"]] = layer["type"];
  for (const char* half : {"R", "G", "B", "A", "transmittance.V", "albedo.R", "media.B", "background.G"})
    EXPECT_EQ(layers[half], "half") << half;
  for (const char* number : {"Z", "depth_in.V"}) EXPECT_EQ(layers[number], "float") << number;
  EXPECT_NE(run({"info", "a.exr"}).out.find("\nZ               float\n"), std::string::npos);

  EXPECT_EQ(render({"-o", "b.exr", "--view", "depth"}).exit_code, 2);
  EXPECT_EQ(render({"-o", "b.exr", "--frames", "0-1"}).exit_code, 2);
  folder_.write("cut.exr", read_text_file(folder_.path() / "a.exr")->substr(0, 100));
  EXPECT_EQ(run({"info", "cut.exr"}).exit_code, 3);
}

TEST_F(Render, NumberedLayersResume) {
  const Arguments whole{"-o",      "f_%d.exr", "--frames", "0-2",    "--size", "32x18",
                        "--march", "quarter",  "--resume", "--json", "-"};
  std::string reasons;
  const auto drawn = [&] {
    const Outcome run = render_well(whole);
    reasons = run.error;
    return Json::parse(run.out)["frames"].get<int>();
  };
  EXPECT_EQ(drawn(), 3);
  const auto expected = contents(folder_);
  EXPECT_EQ(drawn(), 0);
  const std::string& frame = expected.at("f_1.exr");
  folder_.write("f_0.exr", expected.at("f_0.exr") + "more");
  folder_.write("f_1.exr", frame.substr(0, frame.size() - 4));
  std::string damaged = expected.at("f_2.exr");
  damaged[damaged.size() * 3 / 4] ^= 1;
  folder_.write("f_2.exr", damaged);
  EXPECT_EQ(drawn(), 3);
  EXPECT_EQ(reasons,
            "brume: frame 0: damaged; made again\nbrume: frame 1: truncated; made again\nbrume: frame 2: "
            "damaged; made again\n");
  EXPECT_EQ(contents(folder_), expected);
}

// Such frames depend on those before: resuming draws them again.
TEST_F(Render, ResumesTemporalFramesExactly) {
  const Arguments whole{"-o", "f_%d.png", "--frames", "0-5", "--fps", "8", "--size", "32x18", "--temporal"};
  render_well(whole);
  const auto expected = contents(folder_);
  for (const char* name : {"f_2.png", "f_4.png"}) std::filesystem::remove(folder_.path() / name);
  render_well(joined(whole, {"--resume"}));
  EXPECT_EQ(contents(folder_), expected);
}

// The frames of all shards are those of one command, whether or not they depend on those before, and their
// film is the one that a single command encodes.
TEST_F(Render, ShardsMakeTheFramesAndTheFilmOfTheWhole) {
  const Arguments temporal{"--frames", "1-4", "--fps", "8", "--size", "32x18", "--temporal"};
  const Arguments orbit{"--frames", "0-2", "--fps", "8", "--size", "32x18", "--orbit", "90"};
  for (const Arguments& settings : {temporal, orbit}) {
    const auto run = [&](const Arguments& arguments) {
      return render_well(joined(arguments, settings)).error;
    };
    run({"-o", "f_%d.png"});
    const auto expected = contents(folder_);
    for (const auto& [name, bytes] : expected)
      if (name.starts_with("f_")) std::filesystem::remove(folder_.path() / name);
    for (const char* shard : {"2/2", "1/2"}) run({"-o", "f_%d.png", "--shard", shard});
    EXPECT_EQ(contents(folder_), expected);
    EXPECT_EQ(run({"-o", "f_%d.png", "--resume"}), "") << "all are complete";

    run({"-o", "whole.mp4"});
    run_well({"convert", "f_%d.png", "shards.mp4", "--frames", settings[1], "--fps", "8"});
    EXPECT_TRUE(*read_text_file(folder_.path() / "whole.mp4") ==
                *read_text_file(folder_.path() / "shards.mp4"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().extension() != ".obj" && entry.path().extension() != ".toml")
        std::filesystem::remove(entry.path());
  }
}

TEST_F(Render, AFilmIsMadeOfTheFramesOfOneCommand) {
  const Arguments whole{"-o", "f_%d.png", "--frames", "0-2", "--size", "32x18"};
  render_well(whole);
  const std::string frame = bytes("f_1.png");
  Arguments other{"-o", "f_%d.png", "--frames", "1-1", "--size", "32x18", "--step", "2"};
  render_well(other);
  const Arguments film{"convert", "f_%d.png", "film.mp4", "--frames", "0-2"};
  expect_failure(folder_, film, 3, {"f_1.png", "of other settings than f_0.png", "--resume"});
  other[5] = "16x18";
  render_well(other);
  expect_failure(folder_, film, 3, {"f_1.png", "of another size than f_0.png"});
  std::filesystem::remove(folder_.path() / "f_1.png");
  expect_failure(folder_, film, 3, {"f_1.png"});
  folder_.write("f_1.png", frame);
  run_well(film);
  expect_failure(folder_, {"convert", "f_0.png", "film.mp4", "--frames", "0-2"}, 2, {"f_%04d.png"});
  expect_failure(folder_, {"convert", "f_%d.png", "film.mp4"}, 2, {"--frames"});
  expect_failure(folder_, {"convert", "f_%d.png", "film.mp4", "--frames", "0-2", "--shard", "1/2"}, 2,
                 {"--shard"});
}

TEST_F(Render, ShardsAreOfNumberedFrames) {
  for (const char* shard : {"0/2", "3/2", "1", "1/", "/2", "1.5/2", "1/0", "a/b", "1/2000000"})
    expect_failure(folder_, {"render", "room.toml", "-o", "f_%d.png", "--shard", shard}, 2,
                   {"--shard", shard, "3/16"});
  expect_failure(folder_, {"render", "room.toml", "-o", "a.mp4", "--shard", "1/2"}, 2, {"numbered frames"});
}

TEST_F(Render, FilmOnAFullDisk) {
  RunOptions small;
  small.file_bytes = 400;
  const Outcome run = render({"-o", "film.mp4", "--frames", "0-3", "--size", "32x18"}, small);
  EXPECT_EQ(run.exit_code, 4) << run.error;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(folder_.files(), (Arguments{"room.obj", "room.toml"}));
}

}  // namespace
}  // namespace brume::cli
