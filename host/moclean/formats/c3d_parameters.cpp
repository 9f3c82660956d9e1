#include "moclean/formats/c3d_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::size_t most_in_parameter = 255;  // an extent is a byte
constexpr std::size_t most_in_series = 999;     // more than 65 535 points need

// A record is found by a 16-bit offset, which some readers take for a signed one.
constexpr std::size_t most_bytes = 32000;

unsigned byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, upper, upper);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  return text;
}

// Of the body of a parameter; nothing if the body is too short for it.
std::optional<C3dValue> value_of(std::string_view body) {
  if (body.size() < 2) return std::nullopt;
  C3dValue value{.type = static_cast<signed char>(body[0]), .extents = {}, .at = 2, .count = 1};
  const std::size_t axes = byte_at(body, 1);
  if (body.size() < 2 + axes) return std::nullopt;
  for (std::size_t a = 0; a < axes; ++a) value.extents.push_back(byte_at(body, 2 + a));
  value.at += axes;
  if (std::ranges::count(value.extents, 0U) > 0) value.count = 0;
  for (const std::size_t extent : value.extents) {
    value.count *= extent;
    if (value.count > body.size()) return std::nullopt;
  }
  const auto size = static_cast<std::size_t>(std::abs(value.type));
  if (value.at + value.count * size > body.size()) return std::nullopt;
  return value;
}

// The length of the body that starts `bytes`, by what stands in it: for the last record, which has
// no offset to the next. Nothing if `bytes` ends before.
std::optional<std::size_t> body_length(std::string_view bytes, bool is_group) {
  std::size_t length = 0;
  if (!is_group) {
    const auto value = value_of(bytes);
    if (!value) return std::nullopt;
    length = value->at + value->count * static_cast<std::size_t>(std::abs(value->type));
  }
  if (length >= bytes.size()) return std::nullopt;
  length += 1 + byte_at(bytes, length);
  return length <= bytes.size() ? std::optional(length) : std::nullopt;
}

}  // namespace

C3dParameters::C3dParameters(std::string_view content, std::size_t at, C3dNumbers numbers,
                             const std::filesystem::path& file)
    : numbers_(numbers) {
  const auto fail = [&](std::string_view expected) {
    throw FileError(file, fmt::format("byte {}: expected {} of the C3D parameters, found the end "
                                      "of the file",
                                      at, expected));
  };
  for (;;) {
    if (at + 2 > content.size()) fail("the next");
    const auto length = static_cast<signed char>(content[at]);
    if (length == 0) return;
    const auto name_size = static_cast<std::size_t>(std::abs(int{length}));
    const std::size_t offset_at = at + 2 + name_size;
    if (offset_at + 2 > content.size()) fail("the name of one");
    C3dRecord record{.group = static_cast<signed char>(content[at + 1]),
                     .locked = length < 0,
                     .name = std::string(content.substr(at + 2, name_size)),
                     .body = {}};
    const std::size_t offset = numbers_.word(&content[offset_at]);
    const std::string_view rest = content.substr(offset_at + 2);
    const auto natural = body_length(rest, record.group < 0);
    if (offset < 2 && !natural) fail("the value of " + excerpt(record.name));
    if (offset >= 2 && offset - 2 > rest.size()) fail("one after " + excerpt(record.name));
    record.body = rest.substr(0, offset < 2 ? *natural : offset - 2);
    records_.push_back(std::move(record));
    if (offset < 2) return;
    at = offset_at + offset;
  }
}

int C3dParameters::id_of(std::string_view group) const {
  for (const C3dRecord& record : records_)
    if (record.group < 0 && is_same_name(record.name, group)) return -record.group;
  return 0;
}

const C3dRecord* C3dParameters::find(std::string_view group, std::string_view name) const {
  const int id = id_of(group);
  for (const C3dRecord& record : records_)
    if (id != 0 && record.group == id && is_same_name(record.name, name)) return &record;
  return nullptr;
}

C3dRecord* C3dParameters::find(std::string_view group, std::string_view name) {
  return const_cast<C3dRecord*>(std::as_const(*this).find(group, name));
}

std::vector<double> C3dParameters::numbers(std::string_view group, std::string_view name) const {
  std::vector<double> values;
  const C3dRecord* record = find(group, name);
  const auto value = record ? value_of(record->body) : std::nullopt;
  if (!value) return values;
  for (std::size_t i = 0; i < value->count; ++i) {
    const char* bytes = record->body.data() + value->at;
    if (value->type == 4)
      values.push_back(numbers_.real(bytes + 4 * i));
    else if (value->type == 2)
      values.push_back(numbers_.integer(bytes + 2 * i));
    else if (value->type == 1)
      values.push_back(static_cast<unsigned char>(bytes[i]));
  }
  return values;
}

std::vector<unsigned> C3dParameters::words(std::string_view group, std::string_view name) const {
  std::vector<unsigned> values;
  const C3dRecord* record = find(group, name);
  const auto value = record ? value_of(record->body) : std::nullopt;
  if (!value || value->type != 2) return values;
  for (std::size_t i = 0; i < value->count; ++i)
    values.push_back(numbers_.word(record->body.data() + value->at + 2 * i));
  return values;
}

