"""ProDy's adaptive anisotropic network model (Z. Yang, P. Májek, I. Bahar, PLoS Comput. Biol. 5, 2009), on CA.

`python3 adaptive.py SOURCE TARGET MODE MODULE OUT.npz` walks once, in a process of its own so that its CPU seconds are its own, and writes
`frames`, `(frames, residues, 3)`, and `cpu`, the seconds of the call alone. MODE is `alternating`, `one-way` or `both-ways`; MODULE is
`prody`, or a Python file that has a `calcAdaptiveANM` like it.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

MODES = ["alternating", "one-way", "both-ways"]  # in the order of ProDy's numbers
STEPS = 100  # the most steps; each mode ends sooner, at 1 Å or where it tears


def walk(source, target, mode, module, folder):
    """The frames of a walk, Å, the CPU seconds that it took, and whether a second one had the same bits.

    Walks are kept in `folder`; what is there is taken.
    """
    found = []
    for k in (1, 2):
        out = Path(folder) / f"{Path(module).stem}-{mode}-{k}.npz"
        if not out.exists():
            command = [sys.executable, __file__, str(source), str(target), mode, module, str(out)]
            # One thread, so that CPU seconds are those of the work and not of threads that wait.
            environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
            done = subprocess.run(command, capture_output=True, text=True, env=environment)
            if done.returncode != 0:
                sys.exit(f"ProDy's adaptive ANM, {mode}: {(done.stderr.strip() or 'failed').splitlines()[-1]}")
        with np.load(out) as arrays:
            found.append((arrays["frames"], float(arrays["cpu"])))
    (frames, cpu), (other, _) = found
    return frames, cpu, frames.shape == other.shape and frames.tobytes() == other.tobytes()


def main():
    source, target, mode, module, out = sys.argv[1:]
    import prody

    prody.confProDy(verbosity="none")
    function = prody.calcAdaptiveANM
    if module != "prody":
        import importlib.util

        spec = importlib.util.spec_from_file_location(Path(module).stem, module)
        loaded = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(loaded)
        function = loaded.calcAdaptiveANM
    ends = [prody.parsePDB(path).select("name CA and protein").copy() for path in (source, target)]
    before = time.process_time()
    ensemble = function(*ends, STEPS, mode=MODES.index(mode))
    cpu = time.process_time() - before
    np.savez(out, frames=ensemble.getCoordsets(), cpu=cpu)


if __name__ == "__main__":
    main()
