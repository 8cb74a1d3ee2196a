#include "scene/gltf_check.hpp"

#include <map>

#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

using nlohmann::json;

constexpr int kMostNesting = 64;
constexpr double kMostBytes = 1ull << 32, kPi = 3.14159265358979323846;

enum class Kind { any, object, array, text, flag, number, whole, index };

struct Rule {
  const char* path;  ///< Array elements are [], members of any name *.
  Kind kind = Kind::any;
  double least = 0, most = 0;
  std::size_t count = 0;        ///< Required length of an array; 0 for any.
  const char* array = nullptr;  ///< The array that an index refers to.
  bool required = false;
};

#define TEXTURE(path)                                                                                 \
  {path ".index", Kind::index, 0, 0, 0, "/textures", true}, {path ".texCoord", Kind::whole, 0, 64}, { \
    path ".extensions", Kind::object                                                                  \
  }

#define LIGHTS "extensions.KHR_lights_punctual.lights"
constexpr Rule kRules[] = {
    {"asset.version", Kind::text, 0, 0, 0, nullptr, true},
    {"extensionsRequired[]", Kind::text},
    {"scene", Kind::index, 0, 0, 0, "/scenes"},
    {"scenes[].nodes[]", Kind::index, 0, 0, 0, "/nodes"},
    {"nodes[].name", Kind::text},
    {"nodes[].mesh", Kind::index, 0, 0, 0, "/meshes"},
    {"nodes[].camera", Kind::index, 0, 0, 0, "/cameras"},
    {"nodes[].children[]", Kind::index, 0, 0, 0, "/nodes"},
    {"nodes[].matrix[]", Kind::number, -1e30, 1e30, 16},
    {"nodes[].translation[]", Kind::number, -1e30, 1e30, 3},
    {"nodes[].rotation[]", Kind::number, -1e30, 1e30, 4},
    {"nodes[].scale[]", Kind::number, -1e30, 1e30, 3},
    {"nodes[].extensions.KHR_lights_punctual.light", Kind::index, 0, 0, 0,
     "/extensions/KHR_lights_punctual/lights", true},
    {"meshes[].name", Kind::text},
    {"meshes[].primitives[].mode", Kind::whole, 0, 6},
    {"meshes[].primitives[].material", Kind::index, 0, 0, 0, "/materials"},
    {"meshes[].primitives[].indices", Kind::index, 0, 0, 0, "/accessors"},
    {"meshes[].primitives[].attributes.*", Kind::index, 0, 0, 0, "/accessors"},
    {"meshes[].primitives[].attributes.POSITION", Kind::index, 0, 0, 0, "/accessors", true},
    {"accessors[].bufferView", Kind::index, 0, 0, 0, "/bufferViews"},
    {"accessors[].byteOffset", Kind::whole, 0, kMostBytes},
    {"accessors[].count", Kind::whole, 1, kMostBytes, 0, nullptr, true},
    {"accessors[].componentType", Kind::whole, 5120, 5126, 0, nullptr, true},
    {"accessors[].type", Kind::text, 0, 0, 0, nullptr, true},
    {"accessors[].normalized", Kind::flag},
    {"accessors[].sparse.count", Kind::whole, 0, 1u << 30, 0, nullptr, true},
    {"accessors[].sparse.indices.bufferView", Kind::index, 0, 0, 0, "/bufferViews", true},
    {"accessors[].sparse.indices.byteOffset", Kind::whole, 0, 1u << 30},
    {"accessors[].sparse.indices.componentType", Kind::whole, 5121, 5125, 0, nullptr, true},
    {"accessors[].sparse.values.bufferView", Kind::index, 0, 0, 0, "/bufferViews", true},
    {"accessors[].sparse.values.byteOffset", Kind::whole, 0, 1u << 30},
    {"bufferViews[].buffer", Kind::index, 0, 0, 0, "/buffers", true},
    {"bufferViews[].byteOffset", Kind::whole, 0, kMostBytes},
    {"bufferViews[].byteLength", Kind::whole, 1, 0x7fffffff, 0, nullptr, true},
    {"bufferViews[].byteStride", Kind::whole, 4, 252},
    {"buffers[].byteLength", Kind::whole, 1, kMostBytes, 0, nullptr, true},
    {"buffers[].uri", Kind::text},
    {"materials[].name", Kind::text},
    {"materials[].pbrMetallicRoughness.baseColorFactor[]", Kind::number, 0, 1, 4},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Kind::number, 0, 1},
    {"materials[].pbrMetallicRoughness.metallicFactor", Kind::number, 0, 1},
    TEXTURE("materials[].pbrMetallicRoughness.baseColorTexture"),
    TEXTURE("materials[].pbrMetallicRoughness.metallicRoughnessTexture"),
    TEXTURE("materials[].normalTexture"),
    TEXTURE("materials[].emissiveTexture"),
    {"materials[].emissiveFactor[]", Kind::number, 0, 1e6, 3},
    {"materials[].alphaMode", Kind::text},
    {"materials[].alphaCutoff", Kind::number, 0, 1e6},
    {"materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Kind::number, 0, 1e6},
    {"textures[].source", Kind::index, 0, 0, 0, "/images"},
    {"images[].bufferView", Kind::index, 0, 0, 0, "/bufferViews"},
    {"images[].uri", Kind::text},
    {"cameras[].type", Kind::text, 0, 0, 0, nullptr, true},
    {"cameras[].perspective.znear", Kind::number, 0, 1e30, 0, nullptr, true},
    {"cameras[].perspective.yfov", Kind::number, 0.001, kPi - 0.001, 0, nullptr, true},
    {LIGHTS "[].type", Kind::text, 0, 0, 0, nullptr, true},
    {LIGHTS "[].color[]", Kind::number, 0, 1e6, 3},
    {LIGHTS "[].intensity", Kind::number, 0, 1e12},
    {LIGHTS "[].spot.innerConeAngle", Kind::number, 0, kPi / 2},
    {LIGHTS "[].spot.outerConeAngle", Kind::number, 0, kPi / 2},
};
#undef LIGHTS
#undef TEXTURE

