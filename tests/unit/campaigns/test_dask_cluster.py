"""The same cases through a real dask cluster, one of whose workers is killed.

The cluster lives in a process of its own: its event loop and the test runner's workers do not share
one well.
"""

import subprocess
import sys
from pathlib import Path

import pytest
from dentscope.campaigns import read_curves

pytest.importorskip("distributed")

SCRIPT = """
import os, signal, sys
from pathlib import Path
from distributed import LocalCluster
from dentscope import fem
from dentscope.campaigns import Design, run_design, standard_case
from dentscope.campaigns.executor import DaskExecutor
from dentscope.core import Material, Pair

def made():
    flat = Material(E=200e9, nu=0.3, Sy=3e8)
    pairs = [Pair(Material(E=200e9, nu=0.3, Sy=4e8 + 1e7 * i), flat, 1e-3) for i in range(3)]
    smoke = fem.Accuracy.smoke()
    return tuple(standard_case(f"c{i}", p, deepest=3e-4, n_depths=4, accuracy=smoke)
                 for i, p in enumerate(pairs))

def main():
    killed = []
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                      silence_logs=50) as cluster:
        executor = DaskExecutor.connect(cluster.scheduler_address)
        def kill_one(step):
            if not killed:
                killed.append(next(iter(executor.client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)
        status = run_design(Design("dask", "", made), Path(sys.argv[1]), executor=executor,
                            time_limit_s=120.0, report=kill_one)
        print("KILLED", len(killed), "DONE", status.done, status.failed, status.missing, flush=True)
        os._exit(0)

if __name__ == "__main__":
    main()
"""


@pytest.mark.fe
def test_all_cases_arrive_though_a_worker_is_killed(tmp_path):
    script, path = tmp_path / "cluster.py", tmp_path / "c.h5"
    script.write_text(SCRIPT)
    answer = subprocess.run(
        [sys.executable, str(script), str(path)],
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
        cwd=Path(tmp_path),
    )
    assert "KILLED 1 DONE 3 0 0" in answer.stdout, answer.stderr
    assert len(read_curves(path)) == 3


def test_an_address_without_a_scheduler_ends_with_exit_code_2(tmp_path):
    answer = subprocess.run(
        [sys.executable, "-m", "dentscope", "campaign", "run", "--scheduler", "tcp://127.0.0.1:9"],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=tmp_path,
    )
    assert answer.returncode == 2, answer.stderr
    assert "no dask scheduler at tcp://127.0.0.1:9" in answer.stderr
    assert "Traceback" not in answer.stderr
