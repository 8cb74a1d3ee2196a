#include "scene/files/obj.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/log.hpp"
#include "scene/color.hpp"
#include "scene/files/mesh_tools.hpp"
#include "scene/files/polygon.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

/// kInvalid: an index that no statement of the file can make valid.
constexpr std::int64_t kUnset = -1, kInvalid = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t kMostUnknown = 8;

/// Statements of the format and its earlier versions, read or not.
constexpr std::string_view kKnownStatements[] = {
    "v",    "vt",       "vn",     "vp",     "f",      "p",      "l",          "curv",     "curv2",
    "surf", "cstype",   "deg",    "bmat",   "step",   "parm",   "trim",       "hole",     "scrv",
    "sp",   "end",      "con",    "g",      "s",      "mg",     "o",          "bevel",    "c_interp",
    "lod",  "d_interp", "usemtl", "mtllib", "usemap", "maplib", "ctech",      "stech",    "call",
    "csh",  "bsp",      "bzp",    "cdc",    "cdp",    "res",    "shadow_obj", "trace_obj"};

/// The indices of a face corner, from 0; kUnset if absent.
struct Corner {
  std::int64_t position = kUnset, uv = kUnset, normal = kUnset;
  bool operator==(const Corner&) const = default;
};

/// A corner and how the file writes it.
struct FaceCorner {
  Corner corner;
  std::string_view word;
};

