#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_encoding.hpp"

namespace moclean {

/// A table as it was read, so that it can be written again with other samples and nothing else
/// changed.
struct TableDocument {
  DecodedText content;
  std::string_view extension;  ///< of the format that read it, which alone writes it again
  TableShape shape;
  Index frames = 0;
  std::vector<std::string> columns;  ///< names of the samples
  bool uses_confidence = false;      ///< points of confidence 0 are missing
  double least_confidence = 0;       ///< of those that were seen, if it says
  std::vector<double> missing;       ///< numbers that stand for missing samples
  std::string missing_text;          ///< how the file spells the first one, if it has any
};

/// The FramedSource::file of a recording that was read from a table.
struct TableSource {
  std::shared_ptr<const TableDocument> document;
};

/// Reads a table of any head that is known (table_shape.hpp). Throws FileError.
///
/// Cells are numbers, with a decimal point or, where the separator is another, a decimal comma, or
/// say that a sample is missing (says_missing()). Coordinates and plain channels become samples,
/// see recognise_columns(); what the options say of columns goes first. Points whose confidence is
/// exactly 0 are missing, unless all are in all frames. The rate is as stated, or by the time
/// column: seconds unless its name or the size of its values tell of another unit; the option's
/// rate goes before both. Text is an error in a column that has numbers; plain columns that have
/// none pass through.
Recording read_table(std::string_view content, const std::filesystem::path& file,
                     const ReadOptions& options, std::string_view extension);

/// The document of a recording that read_table() read for that extension and that still has its
/// columns and unit; null of any other.
const TableDocument* table_of(const Recording& recording, std::string_view extension);

/// Writes a recording into the text it was read from: samples that have other values now as the
/// shortest text that reads back as the same double, those that are missing now as the file spells
/// that, a rate and number of frames where the head states them; all else, and rows of the frames
/// there are, byte for byte. A point of confidence 0 that has coordinates now gets the least
/// confidence above 0 that the file has, or it would be missing again to its readers. Precondition:
/// `document` is table_of() the recording.
void write_table(AtomicFile& file, const TableDocument& document, const Recording& recording);

}  // namespace moclean
