#include "apps/cli/console.hpp"
#include "apps/cli/run.hpp"

int main(int argc, char** argv) {
  brume::cli::reserve_standard_descriptors();
  return brume::cli::run(argc, argv);
}
