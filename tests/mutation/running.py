"""Runs the tests of the normal run against mutants."""

import hashlib
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time

MOST_MUTANTS = 1 << 16  # as in mutant.h


class Tests:
    """The test files of the programs in C++, by name; each is {command, source, usual, lock}: a
    digest of the file, and the seconds that it took when ctest last ran it."""

    def __init__(self, source, build, results):
        self.build, self.results = build, results
        costs = build / "Testing/Temporary/CTestCostData.txt"
        usual = dict(re.findall(r"^(\S+) \d+ (\S+)$", costs.read_text(), re.MULTILINE)
                     if costs.is_file() else [])
        listed = json.loads(subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True,
                                           capture_output=True, text=True).stdout)
        self.known = {}
        for test in listed["tests"]:
            labels = next((p["value"] for p in test["properties"] if p["name"] == "LABELS"), [])
            file = next((word.partition("=")[2] for word in test["command"]
                         if word.startswith("--tests-of=")), None)
            if file and "slow" not in labels:
                digest = hashlib.sha1((source / "tests" / file).read_bytes()).hexdigest()
                self.known[test["name"]] = {"command": test["command"] + ["--gtest_fail_fast"],
                                            "source": digest, "lock": threading.Lock(),
                                            "usual": float(usual.get(test["name"], 0))}

    def run(self, name, mutant, limit, marks=None):
        """'passed', 'failed' or 'late' after `limit` seconds, and the seconds it took."""
        environment = {**os.environ, "UWVDB_MUTANT": str(mutant)}
        if marks:
            environment["UWVDB_MUTANTS_REACHED"] = marks
        begin = time.monotonic()
        process = subprocess.Popen(
            self.known[name]["command"], cwd=self.build / "tests", env=environment,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True, preexec_fn=bounded)
        try:
            result = "passed" if process.wait(limit) == 0 else "failed"
        except subprocess.TimeoutExpired:
            result = "late"
            os.killpg(process.pid, signal.SIGKILL)  # with whatever it started
            process.wait()
        return result, time.monotonic() - begin

    def measured(self, name):
        """A test without a mutant: {result, seconds, reaches}, reaches being the mutants that it
        runs into. Measured when it is first asked for, and kept."""
        test = self.known[name]
        with test["lock"]:
            kept = self.results.data.get("tests", {}).get(name, {})
            if kept.get("source") == test["source"]:
                return kept
            with tempfile.NamedTemporaryFile() as marks:
                marks.truncate(MOST_MUTANTS)
                result, seconds = self.run(name, 0, 900, marks.name)
                reached = pathlib.Path(marks.name).read_bytes()
            measured = {"source": test["source"], "result": result, "seconds": round(seconds, 2),
                        "reaches": [n for n, mark in enumerate(reached) if mark]}
            if result != "passed":
                print(f"not used, because it fails without mutants: {name}", flush=True)
            self.results.set("tests", name, measured)
            return measured

    def order(self, site):
        """All tests: those of the mutated file first, then its folder's, its layer's and those of
        the layers above, the quick ones first."""
        folder = re.sub(r"/", ".", site.file.rpartition("/")[0])
        unit = folder + "." + site.file.rpartition("/")[2].rpartition(".")[0]
        layer = site.file.split("/")[0]

        def key(name):
            near = 0 if name == unit else 1 if name.startswith(folder + ".") else \
                2 if name.startswith(layer + ".") else 3
            return near, self.known[name]["usual"], name
        return sorted(self.known, key=key)

    def try_mutant(self, site, mutant, budget, before):
        """What becomes of one mutant; `before` is {name: source} of tests that it has passed."""
        begin, waited, passed = time.monotonic(), 0.0, {}
        for name in self.order(site):
            asked = time.monotonic()
            test = self.measured(name)
            waited += time.monotonic() - asked
            if test["result"] != "passed" or mutant not in test["reaches"]:
                continue
            if before.get(name) != test["source"]:
                if time.monotonic() - begin - waited > budget:
                    return {"result": "unfinished", "passed": before | passed}
                result, _ = self.run(name, mutant, 20 + 10 * test["seconds"])
                if result != "passed":
                    return {"result": "killed", "by": name, "late": result == "late"}
            passed[name] = test["source"]
        return {"result": "survived", "passed": passed}


def bounded():
    """What a mutant may take of the machine."""
    resource.setrlimit(resource.RLIMIT_DATA, (6 << 30, 6 << 30))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Results:
    """A JSON file that is complete after every change."""

    def __init__(self, path):
        self.path = path
        self.data = json.loads(path.read_text()) if path.is_file() else {}
        self.lock = threading.Lock()

    def save(self):
        beside = self.path.with_suffix(".tmp")
        beside.write_text(json.dumps(self.data, indent=1))
        beside.replace(self.path)

    def set(self, kind, name, outcome):
        with self.lock:
            self.data.setdefault(kind, {})[name] = outcome
            self.save()
