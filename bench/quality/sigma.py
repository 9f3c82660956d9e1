"""How true the standard deviations of auto are: shares of samples within one and two of them."""
import subprocess
import tempfile
import pathlib

import numpy as np

STATUS = {"kept": 0, "corrected": 1, "filled": 2}  # docs/gaps.md


def within(error, sigma):
    """Shares of finite errors within 1 and 2 sigma; None if there are none."""
    judged = np.isfinite(error) & np.isfinite(sigma)
    if not judged.any():
        return None
    ratio = np.abs(error[judged]), sigma[judged]
    return [float(np.mean(ratio[0] <= k * ratio[1])) for k in (1, 2)]


def by_status(error, sigma, status):
    return {name: within(error[status == number], sigma[status == number])
            for name, number in STATUS.items()}


def denoise(program, sources, folder, rate, method, *more):
    """Cleans files of one folder in one call; {name: result} of -o and of each further output."""
    command = [program, "denoise", *sources, "--method", method, "--format", "npy", "--quiet"]
    command += ["--rate", str(rate)] if rate else []
    options = {"-o": folder / "result", **{o: folder / o.strip("-") for o in more}}
    for option, place in options.items():
        command += [option, place if len(sources) > 1 else place / (sources[0].stem + ".npy")]
        place.mkdir(exist_ok=True)
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode not in (0, 3):
        raise SystemExit(run.stderr)
    return [{s.stem: np.load(place / (s.stem + ".npy")) for s in sources} for place in options.values()]


def measure(given, takes, damages):
    """damage -> status -> shares within 1 and 2 sigma, over all takes, one seed."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        truths, sources = {}, []
        for t, take in enumerate(takes):
            clean = folder / f"clean{t}.csv"
            cut = ["--frames", take.frames] if take.frames else []
            subprocess.run([given.moclean, "convert", take.file, clean, "--rate", "120", *cut], check=True,
                           stdout=subprocess.DEVNULL)
            subprocess.run([given.moclean, "convert", clean, folder / "clean.npy"], check=True,
                           stdout=subprocess.DEVNULL)
            for d, (_, spec) in enumerate(damages):
                target = folder / f"d{d}t{t}.csv"
                subprocess.run([given.moclean, "corrupt", clean, "-o", target, "--noise", spec, "--seed",
                                str(1 + t)], check=True, stdout=subprocess.DEVNULL)
                sources.append(target)
                truths[target.stem] = np.load(folder / "clean.npy")
        found = denoise(given.moclean, sources, folder, None, "auto", "--sigma", "--mask")
        shares = {}
        for d, (damage, _) in enumerate(damages):
            names = [f"d{d}t{t}" for t in range(len(takes))]
            error = np.concatenate([(found[0][n] - truths[n]).ravel() for n in names])
            sigma, status = (np.concatenate([part[n].ravel() for n in names]) for part in found[1:])
            shares[damage] = by_status(error, sigma, status)
        return shares
