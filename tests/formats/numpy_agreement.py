"""NumPy reads what the program writes, and the program what NumPy writes: shapes, types, values.

usage: numpy_agreement.py PROGRAM        exits 77 where Python has no NumPy
"""
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("no numpy: skipped")
    sys.exit(77)

program = sys.argv[1]
random = np.random.default_rng(1)
failures = 0


def check(name, is_right):
    global failures
    if not is_right:
        print("failed:", name)
        failures += 1


def convert(source, target):
    return subprocess.run([program, "convert", source, target], capture_output=True, text=True)


with tempfile.TemporaryDirectory() as folder:
    a, b = Path(folder, "a.npy"), Path(folder, "b.npy")
    for shape in [(20, 5, 3), (20, 5, 2), (20, 15), (20, 4), (20,), (1, 5, 3), (20, 5, 6)]:
        for kind in ["<f4", ">f4", "<f8", ">f8", "<f2", "<i2", ">i4", "<i8", "u1"]:
            for order in "CF":
                array = np.asarray(random.uniform(0, 100, shape).astype(kind), order=order)
                np.save(a, array)
                run = convert(a, b)
                check(f"{shape} {kind} {order}: {run.stderr}", run.returncode == 0)
                back = np.load(b)
                check(f"{shape} {kind} {order} again", back.dtype == array.dtype and
                      back.shape == array.shape and np.array_equal(back, array))

    a, b = Path(folder, "a.npz"), Path(folder, "b.npz")
    names = np.array(["Hüfte", "knee", "手"])
    joints = random.normal(size=(30, 3, 3)).astype("f4")
    for save in [np.savez, np.savez_compressed]:
        save(a, joints=joints, names=names, fps=59.94, gender=np.array("neutral"), betas=np.zeros(16))
        run = convert(a, b)
        check(f"{save.__name__}: {run.stderr}", run.returncode == 0)
        with np.load(a) as before, np.load(b) as after:
            check("members", before.files == after.files)
            check("values", all(np.array_equal(before[m], after[m]) for m in before.files))

    table, c = Path(folder, "a.csv"), Path(folder, "c.npz")
    table.write_text("# frame_rate: 50\nhip.x,hip.y,hip.z\n1,2,3\n4,5.5,6\n")
    run = convert(table, c)
    check("a table becomes an archive: " + run.stderr, run.returncode == 0)
    with np.load(c) as made:
        check("positions", np.array_equal(made["positions"], [[[1, 2, 3]], [[4, 5.5, 6]]]))
        check("names", list(made["names"]) == ["hip"] and made["fps"] == 50)

    np.savez(a, joints=joints, names=np.array([{"a": 1}, None, 3], dtype=object))
    run = convert(a, b)
    check("a pickled member is passed over: " + run.stderr, run.returncode == 0)
    with np.load(b, allow_pickle=True) as after:
        check("pickled member", after["names"][0] == {"a": 1})

print("failures:", failures)
sys.exit(failures > 0)