std::vector<std::string> C3dParameters::texts(std::string_view group, std::string_view name) const {
  std::vector<std::string> found;
  for (std::size_t number = 1; number <= most_in_series; ++number) {
    const C3dRecord* record = find(group, series_name(name, number));
    const auto value = record ? value_of(record->body) : std::nullopt;
    if (!value) break;
    if (value->type != -1 || value->count == 0) continue;
    const std::size_t width = value->extents.empty() ? 1 : value->extents[0];
    for (std::size_t i = 0; i < value->count; i += width)
      found.emplace_back(trimmed(std::string_view(record->body).substr(value->at + i, width)));
  }
  return found;
}

std::string C3dParameters::text(std::string_view group, std::string_view name) const {
  const std::vector<std::string> all = texts(group, name);
  return all.empty() ? std::string() : all.front();
}

void C3dParameters::set(std::string_view group, std::string_view name,
                        const std::vector<double>& values) {
  C3dRecord* record = find(group, name);
  const auto value = record ? value_of(record->body) : std::nullopt;
  if (!value) return;
  for (std::size_t i = 0; i < std::min(value->count, values.size()); ++i) {
    char* bytes = record->body.data() + value->at;
    if (value->type == 4)
      std::ranges::copy(numbers_.real_bytes(values[i]), bytes + 4 * i);
    else if (value->type == 2)
      std::ranges::copy(numbers_.word_bytes(static_cast<unsigned>(values[i])), bytes + 2 * i);
    else if (value->type == 1)
      bytes[i] = static_cast<char>(static_cast<unsigned char>(std::clamp(values[i], 0.0, 255.0)));
  }
}

bool C3dParameters::add_group(std::string_view group, std::string_view description) {
  if (has_group(group)) return false;
  int id = 1;
  const auto is_taken = [&](const C3dRecord& record) { return std::abs(record.group) == id; };
  while (id <= 127 && std::ranges::any_of(records_, is_taken)) ++id;
  if (id > 127) return false;
  std::string body(1, static_cast<char>(description.size()));
  body += description;
  records_.push_back(
      {.group = -id, .locked = false, .name = std::string(group), .body = std::move(body)});
  return true;
}

void C3dParameters::remove_group(std::string_view group) {
  const int id = id_of(group);
  if (id != 0)
    std::erase_if(records_, [=](const C3dRecord& record) { return std::abs(record.group) == id; });
}

void C3dParameters::add(std::string_view group, std::string_view name, int type,
                        const std::vector<std::size_t>& extents, std::string_view data) {
  std::string body;
  body += static_cast<char>(type);
  body += static_cast<char>(extents.size());
  for (const std::size_t extent : extents) body += static_cast<char>(extent);
  body += data;
  body += '\0';  // no description
  records_.push_back(
      {.group = id_of(group), .locked = false, .name = std::string(name), .body = std::move(body)});
}

void C3dParameters::add_word(std::string_view group, std::string_view name, unsigned value) {
  const auto bytes = numbers_.word_bytes(value);
  add(group, name, 2, {}, {bytes.data(), bytes.size()});
}

void C3dParameters::add_words(std::string_view group, std::string_view name,
                              const std::vector<unsigned>& values) {
  std::string data;
  for (const unsigned value : values) {
    const auto bytes = numbers_.word_bytes(value);
    data.append(bytes.data(), bytes.size());
  }
  add(group, name, 2, {values.size()}, data);
}

void C3dParameters::add_real(std::string_view group, std::string_view name, double value) {
  const auto bytes = numbers_.real_bytes(value);
  add(group, name, 4, {}, {bytes.data(), bytes.size()});
}

void C3dParameters::add_text(std::string_view group, std::string_view name, std::string_view text) {
  add(group, name, -1, {text.size()}, text);
}

void C3dParameters::add_texts(std::string_view group, std::string_view name,
                              const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  const std::size_t most = std::min(most_in_parameter, most_bytes / width);
  std::size_t number = 0;
  for (std::size_t first = 0; first < texts.size() || number == 0; first += most) {
    const std::size_t count = std::min(most, texts.size() - first);
    std::string data;
    for (std::size_t i = first; i < first + count; ++i)
      data += texts[i] + std::string(width - texts[i].size(), ' ');
    add(group, series_name(name, ++number), -1, {width, count}, data);
  }
}

void C3dParameters::add_reals(std::string_view group, std::string_view name,
                              const std::vector<double>& values) {
  std::size_t number = 0;
  for (std::size_t first = 0; first < values.size(); first += most_in_parameter) {
    const std::size_t count = std::min(most_in_parameter, values.size() - first);
    std::string data;
    for (std::size_t i = first; i < first + count; ++i) {
      const auto bytes = numbers_.real_bytes(values[i]);
      data.append(bytes.data(), bytes.size());
    }
    add(group, series_name(name, ++number), 4, {count}, data);
  }
}

std::string C3dParameters::bytes() const {
  std::string result;
  for (const C3dRecord& record : records_) {
    const int length = static_cast<int>(record.name.size());
    result += static_cast<char>(record.locked ? -length : length);
    result += static_cast<char>(record.group);
    result += record.name;
    const auto offset = numbers_.word_bytes(static_cast<unsigned>(record.body.size() + 2));
    result.append(offset.data(), offset.size());
    result += record.body;
  }
  return result + std::string(2, '\0');
}

std::string C3dParameters::series_name(std::string_view name, std::size_t number) const {
  return number == 1 ? std::string(name) : fmt::format("{}{}", name, number);
}

}  // namespace moclean
