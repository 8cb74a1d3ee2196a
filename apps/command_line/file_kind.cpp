#include "apps/command_line/file_kind.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>

#include "core/file.hpp"

namespace brume::cli {
namespace {

constexpr std::size_t kStartBytes = 4096;
constexpr std::string_view kBlanks = " \t\r\n";

// A file may break off within the magic bytes.
bool begins_with(std::string_view start, std::string_view magic) {
  const std::size_t length = std::min(start.size(), magic.size());
  return start.substr(0, length) == magic.substr(0, length);
}

// The first word of the first line that is neither blank nor a comment; empty if there is none.
std::string first_word(std::string_view start) {
  std::istringstream lines{std::string(start)};
  for (std::string line, word; std::getline(lines, line);)
    if (std::istringstream(line) >> word && word.front() != '#') return word;
  return "";
}

bool is_mp4(std::string_view start) {
  return start.size() >= 8 && start.substr(4, 4) == "ftyp";
}

// A .gltf is JSON too, but a scene.
bool is_json(std::string_view start, const std::filesystem::path& file) {
  const std::size_t first = start.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return true;
  return (start[first] == '{' || start[first] == '[') && file.extension() != ".gltf";
}

bool is_obj(std::string_view start, const std::filesystem::path& file) {
  constexpr std::string_view kWords[] = {"v", "vt", "vn", "f", "l", "p", "o", "g", "s", "mtllib", "usemtl"};
  const std::string word = first_word(start);
  // Comments alone are no proof: many kinds of text begin with '#'.
  if (word.empty()) return file.extension() == ".obj";
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

bool is_timeline(std::string_view start, const std::filesystem::path& file) {
  const std::string word = first_word(start);
  if (word.empty()) return file.extension() == ".toml";
  return word == "version" || word.rfind("version=", 0) == 0;
}

}  // namespace

const char* name_of(FileKind kind) {
  // Without a default, so that the compiler names a kind that is missing.
  switch (kind) {
    case FileKind::png:
      return ".png file";
    case FileKind::exr:
      return ".exr file";
    case FileKind::mp4:
      return ".mp4 file";
    case FileKind::vxl:
      return ".vxl file";
    case FileKind::brp:
      return ".brp file";
    case FileKind::brv:
      return ".brv file";
    case FileKind::vdb:
      return ".vdb file";
    case FileKind::nvdb:
      return ".nvdb file";
    case FileKind::raw:
      return ".raw file";
    case FileKind::json:
      return "JSON file";
    case FileKind::obj:
      return ".obj file";
    case FileKind::ply:
      return ".ply file";
    case FileKind::spheres:
      return ".spheres file";
    case FileKind::timeline:
      return "timeline";
    case FileKind::frame_log:
      return "frame log";
    case FileKind::godot_import:
      return "Godot import file";
    case FileKind::slice_atlas:
      return "description of a slice atlas";
    case FileKind::flipbook:
      return "description of a flipbook";
    case FileKind::checkpoint:
      return "checkpoint";
    case FileKind::unit_key:
      return "key of a unit";
  }
  return "";
}

Result<bool> may_be_json_input(const std::filesystem::path& file) {
  const auto read = read_file_start(file, kStartBytes);
  if (!read) return read.failure();
  const std::string_view start = *read;
  const std::size_t first = start.find_first_not_of(kBlanks);
  if (first != std::string_view::npos && start[first] == '[') return true;
  constexpr std::string_view kMarks[] = {"\"colors\"", "brume slice atlas", "brume raw volume"};
  return std::any_of(std::begin(kMarks), std::end(kMarks),
                     [&](std::string_view mark) { return start.find(mark) != std::string_view::npos; });
}

Result<bool> is_of_kind(const std::filesystem::path& file, FileKind kind) {
  const auto read = read_file_start(file, kStartBytes);
  if (!read) return read.failure();
  const std::string_view start = *read;
  if (start.empty()) return true;
  switch (kind) {
    case FileKind::png:
      return begins_with(start, "\x89PNG\r\n\x1a\n");
    case FileKind::exr:
      return begins_with(start, "\x76\x2f\x31\x01");
    case FileKind::mp4:
      return is_mp4(start);
    case FileKind::vxl:
      return begins_with(start, "BRUMEVXL");
    case FileKind::brp:
      return begins_with(start, "BRUMERPL");
    case FileKind::brv:
      return begins_with(start, "BRUMEBRV");
    case FileKind::vdb:
      return begins_with(start, std::string_view(" BDV\0\0\0\0", 8));
    case FileKind::nvdb:
      return begins_with(start, "NanoVDB");
    case FileKind::raw:
      return file.extension() == ".raw";  // An array of numbers begins like anything.
    case FileKind::json:
      return is_json(start, file);
    case FileKind::obj:
      return is_obj(start, file);
    case FileKind::ply:
      return begins_with(start, "ply\n");
    case FileKind::spheres:
      return begins_with(start, "BRUMESPH");
    case FileKind::timeline:
      return is_timeline(start, file);
    case FileKind::frame_log:
      return begins_with(start, "frame,seconds,");
    case FileKind::godot_import:
      return begins_with(start, "[remap]");
    case FileKind::slice_atlas:
      return is_json(start, file) && (start.find_first_not_of(kBlanks) == std::string_view::npos ||
                                      start.find("brume slice atlas") != std::string_view::npos);
    case FileKind::flipbook:
      return is_json(start, file) && (start.find_first_not_of(kBlanks) == std::string_view::npos ||
                                      start.find("brume flipbook") != std::string_view::npos);
    case FileKind::checkpoint:
      return begins_with(start, "BRUMEREF");
    case FileKind::unit_key:
      return begins_with(start, "BRUMEKEY");
  }
  return false;
}

}  // namespace brume::cli
