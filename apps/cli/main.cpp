#include <string>
#include <vector>

#include "apps/cli/run.hpp"
#include "core/platform/console.hpp"

int main(int argc, char** argv) {
  brume::platform::prepare_standard_descriptors();
  const std::vector<std::string> words = brume::platform::command_line(argc, argv);
  std::vector<const char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(word.c_str());
  pointers.push_back(nullptr);
  return brume::cli::run(static_cast<int>(words.size()), pointers.data());
}
