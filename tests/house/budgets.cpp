#include "tests/house/budgets.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace brume::house {
namespace {

double budget_of(const std::string& name, const Seconds& budgets) {
  const auto found = budgets.find(name);
  return found == budgets.end() ? 1 : found->second;
}

double most_of(const std::string& name, const Seconds& budgets, double pace) {
  return (1.5 * budget_of(name, budgets) + 1) * pace;
}

double median_or_zero(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Seconds parse_budgets(const std::string& text) {
  Seconds budgets;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    double seconds = 0;
    if (words >> name >> seconds) budgets[name] = seconds;
  }
  return budgets;
}

std::set<std::string> cpu_programs(const std::string& table) {
  std::set<std::string> programs;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, target, room, labels;
    words >> name >> target >> room >> labels;
    if (("," + labels + ",").find(",cpu,") != std::string::npos) programs.insert(name);
  }
  return programs;
}

double pace_of(const Seconds& taken, const Seconds& budgets, const std::set<std::string>& cpu) {
  constexpr double kLeastBudget = 3;
  std::vector<double> with_device, without;
  for (const auto& [name, seconds] : taken)
    if (const double budget = budget_of(name, budgets); budget >= kLeastBudget)
      (cpu.contains(name) ? without : with_device).push_back(seconds / budget);
  return std::max(median_or_zero(without), median_or_zero(with_device));
}

std::vector<std::string> over_budget(const Seconds& taken, const Seconds& budgets, double pace) {
  std::vector<std::string> over;
  for (const auto& [name, seconds] : taken) {
    const double most = most_of(name, budgets, pace);
    if (seconds <= most) continue;
    char line[200];
    std::snprintf(
        line, sizeof line,
        "%s took %.1f CPU seconds, at most %.1f for its budget of %.0f on this machine; make it faster, or "
        "raise tests/budgets.txt and say why",
        name.c_str(), seconds, most, budget_of(name, budgets));
    over.emplace_back(line);
  }
  return over;
}

std::vector<std::string> over_budget_again(Seconds taken, const Seconds& budgets, double pace,
                                           const std::function<double(const std::string&)>& measure) {
  for (int again = 0; again < 2; ++again)
    for (auto& [name, seconds] : taken)
      if (seconds > most_of(name, budgets, pace)) seconds = std::min(seconds, measure(name));
  return over_budget(taken, budgets, pace);
}

}  // namespace brume::house
