// Runs a command line.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace brume::api {

struct ShellRun {
  int status = -1;
  std::string output;  ///< Of standard output.
};

inline ShellRun run_shell(const std::string& command) {
  ShellRun run;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return run;
  char buffer[4096];
  for (std::size_t read; (read = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    run.output.append(buffer, read);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
  return run;
}

}  // namespace brume::api
