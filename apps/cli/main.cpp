#include "apps/cli/run.hpp"
#include "apps/command_line/console.hpp"

int main(int argc, char** argv) {
  brume::cli::reserve_standard_descriptors();
  return brume::cli::run(argc, argv);
}
