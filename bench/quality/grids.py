"""Grids of `moclean experiment`: takes x noises x methods x seeds, and figures of their cells."""
import csv
import dataclasses
import json
import pathlib
import subprocess


@dataclasses.dataclass(frozen=True)
class Take:
    """A recording, what of it is used, and every how many frames."""
    file: pathlib.Path
    frames: str | None = None
    thin: int = 1

    @property
    def label(self):
        return self.file.stem + (f" thinned by {self.thin}" if self.thin > 1 else "")


def toml(takes, noises, methods, seeds, exclude=()):
    text = f"seeds = {seeds}\n"
    if exclude:
        text += "columns_exclude = [" + ", ".join(f'"{e}"' for e in exclude) + "]\n"
    for take in takes:
        text += f'\n[[take]]\nfile = "{take.file}"\nlabel = "{take.label}"\nrate = 120\n'
        text += f'frames = "{take.frames}"\n' if take.frames else ""
        text += f"thin = {take.thin}\n" if take.thin > 1 else ""
    for key, entries in (("noise", noises), ("method", methods)):
        for label, spec in entries:
            text += f'\n[[{key}]]\nlabel = "{label}"\nspec = "{spec}"\n'
    return text


def cells_of(given, name, *grid, **more):
    """Runs a grid; the rows of its cells.csv."""
    folder = given.out / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "grid.toml").write_text(toml(*grid, **more))
    run = subprocess.run([given.moclean, "experiment", "grid", folder / "grid.toml", "-o", folder, "--quiet"],
                         stdout=subprocess.DEVNULL)
    if run.returncode not in (0, 3):  # 3: something did not converge, which is a result
        raise SystemExit(f"{name}: moclean experiment failed")
    with open(folder / "cells.csv", newline="") as file:
        return list(csv.DictReader(file))


def values(cells, figure, **where):
    """A figure of the cells that match; nothing if one of them left samples missing."""
    chosen = [c for c in cells if all(c[k] == v for k, v in where.items())]
    if any(c["refused"] or float(c["missing"] or 0) > 0 for c in chosen):
        return []
    return [float(c[figure]) for c in chosen if c[figure] not in ("", "nan")]


def frames_of(given, file):
    text = subprocess.run([given.moclean, "info", file, "--json"], check=True, capture_output=True).stdout
    return json.loads(text)["frames"]
