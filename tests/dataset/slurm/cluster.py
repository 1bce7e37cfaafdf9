"""A cluster of Slurm with one node, this machine: munged, slurmctld and slurmd as they are installed,
with files of their own in a temporary folder, so that a cluster that runs here already is left alone."""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "sinfo"]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def found(program):
    path = shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
    if path is None:
        raise SystemExit(f"{program} is not installed: scripts/install-packages --tests")
    return path


class Cluster:
    """Runs from `with` to its end. `cpus` need not be those of the machine."""

    def __init__(self, folder, cpus, memory_mb):
        self.folder = pathlib.Path(folder)
        self.host = socket.gethostname().split(".")[0]
        self.processes = []
        self.write_settings(cpus, memory_mb)

    def write_settings(self, cpus, memory_mb):
        control, node = free_ports(2)
        for name in ["state", "spool"]:
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.munge = self.folder / "munge.socket"
        (self.folder / "slurm.conf").write_text(f"""ClusterName=uwvdb
SlurmctldHost={self.host}(127.0.0.1)
SlurmctldPort={control}
SlurmdPort={node}
SlurmUser={getpass.getuser()}
SlurmdUser={getpass.getuser()}
AuthType=auth/munge
AuthInfo=socket={self.munge}
CredType=cred/munge
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
MpiDefault=none
ReturnToService=2
KillWait=5
NodeName={self.host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory_mb} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def start(self, program, *arguments):
        log = open(self.folder / f"{program}.out", "wb")
        self.processes.append(subprocess.Popen([found(program), *arguments], stdout=log, stderr=log,
                                               env=self.environment))

    def __enter__(self):
        for program in PROGRAMS:
            found(program)
        try:
            self.start("munged", "--foreground", f"--socket={self.munge}", "--force",
                       f"--key-file={self.folder}/munge.key", f"--pid-file={self.folder}/munged.pid",
                       f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/munged.seed")
            self.wait_for("munged", self.munge.exists)
            self.start("slurmctld", "-D", "-i")
            self.start("slurmd", "-D", "-N", self.host)
            self.wait_for("the node", lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"))
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.send_signal(signal.SIGTERM)
        for process in self.processes:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def ask(self, program, *arguments):
        """What a program of Slurm prints; empty where it fails."""
        result = subprocess.run([found(program), *arguments], capture_output=True, text=True,
                                env=self.environment)
        return result.stdout.strip() if result.returncode == 0 else ""

    def succeeds(self, program, *arguments):
        return subprocess.run([found(program), *arguments], env=self.environment,
                              stderr=subprocess.DEVNULL).returncode == 0

    def run(self, *command, **options):
        return subprocess.run(command, env=self.environment, check=True, **options)

    def wait_for(self, what, holds, seconds=300, pause=0.2):
        end = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > end:
                raise SystemExit(f"{what}: not there after {seconds} s\n{self.logs()}")
            time.sleep(pause)

    def logs(self):
        return "\n".join(f"--- {log.name}\n{log.read_text(errors='replace')[-3000:]}"
                         for log in sorted(self.folder.glob("*.*"))
                         if log.suffix in [".out", ".log"])

    def jobs(self):
        """{array task or job: state} of all jobs that are queued or run."""
        lines = self.ask("squeue", "-h", "-r", "-o", "%i %T").splitlines()
        return dict(line.split() for line in lines)