/// The rules by path, including those of the enclosing arrays and objects.
struct Node {
  Rule rule{};
  std::vector<std::string> required;
};

const std::map<std::string, Node>& rules() {
  static const std::map<std::string, Node> all = [] {
    std::map<std::string, Node> result;
    for (const Rule& rule : kRules) {
      result[rule.path].rule = rule;
      const std::string path = rule.path;
      for (std::size_t end = path.find_first_of(".["); end != std::string::npos;
           end = path.find_first_of(".[", end + 1)) {
        Rule& around = result[path.substr(0, end)].rule;
        around.kind = path[end] == '.' ? Kind::object : Kind::array;
        if (path[end] == '[' && end + 2 == path.size()) around.count = rule.count;
      }
      const std::size_t dot = path.rfind('.');
      if (rule.required) result[path.substr(0, dot)].required.push_back(path.substr(dot + 1));
    }
    result["meshes[]"].required = {"primitives"};
    result["meshes[].primitives[]"].required = {"attributes"};
    return result;
  }();
  return all;
}

class Checker {
 public:
  Checker(const json& document, const std::string& file) : document_(document), file_(file) {}

  void check() const {
    if (!document_.is_object()) fail("", "expected an object");
    if (!document_.contains("asset")) fail("", "expected a member \"asset\"");
    visit(document_, "", "", 0);
    const json none = json::array();
    const json& views = document_.value("bufferViews", none);
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto end =
          views[i].value("byteOffset", std::uint64_t{0}) + views[i]["byteLength"].get<std::uint64_t>();
      const auto size =
          document_["buffers"][views[i]["buffer"].get<std::size_t>()]["byteLength"].get<std::uint64_t>();
      if (end > size) {
        fail("bufferViews[" + std::to_string(i) + "]",
             "ends at byte " + std::to_string(end) + " of a buffer of " + std::to_string(size));
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& what) const {
    throw Error(ErrorCode::bad_input, file_ + ": " + (path.empty() ? "the document" : path) + ": " + what);
  }

  void expect(bool holds, const json& value, const std::string& path, const std::string& what) const {
    if (holds) return;
    // Printing an untrusted value could be long: arrays and objects are only named.
    const std::string found = value.is_structured()
                                  ? std::string("an ") + value.type_name()
                                  : in_quotes(value.dump(-1, ' ', true, json::error_handler_t::replace));
    fail(path, "expected " + what + ", found " + found);
  }

  /// `pattern` is the path in the form of the rules.
  void visit(const json& value, const std::string& pattern, const std::string& path, int depth) const {
    if (depth > kMostNesting) fail(path.substr(0, 200), "is nested too deeply");
    auto known = rules().find(pattern);
    if (known == rules().end()) known = rules().find(pattern.substr(0, pattern.rfind('.') + 1) + "*");
    if (known != rules().end()) judge(value, known->second, path);
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i)
        visit(value[i], pattern + "[]", path + "[" + std::to_string(i) + "]", depth + 1);
    } else if (value.is_object()) {
      for (const auto& [key, member] : value.items()) {
        const std::string name = (path.empty() ? "" : ".") + key;
        visit(member, pattern + name, path + name, depth + 1);
      }
    }
  }

  void judge(const json& value, const Node& node, const std::string& path) const {
    const Rule& rule = node.rule;
    if (rule.kind == Kind::object) expect(value.is_object(), value, path, "an object");
    if (rule.kind == Kind::array) expect(value.is_array(), value, path, "an array");
    if (rule.kind == Kind::text) expect(value.is_string(), value, path, "a text");
    if (rule.kind == Kind::flag) expect(value.is_boolean(), value, path, "true or false");
    if (rule.count > 0 && value.is_array() && value.size() != rule.count) {
      fail(path,
           "expected " + std::to_string(rule.count) + " numbers, found " + std::to_string(value.size()));
    }
    if (rule.kind == Kind::number || rule.kind == Kind::whole) check_number(value, rule, path);
    if (rule.kind == Kind::index) check_index(value, rule.array, path);
    for (const std::string& key : node.required) {
      if (!value.contains(key)) fail(path, "expected a member \"" + key + "\"");
    }
  }

  void check_number(const json& value, const Rule& rule, const std::string& path) const {
    const bool whole = rule.kind == Kind::whole;
    const std::string what = whole ? "a whole number" : "a number";
    expect(whole ? value.is_number_unsigned() : value.is_number(), value, path, what);
    const auto shown = [whole](double limit) {
      return whole ? std::to_string(static_cast<std::uint64_t>(limit)) : json(limit).dump();
    };
    expect(value.get<double>() >= rule.least && value.get<double>() <= rule.most, value, path,
           what + " from " + shown(rule.least) + " to " + shown(rule.most));
  }

  void check_index(const json& value, const std::string& array, const std::string& path) const {
    expect(value.is_number_unsigned(), value, path, "a whole number");
    const json::json_pointer pointer(array);
    const std::size_t count = document_.contains(pointer) ? document_.at(pointer).size() : 0;
    if (value.get<std::uint64_t>() < count) return;
    fail(path, "names " + array.substr(array.rfind('/') + 1) + "[" + value.dump() +
                   "], but the document has " + std::to_string(count) + " of them");
  }

  const json& document_;
  const std::string& file_;
};

}  // namespace

json checked_gltf_json(std::string_view text, const std::string& file) {
  if (text.size() > kMostGltfJson) {
    throw Error(ErrorCode::resource_limit, file + ": has " + std::to_string(text.size()) +
                                               " bytes of JSON, at most " + std::to_string(kMostGltfJson) +
                                               " are accepted; store the buffers in a .bin or .glb file");
  }
  try {
    json document = json::parse(text.begin(), text.end());
    Checker(document, file).check();
    return document;
  } catch (const json::parse_error& error) {
    const LineColumn at = line_column(text, error.byte > 0 ? error.byte - 1 : 0);
    throw Error(ErrorCode::bad_input,
                file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": invalid JSON");
  } catch (const json::exception&) {
    throw Error(ErrorCode::bad_input, file + ": the JSON holds a number too large to read");
  }
}

}  // namespace brume::scene
