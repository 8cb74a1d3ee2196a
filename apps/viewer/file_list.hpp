// The files of a folder to choose one from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace brume::viewer {

class FileList {
 public:
  /// Lists files with one of these suffixes, in lower case; files match in any case.
  FileList(const std::filesystem::path& folder, std::vector<std::string> suffixes);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<std::string>& folders() const { return folders_; }  ///< Names, sorted; ".." first.
  const std::vector<std::string>& files() const { return files_; }      ///< Names, sorted.
  /// Whether a file has one of the suffixes.
  bool matches(const std::filesystem::path& file) const;
  /// Shows another folder; one that cannot be read is empty but for "..".
  void open(const std::filesystem::path& folder);
  /// Reads the folder again.
  void refresh() { open(folder_); }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> suffixes_, folders_, files_;
};

}  // namespace brume::viewer
