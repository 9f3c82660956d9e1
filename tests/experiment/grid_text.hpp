#pragma once

namespace moclean::test {

/// A grid file with two takes, a noise and two methods, line by line as tests of it count.
inline constexpr const char* grid_text = R"(seeds = [3, 1]
columns_exclude = ["hand"]

[[take]]
file = "walk.npy"
frames = "2:8"
rate = 60
columns_exclude = ["Toe"]

[[take]]
file = "${PLACE:-nowhere}/run.npy"
label = "run"
optional = true

[[noise]]
spec = "gap:count=1,length=3+gaussian-frames:fraction=0.5"
label = "both"

[[method]]
spec = "none"

[[method]]
spec = "hampel:window=5+slra:rho=1.7"
label = "chain"
)";

}  // namespace moclean::test
