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
    "  brume demo                                        # a picture and a film: out/demo.png, out/demo.mp4\n"
    "  brume view                                        # walk in, throw smoke, shoot through it\n"
    "  brume render room.glb -o room.png --smoke 0,1,0   # a picture of a scene with smoke in it\n"
    "  brume sim scenes/demo.toml --hash                 # the same smoke on every machine\n"
    "  brume voxelize room.glb -o room.vxl --json -      # which voxels of a scene are solid\n"
    "  brume info room.glb                               # what is in a file\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --time 3   # who sees whom\n"
    "  brume diff reference.png test.png                 # how far two pictures are apart\n"
    "  brume devices                                     # what can render";

int fail(const Failure& failure) {
  say_failure(failure.message);
  return static_cast<int>(failure.code);
}

// The exit code. Every failure is one line on standard error.
int run(const Command& command) {
  try {
    start_console(command.common->quiet);
    set_thread_count(command.common->threads);
    command.run();
    finish_output();
    return 0;
  } catch (const Error& error) {
    return fail(error.failure());
  } catch (const Interrupted& interrupted) {
    say_failure("interrupted");
    return 128 + interrupted.signal;
  } catch (const std::bad_alloc&) {
    return fail({ErrorCode::resource_limit, "out of memory; use a smaller scene, grid or picture"});
  } catch (const std::exception& error) {
    return fail({ErrorCode::internal, error.what()});
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
    if (!program.parse(argc, argv)) return 0;
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
      .add_option("--threads", command.common->threads, "Threads to use; 0: one a core (default)")
      .range(0u, 1024u)
      .type_name("N");
  command.arguments.add_flag("-q,--quiet", command.common->quiet, "No progress and no warnings");
  return command;
}

}  // namespace brume::cli

int main(int argc, char** argv) {
  try {
    return brume::cli::parse_and_run(argc, argv);
  } catch (const std::exception& error) {  // before a command ran
    std::fprintf(stderr, "brume: %s\n", error.what());
    return static_cast<int>(brume::ErrorCode::internal);
  }
}
