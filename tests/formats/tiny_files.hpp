#pragma once

#include <string_view>

// The smallest files that use every part of their format. Positions are easy to find on paper.
namespace moclean::test {

/// Three joints: hip, knee (rotated about x), foot; two frames at 120 Hz.
inline constexpr std::string_view tiny_bvh = R"(HIERARCHY
ROOT hip
{
  OFFSET 0.0 0.0 0.0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT knee
  {
    OFFSET 0 -2 0
    CHANNELS 1 Xrotation
    JOINT foot
    {
      OFFSET 0 -3 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 0 1
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: .0083333
1 2 3 0 0 0 90 0 0 0
1 2 3 90 0 0 0 0 0 0
)";

/// Root, thigh (length 2, downwards, axis turned by 90 degrees about z) and shin (length 3).
inline constexpr std::string_view tiny_asf = R"(# comment
:version 1.10
:name tiny
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  two bones: nothing else # here
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name shin
    direction 0 -1 0
    length 3
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name thigh
    direction 0 -1 0
    length 2
    axis 0 0 90 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-70.0 inf)
  end
:hierarchy
  begin
    root thigh
    thigh shin
  end
)";

/// Rest but for the thigh, then a thigh turned about z, then a root turned about x and z.
inline constexpr std::string_view tiny_amc = R"(#!OML:ASF tiny.asf
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
thigh 90 0
2
thigh 0 90
root 1 2 3 0 0 0
3
root 1 2 3 90 0 90
thigh 0 0
)";

/// Two markers, three frames at 100 Hz; a is missing in the second, b in the third.
inline constexpr std::string_view tiny_trc =
    "PathFileType\t4\t(X/Y/Z)\ttiny.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\n"
    "100.00\t100.00\t3\t2\tmm\t100.00\t1\t3\n"
    "Frame#\tTime\tR Heel\t\t\tb\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "1\t0.000\t1.50\t-2.25\t3\t4.00\t5.00\t6.00\n"
    "2\t0.010\t\t\t\t4.10\t5.10\t6.10\n"
    "3\t0.020\t1.70\t-2.45\t3.2\t\t\t\n";

inline constexpr std::string_view tiny_csv = R"(# frame_rate: 120
# unit: mm
"hip, left",hip.y,hip.z
1.5,-2,3e-3
nan,,NaN
)";

/// Two angles, three frames at 100 Hz.
inline constexpr std::string_view tiny_mot =
    "Coordinates\nversion=1\nnRows=3\nnColumns=3\ninDegrees=yes\n\nendheader\n"
    "time\thip_flexion\tknee_angle\n"
    "0.00\t10.5\t20\n"
    "0.01\t11.5\tnan\n"
    "0.02\t12.5\t24\n";

}  // namespace moclean::test
