#!/usr/bin/env python3
"""ezc3d_agreement.py MOCLEAN [DATA]: ezc3d reads what moclean writes, and moclean what ezc3d writes.

Takes the files of DATA/c3d (or $MOCLEAN_DATA) where they are there, and files of its own making.
Exits 77, which is ctest's "skipped", where Python has no ezc3d.
"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

try:
    import ezc3d
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

MOCLEAN = sys.argv[1]
DATA = pathlib.Path(os.environ.get("MOCLEAN_DATA") or (sys.argv[2] if len(sys.argv) > 2 else "."))
failures = 0


def check(claim, holds):
    global failures
    failures += not holds
    print("ok  " if holds else "FAIL", claim)


def run(*arguments):
    subprocess.run([MOCLEAN, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def fill(file, out, *options):
    run("denoise", file, "-o", out, "--backend", "reference", "--method",
        "interpolate:kind=linear", *options)


def read(file):
    return ezc3d.c3d(str(file))


def is_readable(file):
    """Whether ezc3d finds frames: it stops at texts of no extent (mocap36.c3d), has no MIPS."""
    try:
        return read(file)["data"]["points"].shape[2] > 0
    except (OSError, RuntimeError):
        return False


def same(a, b):
    return a.shape == b.shape and np.array_equal(a, b, equal_nan=True)


def same_parameters(a, b):
    for group in a["parameters"]:
        for name, parameter in a["parameters"][group].items():
            if name.startswith("__") or (group, name) == ("POINT", "DATA_START"):
                continue
            if not np.array_equal(np.asarray(parameter["value"]),
                                  np.asarray(b["parameters"][group][name]["value"])):
                print("   ", group, name, parameter["value"], b["parameters"][group][name]["value"])
                return False
    return True


def moclean_samples(file, folder, *options):
    """[frames, 3 x points] as moclean reads it."""
    run("convert", file, folder / "read.npy", *options)
    return np.load(folder / "read.npy")


def in_columns(c3d):
    """[frames, 3 x points] as ezc3d reads it, with NaN where the residual is negative."""
    points = np.array(c3d["data"]["points"][:3])
    points[:, c3d["data"]["meta_points"]["residuals"][0] < 0] = np.nan
    return points.transpose(2, 1, 0).reshape(points.shape[2], -1)


def only_changed(before, after, frames):
    """Of the file before, in those frames, only points that have residual 0 or -1 now may differ."""
    b, a = before["data"], after["data"]
    moved = ~np.all((b["points"][:3, :, frames] == a["points"][:3])
                    | np.isnan(b["points"][:3, :, frames]) & np.isnan(a["points"][:3]), axis=0)
    residuals = a["meta_points"]["residuals"][0]
    kept = ~moved & (residuals == b["meta_points"]["residuals"][0][:, frames])
    return bool(np.all(kept | (residuals <= 0)))


def first_frame(file):
    """The header's, which ezc3d does not give as it is where it is 0."""
    return struct.unpack("<H", file.read_bytes()[6:8])[0]


