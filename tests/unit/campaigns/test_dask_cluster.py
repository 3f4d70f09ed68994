"""The same cases through a real dask cluster in a process apart, a worker of which is killed."""

import json
import os
import shutil
import subprocess
import sys
import time
import warnings
from types import SimpleNamespace

import pytest
from dentscope.campaigns import executor, read_curves
from dentscope.campaigns.executor import DaskExecutor
from dentscope.core import InputError
from dentscope.core.provenance import environment
from made_processes import python

comm = pytest.importorskip("distributed.comm")

SCRIPT = """
import os, signal, sys
from pathlib import Path
from dentscope import fem
from dentscope.campaigns import Design, run_design, standard_case
from dentscope.campaigns.executor import DaskExecutor
from dentscope.core import Material, Pair

def made():
    flat, smoke = Material(E=200e9, nu=0.3, Sy=3e8), fem.Accuracy.smoke()
    pairs = [Pair(Material(E=200e9, nu=0.3, Sy=4e8 + 1e7 * i), flat, 1e-3) for i in range(3)]
    return tuple(standard_case(f"c{i}", p, deepest=3e-4, n_depths=4, accuracy=smoke)
                 for i, p in enumerate(pairs))

def main():
    from distributed import LocalCluster
    killed = []
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                      silence_logs=50) as cluster:
        executor = DaskExecutor.connect(cluster.scheduler_address)
        def kill_one(step):
            if not killed:
                killed.append(next(iter(executor.client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)
        status = run_design(Design("dask", "", made), Path(sys.argv[1]),
                            executor=executor, time_limit_s=600.0, report=kill_one)
        print("KILLED", len(killed), "DONE", status.done, status.failed, status.missing, flush=True)
        os._exit(0)

if __name__ == "__main__":
    main()
"""


@pytest.mark.fe
def test_all_cases_arrive_though_a_worker_is_killed(tmp_path):
    script, path = tmp_path / "cluster.py", tmp_path / "run"
    script.write_text(SCRIPT)
    answer = python(script, path, cwd=tmp_path)
    assert "KILLED 1 DONE 3 0 0" in answer.stdout, answer.stderr
    assert len(read_curves(path)) == 3


