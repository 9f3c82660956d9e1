#include "moclean/formats/column_roles.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/nan.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  if (text.ends_with(',')) names.emplace_back();
  return names;
}

ColumnRoles roles_of_names(const std::string& text) {
  const std::vector<std::string> names = split_names(text);
  return recognise_columns(names, Matrix::Zero(2, static_cast<Index>(names.size())));
}

// The samples in one line.
std::string samples_of(const ColumnRoles& roles) {
  std::string text;
  for (const std::string& name : roles.sample_names()) text += name + ",";
  if (!text.empty()) text.pop_back();
  return text;
}

// A letter per column: c coordinate, l confidence, t time, i index, a angle, p plain, o other.
std::string letters_of(const ColumnRoles& roles) {
  std::string text;
  for (const ColumnRole role : roles.roles) text += "cltiapo"[static_cast<int>(role)];
  return text;
}

struct NamedPoints {
  std::string names, samples;
};
class PointNames : public testing::TestWithParam<NamedPoints> {};

TEST_P(PointNames, BecomeCoordinatesOfPoints) {
  EXPECT_EQ(samples_of(roles_of_names(GetParam().names)), GetParam().samples);
}

INSTANTIATE_TEST_SUITE_P(
    Spellings, PointNames,
    testing::Values(
        NamedPoints{"A.x,A.y,A.z,B.x,B.y,B.z", "A.x,A.y,A.z,B.x,B.y,B.z"},
        NamedPoints{"A_x,A_y,A_z", "A.x,A.y,A.z"}, NamedPoints{"A:X,A:Y,A:Z", "A.x,A.y,A.z"},
        NamedPoints{"A x,A y,A z", "A.x,A.y,A.z"}, NamedPoints{"A-X,A-Y,A-Z", "A.x,A.y,A.z"},
        NamedPoints{"x(A),y(A),z(A)", "A.x,A.y,A.z"}, NamedPoints{"A[x],A[y],A[z]", "A.x,A.y,A.z"},
        NamedPoints{"A X (mm),A Y (mm),A Z (mm)", "A.x,A.y,A.z"},
        NamedPoints{"A/x,A/y,A/z", "A.x,A.y,A.z"}, NamedPoints{"A - x,A - y,A - z", "A.x,A.y,A.z"},
        NamedPoints{"xHip,yHip,zHip", "Hip.x,Hip.y,Hip.z"},
        NamedPoints{"A_x_mm,A_y_mm,A_z_mm", "A.x,A.y,A.z"},
        NamedPoints{"X.A,Y.A,Z.A", "A.x,A.y,A.z"}, NamedPoints{"x_A,y_A,z_A", "A.x,A.y,A.z"},
        NamedPoints{"X A,Y A,Z A", "A.x,A.y,A.z"},
        NamedPoints{"S:A:X,S:A:Y,S:A:Z", "S:A.x,S:A.y,S:A.z"},
        NamedPoints{"S:A_x,S:A_y,S:A_z", "S:A.x,S:A.y,S:A.z"},
        NamedPoints{"LHip X,LHip Y,LHip Z", "LHip.x,LHip.y,LHip.z"},
        NamedPoints{"pos_x,pos_y,pos_z", "pos.x,pos.y,pos.z"},
        NamedPoints{"A.Xposition,A.Yposition,A.Zposition", "A.x,A.y,A.z"},
        NamedPoints{"A_x_3d,A_y_3d,A_z_3d", "A.x,A.y,A.z"},
        NamedPoints{"A_x_coord,A_y_coord,A_z_coord", "A.x,A.y,A.z"},
        NamedPoints{"A_pos_x,A_pos_y,A_pos_z", "A.x,A.y,A.z"},
        NamedPoints{"A.position.x,A.position.y,A.position.z", "A.x,A.y,A.z"},
        NamedPoints{"A x position [mm],A y position [mm],A z position [mm]", "A.x,A.y,A.z"},
        NamedPoints{"A-X [mm],A-Y [mm],A-Z [mm]", "A.x,A.y,A.z"},
        NamedPoints{"A_tx,A_ty,A_tz,B_tx,B_ty,B_tz", "A.x,A.y,A.z,B.x,B.y,B.z"},
        NamedPoints{"A_x_2d,A_y_2d,A_x_3d,A_y_3d,A_z_3d", "A_2d.x,A_2d.y,A_3d.x,A_3d.y,A_3d.z"},
        NamedPoints{"A_x,A_y,A_z,A_world_x,A_world_y,A_world_z",
                    "A.x,A.y,A.z,A_world.x,A_world.y,A_world.z"},
        NamedPoints{"AX,AY,AZ,noseX,noseY,noseZ", "A.x,A.y,A.z,nose.x,nose.y,nose.z"},
        NamedPoints{"C7x,C7y,C7z", "C7.x,C7.y,C7.z"},
        NamedPoints{"x1,y1,z1,x2,y2,z2", "point1.x,point1.y,point1.z,point2.x,point2.y,point2.z"}),
    [](const auto& test) { return "kind" + std::to_string(test.index); });

