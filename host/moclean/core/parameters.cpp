#include "moclean/core/parameters.hpp"

#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean::detail {

void ParameterReader::operator()(std::string_view key, int& member) {
  if (!given_.has(key)) return;
  const Index count = given_.count(key);
  if (count > std::numeric_limits<int>::max())
    throw ArgumentError(fmt::format("{}: {} is {}, which is too large", given_.name(), key, count));
  member = static_cast<int>(count);
}

void ParameterWriter::operator()(std::string_view key, double member) {
  append(key, fmt::format("{}", member));
}

void ParameterWriter::operator()(std::string_view key, Index member) {
  append(key, fmt::format("{}", member));
}

void ParameterWriter::append(std::string_view key, std::string_view value) {
  text_ += fmt::format("{}{}={}", empty_ ? ':' : ',', key, value);
  empty_ = false;
}

}  // namespace moclean::detail
