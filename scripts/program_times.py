"""Compares the CPU times of two builds of the program in one run: for scripts/bench --against."""

import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "assets/scenes"
# The case of docs/performance.md, "Other renderers".
S1 = """uwvdb: 1
camera:
  resolution: [320, 240]
  intrinsics: {fx: 207.8461, fy: 207.8461, cx: 160, cy: 120}
  pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.9}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1], reflectance: [0.5, 0.5, 0.5]}
  - {type: box, min: [0.1, -0.2, 1.0], max: [0.4, 0.1, 1.3], reflectance: [0.5, 0.5, 0.5]}
lamps:
  - {name: lamp, position: [1, -0.5, 0], profile: {type: isotropic}, intensity: [50, 50, 50]}
render: {samples: 1}
"""
# Whole processes: case -> (scene, or its text, and options). Scenes that version 1.0.0 reads, too.
CASES = {
    "s1/320x240": (S1, ""),
    "uniform/1280x720": ("uniform.yaml", "--size 1280x720 --samples 1"),
    "uniform/640x360/layers:all": ("uniform.yaml", "--size 640x360 --samples 1 --layers all"),
    "plume/1280x720": ("plume.yaml", "--size 1280x720 --samples 1"),
    "plume/480x270/draft": ("plume.yaml", "--size 480x270 --quality draft"),
    "uniform/320x180/all light": ("uniform.yaml", "--size 320x180 --samples 1 --set render.scattering=multiple"),
    "uniform/64x36/paths": ("uniform.yaml", "--size 64x36 --samples 16 --integrator path "
                            "--set render.scattering=multiple"),
}
SMALLEST = {"uniform/64x36": ("uniform.yaml", "--size 64x36 --samples 1")}


def program_of(what):
    """A program's path as it stands; of a commit, the program built in build/against/COMMIT."""
    if os.access(what, os.X_OK) and os.path.isfile(what):
        return pathlib.Path(what).resolve()
    found = subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{what}^{{commit}}"], cwd=ROOT, text=True,
                           capture_output=True)
    if found.returncode != 0:
        sys.exit(f"--against {what}: neither a program nor a commit; give one of them")
    commit = found.stdout.strip()[:12]
    tree = ROOT / "build/against" / commit
    steps = [["cmake", "--preset", "release", "-DUWVDB_WARNINGS_AS_ERRORS=OFF"],
             ["cmake", "--build", "build/release", "--target", "uwvdb"]]
    if not tree.exists():
        subprocess.run(["git", "worktree", "prune"], cwd=ROOT, check=True)
        subprocess.run(["git", "worktree", "add", "--detach", tree, commit], cwd=ROOT, check=True, capture_output=True)
    print(f"building {commit} in {tree.relative_to(ROOT)}", file=sys.stderr)
    for step in steps:
        done = subprocess.run(step, cwd=tree, text=True, capture_output=True)
        if done.returncode != 0:
            sys.exit(done.stdout[-4000:] + done.stderr[-4000:])
    return tree / "build/release/cli/uwvdb"


def cpu_seconds(program, scene, options, folder):
    """CPU time of all threads of one whole run, from the command to its files."""
    # Version 1.0.0 reads scenes of version 1, whose light is scattered once unless they say otherwise.
    process = subprocess.Popen([program, "render", scene, "-o", folder / "image.exr", "--threads", "1", "--quiet",
                                "--set", "uwvdb=1", *options.split()], stderr=subprocess.PIPE)
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{program}: {scene}: failed\n{errors.decode()[-4000:]}")
    return usage.ru_utime + usage.ru_stime


def quartiles(ratios):
    """The first, the median and the third; of a single ratio three times itself."""
    return statistics.quantiles(ratios, n=4, method="inclusive") if len(ratios) > 1 else [ratios[0]] * 3


def compare(new, old, pairs, cases=None):
    """Case -> (CPU s of the new, of the old, quartiles of their ratios): the least times, since what else
    runs on the machine only ever adds to them. Runs are in turn, new old old new, so that both have the
    same moments, and a machine that slows down favours neither."""
    results = {}
    with tempfile.TemporaryDirectory(prefix="uwvdb-bench-") as name:
        folder = pathlib.Path(name)
        for case, (scene, options) in (cases or CASES).items():
            file = SCENES / scene
            if "\n" in scene:
                file = folder / "scene.yaml"
                file.write_text(scene)
            times = ([], [])
            for program in (new, old):  # not counted: files come into memory
                cpu_seconds(program, file, options, folder)
            for pair in range(pairs):
                for side in (0, 1) if pair % 2 == 0 else (1, 0):
                    times[side].append(cpu_seconds((new, old)[side], file, options, folder))
            results[case] = (min(times[0]), min(times[1]), quartiles([a / b for a, b in zip(*times)]))
            print(f"{case}: {results[case][2][1]:.3f}", file=sys.stderr)
    return results


def slower(results, most):
    """The cases whose median ratio is above `most`."""
    return [case for case, (_, _, (_, median, _)) in results.items() if median > most]


def print_results(results, most):
    print("| process | CPU s | CPU s of the other | ratio: median | quartiles |\n|" + " --- |" * 5)
    for case, (new, old, (low, median, high)) in results.items():
        mark = " **" if median > most else " "
        print(f"| {case} | {new:.3g} | {old:.3g} |{mark}{median:.3f}{mark.strip()} | {low:.3f} to {high:.3f} |")


def check(program):
    """Compares a program with itself, and judges known times. No timing."""
    alone = compare(program, program, 1, SMALLEST)
    for new, old, (low, median, high) in alone.values():
        if not (0 < new < 100 and 0 < old < 100 and low == median == high == new / old):
            sys.exit(f"the program against itself: {alone}")
    if quartiles([1, 2, 3, 4, 5]) != [2, 3, 4]:
        sys.exit("the quartiles are wrong")
    known = {"as fast": (1, 1, [0.9, 1.0, 1.2]), "slower": (1, 1, [1.0, 1.06, 1.1])}
    if slower(known, 1.05) != ["slower"]:
        sys.exit("a slower program is not found out")
