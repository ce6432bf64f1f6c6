#pragma once

#include <cstddef>
#include <utility>

namespace paloc::test {

/// Converts to anything, so that a brace can be filled with so many of them.
struct AnyField {
  template <typename T>
  operator T() const;  // NOLINT: declared only, for unevaluated use
};

/// How many fields an aggregate has: the largest number of initializers that its braces take.
template <typename Struct, typename... Fields>
constexpr std::size_t fieldCount() {
  if constexpr (requires { Struct{Fields{}..., AnyField{}}; }) {
    return fieldCount<Struct, Fields..., AnyField>();
  } else {
    return sizeof...(Fields);
  }
}

}  // namespace paloc::test