INSTANTIATE_TEST_SUITE_P(
    Orders, PointNames,
    testing::Values(
        NamedPoints{"A.z,A.x,A.y", "A.x,A.y,A.z"},
        NamedPoints{"B_x,A_x,B_y,A_y,B_z,A_z", "B.x,B.y,B.z,A.x,A.y,A.z"},
        NamedPoints{"A.X,A.y,A.Z", "A.x,A.y,A.z"},
        NamedPoints{"X,Y,Z,X,Y,Z", "point1.x,point1.y,point1.z,point2.x,point2.y,point2.z"},
        NamedPoints{"X,X,Y,Y,Z,Z", "point1.x,point1.y,point1.z,point2.x,point2.y,point2.z"},
        NamedPoints{"X,Y,Z,X.1,Y.1,Z.1,X.2,Y.2,Z.2",
                    "point1.x,point1.y,point1.z,point2.x,point2.y,point2.z,point3.x,point3.y,"
                    "point3.z"},
        NamedPoints{"A.x,A.y,A.z,A.x,A.y,A.z", "A.x,A.y,A.z,A_2.x,A_2.y,A_2.z"},
        NamedPoints{"A_x,A_y,B_x,B_y", "A.x,A.y,B.x,B.y"}, NamedPoints{"x,y", "point1.x,point1.y"}),
    [](const auto& test) { return "kind" + std::to_string(test.index); });

// Names that tell of other things than places; no sample is lost where there are no points.
INSTANTIATE_TEST_SUITE_P(NoPoints, PointNames,
                         testing::Values(NamedPoints{"hip_flexion,knee_angle,pelvis_tx",
                                                     "hip_flexion,knee_angle,pelvis_tx"},
                                         NamedPoints{"lean,list,A_tx,A_ty,A_tz,hip,knee,ankle",
                                                     "lean,list,A_tx,A_ty,A_tz,hip,knee,ankle"},
                                         NamedPoints{"x", "x"}, NamedPoints{"Fx,Fy,Fz", "Fx,Fy,Fz"},
                                         NamedPoints{"q.w,q.x,q.y,q.z", "q.w,q.x,q.y,q.z"},
                                         NamedPoints{"A.x,B.y,C.z", "A.x,B.y,C.z"},
                                         NamedPoints{"max,may,maz", "max,may,maz"},
                                         NamedPoints{"acc_x,acc_y,acc_z", "acc_x,acc_y,acc_z"},
                                         NamedPoints{"index,suffix", "index,suffix"}),
                         [](const auto& test) { return "kind" + std::to_string(test.index); });

struct NamedRoles {
  std::string names, letters;
};
class ColumnNames : public testing::TestWithParam<NamedRoles> {};

TEST_P(ColumnNames, TellTheRoles) {
  EXPECT_EQ(letters_of(roles_of_names(GetParam().names)), GetParam().letters);
}

