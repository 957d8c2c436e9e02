"""A cluster with Slurm on this machine: munged, slurmctld and some slurmd, in a folder and on ports of its own."""

import contextlib
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "scancel")


def missing_programs() -> list[str]:
    return [name for name in PROGRAMS if shutil.which(name) is None]


def free_port() -> int:
    with contextlib.closing(socket.socket()) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """Starts with the `with` statement and takes all that it has started away at its end."""

    def __init__(self, folder: pathlib.Path, nodes: int, max_array_size: int = 1001):
        self.folder = folder
        self.nodes = [f"node{i + 1}" for i in range(nodes)]
        self.processes: dict[str, subprocess.Popen] = {}
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"), LC_ALL="C.UTF-8")
        user = pwd.getpwuid(os.getuid()).pw_name
        host = socket.gethostname()
        ports = [free_port() for _ in range(nodes + 1)]
        for name in ("state", *[f"spool.{node}" for node in self.nodes]):
            (folder / name).mkdir()
        # A job that is put into the queue again waits for as long as its credential lives: two minutes, unless told.
        lines = [
            "ClusterName=trial", f"SlurmctldHost={host}(127.0.0.1)", f"SlurmctldPort={ports[0]}",
            f"SlurmUser={user}", f"SlurmdUser={user}", "AuthType=auth/munge",
            f"AuthInfo=socket={folder}/munge.socket,cred_expire=5", "CredType=cred/munge",
            f"StateSaveLocation={folder}/state", f"SlurmdSpoolDir={folder}/spool.%n",
            f"SlurmctldPidFile={folder}/slurmctld.pid", f"SlurmdPidFile={folder}/%n.pid",
            "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/none", "MpiDefault=none", "ReturnToService=2",
            "SlurmdParameters=config_overrides", "SelectType=select/cons_tres", "SelectTypeParameters=CR_CPU",
            "SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1,bf_interval=1", "SchedulerTimeSlice=5",
            "KillWait=2", "MessageTimeout=10", "SlurmdTimeout=30", "MailProg=/bin/true", "JobRequeue=1",
            f"MaxArraySize={max_array_size}"]
        for node, port in zip(self.nodes, ports[1:]):
            lines.append(f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={2 // nodes}")
        lines.append("PartitionName=main Nodes=ALL Default=YES State=UP")
        (folder / "slurm.conf").write_text("\n".join(lines) + "\n")
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")

    def __enter__(self):
        try:
            key = self.folder / "munge.key"
            key.write_bytes(os.urandom(128))
            key.chmod(0o400)
            self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                       f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                       f"--seed-file={self.folder}/munged.seed")
            self.wait_until(lambda: (self.folder / "munge.socket").exists(), "munged listens")
            self.start_controller(is_new=True)
            for node in self.nodes:
                self.start_node(node)
            self.wait_until(lambda: self.ask("sinfo", "-h", "-o", "%D %t").split() == [str(len(self.nodes)), "idle"],
                            "all nodes are idle")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        with contextlib.suppress(subprocess.SubprocessError, TimeoutError):
            self.run("scancel", "--full", f"--user={os.getuid()}", limit_s=5)
            self.wait_until(lambda: not self.ask("squeue", "-h", "-o", "%i"), "all jobs have ended", limit_s=10)
        for process in reversed(list(self.processes.values())):
            process.kill()
            process.wait()
        self.kill_tasks()

    def kill_tasks(self):
        """What the cluster has started and did not end: a busy machine may have kept it from that."""
        mark = f"SLURM_CONF={self.folder}/slurm.conf".encode()
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                variables = (entry / "environ").read_bytes().split(b"\0")
                if mark in variables and any(variable.startswith(b"SLURM_JOB_ID=") for variable in variables):
                    os.kill(int(entry.name), signal.SIGKILL)

    def start(self, name: str, *command: str):
        with open(self.folder / f"{name}.log", "ab") as log:
            program = command if command[0].startswith("slurm") else (name, *command)
            self.processes[name] = subprocess.Popen(program, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                                    env=self.environment, start_new_session=True)

    def start_controller(self, is_new: bool = False):
        self.start("slurmctld", "slurmctld", "-D", *(["-c"] if is_new else []), "-f", str(self.folder / "slurm.conf"))
        self.wait_until(lambda: self.run("scontrol", "ping").returncode == 0, "the controller answers")

    def start_node(self, node: str):
        environment = self.environment
        self.environment = dict(environment, **self.variables_of(node))
        self.start(node, "slurmd", "-D", "-N", node, "-f", str(self.folder / "slurm.conf"))
        self.environment = environment

    def variables_of(self, _node: str) -> dict[str, str]:
        return {}

    def kill(self, name: str):
        """kill -9 of a daemon."""
        process = self.processes.pop(name)
        process.send_signal(signal.SIGKILL)
        process.wait()

    def run(self, *command: str, limit_s: float = 60) -> subprocess.CompletedProcess:
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=limit_s, check=False)

    def ask(self, *command: str) -> str:
        """What a command prints; empty if it fails."""
        try:
            result = self.run(*command)
        except subprocess.TimeoutExpired:
            return ""
        return result.stdout.strip() if result.returncode == 0 else ""

    def has_ended(self, job: str) -> bool:
        """Whether a job has ended. False also while the controller does not answer."""
        state = self.ask("scontrol", "-o", "show", "job", job).partition("JobState=")[2].split(" ")[0]
        return state in ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY")

    def release_held(self):
        """What an operator does where the controller died while it launched a task: after its restart it tries again, finds
        the task running, and holds it and drains its node."""
        for job in self.ask("squeue", "-h", "-r", "-t", "PD", "-o", "%i %r").splitlines():
            name, reason = job.split(maxsplit=1)
            if "Held" in reason or "held" in reason:
                print(f"job {name} is held: released", flush=True)
                self.run("scontrol", "release", name)
        for node in self.ask("sinfo", "-h", "-N", "-o", "%N %T").splitlines():
            name, state = node.split()
            if state.startswith("drain"):
                print(f"{name} is drained: resumed", flush=True)
                self.run("scontrol", "update", f"nodename={name}", "state=resume")

    def wait_until(self, holds, what: str, limit_s: float = 30):
        end = time.monotonic() + limit_s
        while not holds():
            if time.monotonic() > end:
                raise TimeoutError(f"not within {limit_s} s: {what}\n{self.logs()}")
            time.sleep(0.1)

    def logs(self) -> str:
        ends = [f"== {file}\n{file.read_text(errors='replace')[-1500:]}" for file in sorted(self.folder.glob("*.log"))]
        return "\n".join([self.ask("squeue"), self.ask("sinfo", "-N", "-l"), *ends])