@pytest.mark.parametrize("kind", ["SLURMCluster", "PBSCluster"])
def test_the_clusters_of_the_guide_write_their_job_scripts(kind):
    jobqueue = pytest.importorskip("dask_jobqueue")
    # the same words as docs/campaign.md; no batch system is needed to write the script
    options = {"cores": 16, "processes": 16, "memory": "32GB", "walltime": "04:00:00"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with getattr(jobqueue, kind)(**options, dashboard_address=None) as cluster:
            script = cluster.job_script()
    assert "dask" in script
    assert "--nworkers 16" in script
    assert "--nthreads 1" in script


def test_an_address_without_a_scheduler_ends_with_exit_code_2(tmp_path):
    command = ("-m", "dentscope", "campaign", "run", "--scheduler", "tcp://127.0.0.1:9")
    answer = python(*command, cwd=tmp_path)
    assert answer.returncode == 2, answer.stderr
    assert "no dask scheduler at tcp://127.0.0.1:9" in answer.stderr
    assert "Traceback" not in answer.stderr


class Running(list):
    """What dask has on its way: futures that are ready at once."""

    def add(self, future):
        self.append(future)

    def has_ready(self):
        return True

    def __next__(self):
        return self.pop()


@pytest.mark.parametrize(
    ("there", "told"),
    [({}, "went away"),  # a client that gave up
     # what was on its way is given back as cancelled: no case fails
     ({"workers": {"tcp://worker:1": {}}}, "went away; all completed cases are kept")],
)  # fmt: skip
def test_a_scheduler_that_goes_away_is_told(monkeypatch, there, told):
    monkeypatch.setattr("distributed.as_completed", Running)
    lost = SimpleNamespace(key="case-a", cancelled=lambda: True)
    client = SimpleNamespace(scheduler_info=lambda: there, submit=lambda *_, **__: lost)
    cases = {"a": SimpleNamespace(specification=dict)} if there else {}
    ended = DaskExecutor("tcp://nowhere:1", 1, client).run(cases, time_limit_s=1.0)
    with pytest.raises(InputError, match=told):
        next(ended)


SUBJECT = ["-subj", "/CN=localhost"]
CONNECT = """
import sys
from dentscope.campaigns.executor import DaskExecutor
from dentscope.core import InputError

if __name__ == "__main__":
    try:
        executor = DaskExecutor.connect(sys.argv[1], timeout_s=60.0, patience_s=float(sys.argv[2]))
        print("CONNECTED", executor.workers, executor.client.submit(sum, [1, 2]).result())
    except InputError as error:
        print("TOLD", str(error).count(chr(10)), error)
"""


class Cluster:
    """A scheduler and workers in processes of their own."""

    def __init__(self, folder, *, protocol="tcp", environment=None):
        self.folder, self.environment, self.processes = folder, {**os.environ}, []
        self.environment |= environment or {}
        self.file = folder / "scheduler.json"
        self.start("scheduler", "--port", "0", "--protocol", protocol, "--host", "127.0.0.1")
        until = time.monotonic() + 120.0
        while not (self.file.exists() and self.file.read_text()) and time.monotonic() < until:
            time.sleep(0.1)
        self.address = json.loads(self.file.read_text())["address"]

    def start(self, name, *options, **changes):
        command = [sys.executable, "-m", f"distributed.cli.dask_{name}", *options]
        command += ["--no-dashboard", "--scheduler-file", str(self.file)]
        self.processes.append(
            subprocess.Popen(
                command, env={**self.environment, **changes}, cwd=self.folder,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )
        )  # fmt: skip

    def worker(self, **changes):
        self.start("worker", "--nthreads", "1", "--no-nanny", "--death-timeout", "60", **changes)

    def connect(self, patience_s=120.0, **changes):
        script = self.folder / "connect.py"
        script.write_text(CONNECT)
        address = changes.pop("address", self.address)
        answer = python(script, address, patience_s, env={**self.environment, **changes})
        return answer.stdout + answer.stderr

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()
            process.wait()


def test_a_cluster_without_workers_is_one_line(tmp_path):
    with Cluster(tmp_path) as cluster:
        told = cluster.connect(patience_s=1.0)
    assert "TOLD 0 tcp://" in told
    assert "no worker within 1 s" in told


def test_every_result_is_held_to_the_versions_of_its_worker():
    mine = environment()
    assert executor._ended("a", ("solution", mine), where="w").computed_by == mine
    for other, told in (
        ({"numpy": "1.0"}, r"numpy .*, there 1\.0"),
        ({"source": "0", "commit": "c"}, "source of commit .*, there c"),
    ):
        with pytest.raises(InputError, match=f"w: other versions: {told}"):
            executor._ended("a", ("solution", {**mine, **other}), where="w")


def checked(*answers):
    """Ask workers for their versions, each of which answers this."""

    def run(_, *, on_error):
        assert on_error == "return"
        if not answers:
            raise comm.CommClosedError("in <Client>: Stream is closed")
        return {f"tcp://worker:{k}": answer for k, answer in enumerate(answers)}

    return DaskExecutor("tcp://here:1", 1, SimpleNamespace(run=run))._check_workers()


def test_a_worker_that_dies_while_it_is_asked_is_left_out():
    mine, gone = environment(), OSError("Stream is closed")
    assert checked(mine, gone, mine) == 2
    with pytest.raises(InputError, match="cannot say its versions"):
        checked(gone, ModuleNotFoundError("dentscope"))
    with pytest.raises(InputError, match="scheduler went away"):
        checked()


def certificates(folder):
    """An authority and one certificate that it signed; return the settings that name them."""
    key = ["-newkey", "rsa:2048", "-nodes"]
    made = [
        ["req", "-x509", *key, "-keyout", "ca.key", "-out", "ca.pem", "-days", "2", *SUBJECT],
        ["req", *key, "-keyout", "host.key", "-out", "host.csr", *SUBJECT],
        ["x509", "-req", "-in", "host.csr", "-CA", "ca.pem", "-CAkey", "ca.key",
         "-CAcreateserial", "-out", "host.pem", "-days", "2", "-extfile", "host.ext"],
    ]  # fmt: skip
    (folder / "host.ext").write_text("subjectAltName = IP:127.0.0.1\n")
    for command in made:
        subprocess.run(["openssl", *command], cwd=folder, check=True, capture_output=True)
    tls = "DASK_DISTRIBUTED__COMM__TLS__"
    host = {"CERT": str(folder / "host.pem"), "KEY": str(folder / "host.key")}
    who = ("SCHEDULER", "WORKER", "CLIENT")
    return {
        "DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION": "true",
        f"{tls}CA_FILE": str(folder / "ca.pem"),
        **{f"{tls}{w}__{what}": place for w in who for what, place in host.items()},
    }


@pytest.mark.skipif(shutil.which("openssl") is None, reason="makes the certificates")
def test_an_encrypted_cluster_takes_those_with_certificates_only(tmp_path):
    settings = certificates(tmp_path)
    with Cluster(tmp_path, protocol="tls", environment=settings) as cluster:
        assert cluster.address.startswith("tls://")
        cluster.worker()
        assert "CONNECTED 1 3" in cluster.connect()
        stranger = dict.fromkeys(settings, "")
        stranger["DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION"] = "false"
        told = cluster.connect(**stranger)
        assert "TOLD 0 scheduler: no dask scheduler at tls://" in told, told
        plain = cluster.address.replace("tls://", "tcp://")
        told = cluster.connect(address=plain, **stranger)
        assert "TOLD 0 scheduler: no dask scheduler at tcp://" in told, told
