#!/usr/bin/env python3
"""uwvdb dataset --slurm on a cluster of one node: eight tasks, of which one is killed, one is put back
into the queue, and whose node is drained and resumed meanwhile, make the same set, to the byte, as one
run of the program.

    array_job.py UWVDB"""

import hashlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cluster import Cluster  # noqa: E402

TASKS = 8

# Slow enough that tasks can be caught while they work: light paths.
SCENE = """uwvdb: 1
camera:
  resolution: [64, 48]
  intrinsics: {fov_x: 60}
  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 0], look_at: [0, 0, 4]}
      - {time: 0.44, position: [0.5, 0, 0], look_at: [0, 0, 4]}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.8}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1]}
  - {type: box, min: [0.2, -0.3, 1.5], max: [0.6, 0.2, 1.9], reflectance: [0.7, 0.4, 0.2]}
lamps:
  - {name: left, position: [-0.5, -0.2, 0], direction: [0.1, 0, 1], intensity: 50}
render: {integrator: path, samples: 24, fps: 25}
variations:
  seed: 2
  keys:
    lamps.left.intensity: {log-uniform: [20, 80]}
"""


def sums(folder):
    """The checksum of every file below a folder."""
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in folder.rglob("*") if file.is_file()}


def expect(holds, what):
    if not holds:
        raise SystemExit(f"FAILED: {what}")


def running():
    """{task: process} of the shards that are rendered now."""
    processes = {}
    for command in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = command.read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        if "dataset" in words and "--shard" in words:
            task, count = words[words.index("--shard") + 1].split("/")
            if count == str(TASKS):
                processes[task] = int(command.parent.name)
    return processes


def catch(cluster, act, but=()):
    """The first task that is seen at work and acted upon, which may be too late for one."""
    caught = []

    def try_it():
        for task, process in running().items():
            if task not in but and act(task, process):
                caught.append(task)
                return True
        return False

    cluster.wait_for("a task at work", try_it, pause=0.02)
    return caught[0]


def kill(_, process):
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def restarts(cluster, job):
    found = re.search(r"Restarts=(\d+)", cluster.ask("scontrol", "show", "job", job))
    return int(found.group(1)) if found else 0


def run(uwvdb, cluster, folder):
    (folder / "scene.yaml").write_text(SCENE)
    whole = [uwvdb, "dataset", "scene.yaml", "-o", "whole", "--variations", "2", "--format",
             "png,depth,flow", "--quiet"]
    subprocess.run(whole, cwd=folder, check=True)

    command = [uwvdb, "dataset", "scene.yaml", "-o", "shared", "--variations", "2", "--format",
               "png,depth,flow", "--threads", "1", "--slurm", str(TASKS)]
    cluster.run(*command, "--slurm-dry-run", cwd=folder)
    expect(not cluster.jobs(), "a dry run submits nothing")
    tasks = folder / "shared-slurm" / "tasks.sh"
    expect("#SBATCH --requeue\n" in tasks.read_text(), "tasks may be put back into the queue")
    submitted = cluster.run(*command, "--slurm-options", "--partition=main --nice=1", cwd=folder,
                            capture_output=True, text=True)
    array = re.search(r"submitted job (\d+) of 8 tasks", submitted.stderr).group(1)

    # One is killed as the system kills what takes too much memory, and comes back by itself.
    killed = catch(cluster, kill)
    # One is put back into the queue.
    requeued = catch(cluster, lambda task, _: cluster.succeeds("scontrol", "requeue",
                                                               f"{array}_{task}"), [killed])
    for task in [killed, requeued]:
        cluster.wait_for(f"the restart of task {task}",
                         lambda: restarts(cluster, f"{array}_{task}") == 1)
    # The node takes no more work for a while.
    cluster.run("scontrol", "update", f"NodeName={cluster.host}", "State=DRAIN", "Reason=test")
    cluster.wait_for("the node to be drained", lambda: "drained" in cluster.ask(
        "sinfo", "-h", "-o", "%T"))
    waiting = cluster.jobs()
    expect("PENDING" in waiting.values() and "RUNNING" not in waiting.values(),
           f"jobs wait while the node is drained: {waiting}")
    expect(not (folder / "shared" / "SHA256SUMS").exists(), "the set is not complete yet")
    cluster.run("scontrol", "update", f"NodeName={cluster.host}", "State=RESUME")

    cluster.wait_for("all jobs to end", lambda: not cluster.jobs(), 600)
    expect((folder / "shared" / "SHA256SUMS").exists(),
           "the set is complete: " + "".join(log.read_text() for log in sorted(
               (folder / "shared-slurm").glob("*.log"))))
    expect(sums(folder / "shared") == sums(folder / "whole"), "the set is that of one run")
    print(f"ok: {len(sums(folder / 'shared'))} files, the same as of one run")


def main():
    uwvdb = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="uwvdb-slurm-") as name:
        folder = pathlib.Path(name)
        (folder / "cluster").mkdir()
        (folder / "work").mkdir()
        with Cluster(folder / "cluster", cpus=2, memory_mb=8000) as cluster:
            start = time.monotonic()
            run(uwvdb, cluster, folder / "work")
            print(f"{time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    main()
