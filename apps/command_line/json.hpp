// JSON values for --json: a thin wrapper over nlohmann-json that keeps the order of members. Only json.cpp
// includes the library, because it adds two seconds to the compile time of every file that builds values with
// it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace brume::cli {

/// A JSON value: null, boolean, number, string, object or list.
class Json {
 public:
  struct Member;

  Json(std::nullptr_t);
  Json(std::same_as<bool> auto value) : Json(Boolean{value}) {}
  Json(std::signed_integral auto value) : Json(Signed{value}) {}
  Json(std::unsigned_integral auto value) requires(!std::same_as<decltype(value), bool>)
      : Json(Unsigned{value}) {}
  Json(double value) : Json(Real{value}) {}
  Json(float value);  ///< As the shortest decimal that reads back as the same float: -5.2.
  Json(const char* text);
  Json(const std::string& text);
  Json(const std::vector<std::string>& texts);
  Json(std::initializer_list<Member> members);  ///< An object.
  static Json object();
  static Json list(std::initializer_list<Json> values);

  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  void set(const std::string& key, const Json& value);  ///< Sets a member of this object.
  void update(const Json& members);                     ///< Sets all members of another object in this one.
  void push_back(const Json& value);                    ///< Appends to this list.

  std::string dump() const;  ///< Text indented by two; bytes that are not UTF-8 become U+FFFD.
  std::string text() const;  ///< In one line; a string without quotes.

 private:
  struct Boolean {
    bool value;
  };
  struct Signed {
    std::int64_t value;
  };
  struct Unsigned {
    std::uint64_t value;
  };
  struct Real {
    double value;
  };
  explicit Json(Boolean boolean);
  explicit Json(Signed number);
  explicit Json(Unsigned number);
  explicit Json(Real number);

  std::unique_ptr<nlohmann::ordered_json> value_;
};

struct Json::Member {
  const char* key;
  Json value;
};

}  // namespace brume::cli
