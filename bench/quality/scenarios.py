"""What is measured on what: takes, damages, methods. Parameters are fixed, whatever the damage."""
import re

UNIT_MM = 25.4 / 0.45  # of the ASF files of CMU and HDM05

PAPER = "gaussian-frames:fraction=0.3333,mean=1,sd=1.2"
SCENARIOS = [
    ("paper noise", PAPER),
    ("small noise", "gaussian-frames:fraction=0.3333,mean=0,sd=0.2"),
    ("20 dB", "gaussian:snr=20"),
    ("1 dB", "gaussian:snr=1"),
    ("30 % dropped, 15 dB", "dropout:fraction=0.3,fill=nan,snr=15"),
    ("40 % dropped, 15 dB", "dropout:fraction=0.4,fill=nan,snr=15"),
    ("30 % zeros, 15 dB", "dropout:fraction=0.3,fill=zero,snr=15"),
    ("bursts of 5", "burst:fraction=0.05,length=5,sd=3"),
    ("bursts of 15", "burst:fraction=0.05,length=15,sd=3"),
    ("bursts of 30", "burst:fraction=0.05,length=30,sd=3"),
    ("bursts of 60", "burst:fraction=0.05,length=60,sd=3"),
    ("ramps of 60", "ramp:fraction=0.05,length=60,sd=3"),
    ("drifts of 240", "drift:fraction=0.05,length=240,sd=3"),  # 100 in short takes: in_short_takes()
    ("swaps of 60", "swap:fraction=0.025,length=60"),
    ("gaps of 10", "gap:fraction=0.05,length=10"),
    ("gaps of 30", "gap:fraction=0.05,length=30"),
    ("gaps of 60", "gap:fraction=0.05,length=60"),
    ("gaps of 120", "gap:fraction=0.05,length=120"),
    ("gaps of 60, paper noise", "gap:fraction=0.05,length=60+" + PAPER),
    ("nothing", "gaussian:sd=0"),
    ("limb swap of 60", "limb-swap:count=1,length=60"),
    ("a limb drifts away", "inertial-drift:sd=3,of=limb"),
    ("the body drifts away", "inertial-drift:sd=3"),
]
METHODS = [
    ("auto", "auto"),
    ("tslra", "tslra"),
    ("slra 400", "slra:segment-length=400"),
    ("rpca", "rpca"),
    ("median 7", "median:window=7"),
    ("Hampel 11", "hampel:window=11,sigmas=3"),
    ("Butterworth 6 Hz", "butterworth:cutoff=6"),
    ("linear", "interpolate:kind=linear"),
    ("cubic", "interpolate:kind=cubic"),
    ("PCHIP", "interpolate:kind=pchip"),
    ("noisy", "none"),
]
DEVELOPMENT = [("14/14_06", "600:1400"), ("02/02_05", "300:1100"), ("49/49_18", "0:800"),
               ("05/05_12", "200:1000"), ("17/17_10", "0:800")]
OTHERS = [("14/14_24", "500:1300"), ("02/02_01", None), ("09/09_12", "300:1100"),
          ("16/16_22", None), ("09/09_06", None)]
EXTREMITIES = ["wrist", "hand", "finger", "thumb", "toe"]
MARKER_RATES = {"mocap36": 100, "02_01": 120, "03_rolling": 175}


def mm(length):
    """A length in millimetres as a number in the unit of the ASF files."""
    return f"{length / UNIT_MM:.6g}"


# Noise that belongs to how a take was recorded; (label, specification, rates that have it).
CLEAN = ("nothing", "gaussian:sd=0", (120, 60, 30))
RECORDING_NOISES = [
    ("rounded to 1 mm", f"round:step={mm(1)}", (120, 60, 30)),
    ("rounded to 1 cm", f"round:step={mm(10)}", (120, 60, 30)),
    ("white, 1 mm", "white:sd-mm=1", (120, 60, 30)),
    ("white, 3 mm", "white:sd-mm=3", (120, 60, 30)),
] + [(f"jitter, {sd} mm at {cutoff} Hz{label}", f"jitter:sd={mm(sd)},cutoff={cutoff}{swap}", (60, 30))
     for label, swap in (("", ""), (", limb swap", "+limb-swap:count=1,length=10"))
     for sd in (5, 20) for cutoff in (3, 6)]

# Filters of whose grids the best parameter per row counts: chosen with the truth, which no user has.
FILTERS = (
    [(f"Savitzky-Golay {w}", f"savitzky-golay:window={w},order=3") for w in (5, 7, 9, 11, 15, 21, 31)]
    + [(f"Whittaker {x}", f"whittaker:lambda={x}") for x in ("0.1", "1", "3", "10", "30", "100", "300",
                                                            "1000", "1e4", "1e5")]
    + [(f"Kalman {x}", f"kalman:model=acceleration,process={x}") for x in ("1e4", "1e5", "1e6", "1e7",
                                                                        "1e8", "1e9")]
    + [(f"Butterworth {f} Hz", f"butterworth:cutoff={f}") for f in (3, 5, 8, 12)])


def in_short_takes(scenarios):
    """The same, no run longer than 100 frames: of takes that have 130 or more."""
    shorter = lambda text: re.sub(r"(240|120)\b", "100", text)
    return [(shorter(label), shorter(spec)) for label, spec in scenarios]