/// A face that uses elements below its line, or comes after one.
struct PendingFace {
  std::size_t part, first_corner, corners;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = static_cast<std::uint64_t>(corner.position) * 0x9e3779b97f4a7c15ull;
    hash = (hash ^ static_cast<std::uint64_t>(corner.uv)) * 0xff51afd7ed558ccdull;
    hash = (hash ^ (hash >> 32) ^ static_cast<std::uint64_t>(corner.normal)) * 0xc4ceb9fe1a85ec53ull;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name)
      : text_(text), reader_(text, name, TextReader::Continuation::backslash) {}

  Result<ObjModel> parse() {
    while (reader_.next_line()) {
      if (auto read = read_statement(reader_.next_word()); !read) return read.failure();
    }
    for (const PendingFace& face : pending_) {
      const auto corners = std::span(pending_corners_).subspan(face.first_corner, face.corners);
      if (auto added = add_face(corners, face.part); !added) return added.failure();
    }
    if (ignored_indices_ > 0)
      log_warning(first_ignored_ + "; ignored indices of this kind: " + std::to_string(ignored_indices_));
    std::erase_if(model_.parts, [](const ObjPart& part) { return part.indices.empty(); });
    model_.has_colors = !colors_.empty();
    return std::move(model_);
  }

 private:
  Result<void> read_statement(std::string_view word) {
    if (word == "v") return read_position();
    if (word == "vt") return read_vector(uvs_, 2, 1, "a texture coordinate");
    if (word == "vn") return read_vector(normals_, 3, 3, "a normal");
    if (word == "f") return read_face();
    if (word == "usemtl") {
      material_ = std::string(reader_.rest_of_line());
      use_part();
    }
    if (word == "o" || word == "g") {
      object_ = std::string(reader_.rest_of_line());
      use_part();
    }
    if (word == "mtllib")
      model_.libraries.push_back({std::string(reader_.rest_of_line()), reader_.line_place()});
    if (!word.empty() && std::ranges::find(kKnownStatements, word) == std::end(kKnownStatements))
      warn_of_unknown(word);
    return {};
  }

  /// Once for each word, up to kMostUnknown: a file that is no OBJ has thousands.
  void warn_of_unknown(std::string_view word) {
    if (unknown_.size() > kMostUnknown || !unknown_.emplace(word).second) return;
    if (unknown_.size() <= kMostUnknown)
      log_warning(reader_.line_place() + ": the statement " + in_quotes(word) + " is unknown and ignored");
    else
      log_warning(reader_.line_place() + ": more unknown statements from here on are ignored");
  }

  /// From `least` to `most` numbers; further values on the line (weights, colours) are ignored.
  Result<void> read_vector(std::vector<glm::vec3>& into, int most, int least, const char* what) {
    constexpr const char* kAxes[3] = {"first", "second", "third"};
    glm::vec3 value(0);
    for (int axis = 0; axis < most; ++axis) {
      const std::string_view word = reader_.next_word();
      if (word.empty() && axis >= least) break;
      const auto number =
          reader_.number_from(word, std::string("the ") + kAxes[axis] + " component of " + what);
      if (!number) return number.failure();
      value[axis] = *number;
    }
    into.push_back(value);
    return {};
  }

  /// A position, and the vertex colour of many scanners and sculpting programs: "v x y z r g b".
  Result<void> read_position() {
    if (auto read = read_vector(positions_, 3, 3, "a position"); !read) return read;
    glm::vec3 color(0);
    int channels = 0;
    for (std::string_view word = reader_.next_word(); !word.empty(); word = reader_.next_word()) {
      const auto number = reader_.number_from(word, "a vertex colour");
      if (!number || channels == 3) return {};
      color[channels++] = *number;
    }
    if (channels != 3) return {};
    colors_.resize(positions_.size(), glm::vec3(1));
    colors_.back() = glm::clamp(color, 0.0f, 1.0f);
    return {};
  }

  /// The part of the present object and material.
  void use_part() {
    const bool is_named = model_.parts.size() < kMostObjObjects || parts_.contains({object_, material_});
    const std::string object = is_named ? object_ : "";
    const auto [entry, is_new] = parts_.try_emplace({object, material_}, model_.parts.size());
    if (is_new) model_.parts.push_back({object, material_, reader_.line_place(), {}});
    part_ = entry->second;
  }

  /// Removes an index from the front of `word`; `count` elements are above this line.
  Result<std::int64_t> read_index(std::string_view& word, std::string_view whole, std::size_t count) {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const auto used = static_cast<std::size_t>(end - word.data());
    if (error == std::errc::invalid_argument || (used < word.size() && *end != '/')) {
      return reader_.expected("a face corner like 1, 1/2, 1//3 or 1/2/3", whole);
    }
    word.remove_prefix(used);
    const auto limit = static_cast<std::int64_t>(count);
    if (error != std::errc() || index == 0 || index < -limit) return kInvalid;
    return index > 0 ? index - 1 : limit + index;
  }

  Result<Corner> read_corner(std::string_view whole) {
    Corner corner;
    std::string_view word = whole;
    const auto position = read_index(word, whole, positions_.size());
    if (!position) return position.failure();
    if (*position == kInvalid) return no_position(reader_.place(), whole, " above this line");
    corner.position = *position;
    if (!word.empty()) word.remove_prefix(1);
    if (!word.empty() && word.front() != '/') {
      const auto uv = read_index(word, whole, uvs_.size());
      if (!uv) return uv.failure();
      corner.uv = *uv;
    }
    if (!word.empty()) word.remove_prefix(1);
    if (!word.empty()) {
      const auto normal = read_index(word, whole, normals_.size());
      if (!normal) return normal.failure();
      corner.normal = *normal;
      if (!word.empty()) return reader_.expected("a face corner like 1, 1/2, 1//3 or 1/2/3", whole);
    }
    return corner;
  }

  Failure no_position(const std::string& place, std::string_view word, const char* where) const {
    return {ErrorCode::bad_input, place + ": " + in_quotes(word) + " names no position: there are " +
                                      std::to_string(positions_.size()) + where + ", and they count from 1"};
  }

  Result<void> read_face() {
    face_.clear();
    for (std::string_view word = reader_.next_word(); !word.empty(); word = reader_.next_word()) {
      const auto corner = read_corner(word);
      if (!corner) return corner.failure();
      face_.push_back({*corner, word});
    }
    if (face_.size() < 3) return reader_.expected("at least 3 corners of a face", {});
    if (model_.parts.empty()) use_part();
    // Faces that follow wait as well, so that triangles stay in the order of the file.
    if (pending_.empty() && !std::ranges::any_of(face_, [&](const FaceCorner& c) { return is_ahead(c); }))
      return add_face(face_, part_);
    pending_.push_back({part_, pending_corners_.size(), face_.size()});
    pending_corners_.insert(pending_corners_.end(), face_.begin(), face_.end());
    return {};
  }

  /// Whether statements below may define what a corner uses.
  bool is_ahead(const FaceCorner& face_corner) const {
    const Corner& corner = face_corner.corner;
    const auto is_below = [](std::int64_t index, std::size_t count) {
      return index != kInvalid && index >= static_cast<std::int64_t>(count);
    };
    return is_below(corner.position, positions_.size()) || is_below(corner.uv, uvs_.size()) ||
           is_below(corner.normal, normals_.size());
  }

  std::string place_of(std::string_view word) const {
    const LineColumn at = line_column(text_, static_cast<std::size_t>(word.data() - text_.data()));
    return reader_.name() + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
  }

  /// A texture coordinate or a normal that does not exist is as good as none.
  void drop_invalid(std::int64_t& index, std::size_t count, std::string_view word, const char* what) {
    if (index < static_cast<std::int64_t>(count)) return;
    index = kUnset;
    if (ignored_indices_++ == 0)
      first_ignored_ = place_of(word) + ": " + in_quotes(word) + " names no " + what + ": there are " +
                       std::to_string(count) + ", and they count from 1";
  }

  Result<void> add_face(std::span<const FaceCorner> face, std::size_t part) {
    // The corners.
    corners_.clear();
    face_positions_.clear();
    for (const auto& [from_file, word] : face) {
      Corner corner = from_file;
      if (corner.position >= static_cast<std::int64_t>(positions_.size()))
        return no_position(place_of(word), word, "");
      drop_invalid(corner.uv, uvs_.size(), word, "texture coordinate");
      drop_invalid(corner.normal, normals_.size(), word, "normal");
      corners_.push_back(corner);
      face_positions_.push_back(positions_[static_cast<std::size_t>(corner.position)]);
    }
    if (face.size() > kMaxConcaveCorners && !is_convex(face_positions_)) {
      return Failure{ErrorCode::resource_limit,
                     place_of(face[0].word) + ": a face with " + std::to_string(face.size()) +
                         " corners; at most " + std::to_string(kMaxConcaveCorners) +
                         " are triangulated if it is not convex: export the mesh as triangles"};
    }

    // The vertices.
    face_vertices_.clear();
    std::int64_t face_normal = kUnset;
    for (Corner corner : corners_) {
      const bool has_normal =
          corner.normal != kUnset && is_usable(normals_[static_cast<std::size_t>(corner.normal)]);
      if (!has_normal) {
        if (face_normal == kUnset) {
          face_normals_.push_back(unit_normal());
          face_normal = static_cast<std::int64_t>(face_normals_.size());
        }
        corner.normal = kUnset - face_normal;  // Below kUnset: one of the faces' own normals.
      }
      face_vertices_.push_back(vertex_of(corner));
    }

    // The triangles.
    std::vector<std::uint32_t>& indices = model_.parts[part].indices;
    for (const auto& triangle : triangulate(face_positions_)) {
      for (const std::uint32_t corner : triangle) indices.push_back(face_vertices_[corner]);
    }
    return {};
  }

  static glm::vec3 linear(glm::vec3 srgb) {
    return glm::vec3(
        glm::dvec3(linear_from_srgb(srgb.r), linear_from_srgb(srgb.g), linear_from_srgb(srgb.b)));
  }

  static bool is_usable(glm::vec3 normal) {
    const double square = glm::dot(glm::dvec3(normal), glm::dvec3(normal));
    return square > 1e-60;
  }

  glm::vec3 unit_normal() const {
    const glm::dvec3 area = area_vector(face_positions_);
    const double size = glm::length(area);
    return size > 1e-150 && size < 1e150 ? glm::vec3(area / size) : glm::vec3(0, 1, 0);
  }

  std::uint32_t vertex_of(const Corner& corner) {
    const auto next = static_cast<std::uint32_t>(model_.vertices.size());
    const auto [entry, is_new] = vertex_of_corner_.try_emplace(corner, next);
    if (!is_new) return entry->second;
    Vertex vertex;
    const auto position = static_cast<std::size_t>(corner.position);
    vertex.position = positions_[position];
    if (position < colors_.size()) vertex.color = glm::vec4(linear(colors_[position]), 1);
    if (corner.uv != kUnset) {
      const glm::vec3 uv = uvs_[static_cast<std::size_t>(corner.uv)];
      vertex.uv = glm::vec2(uv.x, 1.0f - uv.y);
    }
    vertex.normal =
        corner.normal >= 0
            ? glm::vec3(glm::normalize(glm::dvec3(normals_[static_cast<std::size_t>(corner.normal)])))
            : face_normals_[static_cast<std::size_t>(kUnset - corner.normal - 1)];
    model_.vertices.push_back(vertex);
    return next;
  }

  std::string_view text_;
  TextReader reader_;
  ObjModel model_;
  std::vector<glm::vec3> positions_, uvs_, normals_, face_normals_;
  std::vector<glm::vec3> colors_;  ///< sRGB, of the first positions; the others are white.
  std::string object_, material_;
  std::map<std::pair<std::string, std::string>, std::size_t> parts_;  // by object and material
  std::size_t part_ = 0;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertex_of_corner_;
  std::vector<FaceCorner> face_, pending_corners_;
  std::vector<PendingFace> pending_;
  std::vector<Corner> corners_;
  std::vector<glm::vec3> face_positions_;
  std::vector<std::uint32_t> face_vertices_;
  std::size_t ignored_indices_ = 0;
  std::string first_ignored_;
  std::set<std::string, std::less<>> unknown_;
};

}  // namespace

Result<ObjModel> parse_obj(std::string_view text, const std::string& name) {
  if (is_utf16(text)) return parse_obj(utf8_from_utf16(text), name);
  return ObjParser(text, name).parse();
}

Mesh merged_mesh(ObjModel model, const std::string& name) {
  Mesh mesh{name, std::move(model.vertices), {}};
  for (const ObjPart& part : model.parts) {
    mesh.indices.insert(mesh.indices.end(), part.indices.begin(), part.indices.end());
  }
  compute_tangents(mesh);
  return mesh;
}

std::vector<Mesh> part_meshes(const ObjModel& model) {
  std::vector<Mesh> meshes;
  std::vector<std::uint32_t> new_index(model.vertices.size(), kNone);
  for (const ObjPart& part : model.parts) {
    Mesh mesh{part.material, {}, {}};
    for (const std::uint32_t index : part.indices) {
      if (new_index[index] == kNone) {
        new_index[index] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(model.vertices[index]);
      }
      mesh.indices.push_back(new_index[index]);
    }
    for (const std::uint32_t index : part.indices) new_index[index] = kNone;
    compute_tangents(mesh);
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace brume::scene
