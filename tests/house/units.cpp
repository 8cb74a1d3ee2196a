#include "tests/house/units.hpp"

#include <algorithm>
#include <filesystem>

#include "tests/house/house_rules.hpp"

namespace brume::house {
namespace {

std::string without_suffix(const std::string& path) {
  return std::filesystem::path(path).replace_extension().string();
}

/// Tarjan's algorithm: a unit that reaches no unit above it on the stack closes a group.
class Search {
 public:
  explicit Search(const Units& units) : units_(units) {}

  std::vector<std::vector<std::string>> run() {
    for (const auto& [name, unit] : units_)
      if (!places_.contains(name)) visit(name);
    std::sort(groups_.begin(), groups_.end());
    return groups_;
  }

 private:
  /// Sources of the project are included from src/ or from its root.
  std::vector<std::string> neighbours(const std::string& name) const {
    std::vector<std::string> found;
    for (const std::string& path : units_.at(name).included)
      for (const std::string& other : {without_suffix("src/" + path), without_suffix(path)})
        if (other != name && units_.contains(other)) found.push_back(other);
    return found;
  }

  void visit(const std::string& name) {
    const std::size_t place = places_.size();
    lowest_[name] = places_[name] = place;
    stack_.push_back(name);
    for (const std::string& other : neighbours(name)) {
      if (!places_.contains(other)) {
        visit(other);
        lowest_[name] = std::min(lowest_[name], lowest_[other]);
      } else if (std::find(stack_.begin(), stack_.end(), other) != stack_.end()) {
        lowest_[name] = std::min(lowest_[name], places_[other]);
      }
    }
    if (lowest_[name] != place) return;

    // All that is above it on the stack reaches it, and it reaches them.
    const auto first = std::find(stack_.begin(), stack_.end(), name);
    std::vector<std::string> group(first, stack_.end());
    stack_.erase(first, stack_.end());
    std::sort(group.begin(), group.end());
    if (group.size() > 1) groups_.push_back(std::move(group));
  }

  const Units& units_;
  std::map<std::string, std::size_t> places_, lowest_;
  std::vector<std::string> stack_;
  std::vector<std::vector<std::string>> groups_;
};

}  // namespace

void add_file(Units& units, const std::string& path, std::string_view text) {
  Unit& unit = units[without_suffix(path)];
  unit.lines += line_count(text);
  for (std::string& include : quoted_includes(text)) unit.included.insert(std::move(include));
}

std::vector<std::vector<std::string>> circles(const Units& units) {
  return Search(units).run();
}

}  // namespace brume::house
