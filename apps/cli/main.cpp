#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "apps/cli/command.hpp"
#include "apps/cli/console.hpp"
#include "core/error.hpp"
#include "core/tasks.hpp"

namespace brume::cli {
namespace {

constexpr const char* kAbout =
    "Real-time volumetric smoke that floods real scenes.\n\n"
    "Examples:\n"
    "  brume demo                                        # an image and a film: out/demo.png, out/demo.mp4\n"
    "  brume view                                        # walk around, throw smoke, shoot through it\n"
    "  brume render room.glb -o room.png --smoke 0,1,0   # render a scene with smoke in it\n"
    "  brume sim scenes/demo.toml --hash                 # simulate: the same hashes on every machine\n"
    "  brume voxelize room.glb -o room.vxl --json -      # find the solid voxels of a scene\n"
    "  brume info room.glb                               # summarize a file\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --time 3   # line of sight\n"
    "  brume diff reference.png test.png                 # compare two images\n"
    "  brume devices                                     # list the Vulkan devices";

int fail(const Failure& failure) {
  print_failure(failure.message);
  return static_cast<int>(failure.code);
}

// Runs a command and returns the exit code. Every failure is one line on standard error.
int run(const Command& command) {
  Outputs& outputs = command.common->outputs;
  try {
    start_console(command.common->quiet);
    set_thread_count(command.common->threads);
    outputs.set_force(command.common->force);
    command.run();
    if (const std::string written = outputs.written(); !written.empty())
      print_on_terminal("wrote " + written);
    finish_output();
    return 0;
  } catch (const Error& error) {
    return fail(outputs.explain(error.failure()));
  } catch (const Interrupted& interrupted) {
    if (const auto partial = outputs.explain_interruption()) return fail(*partial);
    print_failure("interrupted" + interrupted.state);
    return 128 + interrupted.signal;
  } catch (const std::bad_alloc&) {
    return fail(
        outputs.explain({ErrorCode::resource_limit, "out of memory; use a smaller scene, grid or image"}));
  } catch (const std::exception& error) {
    return fail(outputs.explain({ErrorCode::internal, error.what()}));
  }
}

int parse_and_run(int argc, char** argv) {
  CommandLine program(kAbout, "brume", BRUME_VERSION);
  const std::array commands{add_demo(program),     add_render(program),  add_sim(program),
                            add_voxelize(program), add_info(program),    add_query(program),
                            add_diff(program),     add_devices(program), add_bench(program),
#ifdef BRUME_VIEWER
                            add_view(program)
#endif
  };
  try {
    if (!program.parse(argc, argv)) {
      finish_output();
      return 0;
    }
  } catch (const Error& error) {
    return fail(error.failure());
  }
  for (const Command& command : commands) {
    if (command.arguments.parsed()) return run(command);
  }
  return fail({ErrorCode::internal, "no command ran"});
}

}  // namespace

Command declare(CommandLine& program, const std::string& name, const std::string& what,
                const std::string& examples) {
  Command command;
  command.common = std::make_shared<CommonOptions>();
  command.arguments = program.add_command(name, what + "\n\nExamples:\n" + examples);
  command.arguments
      .add_option("--threads", command.common->threads, "Number of threads; default 0: one per core")
      .range(0u, 1024u)
      .type_name("N");
  command.arguments.add_flag("--force", command.common->force,
                             "Let outputs replace files of another kind; never an input");
  command.arguments.add_flag("-q,--quiet", command.common->quiet, "Suppress progress and warnings");
  return command;
}

}  // namespace brume::cli

int main(int argc, char** argv) {
  try {
    brume::cli::reserve_standard_descriptors();
    return brume::cli::parse_and_run(argc, argv);
  } catch (const std::exception& error) {  // before a command ran
    std::fprintf(stderr, "brume: %s\n", error.what());
    return static_cast<int>(brume::ErrorCode::internal);
  }
}
