#include "apps/viewer/file_list.hpp"

#include <algorithm>
#include <cctype>

namespace brume::viewer {
namespace {

namespace fs = std::filesystem;

std::string suffix_of(const fs::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

}  // namespace

FileList::FileList(const fs::path& folder, std::vector<std::string> suffixes)
    : folder_(folder), suffixes_(std::move(suffixes)) {}

bool FileList::matches(const fs::path& file) const {
  return std::find(suffixes_.begin(), suffixes_.end(), suffix_of(file)) != suffixes_.end();
}

void FileList::open(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder, error);
  folder_ = error ? folder : whole;
  folders_.clear();
  files_.clear();
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with('.')) continue;
    std::error_code unknown;
    if (entry->is_directory(unknown)) {
      folders_.push_back(name);
    } else if (matches(name)) {
      files_.push_back(name);
    }
  }
  std::sort(folders_.begin(), folders_.end());
  std::sort(files_.begin(), files_.end());
  folders_.insert(folders_.begin(), "..");
}

}  // namespace brume::viewer