INSTANTIATE_TEST_SUITE_P(
    Others, ColumnNames,
    testing::Values(
        NamedRoles{"Frame,Time (Seconds),A_x,A_y,A_z", "itccc"},
        NamedRoles{"A.x,A.y,A.z,time_ms,frame_index", "cccti"},
        NamedRoles{"timestamp,A_x,A_y,A_z,label", "tccco"}, NamedRoles{"TIME,a,b", "tpp"},
        NamedRoles{"t(s),t [s],a", "top"}, NamedRoles{"fnum,A_x,A_y,A_z", "iccc"},
        NamedRoles{"A_x,A_y,A_likelihood,B_x,B_y,B_likelihood", "cclccl"},
        NamedRoles{"A_x,A_y,A_z,A_visibility,A_presence", "cccll"},
        NamedRoles{"x,y,score,x,y,score", "cclccl"},
        NamedRoles{"x,y,confidence,x.1,y.1,confidence.1", "cclccl"},
        NamedRoles{"noseX,noseY,noseScore", "ccl"}, NamedRoles{"c_A,x_A,y_A", "lcc"},
        NamedRoles{"A_x,A_y,A_z,A_error,A_ncams,A_score", "cccool"},
        NamedRoles{"A_x,A_y,A_z,A_rot_x,A_rot_y,A_rot_z", "cccaaa"},
        NamedRoles{"A.x,A.y,A.z,A.qw,A.qx,A.qy,A.qz", "cccaaaa"},
        NamedRoles{"A.X,A.Y,A.Z,B.X,B.Y,B.Z,B.W", "cccaaaa"},
        NamedRoles{"A.Xposition,A.Yposition,A.Zposition,A.Xrotation", "ccca"},
        NamedRoles{"A_x,A_y,A_z,RotX,RotY,RotZ", "cccaaa"},
        NamedRoles{"A_x,A_y,A_z,A_vel_x,A_vel_y,A_vel_z,speed", "cccoooo"},
        NamedRoles{"A_x,A_y,A_z,B_x", "ccco"}, NamedRoles{"class,x1,y1,z1,v1", "occcl"},
        NamedRoles{"x0,y0,c0,x1,y1,c1", "cclccl"}, NamedRoles{"TX,TY,TZ,RX,RY,RZ", "cccaaa"},
        NamedRoles{"p_X,p_Y,p_Z,p_Ox,p_Oy,p_Oz", "cccaaa"}, NamedRoles{"M0X,M0Y,M0Z", "ccc"},
        NamedRoles{"A_x,A_y,box_x,box_y,box_w,box_h", "ccoooo"}),
    [](const auto& test) { return "kind" + std::to_string(test.index); });

TEST(ColumnRoles, TakeAConfidenceToItsPoint) {
  const ColumnRoles roles = roles_of_names("B_score,A_x,A_y,A_score,B_x,B_y");

  ASSERT_EQ(roles.points.size(), 2U);
  EXPECT_EQ(roles.points[0].name, "A");
  EXPECT_EQ(roles.points[0].confidence, 3U);
  EXPECT_EQ(roles.points[1].confidence, 0U);
}

TEST(ColumnRoles, TakeAColumnWithoutANameForAnIndexOnlyIfItCounts) {
  const std::vector<std::string> names = {"Unnamed: 0", "A_x", "A_y", "A_z", ""};
  const Matrix counting{{5, 1, 2, 3, test::nan}, {6, 1, 2, 3, test::nan}};
  const Matrix thinned{{5, 1, 2, 3, test::nan}, {8, 1, 2, 3, test::nan}};
  const Matrix other{{5, 1, 2, 3, test::nan}, {5.5, 1, 2, 3, test::nan}};

  EXPECT_EQ(letters_of(recognise_columns(names, counting)), "iccco");
  EXPECT_EQ(letters_of(recognise_columns(names, thinned)), "iccco");
  EXPECT_EQ(letters_of(recognise_columns(names, other)), "occco");
  EXPECT_EQ(letters_of(recognise_columns({"id", "b", ""}, Matrix{{1, 1, 1}, {2, 1, 1}})), "ipp");
  EXPECT_EQ(letters_of(recognise_columns({"id", "b", ""}, Matrix{{1, 1, test::nan}})), "ppo");
}

TEST(ColumnRoles, AreDescribedInOneLine) {
  EXPECT_EQ(roles_of_names("S:A:X,S:A:Y,S:A:Z,n").described(),
            "1 point of three coordinates (names like 'S:A:X')");
  EXPECT_EQ(roles_of_names("A_x,A_y,B_x,B_y").described(),
            "2 points of two coordinates (names like 'A_x')");
  EXPECT_EQ(roles_of_names("a,b").described(), "2 channels; no names tell of points");
}

TEST(ColumnRoles, OfAHundredThousandColumnsTakeNoLong) {
  std::vector<std::string> names;
  for (int i = 0; i < 25000; ++i)
    for (const char* ending : {"_x", "_y", "_z", "_score"})
      names.push_back("M" + std::to_string(i) + ending);

  const ColumnRoles roles = recognise_columns(names, Matrix::Zero(1, 100000));

  EXPECT_EQ(roles.points.size(), 25000U);
  EXPECT_EQ(std::ranges::count(roles.roles, ColumnRole::confidence), 25000);
}

