// What test programs may take: tests/budgets.txt.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace brume::house {

/// CPU seconds in user mode by the name of a program.
using Seconds = std::map<std::string, double>;

/// The lines "NAME SECONDS" of a text; others are comments.
Seconds parse_budgets(const std::string& text);

/// The programs with the label cpu in a build's table of tests (cmake/BrumeTests.cmake).
std::set<std::string> cpu_programs(const std::string& table);

/// How slow this machine is beside that of the budgets: the median of taken / budget over programs that have
/// a budget of at least three seconds, of those of `cpu` or of all others, whichever is more. 0 if there are
/// none. Machines differ in one kind more than in the other; what a driver finds in its cache lets the others
/// take less, which changes nothing then.
double pace_of(const Seconds& taken, const Seconds& budgets, const std::set<std::string>& cpu);

/// A line for each program that took more than half as much again as its budget at this pace, and a second.
/// The budget of a program that is not listed is one second.
std::vector<std::string> over_budget(const Seconds& taken, const Seconds& budgets, double pace);

/// The same after up to two more measurements of those that are over it, of which the least counts: what else
/// a machine does costs a program CPU seconds, too, as it takes its caches and the other half of its core.
std::vector<std::string> over_budget_again(Seconds taken, const Seconds& budgets, double pace,
                                           const std::function<double(const std::string&)>& measure);

}  // namespace brume::house