def judge_real(file, folder):
    out = folder / "out.c3d"
    run("convert", file, out)
    check(f"{file.name}: written without a byte changed", file.read_bytes() == out.read_bytes())
    run("convert", file, folder / "part.c3d", "--frames", "10:110")
    fill(file, out, "--max-gap", "0.1")
    if not is_readable(file):
        return print(f"note {file.name}: ezc3d does not read it")
    before, after, part = read(file), read(out), read(folder / "part.c3d")
    frames = slice(10, 110)
    check(f"{file.name}: a part has the frames' points",
          same(before["data"]["points"][:, :, frames], part["data"]["points"]))
    analogs = before["data"]["analogs"]
    per_frame = max(1, analogs.shape[2] // before["data"]["points"].shape[2])
    check(f"{file.name}: a part has the frames' analog samples",
          analogs.size == 0 or same(analogs[:, :, 10 * per_frame:110 * per_frame],
                                    part["data"]["analogs"]))
    check(f"{file.name}: a part is numbered in the trial",
          first_frame(folder / "part.c3d") == first_frame(file) + 10)
    check(f"{file.name}: gaps filled, all else the same", only_changed(before, after, slice(None)))
    check(f"{file.name}: analog samples the same", same(analogs, after["data"]["analogs"]))
    check(f"{file.name}: parameters the same", same_parameters(before, after))
    check(f"{file.name}: events the same",
          before["header"]["events"] == after["header"]["events"])


def judge_gaps(file, folder):
    """Gaps up to --max-gap are filled and marked, longer ones are still gaps, byte for byte."""
    out = folder / "out.c3d"
    fill(file, out, "--max-gap", "0.1")
    before, after = moclean_samples(file, folder), moclean_samples(out, folder)
    missing, left = np.isnan(before), np.isnan(after)
    filled = missing & ~left
    check(f"{file.name}: some gaps are filled and some left", filled.any() and left.any())
    check(f"{file.name}: what was there is there", same(before[~missing], after[~missing]))
    group = read(out)["parameters"]["MOCLEAN"]
    check(f"{file.name}: MOCLEAN:FILLED counts them",
          np.array_equal(group["FILLED"]["value"], filled[:, ::3].sum(axis=0)))


def synthetic(frames=40, points=7, analogs=3):
    """A file of ezc3d's with analog channels and gaps."""
    random = np.random.default_rng(1)
    c3d = ezc3d.c3d()
    c3d["header"]["points"]["first_frame"] = 0
    c3d["parameters"]["POINT"]["RATE"]["value"] = [100]
    c3d["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    c3d["parameters"]["POINT"]["LABELS"]["value"] = [f"marker{p}" for p in range(points)]
    c3d["parameters"]["ANALOG"]["RATE"]["value"] = [1000]
    c3d["parameters"]["ANALOG"]["LABELS"]["value"] = [f"channel{c}" for c in range(analogs)]
    c3d["data"]["points"] = np.ones((4, points, frames))
    c3d["data"]["points"][:3] = random.normal(0, 300, (3, points, frames)).astype(np.float32)
    c3d["data"]["points"][:3, 2, 5:9] = np.nan
    c3d["data"]["analogs"] = random.normal(0, 1, (1, analogs, 10 * frames))
    c3d.add_event([0, 0.1], "Left", "Foot Strike")
    return c3d


def judge_ezc3d_file(folder, points, frames):
    file = folder / "ezc3d.c3d"
    synthetic(frames, points).write(str(file))
    name = f"{points} points, {frames} frames of ezc3d"
    check(f"{name}: moclean reads the same", same(in_columns(read(file)).astype(np.float32),
                                                  moclean_samples(file, folder).astype(np.float32)))
    run("convert", file, folder / "again.c3d")
    check(f"{name}: written without a byte changed",
          file.read_bytes() == (folder / "again.c3d").read_bytes())


def judge_new_file(folder, points, frames):
    random = np.random.default_rng(2)
    samples = random.normal(0, 1000, (frames, 3 * points)).astype(np.float32).astype(float)
    samples[1:3, 3:6] = np.nan
    np.save(folder / "new.npy", samples)
    run("convert", folder / "new.npy", folder / "new.c3d", "--rate", "59.94")
    c3d = read(folder / "new.c3d")
    name = f"new file of {points} points, {frames} frames"
    check(f"{name}: ezc3d reads the same", same(in_columns(c3d), samples))
    check(f"{name}: names",
          c3d["parameters"]["POINT"]["LABELS"]["value"][-1] ==
          f"joint{min(points, 255) - 1}" and c3d["header"]["points"]["size"] == points)


# Bytes of the same little file as every processor stores it.
def stored(processor, is_float):
    def word(value):
        return struct.pack(">H" if processor == 86 else "<H", value & 0xFFFF)

    def real(value):
        if processor == 85:  # F_floating: IEEE's bits of four times the value, high word first
            bits = struct.unpack("<I", struct.pack("<f", 4 * value))[0]
            return struct.pack("<HH", bits >> 16, bits & 0xFFFF)
        return struct.pack(">f" if processor == 86 else "<f", value)

    def group(number, name):
        return struct.pack("bb", len(name), -number) + name + word(3) + b"\0"

    def parameter(number, name, kind, extents, data):
        body = struct.pack("bb", kind, len(extents)) + bytes(extents) + data + b"\0"
        return struct.pack("bb", len(name), number) + name + word(len(body) + 2) + body

    scale = -0.25 if is_float else 0.25
    frames, points = 30, 2
    header = (bytes([2, 80]) + word(points) + word(2) + word(1) + word(frames) + word(10) +
              real(scale) + word(4) + word(1) + real(50))
    texts = b"".join(name.ljust(8) for name in (b"hip", b"knee"))
    section = (bytes([1, 80, 2, processor]) + group(1, b"POINT") +
               parameter(1, b"USED", 2, [], word(points)) +
               parameter(1, b"SCALE", 4, [], real(scale)) +
               parameter(1, b"RATE", 4, [], real(50)) +
               parameter(1, b"DATA_START", 2, [], word(4)) +
               parameter(1, b"FRAMES", 2, [], word(frames)) +
               parameter(1, b"LABELS", -1, [8, 2], texts) +
               parameter(1, b"UNITS", -1, [2], b"mm") + group(2, b"ANALOG") +
               parameter(2, b"USED", 2, [], word(2)) +
               parameter(2, b"GEN_SCALE", 4, [], real(1)) +
               parameter(2, b"SCALE", 4, [2], real(1) + real(1)) +
               parameter(2, b"OFFSET", 2, [2], word(0) + word(0)) +
               parameter(2, b"RATE", 4, [], real(50)) + b"\0\0")
    number = real if is_float else word
    data = b""
    for f in range(frames):
        gap = 10 <= f < 13
        for p in range(points):
            lost = gap and p == 1
            data += b"".join(number(0 if lost else 8 * f + 100 * p + i) for i in range(3))
            data += number(-1 if lost else 0x0103)
        data += number(f) + number(-f)
    return b"".join(block.ljust(-(-len(block) // 512) * 512, b"\0")
                    for block in (header, section.ljust(1024, b"\0"), data))


def judge_processor(folder, processor, is_float):
    kinds = {84: "Intel", 85: "DEC", 86: "MIPS"}
    name = f"{kinds[processor]} {'reals' if is_float else 'integers'}"
    file, out = folder / "stored.c3d", folder / "out.c3d"
    file.write_bytes(stored(processor, is_float))
    if not is_readable(file):
        return print(f"note {name}: ezc3d does not read them")
    before = read(file)
    check(f"{name}: both read the same", same(in_columns(before), moclean_samples(file, folder)))
    fill(file, out)
    after = read(out)
    check(f"{name}: gaps filled, all else the same",
          only_changed(before, after, slice(None)) and
          same(in_columns(after), moclean_samples(out, folder)))
    check(f"{name}: the gap is filled", not np.isnan(in_columns(after)).any())
    check(f"{name}: analog samples the same",
          same(before["data"]["analogs"], after["data"]["analogs"]))


with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    for file in sorted((DATA / "c3d").glob("*.c3d")):
        judge_real(file, folder)
    if (DATA / "c3d" / "03_rolling.c3d").exists():
        judge_gaps(DATA / "c3d" / "03_rolling.c3d", folder)
    for points, frames in ((7, 40), (300, 12)):
        judge_ezc3d_file(folder, points, frames)
        judge_new_file(folder, points, frames)
    judge_new_file(folder, 2, 70000)
    for processor in (84, 85, 86):
        for is_float in (True, False):
            judge_processor(folder, processor, is_float)
print(f"{failures} failed")
sys.exit(failures > 0)
