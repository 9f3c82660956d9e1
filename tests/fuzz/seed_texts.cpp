#include "fuzz/seed_texts.hpp"

#include "moclean/core/error.hpp"
#include "moclean/denoise/chain.hpp"

#include "formats/tiny_files.hpp"

namespace moclean::fuzz {

const std::string_view other_bvh = R"(# exported
HIERARCHY
ROOT a b
{
  OFFSET 0,5 1 0
  CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
  JOINT a
  {
    OFFSET 1 0 0
    CHANNELS 0
    End Site tip
    {
      OFFSET 0 1,25 0
    }
  }
}
ROOT a
{
  OFFSET 0 0 0
  CHANNELS 3 Zposition Xrotation Yrotation
}
MOTION
Frame Time: ,0333333
Frames : 3.0
1,5 2 3 10 20 30
-4e1 -1.#IND 5
1 2 3 nan 20 30
4 1 5
1 2 3 10 20 30 4 1
)";

const std::string_view config_text = R"(method = "median"
output = "clean"
input = ["a.bvh", "b.bvh"]
missing = [0, -9999]
jobs = 2
quiet = true
rate = 120.0

[[folder]]
path = "walks/slow"
method = "hampel:window=7,sigmas=3+slra:rho=1.6"
frames = "0:40"
columns = "t,(xyz)*"
)";

const std::string_view other_grid = R"(seeds = 2

[[take]]
file = "${PLACE:-nowhere}/${PLACE}walk.npy"
thin = 2
skeleton = "walk.asf"

[[noise]]
spec = "gap:count=1,length=3"

[[method]]
spec = "none"
)";

const std::string_view cells_text =
    R"({"key":"a","frames":7,"unconverged":0,"figures":{"fd":0.1,"rmse":null}})"
    "\n"
    R"({"key":"b","frames":7,"unconverged":1,"figures":{},"refused":"why"})"
    "\n";

const std::string_view manifest_text =
    R"({"output":"take.csv","input":"/in/take.bvh",)"
    R"("input_hash":"0123456789abcdef","input_size":12,)"
    R"("version":"0.1.0","parameters":{"method":"none"},"outputs":{"take.csv":"0123456789abcdef",)"
    R"("take.mask.csv":"0123456789abcdef"}})"
    "\n"
    R"({"output":"a\\x5C.csv","input":"../b.bvh","outputs":{}})"
    "\n";

const std::string_view tuning_text = R"({
  "format": "moclean tuning",
  "version": 1,
  "device": "n",
  "platform": "p",
  "driver": "d",
  "tuning": {
    "tile_rows": 6,
    "tile_vectors": 3,
    "sweep_rows": 48,
    "panel": 2,
    "form": "gpu",
    "products": "clblast",
    "work_group": 32,
    "eigen": "gpu",
    "batch_segments": 64,
    "queues": 3
  }
}
)";

