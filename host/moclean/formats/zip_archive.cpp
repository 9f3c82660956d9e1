#include "moclean/formats/zip_archive.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>
#include <zip.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::uint64_t largest_expansion = 100;  // of positions hardly 2

std::string text_of(zip_error_t& error) {
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

[[noreturn]] void fail(const std::filesystem::path& file, zip_error_t& error) {
  throw FileError(file, "cannot be read as a zip archive: " + text_of(error));
}

zip_source_t* source_of(std::string_view content, const std::filesystem::path& file) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  if (!source) fail(file, error);
  return source;
}

zip_t* opened(zip_source_t* source, int flags, const std::filesystem::path& file) {
  zip_error_t error;
  zip_error_init(&error);
  zip_t* const archive = zip_open_from_source(source, flags, &error);
  if (archive) return archive;
  zip_source_free(source);
  fail(file, error);
}

// Discards what was changed unless it is released.
struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

}  // namespace

ZipArchive::ZipArchive(std::string_view content, std::filesystem::path file)
    : size_(content.size()),
      file_(std::move(file)),
      archive_(opened(source_of(content, file_), ZIP_RDONLY, file_)) {
  auto* const archive = static_cast<zip_t*>(archive_);
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i)
    if (const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW))
      names_.emplace_back(name);
}

ZipArchive::~ZipArchive() { zip_discard(static_cast<zip_t*>(archive_)); }

std::string ZipArchive::member(const std::string& name) const {
  auto* const archive = static_cast<zip_t*>(archive_);
  const auto refuse = [&](std::string_view problem) {
    throw FileError(file_, fmt::format("its member {} {}", excerpt(name), problem));
  };
  zip_stat_t found;
  if (zip_stat(archive, name.c_str(), ZIP_FL_ENC_RAW, &found) != 0) refuse("cannot be found");
  if (found.size > largest_expansion * (size_ + 1))
    refuse(
        fmt::format("has {} bytes, more than {} times the archive", found.size, largest_expansion));
  zip_file_t* const stream = zip_fopen_index(archive, found.index, 0);
  if (!stream) refuse(fmt::format("cannot be read: {}", zip_strerror(archive)));
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> closed(stream, zip_fclose);
  std::string content(found.size, '\0');
  std::size_t length = 0;
  while (length < content.size()) {
    const zip_int64_t read = zip_fread(stream, content.data() + length, content.size() - length);
    if (read <= 0) refuse("is damaged");
    length += static_cast<std::size_t>(read);
  }
  char beyond = 0;  // reading to the end checks the sum
  if (zip_fread(stream, &beyond, 1) != 0) refuse("is damaged");
  return content;
}

std::string with_members(std::string_view content,
                         const std::map<std::string, std::string>& members,
                         const std::filesystem::path& file) {
  constexpr std::int64_t first_day = 315576000;  // 1 January 1980, the first a zip knows
  zip_source_t* const source = source_of(content, file);
  zip_source_keep(source);  // holds the result after closing
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> freed(source, zip_source_free);
  const int flags = content.empty() ? ZIP_CREATE | ZIP_TRUNCATE : 0;
  std::unique_ptr<zip_t, Discard> archive(opened(source, flags, file));
  for (const auto& [name, data] : members) {
    zip_stat_t before;  // stored members stay stored, compressed ones compressed
    const bool is_new = zip_stat(archive.get(), name.c_str(), ZIP_FL_ENC_RAW, &before) != 0;
    const zip_int32_t method = is_new ? ZIP_CM_STORE : before.comp_method;
    zip_source_t* const added = zip_source_buffer(archive.get(), data.data(), data.size(), 0);
    const zip_int64_t index = added ? zip_file_add(archive.get(), name.c_str(), added,
                                                   ZIP_FL_OVERWRITE | ZIP_FL_ENC_UTF_8)
                                    : -1;
    if (index < 0) {
      zip_source_free(added);
      throw FileError(file, fmt::format("cannot be written: {}", zip_strerror(archive.get())));
    }
    const auto place = static_cast<zip_uint64_t>(index);
    zip_set_file_compression(archive.get(), place, method, 0);
    zip_file_set_mtime(archive.get(), place, first_day, 0);
  }
  if (zip_close(archive.get()) != 0)
    throw FileError(file, fmt::format("cannot be written: {}", zip_strerror(archive.get())));
  static_cast<void>(archive.release());
  zip_stat_t found;
  zip_stat_init(&found);
  std::string result;
  if (zip_source_stat(source, &found) != 0 || zip_source_open(source) != 0)
    throw FileError(file, "cannot be written: the archive is empty");
  result.resize(found.size);
  const zip_int64_t read = zip_source_read(source, result.data(), result.size());
  zip_source_close(source);
  if (read < 0 || static_cast<std::size_t>(read) != result.size())
    throw FileError(file, "cannot be written: the archive is not complete");
  return result;
}

}  // namespace moclean
