// Visits the members of an aggregate in order, without naming them.
#pragma once

#include <cstddef>
#include <utility>

namespace brume::passes {

/// Converts to anything: stands for a member in an initializer.
struct AnyMember {
  template <typename T>
  operator T() const;  // NOLINT: implicit by design, never defined
};

template <typename T, std::size_t... I>
constexpr bool takes_members(std::index_sequence<I...>) {
  return requires {
    T{(static_cast<void>(I), AnyMember{})...};
  };
}

/// Number of members of an aggregate: as many as its initializer takes.
template <typename T, std::size_t N = 0>
constexpr std::size_t member_count() {
  if constexpr (takes_members<T>(std::make_index_sequence<N + 1>()))
    return member_count<T, N + 1>();
  else
    return N;
}

/// The members of an aggregate of 10 to 20, as for_each_member.
template <std::size_t kCount, typename T, typename All>
void for_many_members(const T& s, const All& all) {
  if constexpr (kCount == 10) {
    const auto& [a, b, c, d, e, f, g, h, i, j] = s;
    all(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (kCount == 11) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k] = s;
    all(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (kCount == 12) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l);
  } else if constexpr (kCount == 13) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else if constexpr (kCount == 14) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  } else if constexpr (kCount == 15) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  } else if constexpr (kCount == 16) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
  } else if constexpr (kCount == 17) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
  } else if constexpr (kCount == 18) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
  } else if constexpr (kCount == 19) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t);
  } else {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u] = s;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u);
  }
}

/// Calls visit(member) for each member of an aggregate of at most 20.
template <typename T, typename Visit>
void for_each_member(const T& s, Visit visit) {
  constexpr std::size_t kCount = member_count<T>();
  static_assert(kCount >= 1 && kCount <= 20);
  const auto all = [&](const auto&... members) { (visit(members), ...); };
  if constexpr (kCount == 1) {
    const auto& [a] = s;
    all(a);
  } else if constexpr (kCount == 2) {
    const auto& [a, b] = s;
    all(a, b);
  } else if constexpr (kCount == 3) {
    const auto& [a, b, c] = s;
    all(a, b, c);
  } else if constexpr (kCount == 4) {
    const auto& [a, b, c, d] = s;
    all(a, b, c, d);
  } else if constexpr (kCount == 5) {
    const auto& [a, b, c, d, e] = s;
    all(a, b, c, d, e);
  } else if constexpr (kCount == 6) {
    const auto& [a, b, c, d, e, f] = s;
    all(a, b, c, d, e, f);
  } else if constexpr (kCount == 7) {
    const auto& [a, b, c, d, e, f, g] = s;
    all(a, b, c, d, e, f, g);
  } else if constexpr (kCount == 8) {
    const auto& [a, b, c, d, e, f, g, h] = s;
    all(a, b, c, d, e, f, g, h);
  } else if constexpr (kCount == 9) {
    const auto& [a, b, c, d, e, f, g, h, i] = s;
    all(a, b, c, d, e, f, g, h, i);
  } else {
    for_many_members<kCount>(s, all);
  }
}

}  // namespace brume::passes
