#!/usr/bin/env python3
"""bvhio_agreement.py MOCLEAN [DATA]: bvhio finds the joints of a BVH file where moclean does.

Of the takes in DATA/bvh (or $MOCLEAN_DATA), of what moclean writes of them with some positions
changed, and of BVH files that it makes of takes in DATA/cmu. Exits 77, which is ctest's "skipped",
where Python has no bvhio or there is no take.
"""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import bvhio
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

MOCLEAN = sys.argv[1]
DATA = pathlib.Path(os.environ.get("MOCLEAN_DATA") or (sys.argv[2] if len(sys.argv) > 2 else "."))
FRAMES = 40  # of each take: bvhio is no fast reader
failures = 0


def run(*arguments):
    subprocess.run([MOCLEAN, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def by_moclean(file, folder):
    """Per joint its places, frame after frame."""
    table = folder / "positions.csv"
    run("convert", file, table)
    with open(table, encoding="utf-8") as lines:
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    joints = {}
    for column in range(0, len(rows[0]), 3):
        joints[rows[0][column].removesuffix(".x")] = [
            tuple(map(float, row[column:column + 3])) for row in rows[1:]]
    return joints


def by_bvhio(file):
    root = bvhio.readAsHierarchy(str(file))
    joints = {}
    for frame in range(FRAMES):
        root.loadPose(frame)
        for joint, _, _ in root.layout():
            place = joint.PositionWorld
            joints.setdefault(joint.Name, []).append((place.x, place.y, place.z))
    return joints


def check(claim, file, folder):
    global failures
    ours, theirs = by_moclean(file, folder), by_bvhio(file)
    size = max(max(joint[0][axis] for joint in ours.values()) -
               min(joint[0][axis] for joint in ours.values()) for axis in range(3))
    missing = [name for name in ours if name not in theirs]
    # bvhio counts in single precision, a coordinate of some metres to 1e-7 of it
    far = max(abs(a - b) for name in ours if name in theirs
              for one, other in zip(ours[name], theirs[name]) for a, b in zip(one, other))
    holds = not missing and far <= 1e-4 * size
    failures += not holds
    print("ok  " if holds else "FAIL", f"{claim}: {len(ours)} joints, {far / size:.1e} of the body",
          *missing)


def main():
    takes = sorted(DATA.glob("bvh/*.bvh")) + sorted(DATA.glob("cmu/0[29]/0?_0[16].amc"))
    if not takes:
        print(f"skipped: no takes in {DATA}")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for take in takes:
            cut, changed = folder / "cut.bvh", folder / "changed.bvh"
            run("convert", take, cut, "--frames", f"10:{10 + FRAMES}")
            check(f"{take.name} read", cut, folder)
            run("denoise", cut, "-o", changed, "--backend", "reference", "--method",
                "median:window=5")
            check(f"{take.name} written", changed, folder)
    sys.exit(failures > 0)


main()
