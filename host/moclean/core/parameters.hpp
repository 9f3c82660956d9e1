#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "moclean/core/specification.hpp"

namespace moclean {

// Parameter structs that can be written as specifications. Such a struct T is an aggregate whose
// members have defaults, with
//   T::name            what its specifications begin with
//   T::visit(self, v)  calls v(key, member) for every parameter, v(key, member, choices) for an
//                      enumeration, the choices in the order of its enumerators
//   check(t)           a free function that throws ArgumentError for values out of range
// Members are double, Index, int, enumerations, and std::optional of the first two.

namespace detail {

/// Reads the parameters that are given over those that `value` has.
class ParameterReader {
 public:
  explicit ParameterReader(const Specification& specification) : given_(specification) {}

  void operator()(std::string_view key, double& member) { member = given_.number(key, member); }
  void operator()(std::string_view key, Index& member) {
    if (given_.has(key)) member = given_.count(key);
  }
  void operator()(std::string_view key, int& member);
  void operator()(std::string_view key, std::optional<double>& member) {
    if (given_.has(key)) member = given_.number(key, 0);
  }
  void operator()(std::string_view key, std::optional<Index>& member) {
    if (given_.has(key)) member = given_.count(key);
  }
  template <class Enumeration>
  void operator()(std::string_view key, Enumeration& member,
                  std::span<const std::string_view> choices) {
    const auto otherwise = static_cast<std::size_t>(member);
    member = static_cast<Enumeration>(given_.choice(key, choices, otherwise));
  }

 private:
  const Specification& given_;
};

/// Collects the keys.
struct KeyCollector {
  std::vector<std::string_view> keys;

  void operator()(std::string_view key, const auto&, const auto&...) { keys.push_back(key); }
};

/// Appends `:key=value`, then `,key=value`.
class ParameterWriter {
 public:
  explicit ParameterWriter(std::string_view name) : text_(name) {}

  const std::string& text() const { return text_; }

  void operator()(std::string_view key, double member);
  void operator()(std::string_view key, Index member);
  void operator()(std::string_view key, int member) { (*this)(key, Index{member}); }
  template <class Number>
  void operator()(std::string_view key, const std::optional<Number>& member) {
    if (member) (*this)(key, *member);
  }
  template <class Enumeration>
  void operator()(std::string_view key, const Enumeration& member,
                  std::span<const std::string_view> choices) {
    append(key, choices[static_cast<std::size_t>(member)]);
  }

 private:
  void append(std::string_view key, std::string_view value);

  std::string text_;
  bool empty_ = true;
};

}  // namespace detail

/// Reads a specification over `value`, which gives what it leaves out, and checks the result.
/// Throws ArgumentError for keys that T does not have, listing those it has, for values that do not
/// parse, and what check() throws.
template <class T>
T read_parameters(const Specification& specification, T value = {}) {
  detail::KeyCollector known;
  T::visit(value, known);
  specification.allow(known.keys);
  detail::ParameterReader reader(specification);
  T::visit(value, reader);
  check(value);
  return value;
}

/// The specification that read_parameters() reads back to the same value, with every parameter.
template <class T>
std::string to_specification(const T& value) {
  detail::ParameterWriter writer(T::name);
  T::visit(value, writer);
  return writer.text();
}

/// The names of the alternatives of a variant of parameter structs.
template <class Variant>
std::vector<std::string_view> names_of() {
  return []<class... T>(std::type_identity<std::variant<T...>>) {
    return std::vector<std::string_view>{T::name...};
  }(std::type_identity<Variant>());
}

/// The alternative whose name the specification has, read by `read(Specification, T{})`; nothing if
/// it has the name of none.
template <class Variant, class Read>
std::optional<Variant> find_alternative(const Specification& specification, const Read& read) {
  std::optional<Variant> found;
  [&]<class... T>(std::type_identity<std::variant<T...>>) {
    static_cast<void>(
        ((specification.name() == T::name && (found = read(specification, T{}), true)) || ...));
  }(std::type_identity<Variant>());
  return found;
}

}  // namespace moclean
