#include "scene/files/scene_files.hpp"

#include <algorithm>
#include <sstream>
#include <system_error>

#include "core/file.hpp"
#include "core/utf8.hpp"

namespace brume::scene {
namespace {

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string forward_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

/// The entry of the folder whose name equals `wanted` except for letter case.
std::optional<std::string> matching_entry(const std::filesystem::path& folder, const std::string& wanted) {
  std::error_code error;
  if (std::filesystem::exists(folder / to_path(wanted), error)) return wanted;
  std::optional<std::string> best;
  std::filesystem::directory_iterator entries(folder, error);
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
    std::string entry = entries->path().filename().string();
    if (lower(entry) == lower(wanted) && (!best || entry < *best)) best = std::move(entry);
  }
  return best;
}

}  // namespace

bool is_safe_relative(const std::string& name) {
  const std::string path = forward_slashes(name);
  if (path.empty() || path.front() == '/' || path.size() > 4096) return false;
  if (path.size() > 1 && path[1] == ':') return false;
  if (std::any_of(path.begin(), path.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    return false;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    if (part == "..") return false;
  }
  return true;
}

std::string why_not_found(const std::string& name) {
  const bool has_drive = name.size() > 1 && name[1] == ':';
  if (has_drive || name.starts_with('/') || name.starts_with('\\'))
    return "is an absolute path, and no file of its name is beside the scene or what names it";
  const bool may_be = is_safe_relative(to_path(name).lexically_normal().generic_string());
  return may_be ? "does not exist" : "lies outside of the scene's folder, from which alone files are read";
}

FolderFiles::FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) folder_ = ".";
}

std::optional<std::string> FolderFiles::find(const std::string& name) const {
  if (!is_safe_relative(name)) return std::nullopt;
  std::filesystem::path found;
  std::istringstream parts(forward_slashes(name));
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty() || part == ".") continue;
    const auto entry = matching_entry(folder_ / found, part);
    if (!entry) return std::nullopt;
    found /= to_path(*entry);
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(folder_ / found, error)) return std::nullopt;
  return found.generic_string();
}

Result<std::vector<std::byte>> FolderFiles::read(const std::string& found) const {
  const std::filesystem::path path = folder_ / to_path(found);
  if (std::find(read_.begin(), read_.end(), path) == read_.end()) read_.push_back(path);
  return read_file(path);
}

void MemoryFiles::add_text(const std::string& name, const std::string& text) {
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  files[name].assign(bytes, bytes + text.size());
}

std::optional<std::string> MemoryFiles::find(const std::string& name) const {
  if (!is_safe_relative(name)) return std::nullopt;
  if (files.contains(name)) return name;
  for (const auto& [stored, bytes] : files) {
    if (lower(stored) == lower(forward_slashes(name))) return stored;
  }
  return std::nullopt;
}

Result<std::vector<std::byte>> MemoryFiles::read(const std::string& found) const {
  const auto file = files.find(found);
  if (file == files.end()) return Failure{ErrorCode::bad_input, found + ": no such file"};
  return file->second;
}

}  // namespace brume::scene