std::string specified(const std::string& specification, std::size_t width) {
  const ColumnRoles roles =
      parse_column_roles(specification, std::vector<std::string>(width, std::string()));
  return letters_of(roles) + " " + samples_of(roles);
}

TEST(ColumnSpecification, GivesEveryColumnItsRole) {
  EXPECT_EQ(specified("itxyzcpo", 8), "itccclpo point1.x,point1.y,point1.z,");
  EXPECT_EQ(specified("xyxy", 4), "cccc point1.x,point1.y,point2.x,point2.y");
  EXPECT_EQ(specified("zyxo", 4), "ccco point1.x,point1.y,point1.z");
  EXPECT_EQ(specified("2(xyc)", 6), "cclccl point1.x,point1.y,point2.x,point2.y");
  EXPECT_EQ(specified("t(xyz)*", 7),
            "tcccccc point1.x,point1.y,point1.z,point2.x,point2.y,point2.z");
  EXPECT_EQ(specified("o2(2(xy)o)", 11).substr(0, 11), "occccocccco");
  EXPECT_EQ(specified("3p", 3), "ppp ,,");
  EXPECT_EQ(specified("i, t, (x,y)*", 4), specified("it(xy)*", 4));
}

TEST(ColumnSpecification, NamesPointsAfterTheirColumns) {
  const ColumnRoles roles =
      parse_column_roles("xyzxyz", {"hip_x", "hip_y", "hip_z", "a", "b", "c"});

  EXPECT_THAT(roles.sample_names(),
              ElementsAre("hip.x", "hip.y", "hip.z", "point2.x", "point2.y", "point2.z"));
}

TEST(ColumnSpecification, RefusesWhatItIsNot) {
  const auto failure = [](const std::string& specification, std::size_t width,
                          const std::string& message) {
    EXPECT_THAT([&] { specified(specification, width); },
                ThrowsMessage<ArgumentError>(HasSubstr(message)))
        << specification;
  };

  failure("xyz", 4, "--columns xyz tells of 3 columns, there are 4");
  failure("xyzxyz", 4, "--columns xyzxyz tells of 6 columns, there are 4");
  failure("(xyz)*", 4, "--columns (xyz)* tells of 6 columns, there are 4");
  failure("999999999999(xyz)", 4, "tells of far more columns, there are 4");
  failure("9(9(9(9(9(9(9(9(9(9(xyz))))))))))", 4, "tells of far more columns, there are 4");
  failure("xq", 2,
          "--columns xq: expected one of t i x y z c p o, or a group in ( ) at character 2");
  failure("(xy", 2, "expected ) behind a group at character 4");
  failure("xy)", 2, "expected a ( before this ) at character 3");
  failure("()*", 2, "expected letters in a group");
  failure("x*y", 2, "expected a * behind the last group alone");
  failure("0x", 2, "expected a number of times above 0");
  failure("xz", 2, "point 1 lacks its y");
  failure("cxy", 3, "c for column 1 needs a point of its own before it");
  failure("tt", 2, "has more than one time");
  failure("to", 2, "leaves no samples");
  failure(std::string(100, '(') + "x", 2, "expected fewer groups in each other");
}

TEST(ColumnLayouts, SplitAllColumnsThatAreNoTimeOrIndex) {
  const std::vector<std::string> names = {"Frame", "a", "b", "c", "time", "d", "e", "f", ""};
  Matrix rows = Matrix::Zero(1, 9);
  rows(0, 8) = test::nan;

  EXPECT_EQ(letters_of(columns_in_layout(ColumnLayout::points3, names, rows)), "iccctccco");
  EXPECT_EQ(columns_in_layout(ColumnLayout::points2, names, rows).points.size(), 3U);
  EXPECT_EQ(letters_of(columns_in_layout(ColumnLayout::plain, names, rows)), "ippptpppo");
  EXPECT_THAT(
      [&] {
        columns_in_layout(ColumnLayout::points3, {"a", "b"}, Matrix::Zero(1, 2));
      },
      ThrowsMessage<ArgumentError>(
          HasSubstr("--layout points3 needs a multiple of 3 columns beside time and index, "
                    "there are 2")));
}

}  // namespace
}  // namespace moclean
