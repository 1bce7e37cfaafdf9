#!/usr/bin/env python3
"""docs/examples/datasets/container_array.sh on a cluster of one node: three tasks in containers, of which one is
put back into the queue, make the same set, to the byte, as one container.

    container_array.py FOLDER COMMAND...

COMMAND runs uwvdb in a container, with FOLDER as its folder; scripts/container says how."""

import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from array_job import expect, restarts, sums  # noqa: E402
from cluster import Cluster  # noqa: E402

SCRIPT = pathlib.Path(__file__).resolve().parents[3] / "docs/examples/datasets/container_array.sh"
SCENE = "/opt/uwvdb/share/uwvdb/scenes/wreck.yaml"
OPTIONS = ["--frames", "20-25", "--size", "32x24", "--format", "png,depth,flow"]


def run(cluster, folder, command):
    subprocess.run([*command, "dataset", SCENE, "-o", "whole", *OPTIONS, "--quiet"], cwd=folder, check=True)
    cluster.environment["UWVDB_CONTAINER"] = " ".join(command)
    submitted = cluster.run(SCRIPT, "3", "shared", SCENE, *OPTIONS, cwd=folder, capture_output=True, text=True)
    merge = submitted.stdout.split()[-1]
    array = str(int(merge) - 1)
    # A task's number is in the queue until it has ended.
    cluster.wait_for("a task at work", lambda: "RUNNING" in cluster.jobs().values(), pause=0.02)
    task = next(name for name, state in cluster.jobs().items() if state == "RUNNING")
    expect(task.startswith(f"{array}_"), f"the tasks are those of job {array}: {task}")
    expect(cluster.succeeds("scontrol", "requeue", task), "a task can be put back into the queue")
    cluster.wait_for(f"the restart of {task}", lambda: restarts(cluster, task) == 1)
    cluster.wait_for("all jobs to end", lambda: not cluster.jobs(), 600)
    expect((folder / "shared" / "SHA256SUMS").exists(), "the set is complete: " + "".join(
        log.read_text() for log in sorted((folder / "shared-logs").glob("*.log"))))
    expect(sums(folder / "shared") == sums(folder / "whole"), "the set is that of one container")
    print(f"a job array of Slurm: 3 tasks, one of them twice, made the {len(sums(folder / 'whole'))} files of one")


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="uwvdb-slurm-") as name:
        with Cluster(name, cpus=os.cpu_count(), memory_mb=8000) as cluster:
            run(cluster, folder, sys.argv[2:])


if __name__ == "__main__":
    main()