std::vector<std::string> table_texts() {
  return {
      std::string(test::tiny_csv),
      "\xEF\xBB\xBFtime,hip.x,hip.y,hip.z,note\n0.00,1,2,3,a\n0.01,1,,nan,b\n0.02,4,5,6,c\n",
      "sep=;\n\"Hips, x\";\"Hips, y\"\n1,5;2\n3,5;4\n;;\n",
      std::string("\xFF\xFE") + std::string("a\0,\0b\0\n\0"
                                            "1\0,\0"
                                            "2\0\n\0",
                                            16),
      "# A.x A.y A.z\n1.500000000000000000e+00 2.000000000000000000e+00 nan\n4 5 6\n",
      "Frame\tTime\tx1\ty1\tz1\tX.1\tY.1\tZ.1\n1\t12:34:56.789\t1\t2\t3\t4\t5\t6\n"
      "2\t12:34:56.799\t1\t2\t3\t4\t5\t6\n",
      "scorer,net,net,net,net,net,net\nbodyparts,nose,nose,nose,ear,ear,ear\n"
      "coords,x,y,likelihood,x,y,likelihood\n0,1,2,0.9,3,4,0\n1,5,6,0.8,7,8,0.5\n",
      ",nose,nose,ear,ear\n,x,y,x,y\nframe,,,,\n0,1,2,3,4\n1,5,6,7,8\n",
      "frame,keypoint,x,y,z,likelihood\n0,nose,1,2,3,1\n0,ear,1,2,3,1\n1,nose,1,2,3,1\n",
      "Format Version,1.23,Take Name,walk,Capture Frame Rate,120.000000,Export Frame Rate,100.0,"
      "Total Exported Frames,2,Length Units,Meters\n\n,Type,Bone,Bone,Bone,Marker,Marker,Marker\n"
      ",Name,S:H,S:H,S:H,S:L,S:L,S:L\n,ID,\"2\",\"2\",\"2\",\"3\",\"3\",\"3\"\n"
      ",,Position,Position,Position,Position,Position,Position\n"
      "Frame,Time (Seconds),X,Y,Z,X,Y,Z\n0,0.00,9,9,9,1.5,2.5,3.5\n1,0.01,9,9,9,,,\n",
      "Trajectories\n100\n,,Ann:LFHD,,,Ann:RFHD,,,Ann:LFHD,\n"
      "Frame,Sub Frame,X,Y,Z,X,Y,Z,X',Y'\n,,mm,mm,mm,mm,mm,mm,mm/s,mm/s\n"
      "11,0,1.5,2.5,3.5,,,,0,0\n12,0,1.6,2.6,3.6,4,5,6,0,0\n"
      "\nDevices\n1000\n,,Force.Fx\nFrame,Sub Frame,Fx\n,,N\n11,0,5\n11,1,6\n12,0,7\n",
      "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t100\nNO_OF_ANALOG\t0\n"
      "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nTIME_STAMP\t2020-01-01, 10:00:00\nDATA_INCLUDED\t3D\n"
      "MARKER_NAMES\tHead\tToe\n1.5\t2\t3\t4\t5\t6\n0.000\t0.000\t0.000\t4\t5\t6\n",
      "'=a.x,'+b.y,-c.z\n#N/A,1.#IND,<NA>\n-9999,1e-300,1e140\n",
  };
}

std::vector<std::string> column_texts() {
  const std::string row = "\n0,1,2,3,4,5,6\n0.01,1,2,3,4,5,6\n";
  return {"t,(xyz)*\ntime,a.x,a.y,a.z,b.x,b.y,b.z" + row,
          "i 2(xyc)\nf,1,2,3,4,5,6" + row,
          "oxyz2p\nf,1,2,3,4,5,6,7" + row,
          "points3\nt,1,2,3,4,5,6" + row,
          "points2\nt,1,2,3,4,5,6" + row,
          "plain\nt,1,2,3,4,5,6" + row,
          "automatic\nt,1,2,3,4,5,6" + row};
}

std::vector<std::string> method_texts() {
  std::vector<std::string> texts;
  for (const std::string_view name : step_names()) {
    texts.emplace_back(name);
    try {
      texts.push_back(to_string(parse_chain(name)));
    } catch (const ArgumentError&) {
      continue;  // it has a parameter without default
    }
  }
  texts.emplace_back("tsvd:rank=10,segments=3");
  texts.emplace_back("hampel:window=7,sigmas=3+butterworth:cutoff=10");
  texts.emplace_back("slra:segment=auto,rho=1.6e+0+median:window=5");
  return texts;
}

std::vector<std::string> noise_texts() {
  return {"gaussian-frames:frames=400,mean=1,sd=1.2",
          "gap:fraction=0.1+gaussian-frames:fraction=0.3",
          "gaussian:snr=15",
          "dropout:fraction=0.1,fill=nan,background=none,snr=1e+1",
          "burst:count=3,length=60,sd=5",
          "swap:fraction=0.1,length=6",
          "drift:count=1",
          "ramp:count=1,sd=2",
          "jitter:sd=1,cutoff=6",
          "round:step=0.01",
          "white:sd-mm=3,unit-mm=25.4",
          "limb-swap:count=1,length=30",
          "inertial-drift:sd=2,of=limb"};
}

}  // namespace moclean::fuzz
