"""The same cases through a real dask cluster, one of whose workers is killed."""

import os
import signal

import pytest
from dentscope import fem
from dentscope.campaigns import Design, read_curves, run_design, standard_case
from dentscope.campaigns.executor import DaskExecutor
from dentscope.core import InputError, Material, Pair

distributed = pytest.importorskip("distributed")


def made():
    flat = Material(E=200e9, nu=0.3, Sy=3e8)
    return tuple(
        standard_case(
            f"c{i}",
            Pair(Material(E=200e9, nu=0.3, Sy=4e8 + 1e7 * i), flat, 1e-3),
            deepest=3e-4,
            n_depths=4,
            accuracy=fem.Accuracy.smoke(),
        )
        for i in range(3)
    )


@pytest.mark.fe
def test_all_cases_arrive_though_a_worker_is_killed(tmp_path):
    path = tmp_path / "c.h5"
    killed = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        executor = DaskExecutor.connect(cluster.scheduler_address)

        def kill_one(step):
            if not killed:
                pids = executor.client.run(os.getpid)
                killed.append(next(iter(pids.values())))
                os.kill(killed[0], signal.SIGKILL)

        status = run_design(
            Design("dask", "", made), path, executor=executor, time_limit_s=120.0, report=kill_one
        )
        executor.client.close()
    assert killed
    assert (status.done, status.failed, status.missing) == (3, 0, 0)
    assert len(read_curves(path)) == 3


def test_an_address_without_a_scheduler_is_one_line():
    with pytest.raises(InputError, match="no dask scheduler at") as caught:
        DaskExecutor.connect("tcp://127.0.0.1:9", timeout_s=1.0)
    assert "\n" not in str(caught.value)
