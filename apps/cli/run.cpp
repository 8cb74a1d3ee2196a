#include "apps/cli/run.hpp"

#include <array>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "apps/cli/command.hpp"
#include "apps/cli/data_files.hpp"
#include "apps/cli/manual.hpp"
#include "apps/command_line/console.hpp"
#include "core/error.hpp"
#include "core/tasks.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

constexpr const char* kAbout =
    "Real-time volumetric smoke that floods real scenes.\n\n"
    "Examples:\n"
    "  brume demo                                        # an image and a film: out/demo.png, out/demo.mp4\n"
    "  brume view                                        # walk around, throw smoke, shoot through it\n"
    "  brume render room.glb -o room.png                 # render a scene with smoke in it\n"
    "  brume sim scenes/demo.toml --hash                 # simulate: the same hashes on every machine\n"
    "  brume voxelize room.glb -o room.vxl --json -      # find the solid voxels of a scene\n"
    "  brume bake pyroclastic -o cloud.brv               # write a cloud as a volume\n"
    "  brume info room.glb                               # summarize a file\n"
    "  brume convert smoke.vdb smoke.nvdb                # convert volumes\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --time 3   # line of sight\n"
    "  brume diff reference.png test.png                 # compare two images\n"
    "  brume devices                                     # list the Vulkan devices";

// The end of a command that failed: one line on standard error, and the same as JSON.
int fail(const Outputs::End& end, bool may_write_json_file) {
  print_failure(end.message);
  write_json_error(end.code, end.message, may_write_json_file);
  return end.code;
}

// Before a command ran. Its --json file is not touched: the command line is not understood.
int fail(const Failure& failure) {
  return fail({static_cast<int>(failure.code), failure.message}, false);
}

void attempt(const Command& command) {
  if (command.common->quiet) command.arguments.refuse("--progress", "there is none with --quiet");
  command.run();
  Outputs& outputs = command.common->outputs;
  if (const std::string written = outputs.written(); !written.empty()) print_on_terminal("wrote " + written);
  finish_output();
}

// How a command ended; nothing: well.
std::optional<Outputs::End> end_of(const Command& command) {
  const Outputs& outputs = command.common->outputs;
  const auto explained = [&](const Failure& failure) {
    const Failure end = outputs.explain(failure);
    return Outputs::End{static_cast<int>(end.code), end.message};
  };
  try {
    attempt(command);
    return std::nullopt;
  } catch (const Error& error) {
    return explained(error.failure());
  } catch (const Interrupted& interrupted) {
    return outputs.explain_interruption(interrupted.signal);
  } catch (const std::bad_alloc&) {
    return explained({ErrorCode::resource_limit, "out of memory; use a smaller scene, grid or image"});
  } catch (const std::exception& error) {
    return explained({ErrorCode::internal, error.what()});
  }
}

int run_command(const Command& command, const std::string& json) {
  CommonOptions& common = *command.common;
  start_console(common.quiet, common.progress == "json" ? ProgressForm::json : ProgressForm::line);
  set_thread_count(common.threads);
  common.outputs.set_force(common.force);
  const auto report = [&](const Outputs::End& end) {
    return fail(end, common.outputs.may_hold_error(to_path(json)));
  };
  const Attendant attendant(common.grace_seconds,
                            [&](int signal) { return report(common.outputs.explain_interruption(signal)); });
  const std::optional<Outputs::End> end = end_of(command);
  claim_end();
  return end ? report(*end) : 0;
}

int parse_and_run(int argc, const char* const* argv) {
  CommandLine program(kAbout, "brume", build_facts());
  const std::array commands{add_demo(program),
                            add_render(program),
                            add_sim(program),
                            add_voxelize(program),
                            add_bake(program),
                            add_bake_slices(program),
                            add_bake_occlusion(program),
                            add_bake_spheres(program),
                            add_info(program),
                            add_convert(program),
                            add_query(program),
                            add_diff(program),
                            add_palettes(program),
                            add_devices(program),
                            add_bench(program),
#ifdef BRUME_VIEWER
                            add_view(program)
#endif
  };
  const std::string json = value_of(argc, argv, "--json");
  set_json(argc > 1 ? argv[1] : "", json);
  try {
    if (argc == 3 && std::string(argv[1]) == "--write-manual") {  // called by the build
      write_manual(program.declarations(), argv[2]);
      return 0;
    }
    if (!program.parse(argc, argv)) {
      finish_output();
      return 0;
    }
  } catch (const Error& error) {
    return fail(error.failure());
  }
  for (const Command& command : commands) {
    if (command.arguments.parsed()) return run_command(command, json);
  }
  return fail({ErrorCode::internal, "no command ran"});
}

}  // namespace

int run(int argc, const char* const* argv) {
  const Console console;
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception& error) {  // before a command ran
    return fail({ErrorCode::internal, error.what()});
  }
}

}  // namespace brume::cli
