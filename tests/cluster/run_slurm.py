"""Prove profiles/slurm: the smoke study through a Slurm that lives for this run only.

`python tests/cluster/run_slurm.py` starts munge, slurmctld and slurmd from Debian's packages on
loopback, without systemd, runs the smoke study locally and through Slurm, compares both byte for
byte, and shuts down what it started. It needs root, and it leaves an existing Slurm alone.
"""

import importlib.util
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "pipeline"))
from repository import SMOKE, copy_of_the_repository, environment

# The Slurm plugin of Snakemake drops SLURM_CONF, so the file must stand in its default place.
CONF = Path("/etc/slurm/slurm.conf")
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "setpriv")
START_SECONDS, RUN_SECONDS = 60.0, 3600.0

# More cores and memory are declared than the machine has, so that the profile runs as it is.
TEMPLATE = """# Written for a test by tests/cluster/run_slurm.py.
ClusterName=lube
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
AuthInfo=socket={folder}/munge.socket
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
MinJobAge=86400
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
NodeName={host} NodeAddr=127.0.0.1 CPUs=8 RealMemory=16000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class Skipped(Exception):
    """Slurm is not available here."""


class Failed(Exception):
    """Slurm or the study did not do what it should."""


def main():
    # A signal, too, must shut down what was started.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    os.environ.pop("SLURM_CONF", None)
    try:
        check_that_slurm_is_installed()
        with ExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="lube-slurm-")))
            folder.chmod(0o755)
            start_slurm(folder, stack)
            checks = compare_runs(copy_of_the_repository(folder / "study" / "repository"))
    except Skipped as reason:
        print(f"Skipped: {reason}")
        return 0
    except Failed as reason:
        print(f"Failed: {reason}\n0 passed, 1 failed")
        return 1
    for name, good in checks.items():
        print(f"{'passed' if good else 'FAILED'}  {name}")
    failed = list(checks.values()).count(False)
    print(f"{len(checks) - failed} passed, {failed} failed")
    return 1 if failed else 0


# Slurm


def check_that_slurm_is_installed():
    if os.geteuid() != 0:
        raise Skipped("only root can start a Slurm of its own and write /etc/slurm/slurm.conf")
    if not all(map(shutil.which, PROGRAMS)):
        raise Skipped("Slurm is missing: apt-get install munge slurm-client slurmctld slurmd")
    if importlib.util.find_spec("snakemake_executor_plugin_slurm") is None:
        raise Skipped("snakemake-executor-plugin-slurm is missing: pip install -e '.[slurm]'")


def quiet_run(*command, seconds=600.0):
    """Run a command and return it finished; its `stdout` is all it said."""
    return subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=seconds,
    )


def start_slurm(folder, stack):
    """Start the three daemons and wait for the node; the stack shuts them down."""
    stack.enter_context(configuration(folder))
    for name in ("state", "spool", "log"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.touch(mode=0o600)
    key.write_bytes(os.urandom(1024))
    sign = f"--socket={folder}/munge.socket"
    files = [f"--key-file={key}", f"--pid-file={folder}/munged.pid"]
    files += [f"--log-file={folder}/log/munge.log", f"--seed-file={folder}/munge.seed"]
    stack.enter_context(daemon(folder, "munged", "--foreground", "--force", sign, *files))
    wait_until("munge signs", lambda: quiet_run("munge", "-n", sign).returncode == 0)
    stack.enter_context(daemon(folder, "slurmctld", "-D"))
    stack.enter_context(daemon(folder, "slurmd", "-D"))
    stack.callback(cancel_jobs)
    try:
        wait_until("the node is idle", node_is_idle)
    except Failed as reason:
        logs = "\n".join(path.read_text("utf-8") for path in folder.glob("log/*"))
        raise Failed(f"{reason}\n{logs}") from None


@contextmanager
def configuration(folder):
    """Write slurm.conf for a while, unless there is one."""
    if CONF.exists():
        raise Skipped(f"{CONF} exists: this machine has a Slurm of its own, left as it is")
    CONF.parent.mkdir(exist_ok=True)
    with socket.socket() as one, socket.socket() as two:
        one.bind(("127.0.0.1", 0))
        two.bind(("127.0.0.1", 0))
        ports = {"controller_port": one.getsockname()[1], "node_port": two.getsockname()[1]}
    host = socket.gethostname().split(".")[0]
    text = TEMPLATE.format(host=host, folder=folder, **ports)
    CONF.write_text(text, encoding="utf-8")
    try:
        yield
    finally:
        CONF.unlink()


@contextmanager
def daemon(folder, *command):
    """Run a daemon in the foreground; it ends with the block, or with this process if killed."""
    with (folder / f"log/{command[0]}").open("wb") as log:
        process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM", *command],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
        )
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(20.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def node_is_idle():
    return quiet_run("sinfo", "--noheader", "--format=%t", seconds=20.0).stdout.strip() == "idle"


def jobs(state):
    said = quiet_run("squeue", "--noheader", "--states", state, "--format=%i", seconds=20.0)
    return said.stdout.split()


def cancel_jobs():
    """Cancel what still runs: its processes would outlive slurmd."""
    for job in jobs("pending,running"):
        quiet_run("scancel", "--full", "--signal=KILL", job, seconds=20.0)
        quiet_run("scancel", job, seconds=20.0)
    wait_until("cancelled jobs have ended", lambda: not jobs("running,completing"))


def wait_until(what, holds):
    deadline = time.monotonic() + START_SECONDS
    while not holds():
        if time.monotonic() > deadline:
            raise Failed(f"waited {START_SECONDS:.0f} s in vain until {what}")
        time.sleep(0.3)


# The study


def compare_runs(repository):
    """Run the smoke study both ways; return checks by name, each True if it is passed."""
    local = timed_run("locally", repository)
    there = repository.products()
    with repository.clean_slate():
        # The profile as it is, except that it checks the status of jobs more often.
        often = ["--slurm-init-seconds-before-status-checks", "2", "--latency-wait", "10"]
        timed_run("through Slurm", repository, "--workflow-profile", "profiles/slurm", *often)
        here = repository.products()
        again = repository.run()
        done = jobs("completed")
    print(f"{len(done)} Slurm jobs for {local.count('Finished jobid')} steps", flush=True)
    checks = {name: there.get(name) == here.get(name) for name in sorted({*there, *here})}
    checks["Slurm did the work"] = len(done) > 0 and jobs("all") == done
    checks["a local run afterwards has nothing to do"] = "Nothing to be done" in again
    return checks


def timed_run(how, repository, *arguments):
    began = time.monotonic()
    try:
        finished = subprocess.run(
            ["setpriv", "--pdeathsig", "KILL", *repository.command(*arguments, study=SMOKE)],
            cwd=repository.folder,
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=RUN_SECONDS,
        )
    except subprocess.TimeoutExpired as late:
        raise Failed(f"the study {how} took over {RUN_SECONDS:.0f} s\n{late.stdout}") from None
    if finished.returncode != 0:
        logs = (repository / ".snakemake/slurm_logs").rglob("*.log")
        texts = [finished.stdout, *(path.read_text("utf-8") for path in logs)]
        raise Failed("\n".join([f"the study {how} ended with {finished.returncode}", *texts]))
    print(f"The smoke study {how}: {time.monotonic() - began:.0f} s", flush=True)
    return finished.stdout


if __name__ == "__main__":
    sys.exit(main())
