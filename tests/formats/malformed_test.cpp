#include <algorithm>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"

#include "support/data.hpp"

namespace moclean {
namespace {

struct Case {
  std::string file;     // in tests/data/malformed
  std::string message;  // file, line where there are lines, and what was expected and found
};

class Malformed : public testing::TestWithParam<Case> {};

std::string message_of(const std::string& file) {
  const std::filesystem::path path = test::test_file("malformed") / file;
  const bool is_skeleton = path.extension() == ".asf";
  try {
    read_recording(is_skeleton ? test::test_file("malformed") / "truncated.amc" : path,
                   {.skeleton = is_skeleton ? path : test::test_file("malformed") / "leg.asf"});
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST_P(Malformed, IsRefusedWithFileLineAndExpectation) {
  EXPECT_THAT(message_of(GetParam().file), testing::HasSubstr("/" + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Files, Malformed,
    testing::Values(
        Case{"bad_order.npy",
             "bad_order.npy: bad npy header: expected True or False, found 'Maybe, 'shape': ("},
        Case{"bad_rate.csv", "bad_rate.csv:1: expected a frame rate in Hz, found 'fast'"},
        Case{"bad_rate.trc", "bad_rate.trc:3: expected a number for DataRate, found 'fast'"},
        Case{"beyond_64_bits.npy",
             "beyond_64_bits.npy: bad npy header: expected a number of frames or columns, found "
             "'99999999999999999"},
        Case{"binary.amc", "binary.amc:1: expected a frame number"},
        Case{"binary.asf", "binary.asf:1: expected a section such as :units or :root"},
        Case{"binary.bvh", "binary.bvh:1: expected HIERARCHY"},
        Case{"binary.csv", "binary.csv:2: expected a number"},
        Case{"binary.trc", "binary.trc:1: expected PathFileType, found"},
        Case{"blank_between_words.trc",
             "blank_between_words.trc:7: expected 8 numbers, found 7; which are missing cannot be "
             "told without tabs: write nan for them"},
        Case{"comma_and_point.csv",
             "comma_and_point.csv:3: expected a decimal point, as in other cells, found '1,5'"},
        Case{
            "comma_for_both.csv",
            "comma_for_both.csv:2: expected 2 columns, found 4: if the comma is both separator and "
            "decimal mark, separate by ; or tab"},
        Case{"comma_for_point.trc",
             "comma_for_point.trc:7: expected a number, found '4,5'; decimals stand behind a "
             "point, not a comma"},
        Case{"empty.amc", "empty.amc:1: expected a frame number, found the end of the file"},
        Case{"empty.asf", "empty.asf:1: expected a :hierarchy section, found the end of the file"},
        Case{"empty.bvh", "empty.bvh:1: expected HIERARCHY, found the end of the file"},
        Case{"empty.csv",
             "empty.csv:1: expected a line of column names, found the end of the file"},
        Case{
            "empty.npy",
            "empty.npy: expected an npy file, which starts with '\\x93NUMPY', found an empty file"},
        Case{"empty.trc", "empty.trc:1: expected PathFileType, found the end of the file"},
        Case{"fewer_markers.trc", "fewer_markers.trc:4: expected 1 markers (NumMarkers), found 2"},
        Case{"glued_numbers.bvh",
             "glued_numbers.bvh:14: expected a number, found '3-10.5'; two numbers without a blank "
             "between them"},
        Case{"header_alone.csv",
             "header_alone.csv:2: expected a line of samples, found the end of the file"},
        Case{"huge_channels.bvh",
             "huge_channels.bvh:6: expected a channel (Xposition ... Zrotation), found 'End'"},
        Case{"huge_header.npy",
             "huge_header.npy: the npy header is cut short: expected 4294967307 bytes, found 176"},
        Case{"huge_shape.npy",
             "huge_shape.npy: expected 999999999999 x 3 samples of 8 bytes, found 48 bytes"},
        Case{"infinite.trc", "infinite.trc:7: expected a number, found 'inf'"},
        Case{"length_freedom.asf",
             "length_freedom.asf:15: expected a degree of freedom (tx ty tz rx ry rz), found 'l'"},
        Case{"long_row.csv", "long_row.csv:4: expected 2 columns, found 3"},
        Case{"long_row.trc", "long_row.trc:7: expected 8 cells, found more: '7'"},
        Case{"missing_bone.amc",
             "missing_bone.amc:6: expected bone 'thigh' in frame 1, found the frame's end"},
        Case{"nan.asf", "nan.asf:12: expected a finite number, found 'nan'"},
        Case{"no_axes.npy", "no_axes.npy: expected frames and columns, found an array of shape ()"},
        Case{"no_channels.bvh", "no_channels.bvh:10: no joint has a channel"},
        Case{"no_columns.npy",
             "no_columns.npy: expected frames and columns, found an array of shape (2, 0)"},
        Case{"no_frames.amc",
             "no_frames.amc:4: expected a frame number, found the end of the file"},
        Case{"no_frames.bvh", "no_frames.bvh:15: expected at least one frame, found 'Frames: 0'"},
        Case{"no_hierarchy.asf",
             "no_hierarchy.asf:17: expected a :hierarchy section, found the end of the file"},
        Case{"no_labels.trc", "no_labels.trc:6: expected X1, Y1, Z1 ..., found '1'"},
        Case{"no_length.asf",
             "no_length.asf:15: expected name, direction and length in a bone, bone 'thigh' lacks "
             "length"},
        Case{"no_names.trc",
             "no_names.trc:4: expected Frame#, Time and the markers, found "
             "'\\x09\\x09X1\\x09Y1\\x09Z1\\x09X2\\x09Y2\\x09Z2'"},
        Case{"no_offset.bvh", "no_offset.bvh:9: expected OFFSET in joint 'hip', found its end"},
        Case{"no_rate.trc", "no_rate.trc:3: expected DataRate in the line above, found none"},
        Case{"no_rows.trc", "no_rows.trc:5: expected a row of samples, found the end of the file"},
        Case{"no_rows.bvh", "no_rows.bvh:14: expected 3 frames, found none"},
        Case{"no_shape.npy",
             "no_shape.npy: bad npy header: expected descr, fortran_order and shape"},
        Case{"non_number.amc", "non_number.amc:9: expected a number, found 'O'"},
        Case{"non_number.asf", "non_number.asf:13: expected a number, found 'two'"},
        Case{"non_number.bvh", "non_number.bvh:15: expected a number, found '2o'"},
        Case{"non_number.csv",
             "non_number.csv:4: expected a number, found 'four' in column 2 ('hip.y')"},
        Case{"non_number.trc", "non_number.trc:7: expected a number, found 'four'"},
        Case{"not_numpy.npy",
             "not_numpy.npy: expected an npy file, which starts with '\\x93NUMPY', found 'hip.x,'"},
        Case{"numbers_only.csv",
             "numbers_only.csv:1: expected a line of column names, found numbers; --columns or "
             "--layout say what they are"},
        Case{"other_axes.trc", "other_axes.trc:1: expected coordinates (X/Y/Z), found '(X/Z/Y)'"},
        Case{"overflow.bvh", "overflow.bvh:14: expected a number, found '1e999'"},
        Case{"overflowing_shape.npy",
             "overflowing_shape.npy: expected 4611686018427387904 x 8 samples of 8 bytes, found 48 "
             "bytes"},
        Case{"repeated_bone.amc", "repeated_bone.amc:10: frame 2 gives bone 'thigh' twice"},
        Case{"separated_by_commas.bvh",
             "separated_by_commas.bvh:14: expected a number, found '1.0,'; numbers stand between "
             "blanks, decimals behind a point"},
        Case{"short_labels.trc",
             "short_labels.trc:5: expected X, Y, Z of the 2 markers above, found 5 cells"},
        Case{"short_row.csv", "short_row.csv:4: expected 2 columns, found 1"},
        Case{"short_row.trc", "short_row.trc:7: expected 8 cells, found 7"},
        Case{"skipped_frame.amc",
             "skipped_frame.amc:7: expected frame 2, found 3: 1 frames are missing between"},
        Case{"structured.npy", "structured.npy: holds a structured array; save its coordinates"},
        Case{"time_alone.csv", "time_alone.csv:2: expected columns beside the time"},
        Case{"time_backwards.csv",
             "time_backwards.csv:4: expected a time after 0.1, found 0.05 in column 1 ('time')"},
        Case{"time_of_other_rate.trc",
             "time_of_other_rate.trc:3: expected a Time column of DataRate 100 Hz, found one of 20 "
             "Hz; --rate states which is right"},
        Case{"too_many_numbers.amc",
             "too_many_numbers.amc:9: expected 2 numbers for bone 'thigh', found more"},
        Case{"too_many_numbers.bvh",
             "too_many_numbers.bvh:14: expected 6 numbers per frame, found more: '40'"},
        Case{"trailing_data.npy",
             "trailing_data.npy: expected 2 x 3 samples of 8 bytes, found 56 bytes"},
        Case{"truncated.amc",
             "truncated.amc:9: expected bone 'thigh' in frame 2, found the frame's end"},
        Case{"truncated.asf",
             "truncated.asf:14: expected 'end' of a bone, found the end of the file"},
        Case{"truncated.trc", "truncated.trc:8: expected 8 cells, found 5"},
        Case{"truncated_data.npy",
             "truncated_data.npy: expected 2 x 3 samples of 8 bytes, found 40 bytes"},
        Case{"truncated_header.bvh",
             "truncated_header.bvh:6: expected OFFSET, CHANNELS, JOINT, End Site or '}', found the "
             "end of the file"},
        Case{"truncated_header.npy",
             "truncated_header.npy: the npy header is cut short: expected 128 bytes, found 40"},
        Case{"two_parents.asf", "two_parents.asf:20: bone 'thigh' has a parent already"},
        Case{"unconnected_bone.asf",
             "unconnected_bone.asf:20: bone 'thigh' does not hang on the root"},
        Case{"unknown_axis_order.asf",
             "unknown_axis_order.asf:14: expected an order of axes such as XYZ, found 'XXZ'"},
        Case{"unknown_bone.amc",
             "unknown_bone.amc:9: expected a bone of the skeleton, found 'shin'"},
        Case{"unknown_bone.asf", "unknown_bone.asf:19: expected the name of a bone, found 'shin'"},
        Case{"unknown_channel.bvh",
             "unknown_channel.bvh:5: expected a channel (Xposition ... Zrotation), found "
             "'Wrotation'"},
        Case{"version_9.npy", "version_9.npy: expected npy format 1, 2 or 3, found 9"},
        Case{"wrong_channel_count.bvh",
             "wrong_channel_count.bvh:15: expected 6 numbers per frame, found 5"},
        Case{"wrong_count.amc", "wrong_count.amc:9: expected 2 numbers for bone 'thigh', found 1"},
        Case{"zero_frame_time.bvh",
             "zero_frame_time.bvh:13: expected a positive frame time (--rate states"}),
    [](const auto& test) {
      std::string name = test.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '.'; }, '_');
      return name;
    });

}  // namespace
}  // namespace moclean
